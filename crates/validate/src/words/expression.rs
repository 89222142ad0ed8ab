//! Expressions.

use naga::front::Typifier;
use naga::proc::ResolveContext;
use naga::valid::ExpressionError;
use naga::{BinaryOperator, Expression, Function, Handle, Module, TypeInner, UnaryOperator};

use super::function::{mismatch_words, value_type};
use super::{
    Sentence, bare_type, foreign_words, inner_type_text, lacking_words, spaced_name, type_text,
    types,
};
use crate::advice::Wrong;
use lamplight_diagnostic::codes;

pub fn expression_words(module: &Module, of: &Function, error: &ExpressionError) -> Sentence {
    use ExpressionError as E;
    let text = match error {
        E::InvalidBaseType(_) => "this has no members and no elements",
        E::InvalidIndexType(index) => {
            let sentence = mismatch_words("an index is an integer");
            return match value_type(module, of, *index) {
                Some(found) => sentence.about(Wrong::Index { found }),
                None => sentence,
            };
        }
        E::NegativeIndex(_) => "an index is not negative",
        E::IndexOutOfBounds(base, index) => {
            let sentence = Sentence::plain(format!("index {index} is out of bounds"));
            return match length_of(module, of, *base) {
                Some(length) => sentence.about(Wrong::Bounds { length }),
                None => sentence,
            };
        }
        E::InvalidPointerType(_) => "there is nothing to be read here",
        E::InvalidArrayType(_) => "only arrays in storage buffers have a length to ask for",
        E::InvalidSplatType(_) => "only a scalar can fill all components of a vector",
        E::InvalidVectorType(_) => "only vectors have components such as `xyz`",
        E::InvalidSwizzleComponent(component, _) => {
            let name = spaced_name(&format!("{component:?}"));
            return Sentence::plain(format!("the vector has no component `{name}`"));
        }
        E::Compose(error) => return types::compose_words(module, error),
        E::InvalidZeroValue(handle) => {
            return Sentence::plain(format!("there is no zero of {}", type_text(module, *handle)));
        }
        E::IndexableLength(_) => "the length of this is not known",
        E::InvalidUnaryOperandType(operator, value) => {
            let operator = unary_sign(*operator);
            let Some(found) = value_type(module, of, *value) else {
                return mismatch_words(format!("`{operator}` does not work with this type"));
            };
            return mismatch_words(format!("`{operator}` does not work with `{found}`"))
                .about(Wrong::Operand { operator, found });
        }
        E::InvalidBinaryOperandTypes { op, lhs_type, rhs_type, .. } => {
            let (left, right) = (bare_type(module, lhs_type), bare_type(module, rhs_type));
            return mismatch_words(format!(
                "`{}` does not work with `{left}` and `{right}`",
                binary_sign(*op)
            ))
            .about(Wrong::Operands { left, right });
        }
        E::SelectValuesTypeMismatch { accept, reject } => {
            let (accept, reject) = (bare_type(module, accept), bare_type(module, reject));
            return mismatch_words(format!(
                "the two choices have different types: `{reject}`, `{accept}`"
            ))
            .about(Wrong::Choices { reject, accept });
        }
        E::SelectConditionNotABool { actual } => {
            return mismatch_words(format!(
                "the condition is {}, not `bool`",
                inner_type_text(module, actual)
            ));
        }
        E::InvalidBooleanVector(_) => return mismatch_words("this needs booleans"),
        E::InvalidFloatArgument(_) => return mismatch_words("this needs floating-point numbers"),
        E::Type(_) => return mismatch_words("the types in this expression do not match"),
        E::ExpectedGlobalVariable | E::ExpectedGlobalOrArgument => {
            "a texture or sampler must be named directly"
        }
        E::ExpectedBindingArrayType(_) => "this is not an array of bindings",
        E::ExpectedImageType(_) => "this is not a texture",
        E::ExpectedSamplerType(_) => "this is not a sampler",
        E::InvalidDerivative => "derivatives need floating-point scalars or vectors",
        E::InvalidImageClass(_)
        | E::InvalidImageFormat(_)
        | E::InvalidImageStorageAccess(_)
        | E::InvalidImageArrayIndex
        | E::InvalidImageSampleSelector
        | E::MissingImageSampleSelector
        | E::InvalidImageLevelSelector
        | E::MissingImageLevelSelector
        | E::InvalidImageArrayIndexType(_)
        | E::InvalidImageOtherIndexType(_)
        | E::InvalidImageCoordinateType(..)
        | E::ComparisonSamplingMismatch { .. }
        | E::InvalidSampleOffsetExprType
        | E::InvalidSampleOffset(..)
        | E::InvalidDepthReference(_)
        | E::InvalidDepthSampleLevel
        | E::InvalidGatherLevel
        | E::InvalidGatherComponent(_)
        | E::InvalidGatherDimension(_)
        | E::InvalidSampleLevelExactType(_)
        | E::InvalidSampleLevelBiasType(_)
        | E::InvalidSampleLevelBiasDimension(_)
        | E::InvalidSampleLevelGradientType(..)
        | E::InvalidSampleClampCoordinateToEdge(_) => return texture_words(module, of, error),
        E::InvalidCastArgument => return mismatch_words("this cannot be converted to that type"),
        E::WrongArgumentCount(function) => {
            let name = spaced_name(&format!("{function:?}"));
            let message = format!("`{name}` takes another number of arguments");
            return Sentence::coded(codes::CALL_MISMATCH, message);
        }
        E::InvalidArgumentType(function, index, value) => {
            let name = spaced_name(&format!("{function:?}")).replace(' ', "");
            let found = value_type(module, of, *value)
                .map_or_else(|| "has a type".to_owned(), |found| format!("is `{found}`, a type"));
            let message =
                format!("argument {} of `{name}` {found} that it does not take", index + 1);
            return Sentence::coded(codes::CALL_MISMATCH, message);
        }
        E::MissingCapabilities(capabilities) => return lacking_words(*capabilities),
        E::Literal(error) => return types::literal_words(error),
        E::UnsupportedWidth(_, _, width) => {
            return foreign_words(&format!("this function for {} bits", u32::from(*width) * 8));
        }
        E::ShiftAmountTooLarge { lhs_type, .. } => {
            return Sentence::plain(format!(
                "{} has fewer bits than that",
                inner_type_text(module, lhs_type)
            ));
        }
        E::DivideByZero => {
            return Sentence::plain("this divides by zero, and integers have no infinity")
                .note("help: write another divisor than `0`, or test it before");
        }
        E::InvalidRayQueryType(_) => return foreign_words("ray tracing"),
        E::InvalidCooperativeOperand(_) => return foreign_words("cooperative matrices"),
        E::NotInScope | E::FunctionArgumentDoesntExist(_) => {
            "internal error in naga: its validator refuses an expression that its parser made"
        }
        E::InvalidWorkGroupUniformLoadResultType(_) => {
            "this type cannot be loaded for a whole workgroup"
        }
    };
    Sentence::plain(text)
}

/// The message for a wrong lookup of a texture, by what does not fit the texture.
fn texture_words(module: &Module, of: &Function, error: &ExpressionError) -> Sentence {
    use ExpressionError as E;
    let text = match error {
        E::InvalidImageArrayIndex => {
            "array textures need the index of a layer, and other textures have none"
        }
        E::InvalidImageSampleSelector | E::MissingImageSampleSelector => {
            "multisampled textures need the index of a sample, and other textures have none"
        }
        E::InvalidImageLevelSelector | E::MissingImageLevelSelector => {
            "textures with mip levels need a level, and other textures have none"
        }
        E::InvalidImageArrayIndexType(_) | E::InvalidImageOtherIndexType(_) => {
            "a layer, a sample and a level are integers"
        }
        E::InvalidImageCoordinateType(dimension, value) => {
            return coordinate_words(module, of, *dimension, *value);
        }
        E::ComparisonSamplingMismatch { .. } => return comparison_words(),
        E::InvalidSampleOffsetExprType | E::InvalidSampleOffset(..) => {
            "the offset of a lookup is a constant, with one integer for each axis of the texture"
        }
        E::InvalidDepthReference(_) => "the value to compare with is an `f32`",
        E::InvalidDepthSampleLevel => "a comparison is made at the level of the lookup, or at 0",
        E::InvalidGatherLevel | E::InvalidGatherComponent(_) | E::InvalidGatherDimension(_) => {
            "four texels are gathered of level 0 of a 2D texture or cube, from a component it has"
        }
        E::InvalidSampleLevelExactType(_)
        | E::InvalidSampleLevelBiasType(_)
        | E::InvalidSampleLevelBiasDimension(_)
        | E::InvalidSampleLevelGradientType(..) => {
            "the level, bias or gradient does not fit the texture"
        }
        E::InvalidImageClass(naga::ImageClass::Sampled {
            kind: naga::ScalarKind::Sint | naga::ScalarKind::Uint,
            multi: false,
        }) => return unfiltered_words(),
        _ => "this texture cannot be used in this way",
    };
    Sentence::coded(codes::CALL_MISMATCH, text)
}

fn comparison_words() -> Sentence {
    Sentence::coded(
        codes::CALL_MISMATCH,
        "a comparison needs a depth texture and a `sampler_comparison`; other lookups need a `sampler`",
    )
    .note("help: declare the sampler as `sampler_comparison` for `textureSampleCompare`")
}

fn unfiltered_words() -> Sentence {
    Sentence::coded(
        codes::CALL_MISMATCH,
        "textures of integers are not filtered, so they are loaded and not sampled",
    )
    .note("help: write `textureLoad(t, vec2u(texel), 0)`")
}

/// Coordinates of another type than a texture has.
fn coordinate_words(
    module: &Module,
    of: &Function,
    dimension: naga::ImageDimension,
    value: Handle<Expression>,
) -> Sentence {
    let axes = match dimension {
        naga::ImageDimension::D1 => 1,
        naga::ImageDimension::D2 => 2,
        naga::ImageDimension::D3 | naga::ImageDimension::Cube => 3,
    };
    let loads = of.expressions.iter().any(
        |(_, one)| matches!(one, Expression::ImageLoad { coordinate, .. } if *coordinate == value),
    );
    let (at, scalar) = if loads { (1, "u32") } else { (2, "f32") };
    let expected = if axes == 1 { scalar.to_owned() } else { format!("vec{axes}<{scalar}>") };
    let sentence = |found: &str| {
        let message = format!("the texture needs coordinates of type `{expected}`{found}");
        Sentence::coded(codes::CALL_MISMATCH, message)
    };
    match value_type(module, of, value) {
        Some(found) => sentence(&format!(", and these are `{found}`")).about(Wrong::Coordinates {
            at,
            found,
            expected,
        }),
        None => sentence(""),
    }
}

/// The length of an array, a vector or a matrix.
fn length_of(module: &Module, of: &Function, base: Handle<Expression>) -> Option<u32> {
    let mut typifier = Typifier::new();
    let context = ResolveContext::with_locals(module, &of.local_variables, &of.arguments);
    typifier.grow(base, &of.expressions, &context).ok()?;
    let inner = typifier.get(base, &module.types);
    let inner = match inner {
        TypeInner::Pointer { base, space: _ } => &module.types[*base].inner,
        inner => inner,
    };
    match inner {
        TypeInner::Array { size: naga::ArraySize::Constant(size), .. } => Some(size.get()),
        TypeInner::Vector { size, .. } => Some(*size as u32),
        TypeInner::Matrix { columns, .. } => Some(*columns as u32),
        _ => None,
    }
}

fn unary_sign(operator: UnaryOperator) -> &'static str {
    match operator {
        UnaryOperator::Negate => "-",
        UnaryOperator::LogicalNot => "!",
        UnaryOperator::BitwiseNot => "~",
    }
}

fn binary_sign(operator: BinaryOperator) -> &'static str {
    match operator {
        BinaryOperator::Add => "+",
        BinaryOperator::Subtract => "-",
        BinaryOperator::Multiply => "*",
        BinaryOperator::Divide => "/",
        BinaryOperator::Modulo => "%",
        BinaryOperator::Equal => "==",
        BinaryOperator::NotEqual => "!=",
        BinaryOperator::Less => "<",
        BinaryOperator::LessEqual => "<=",
        BinaryOperator::Greater => ">",
        BinaryOperator::GreaterEqual => ">=",
        BinaryOperator::And => "&",
        BinaryOperator::ExclusiveOr => "^",
        BinaryOperator::InclusiveOr => "|",
        BinaryOperator::LogicalAnd => "&&",
        BinaryOperator::LogicalOr => "||",
        BinaryOperator::ShiftLeft => "<<",
        BinaryOperator::ShiftRight => ">>",
    }
}
