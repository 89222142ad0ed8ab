//! The twins of a module, in WESL and in GLSL, have the same functions.

use std::collections::BTreeMap;

use libtest_mimic::Failed;
use naga::{Handle, Module, Type, TypeInner};

use super::{functions, parse_glsl, parse_wesl, read};

/// The functions of a module have the same comments and signatures in both languages. Structures are
/// compared as part of signatures.
pub fn twins_agree(module: &str) -> Result<(), Failed> {
    let documented = |path: String| -> Vec<(String, Vec<String>)> {
        functions(&read(&path)).into_iter().map(|f| (f.name, f.doc)).collect()
    };
    let wesl = documented(format!("{module}.wesl"));
    same("comments", &wesl, &documented(format!("{module}.glsl")))?;
    let own = |parsed: Module| -> BTreeMap<String, String> {
        signatures(&parsed)
            .into_iter()
            .filter(|(name, _)| wesl.iter().any(|(own, _)| own == name))
            .collect()
    };
    same("signatures", &own(parse_wesl(module)?), &own(parse_glsl(module)?))
}

/// The parameters and the result of each function, by name.
fn signatures(module: &Module) -> BTreeMap<String, String> {
    let functions = module.functions.iter().map(|(_, function)| {
        let name = |name: &Option<String>| name.clone().unwrap_or_default();
        let parameters: Vec<String> = function
            .arguments
            .iter()
            .map(|argument| format!("{}: {}", name(&argument.name), spelled(module, argument.ty)))
            .collect();
        let result =
            function.result.as_ref().map_or(String::new(), |result| spelled(module, result.ty));
        (name(&function.name), format!("({}) -> {result}", parameters.join(", ")))
    });
    functions.filter(|(name, _)| name != "main").collect()
}

fn spelled(module: &Module, handle: Handle<Type>) -> String {
    let Type { name, inner } = &module.types[handle];
    match inner {
        TypeInner::Struct { members, .. } => {
            let members = members.iter().map(|member| {
                format!("{:?}@{}: {}", member.name, member.offset, spelled(module, member.ty))
            });
            format!("{name:?} {{ {} }}", members.collect::<Vec<_>>().join(", "))
        }
        TypeInner::Array { base, size, .. } => {
            format!("array<{}, {size:?}>", spelled(module, *base))
        }
        other => format!("{other:?}"),
    }
}

pub fn same<T: PartialEq + std::fmt::Debug>(what: &str, wesl: &T, glsl: &T) -> Result<(), Failed> {
    if wesl == glsl {
        Ok(())
    } else {
        Err(format!("{what} differ\nWESL: {wesl:#?}\nGLSL: {glsl:#?}").into())
    }
}
