//! Types, constants and overrides.

use naga::Module;
use naga::valid::{
    ComposeError, ConstExpressionError, ConstantError, LiteralError, OverrideError, TypeError,
    WidthError,
};

use super::{NOT_EVERY, Sentence, entry, foreign_words, lacking_words, type_text};
use crate::advice::Wrong;
use lamplight_diagnostic::codes;

pub fn type_of(module: &Module, name: &str, error: &TypeError) -> Sentence {
    let what = if name.is_empty() { "this type".to_owned() } else { format!("`{name}`") };
    match error {
        TypeError::MissingCapability(capabilities) => lacking_words(*capabilities),
        TypeError::InvalidAtomicWidth(..) => Sentence::plain(format!(
            "{what} is not a type that an atomic can have: `u32` and `i32` are"
        )),
        TypeError::InvalidPointerBase(base) => {
            Sentence::plain(format!("there are no pointers to {}", type_text(module, *base)))
        }
        TypeError::InvalidPointerToUnsized { base, .. } => Sentence::plain(format!(
            "the size of {} is not known, so it can only be in a storage buffer",
            type_text(module, *base)
        )),
        TypeError::InvalidData(base) => {
            Sentence::plain(format!("{} cannot be a member here", type_text(module, *base)))
                .about(Wrong::Held(name.to_owned()))
        }
        TypeError::InvalidArrayBaseType(base) => {
            Sentence::plain(format!("there are no arrays of {}", type_text(module, *base)))
        }
        TypeError::MatrixElementNotFloat => {
            Sentence::plain("the elements of a matrix are floating-point numbers")
        }
        TypeError::UnsupportedSpecializedArrayLength(_) => {
            Sentence::plain("an override cannot be the size of an array")
        }
        TypeError::UnsupportedImageType { arrayed, .. } => {
            let many = if *arrayed { "arrays of such textures" } else { "such textures" };
            foreign_words(many)
        }
        TypeError::InvalidArrayStride { stride, expected } => Sentence::plain(format!(
            "the elements of {what} are {stride} bytes apart, and must be {expected}"
        )),
        TypeError::InvalidDynamicArray(field, _) => {
            Sentence::plain(format!("`{field}` has no fixed size, so it must be the last member"))
        }
        TypeError::BindingArrayBaseTypeNotStruct(_)
        | TypeError::BindingArrayBaseExternalTextures => foreign_words("arrays of such bindings"),
        TypeError::MemberOverlap { index, offset } => Sentence::plain(format!(
            "member {} of {what}, at byte {offset}, overlaps the member before it",
            index + 1
        )),
        TypeError::MemberOutOfBounds { index, offset, size, span } => Sentence::plain(format!(
            "member {} of {what} has {size} bytes at {offset}, beyond the {span} of the structure",
            index + 1
        )),
        TypeError::EmptyStruct => Sentence::plain(format!("{what} needs at least one member")),
        TypeError::InvalidBlendSrc(error) => entry::varying_words(module, error),
        TypeError::WidthError(error) => width_words(error),
        TypeError::UnresolvedOverride(_) | TypeError::InvalidArraySize(_) => {
            Sentence::plain(format!("the size of {what} must be a constant above 0"))
        }
    }
}

pub fn width_words(error: &WidthError) -> Sentence {
    match error {
        WidthError::Invalid(_, bytes) => {
            foreign_words(&format!("numbers of {} bits", u32::from(*bytes) * 8))
        }
        WidthError::MissingCapability { name, .. } => {
            Sentence::coded(codes::NOT_PORTABLE, format!("{NOT_EVERY} the type `{name}`"))
        }
        WidthError::Abstract => {
            Sentence::plain("this number needs a type, such as `1.0f` or `f32(x)`")
        }
    }
}

pub fn literal_words(error: &LiteralError) -> Sentence {
    match error {
        LiteralError::NaN => Sentence::plain("a constant is not a number"),
        LiteralError::Infinity => Sentence::plain("a constant is infinite"),
        LiteralError::Width(error) => width_words(error),
    }
}

pub fn compose_words(module: &Module, error: &ComposeError) -> Sentence {
    match error {
        ComposeError::Type(handle) => Sentence::plain(format!(
            "{} cannot be constructed from components",
            type_text(module, *handle)
        )),
        ComposeError::ComponentCount { given, expected } => Sentence::coded(
            codes::CALL_MISMATCH,
            format!("a constructor takes {expected} components, not {given}"),
        )
        .about(Wrong::Components { given: *given, expected: *expected }),
        ComposeError::ComponentType { index } => Sentence::coded(
            codes::CALL_MISMATCH,
            format!("argument {} of a constructor has another type than it takes", index + 1),
        ),
    }
}

pub fn constant_words(module: &Module, error: &ConstExpressionError) -> Sentence {
    match error {
        ConstExpressionError::NonConstOrOverride | ConstExpressionError::NonFullyEvaluatedConst => {
            Sentence::plain("this must be known when the shader is compiled")
        }
        ConstExpressionError::Compose(error) => compose_words(module, error),
        ConstExpressionError::InvalidSplatType(_) => {
            Sentence::plain("only a scalar can fill all components of a vector")
        }
        ConstExpressionError::Type(_) => {
            Sentence::plain("the type of a constant cannot be inferred")
        }
        ConstExpressionError::Literal(error) => literal_words(error),
        ConstExpressionError::Width(error) => width_words(error),
    }
}

pub fn of_constant(name: &str, error: &ConstantError) -> String {
    match error {
        ConstantError::InitializerExprType => {
            format!("the value of `{name}` must be known when the shader is compiled")
        }
        ConstantError::InvalidType => format!("the value of `{name}` does not fit its type"),
        ConstantError::NonConstructibleType => {
            format!("`{name}` has a type that a constant cannot have")
        }
    }
}

pub fn of_override(module: &Module, name: &str, error: &OverrideError) -> Sentence {
    let text = match error {
        OverrideError::MissingNameAndID => "an override needs a name".to_owned(),
        OverrideError::DuplicateID => format!("the `@id` of `{name}` is used twice"),
        OverrideError::InitializerExprType => {
            format!("the default of `{name}` must be a constant")
        }
        OverrideError::InvalidType => format!("the default of `{name}` does not fit its type"),
        OverrideError::NonConstructibleType | OverrideError::TypeNotScalar => {
            format!("`{name}` is an override, and those are booleans or numbers")
        }
        OverrideError::NotAllowed => "there are no overrides here".to_owned(),
        OverrideError::UninitializedOverride => format!("`{name}` needs a default"),
        OverrideError::ConstExpression { source, .. } => return constant_words(module, source),
    };
    Sentence::plain(text)
}
