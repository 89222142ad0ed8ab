//! Structures with locations in buffers of constants, in HLSL. naga writes no padding into a structure
//! whose members have locations, so that they would lie elsewhere than in WGSL.

use naga::{AddressSpace, Handle, Module, Span, StructMember, Type, TypeInner};

/// Why a program is refused.
pub const LOCATED: &str = "a structure with locations has gaps, which are lost in a buffer: use \
     another structure for the buffer";

/// The variables whose structures lose gaps.
pub fn lost_gaps(module: &Module) -> Vec<Span> {
    let constants = module.global_variables.iter().filter(|(_, variable)| {
        matches!(variable.space, AddressSpace::Uniform | AddressSpace::Immediate)
    });
    let lost = constants.filter(|(_, variable)| loses_gaps(module, variable.ty, false));
    lost.map(|(handle, _)| module.global_variables.get_span(handle)).collect()
}

/// Whether a type, or one in it, loses a gap. A gap at the end counts where something may follow.
fn loses_gaps(module: &Module, ty: Handle<Type>, is_inner: bool) -> bool {
    match &module.types[ty].inner {
        TypeInner::Struct { members, span } => {
            let has_locations = members.iter().any(|member| member.binding.is_some());
            let is_lost = || {
                let end = if is_inner { *span } else { 0 };
                has_gap(module, members, end)
            };
            (has_locations && is_lost())
                || members.iter().any(|member| loses_gaps(module, member.ty, true))
        }
        TypeInner::Array { base, size: _, stride: _ }
        | TypeInner::BindingArray { base, size: _ } => loses_gaps(module, *base, is_inner),
        _ => false,
    }
}

fn has_gap(module: &Module, members: &[StructMember], end: u32) -> bool {
    let mut last = 0;
    for member in members {
        if member.offset > last {
            return true;
        }
        last = member.offset + module.types[member.ty].inner.size(module.to_ctx());
    }
    end > last
}

#[cfg(test)]
mod tests {
    use super::lost_gaps;

    fn count(text: &str) -> Result<usize, naga::front::wgsl::ParseError> {
        Ok(lost_gaps(&naga::front::wgsl::parse_str(text)?).len())
    }

    #[test]
    fn gaps() -> Result<(), naga::front::wgsl::ParseError> {
        let gap = "struct S { @location(0) a: f32, @location(1) b: vec3f }";
        assert_eq!(count(&format!("{gap} @group(0) @binding(0) var<uniform> s: S;"))?, 1);
        let storage = "@group(0) @binding(0) var<storage> s: S;";
        assert_eq!(count(&format!("{gap} {storage}"))?, 0);
        let plain = "struct S { a: f32, b: vec3f }";
        assert_eq!(count(&format!("{plain} @group(0) @binding(0) var<uniform> s: S;"))?, 0);
        let end = "struct S { @location(0) a: vec3f } struct T { s: S, b: f32 }";
        assert_eq!(count(&format!("{end} @group(0) @binding(0) var<uniform> t: T;"))?, 1);
        assert_eq!(count(&format!("{end} @group(0) @binding(0) var<uniform> s: S;"))?, 0);
        Ok(())
    }
}
