//! Types and built-ins as WGSL spells them.

use std::fmt::Display;

use naga::common::wgsl::{ToWgsl, TypeContext};
use naga::{Handle, Module, Type, TypeInner};

/// The type as WGSL declares it; a struct by its name.
pub fn type_name(module: &Module, ty: Handle<Type>) -> String {
    match &module.types[ty] {
        Type { name: Some(name), inner: TypeInner::Struct { members: _, span: _ } } => name.clone(),
        Type { name: None, inner: TypeInner::Struct { members: _, span: _ } } => {
            "struct".to_owned()
        }
        _ => module.to_ctx().type_to_string(ty),
    }
}

/// The name that a writer gave the entry point.
pub fn first_entry_name<E: Display>(names: Vec<Result<String, E>>) -> Result<String, String> {
    let first = names.into_iter().next().ok_or("no entry point was written")?;
    first.map_err(|error| error.to_string())
}

/// The built-in's name in `@builtin`.
pub fn builtin_name(builtin: naga::BuiltIn) -> String {
    use naga::common::wgsl::TryToWgsl;
    builtin.try_to_wgsl().map_or_else(|| format!("{builtin:?}"), str::to_owned)
}

/// `perspective`, `linear` or `flat`.
pub fn interpolation_name(interpolation: naga::Interpolation) -> String {
    interpolation.to_wgsl().to_owned()
}

/// `center`, `centroid` or `sample`.
pub fn sampling_name(sampling: naga::Sampling) -> String {
    sampling.to_wgsl().to_owned()
}
