//! `enable` in WGSL, which browsers ask for. naga reads what subgroups allow without it, and does not
//! write it; and it writes `enable f16;` only where a type of the module is of `f16`.

use naga::{Binding, BuiltIn, Expression, Function, Module, Scalar, TypeInner};

use lamplight_validate::{functions, makes_scalar};

/// The directive of an extension, and whether a module needs it.
type Extension = (&'static str, fn(&Module) -> bool);

const EXTENSIONS: [Extension; 3] = [
    ("enable subgroups;\n", uses_subgroups),
    ("enable primitive_index;\n", uses_primitive_index),
    ("enable f16;\n", uses_f16),
];

/// The text that naga wrote of a module, with the extensions that the module needs.
pub fn with_extensions(text: String, module: &Module) -> String {
    EXTENSIONS.iter().fold(text, |text, (directive, is_used)| {
        match !text.contains(directive) && is_used(module) {
            true => format!("{directive}{text}"),
            false => text,
        }
    })
}

/// Whether a conversion or a number is of `f16`; naga sees types by itself.
fn uses_f16(module: &Module) -> bool {
    functions(module).any(|function| {
        function.expressions.iter().any(|(_, value)| makes_scalar(value, Scalar::F16))
    })
}

fn uses_subgroups(module: &Module) -> bool {
    let is_built_in = |built_in: BuiltIn| {
        matches!(
            built_in,
            BuiltIn::NumSubgroups
                | BuiltIn::SubgroupId
                | BuiltIn::SubgroupSize
                | BuiltIn::SubgroupInvocationId
        )
    };
    let computes = |function: &Function| {
        function.expressions.iter().any(|(_, value)| {
            matches!(
                value,
                Expression::SubgroupBallotResult | Expression::SubgroupOperationResult { .. }
            )
        })
    };
    takes_built_in(module, is_built_in) || functions(module).any(computes)
}

fn uses_primitive_index(module: &Module) -> bool {
    takes_built_in(module, |built_in| built_in == BuiltIn::PrimitiveIndex)
}

/// Whether an argument of a function, or a member of a structure, is such a built-in value.
fn takes_built_in(module: &Module, is_it: impl Fn(BuiltIn) -> bool) -> bool {
    let is_bound = |binding: &Option<Binding>| match binding {
        Some(Binding::BuiltIn(built_in)) => is_it(*built_in),
        Some(Binding::Location {
            location: _,
            interpolation: _,
            sampling: _,
            blend_src: _,
            per_primitive: _,
        })
        | None => false,
    };
    let has_member = module.types.iter().any(|(_, one)| match &one.inner {
        TypeInner::Struct { members, span: _ } => {
            members.iter().any(|member| is_bound(&member.binding))
        }
        _ => false,
    });
    let is_taken =
        |function: &Function| function.arguments.iter().any(|argument| is_bound(&argument.binding));
    has_member || functions(module).any(is_taken)
}
