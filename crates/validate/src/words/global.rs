//! Variables of a module.

use naga::valid::GlobalVariableError;
use naga::{AddressSpace, Module};

use super::{Sentence, foreign_words, lacking_words, type_text};

pub fn variable_words(module: &Module, name: &str, error: &GlobalVariableError) -> Sentence {
    let text = match error {
        GlobalVariableError::InvalidUsage(space) => {
            format!("`{name}` is used in a way that {} does not allow", space_name(*space))
        }
        GlobalVariableError::InvalidType(space) => {
            format!("`{name}` has a type that {} cannot hold", space_name(*space))
        }
        GlobalVariableError::InvalidBindingArray(handle) => {
            format!("there are no arrays of bindings of {}", type_text(module, *handle))
        }
        GlobalVariableError::MissingTypeFlags { .. } => format!(
            "`{name}` has a type that cannot be in a buffer: booleans, textures and pointers cannot"
        ),
        GlobalVariableError::UnsupportedCapability(capabilities) => {
            return lacking_words(*capabilities);
        }
        GlobalVariableError::InvalidBinding => format!(
            "`{name}` needs `@group` and `@binding`, or must not have them: resources have them, \
             other variables do not"
        ),
        GlobalVariableError::Alignment(_, handle, disalignment) => {
            return Sentence::plain(format!(
                "the layout of {} does not fit a uniform buffer",
                type_text(module, *handle)
            ))
            .note(disalignment.to_string().to_lowercase());
        }
        GlobalVariableError::InitializerExprType => {
            format!("the first value of `{name}` must be a constant")
        }
        GlobalVariableError::InitializerType => {
            format!("the first value of `{name}` does not fit its type")
        }
        GlobalVariableError::InitializerNotAllowed(space) => {
            format!("`{name}` is in {}, and has no first value there", space_name(*space))
        }
        GlobalVariableError::StorageAddressSpaceWriteOnlyNotSupported => {
            format!("`{name}` must be readable: storage buffers are `read` or `read_write`")
        }
        GlobalVariableError::InvalidImmediateType(_)
        | GlobalVariableError::ZeroSizedTaskPayload
        | GlobalVariableError::InvalidMemoryDecorationsAddressSpace
        | GlobalVariableError::CoherentNotSupported
        | GlobalVariableError::VolatileNotSupported => {
            return foreign_words(&format!("the kind of variable that `{name}` is"));
        }
    };
    Sentence::plain(text)
}

pub fn space_name(space: AddressSpace) -> &'static str {
    match space {
        AddressSpace::Function => "a function",
        AddressSpace::Private => "the private variables of a module",
        AddressSpace::WorkGroup => "the memory of a workgroup",
        AddressSpace::Uniform => "a uniform buffer",
        AddressSpace::Storage { .. } => "a storage buffer",
        AddressSpace::Handle => "a binding",
        AddressSpace::Immediate
        | AddressSpace::TaskPayload
        | AddressSpace::RayPayload
        | AddressSpace::IncomingRayPayload => "memory that no target has",
    }
}
