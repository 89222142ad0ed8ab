//! Arrays whose elements lie further apart than WGSL and Metal put them.
//!
//! In std140 the elements of an array begin at multiples of 16 bytes, which for numbers and vectors
//! of two is more than their size. naga's GLSL front end knows this. Its writers of WGSL and Metal
//! write the type of the elements alone, so these languages would read other bytes.

use naga::proc::Layouter;
use naga::{AddressSpace, Handle, Module, Span, Type, TypeInner};

use lamplight_bundle::Target;

/// What is wrong, and what to write.
pub const WIDE: &str = "an array of numbers or of vectors of two in a uniform block would lie \
                        closer together there: use `vec4` as its elements";

/// The places of the variables that `target` would read wrongly.
pub fn wide_arrays(module: &Module, target: Target) -> Vec<Span> {
    let in_buffers = |space: AddressSpace| match space {
        AddressSpace::Uniform => [Target::WGSL, Target::MSL].contains(&target),
        // naga writes storage buffers of GLSL in std430, whatever the author's layout is.
        AddressSpace::Storage { access: _ } => ![Target::SPIRV, Target::HLSL].contains(&target),
        _ => false,
    };
    let variables = module.global_variables.iter();
    let mut variables = variables.filter(|(_, one)| in_buffers(one.space)).peekable();
    let mut layouter = Layouter::default();
    if variables.peek().is_none() || layouter.update(module.to_ctx()).is_err() {
        return Vec::new();
    }
    let is_wide = |ty| has_wide(module, &layouter, ty);
    let wide = variables.filter(|(_, one)| is_wide(one.ty));
    wide.map(|(handle, _)| module.global_variables.get_span(handle)).collect()
}

/// Whether a type has an array that is too wide.
fn has_wide(module: &Module, layouter: &Layouter, ty: Handle<Type>) -> bool {
    match &module.types[ty].inner {
        TypeInner::Array { base, size: _, stride } => {
            layouter[*base].to_stride() != *stride || has_wide(module, layouter, *base)
        }
        TypeInner::Struct { members, span: _ } => {
            members.iter().any(|member| has_wide(module, layouter, member.ty))
        }
        _ => false,
    }
}
