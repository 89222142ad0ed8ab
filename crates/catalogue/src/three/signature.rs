//! What a function takes and gives, in the types of TSL.

use std::collections::BTreeMap;

use lamplight_translate::tree::{Function, Scalar, Type};

/// The parameters of a function with their types, and its result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signature {
    pub parameters: Vec<(String, String)>,
    pub result: String,
}

/// The signature of a function; the error is the reason why no node has it.
pub(super) fn signature_of(
    function: &Function,
    aliases: &BTreeMap<String, Type>,
) -> Result<Signature, String> {
    if function.stage.is_some() {
        return Err("it is an entry point".to_owned());
    }
    let mut parameters = Vec::new();
    for node in &function.parameters {
        let name = &node.body.name;
        let ty = type_name(&node.body.ty, aliases)
            .map_err(|what| format!("its parameter `{name}` is {what}"))?;
        parameters.push((name.clone(), ty));
    }
    let result = function.result.as_ref().ok_or("it has no result")?;
    let result = type_name(&result.ty, aliases).map_err(|what| format!("its result is {what}"))?;
    Ok(Signature { parameters, result })
}

/// The name of a type in TSL; the error says what it is.
fn type_name(ty: &Type, aliases: &BTreeMap<String, Type>) -> Result<String, String> {
    let prefix = |scalar: Scalar| match scalar {
        Scalar::Bool => "b",
        Scalar::I32 | Scalar::AbstractInteger => "i",
        Scalar::U32 => "u",
        Scalar::F32 | Scalar::AbstractFloat => "",
    };
    let what = match ty {
        Type::Scalar(scalar) => return Ok(scalar_name(*scalar).to_owned()),
        Type::Vector(size, scalar) => return Ok(format!("{}vec{size}", prefix(*scalar))),
        Type::Matrix { columns, rows, scalar: Scalar::F32 } if columns == rows => {
            return Ok(format!("mat{columns}"));
        }
        Type::Named(name) => match aliases.get(name) {
            Some(meant) => return type_name(meant, aliases),
            None => "a structure",
        },
        Type::Matrix { .. } => "a matrix that is not square",
        Type::Array(..) => "an array",
        Type::Structure(_) => "a structure",
        Type::Pointer(..) => "a pointer, by which it gives a result",
        Type::Atomic(_) => "atomic",
        Type::Texture(_) => "a texture",
        Type::Sampler { .. } => "a sampler",
        Type::Unknown
        | Type::Nothing
        | Type::OpenVector(_)
        | Type::OpenMatrix { .. }
        | Type::OpenArray => "of a type without a name in TSL",
    };
    Err(what.to_owned())
}

fn scalar_name(scalar: Scalar) -> &'static str {
    match scalar {
        Scalar::Bool => "bool",
        Scalar::I32 | Scalar::AbstractInteger => "int",
        Scalar::U32 => "uint",
        Scalar::F32 | Scalar::AbstractFloat => "float",
    }
}
