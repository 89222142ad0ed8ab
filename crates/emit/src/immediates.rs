//! Immediates, which are push constants in Vulkan: the languages without them have a uniform buffer
//! in their place.

use naga::valid::ModuleInfo;
use naga::{AddressSpace, GlobalVariable, Module, ResourceBinding, Span};

use lamplight_validate::info_for_some;

/// Where the buffer is: in the first group that devices have only where more were asked for.
pub const PLACE: ResourceBinding = ResourceBinding { group: 4, binding: 0 };

/// Why a module with these immediates has no such buffer.
const TAKEN: &str = "group 4 binding 0, which immediates are bound to there, has a binding already";
const LAYOUT: &str = "immediates are a uniform buffer there, in which a structure within the \
                      structure lies at a multiple of 16 bytes: write `@align(16)` at it";

/// Whether a variable is one of immediates.
pub fn is_immediate(variable: &GlobalVariable) -> bool {
    variable.space == AddressSpace::Immediate
}

/// The group and binding of a variable, of immediates as well.
pub fn place(variable: &GlobalVariable) -> Option<ResourceBinding> {
    variable.binding.or_else(|| is_immediate(variable).then_some(PLACE))
}

/// The module with a uniform buffer in the place of immediates, and naga's analysis of it; `None`
/// where it has none.
///
/// # Errors
/// Why there is no such buffer.
pub fn as_uniform(module: &Module) -> Result<Option<(Module, ModuleInfo)>, String> {
    if !module.global_variables.iter().any(|(_, variable)| is_immediate(variable)) {
        return Ok(None);
    }
    if module.global_variables.iter().any(|(_, variable)| variable.binding == Some(PLACE)) {
        return Err(TAKEN.to_owned());
    }
    let mut module = module.clone();
    for (_, variable) in module.global_variables.iter_mut() {
        if is_immediate(variable) {
            variable.space = AddressSpace::Uniform;
            variable.binding = Some(PLACE);
        }
    }
    let info = info_for_some(&module).map_err(|_| LAYOUT.to_owned())?;
    Ok(Some((module, info)))
}

/// Why a module has no such buffer, and the place of the variable.
pub fn lack(module: &Module) -> Option<(String, Span)> {
    let reason = as_uniform(module).err()?;
    let (handle, _) = module.global_variables.iter().find(|(_, one)| is_immediate(one))?;
    Some((reason, module.global_variables.get_span(handle)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lack_of(text: &str) -> Option<String> {
        let module = naga::front::wgsl::parse_str(text).unwrap();
        lack(&module).map(|(reason, _)| reason)
    }

    #[test]
    fn only_what_a_uniform_buffer_cannot_be_is_refused() {
        let text = "struct Inner { x: f32 }\nstruct All { x: f32, INNER: Inner }\n\
            var<immediate> all: All;\n@fragment fn f() -> @location(0) vec4f {\n\
            return vec4f(all.inner.x); }";
        assert_eq!(lack_of(&text.replace("INNER", "inner")).as_deref(), Some(LAYOUT));
        assert_eq!(lack_of(&text.replace("INNER", "@align(16) inner")), None);
        let taken = "\n@group(4) @binding(0) var<uniform> other: vec4f;";
        let text = text.replace("INNER", "@align(16) inner") + taken;
        assert_eq!(lack_of(&text).as_deref(), Some(TAKEN));
    }
}
