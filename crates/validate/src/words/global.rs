//! Variables of a module.

use naga::valid::{Disalignment, GlobalVariableError};
use naga::{AddressSpace, Expression, Handle, Module, TypeInner};

use crate::advice::{Variable, Wrong};

use super::{Sentence, foreign_words, inner_type_text, lacking_words, type_text};

pub fn variable_words(module: &Module, name: &str, error: &GlobalVariableError) -> Sentence {
    let text = match error {
        GlobalVariableError::InvalidUsage(space) => {
            format!("`{name}` is used in a way that {} does not allow", space_name(*space))
        }
        GlobalVariableError::InvalidType(AddressSpace::Handle) => {
            return Sentence::plain(format!("`{name}` does not say where it is"))
                .note("textures and samplers are declared without an address space, and no others")
                .about(Wrong::Variable(name.to_owned(), Variable::Spaceless));
        }
        GlobalVariableError::InvalidType(space) => {
            format!("`{name}` has a type that {} cannot hold", space_name(*space))
        }
        GlobalVariableError::InvalidBindingArray(handle) => {
            format!("there are no arrays of bindings of {}", type_text(module, *handle))
        }
        GlobalVariableError::MissingTypeFlags { .. } => return held_words(module, name),
        GlobalVariableError::UnsupportedCapability(capabilities) => {
            return lacking_words(*capabilities);
        }
        GlobalVariableError::InvalidBinding => return binding_words(module, name),
        GlobalVariableError::Alignment(_, handle, disalignment) => {
            return layout_words(module, name, *handle, disalignment);
        }
        GlobalVariableError::InitializerExprType => {
            format!("the initializer of `{name}` must be a constant expression")
        }
        GlobalVariableError::InitializerType => return initializer_words(module, name),
        GlobalVariableError::InitializerNotAllowed(space) => {
            let space = space_words(*space);
            return Sentence::plain(format!(
                "variables in {space} cannot have an initializer, and `{name}` has one"
            ))
            .about(Wrong::Variable(name.to_owned(), Variable::Initialised));
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

/// A type whose layout a uniform buffer does not have.
fn layout_words(
    module: &Module,
    name: &str,
    of_type: Handle<naga::Type>,
    disalignment: &Disalignment,
) -> Sentence {
    let sentence = Sentence::plain(format!(
        "the layout of {} does not fit a uniform buffer",
        type_text(module, of_type)
    ));
    match disalignment {
        Disalignment::ArrayStride { .. } => sentence
            .note(disalignment.to_string().to_lowercase())
            .about(Wrong::Variable(name.to_owned(), Variable::Strided)),
        Disalignment::NonHostShareable => {
            sentence.about(Wrong::Variable(name.to_owned(), Variable::Boolean))
        }
        _ => sentence.note(disalignment.to_string().to_lowercase()),
    }
}

/// A variable without a binding that needs one, or with one.
fn binding_words(module: &Module, name: &str) -> Sentence {
    let found =
        module.global_variables.iter().find(|(_, found)| found.name.as_deref() == Some(name));
    match found {
        Some((_, variable)) if variable.binding.is_some() => Sentence::plain(format!(
            "`{name}` has `@group` and `@binding`, which only buffers, textures and samplers have"
        ))
        .note("help: leave them out"),
        _ => Sentence::plain(format!("`{name}` needs `@group` and `@binding`"))
            .about(Wrong::Variable(name.to_owned(), Variable::Unbound)),
    }
}

/// The error for an initializer of another type, with both types.
fn initializer_words(module: &Module, name: &str) -> Sentence {
    let found = module
        .global_variables
        .iter()
        .find(|(_, variable)| variable.name.as_deref() == Some(name) && variable.init.is_some());
    let types = found.map_or_else(String::new, |(_, variable)| {
        let expected = type_text(module, variable.ty);
        let found = variable.init.and_then(|init| constant_type(module, init));
        let found = found.map_or(String::new(), |found| format!(", found {found}"));
        format!(": expected {expected}{found}")
    });
    super::function::mismatch_words(format!(
        "the initializer of `{name}` has the wrong type{types}"
    ))
}

/// The type of a constant expression, where the expression itself names it.
fn constant_type(module: &Module, handle: Handle<Expression>) -> Option<String> {
    match &module.global_expressions[handle] {
        Expression::Literal(literal) => {
            Some(inner_type_text(module, &TypeInner::Scalar(literal.scalar())))
        }
        Expression::Compose { ty, components: _ } | Expression::ZeroValue(ty) => {
            Some(type_text(module, *ty))
        }
        Expression::Constant(constant) => Some(type_text(module, module.constants[*constant].ty)),
        _ => None,
    }
}

/// An address space as WGSL names it, with its name for people where that is another one.
fn space_words(space: AddressSpace) -> &'static str {
    match space {
        AddressSpace::Private => "`<private>`",
        AddressSpace::WorkGroup => "`<workgroup>`",
        AddressSpace::Uniform => "`<uniform>`",
        AddressSpace::Storage { .. } => "`<storage>`",
        AddressSpace::Function
        | AddressSpace::Handle
        | AddressSpace::Immediate
        | AddressSpace::TaskPayload
        | AddressSpace::RayPayload
        | AddressSpace::IncomingRayPayload => space_name(space),
    }
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

/// About a variable whose type its address space cannot hold.
fn held_words(module: &Module, name: &str) -> Sentence {
    if is_endless(module, name) {
        return Sentence::plain(format!(
            "`{name}` is an array without a length, which only `storage` can hold"
        ))
        .note("help: give it a length, or declare it as `var<storage>`");
    }
    Sentence::plain(format!(
        "`{name}` has a type that cannot be in a buffer: booleans, textures and pointers cannot"
    ))
}

/// Whether a variable that is not in `storage` is an array without a length.
fn is_endless(module: &Module, name: &str) -> bool {
    let named =
        module.global_variables.iter().find(|(_, found)| found.name.as_deref() == Some(name));
    named.is_some_and(|(_, variable)| {
        let is_dynamic = matches!(
            module.types[variable.ty].inner,
            TypeInner::Array { size: naga::ArraySize::Dynamic, .. }
        );
        is_dynamic && !matches!(variable.space, AddressSpace::Storage { .. })
    })
}
