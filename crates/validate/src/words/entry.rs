//! Entry points, and what enters and leaves them.

use naga::valid::{EntryPointError, VaryingError};
use naga::{EntryPoint, Function, Module};

use super::{
    Sentence, foreign_words, function, inner_type_text, lacking_words, spaced_name, stage_name,
    stages, type_text,
};
use crate::advice::{Interface, Port, Variable, Wrong};
use lamplight_diagnostic::codes;

pub fn entry_words(
    module: &Module,
    point: Option<&EntryPoint>,
    error: &EntryPointError,
) -> Sentence {
    let text = match error {
        EntryPointError::Conflict => "two entry points of one stage have this name".to_owned(),
        EntryPointError::MissingVertexOutputPosition => {
            return Sentence::plain("a vertex shader must return `@builtin(position)`").note(
                "help: write `-> @builtin(position) vec4f`, or `@builtin(position) position: vec4f` in \
                 the structure that it returns",
            );
        }
        EntryPointError::UnexpectedEarlyDepthTest => {
            "only fragment shaders have an early depth test".to_owned()
        }
        EntryPointError::UnexpectedWorkgroupSize => {
            "only compute shaders have a workgroup size".to_owned()
        }
        EntryPointError::OutOfRangeWorkgroupSize => "the workgroup size is out of range".to_owned(),
        EntryPointError::ForbiddenStageOperations => return stage_words(module, point),
        EntryPointError::InvalidGlobalUsage(handle, _) => {
            format!("{} is used in a way that it does not allow", variable_words(module, *handle))
        }
        EntryPointError::BindingCollision(handle) => return collision_words(module, *handle),
        EntryPointError::Argument(index, error) => {
            return at_port(module, point, Some(*index as usize), error);
        }
        EntryPointError::Result(error) => return at_port(module, point, None, error),
        EntryPointError::Function(error) => {
            let nothing = Function::default();
            let of = point.map_or(&nothing, |point| &point.function);
            return function::function_words(module, of, error);
        }
        EntryPointError::UnsupportedCapability(capabilities) => {
            return lacking_words(*capabilities);
        }
        EntryPointError::MoreThanOneImmediateUsed => return foreign_words("immediate data"),
        EntryPointError::ExpectedMeshShaderAttributes
        | EntryPointError::UnexpectedMeshShaderAttributes
        | EntryPointError::UnexpectedTaskPayload
        | EntryPointError::TaskPayloadWrongAddressSpace
        | EntryPointError::WrongTaskPayloadUsed
        | EntryPointError::WrongTaskShaderEntryResult
        | EntryPointError::ExpectedTaskPayload
        | EntryPointError::BadMeshOutputVariableType
        | EntryPointError::BadMeshOutputVariableField
        | EntryPointError::UnexpectedMeshShaderEntryResult
        | EntryPointError::InvalidMeshOutputType
        | EntryPointError::InvalidMeshPrimitiveOutputType
        | EntryPointError::WrongMeshOutputAddressSpace
        | EntryPointError::TaskPayloadTooSmall(_) => return foreign_words("mesh and task shaders"),
        EntryPointError::RayPayloadInInvalidStage(_)
        | EntryPointError::IncomingRayPayloadInInvalidStage(_) => {
            return foreign_words("ray tracing");
        }
    };
    Sentence::plain(text)
}

/// The message about an input or an output, with what is needed to find it in the text.
fn at_port(
    module: &Module,
    point: Option<&EntryPoint>,
    parameter: Option<usize>,
    error: &VaryingError,
) -> Sentence {
    let sentence = varying_words(module, error);
    let Some(point) = point else { return sentence };
    let member = match error {
        VaryingError::MemberMissingBinding(index) => Some(*index as usize),
        _ => None,
    };
    let interface = match error {
        VaryingError::MissingBinding | VaryingError::MemberMissingBinding(_) => {
            Interface::Unplaced { is_vertex: point.stage == naga::ShaderStage::Vertex }
        }
        VaryingError::InvalidInterpolationForInteger | VaryingError::MissingInterpolation => {
            Interface::Interpolated
        }
        VaryingError::BindingCollision { .. } => Interface::Taken,
        VaryingError::InvalidBuiltInType(built_in, _) => {
            Interface::Typed { built_in: built_in_name(*built_in) }
        }
        VaryingError::InvalidBuiltInStage(_) => {
            Interface::Foreign { stage: stage_name(point.stage) }
        }
        _ => return sentence,
    };
    let held = match parameter {
        Some(at) => point.function.arguments.get(at).map(|argument| argument.ty),
        None => point.function.result.as_ref().map(|result| result.ty),
    };
    let members = held.and_then(|held| match &module.types[held].inner {
        naga::TypeInner::Struct { members, span: _ } => Some(members),
        _ => None,
    });
    let member = member.or_else(|| match interface {
        Interface::Interpolated => members?.iter().position(|one| is_smooth_integer(module, one)),
        _ => None,
    });
    // Which member another error is about is not known.
    if members.is_some() && member.is_none() {
        return sentence;
    }
    sentence.about(Wrong::Port(Port { entry: point.name.clone(), parameter, member }, interface))
}

/// Whether a member is an integer between stages that is not `flat`.
fn is_smooth_integer(module: &Module, member: &naga::StructMember) -> bool {
    let is_integer = module.types[member.ty]
        .inner
        .scalar_kind()
        .is_some_and(|kind| matches!(kind, naga::ScalarKind::Sint | naga::ScalarKind::Uint));
    let is_flat = matches!(
        member.binding,
        Some(naga::Binding::Location { interpolation: Some(naga::Interpolation::Flat), .. })
    );
    is_integer && !is_flat && matches!(member.binding, Some(naga::Binding::Location { .. }))
}

/// The message for an operation that the stage of an entry point does not have.
fn stage_words(module: &Module, point: Option<&EntryPoint>) -> Sentence {
    let found =
        point.and_then(|point| stages::forbidden_operation(module, &point.function, point.stage));
    match found {
        Some((span, sentence)) => {
            let beside = Some((span, "not in this stage".to_owned()));
            let plain = Sentence { beside, ..Sentence::plain(sentence) };
            if sentence.starts_with("sampling") { plain.about(Wrong::Level) } else { plain }
        }
        None => Sentence::plain("this stage cannot do what the function does"),
    }
}

fn variable_words(module: &Module, handle: naga::Handle<naga::GlobalVariable>) -> String {
    module.global_variables[handle]
        .name
        .as_ref()
        .map_or("a variable without a name".to_owned(), |name| format!("`{name}`"))
}

/// The message for two variables with the same group and binding.
fn collision_words(module: &Module, handle: naga::Handle<naga::GlobalVariable>) -> Sentence {
    let binding = module.global_variables[handle].binding;
    let other = module.global_variables.iter().find(|(other, found)| {
        *other != handle && found.binding.is_some() && found.binding == binding
    });
    let name = variable_words(module, handle);
    let place = binding.map_or(String::new(), |binding| {
        format!(" `@group({}) @binding({})`", binding.group, binding.binding)
    });
    let message = match other {
        Some((other, _)) => {
            format!("{name} and {} have the same place:{place}", variable_words(module, other))
        }
        None => format!("{name} has a place that something else has:{place}"),
    };
    let beside = other.map(|(other, _)| {
        (module.global_variables.get_span(other), "has the same place".to_owned())
    });
    let wrong = Wrong::Variable(name.replace('`', ""), Variable::Collides);
    Sentence { beside, ..Sentence::coded(codes::BINDING_CONFLICT, message) }.about(wrong)
}

pub fn varying_words(module: &Module, error: &VaryingError) -> Sentence {
    let text = match error {
        VaryingError::InvalidType(handle) | VaryingError::NotIOShareableType(handle) => format!(
            "{} cannot be an input or output of a stage: scalars and vectors of numbers can",
            type_text(module, *handle)
        ),
        VaryingError::InvalidInterpolationInStage(_, stage) => {
            format!("this `@interpolate` is only allowed in {} shaders", stage_name(*stage))
        }
        VaryingError::InvalidInterpolationSamplingCombination { .. } => {
            "these two parts of `@interpolate` cannot be combined".to_owned()
        }
        VaryingError::InvalidInterpolationForInteger => {
            "integers between stages need `@interpolate(flat)`".to_owned()
        }
        VaryingError::MissingInterpolation => {
            "values between vertex and fragment shaders need an interpolation".to_owned()
        }
        VaryingError::InvalidBuiltInStage(built_in) => {
            format!("this stage has no `{}`", built_in_name(*built_in))
        }
        VaryingError::InvalidBuiltInType(built_in, found) => {
            let found = inner_type_text(module, found);
            format!("`{}` does not have the type {found}", built_in_name(*built_in))
        }
        VaryingError::MissingBinding => {
            "inputs and outputs of an entry point need `@location` or `@builtin`".to_owned()
        }
        VaryingError::MemberMissingBinding(index) => {
            format!("member {} needs `@location` or `@builtin`", index + 1)
        }
        VaryingError::BindingCollision { location } => {
            return Sentence::coded(
                codes::BINDING_CONFLICT,
                format!("`@location({location})` is used twice"),
            );
        }
        VaryingError::BindingCollisionBlendSrc { blend_src } => {
            return Sentence::coded(
                codes::BINDING_CONFLICT,
                format!("`@blend_src({blend_src})` is used twice"),
            );
        }
        VaryingError::DuplicateBuiltIn(built_in) => {
            format!("`{}` occurs twice", built_in_name(*built_in))
        }
        VaryingError::UnsupportedCapability(capabilities) => return lacking_words(*capabilities),
        VaryingError::InvalidInputAttributeInStage(name, stage) => {
            format!("`@{name}` is for what leaves {} shaders", stage_name(*stage))
        }
        VaryingError::InvalidAttributeInStage(name, stage) => {
            format!("{} shaders have no `@{name}`", stage_name(*stage))
        }
        VaryingError::InvalidBlendSrcIndex { .. }
        | VaryingError::IncompleteBlendSrcUsage { .. }
        | VaryingError::InvalidBlendSrcWithOtherBindings { .. }
        | VaryingError::BlendSrcOutputTypeMismatch { .. }
        | VaryingError::BlendSrcNotOnStructMember => {
            "`@blend_src(0)` and `@blend_src(1)` are for the two members of one structure, of one \
             type, at location 0"
                .to_owned()
        }
        VaryingError::InvalidMultiDimensionalSubgroupBuiltIn => return foreign_words("subgroups"),
        VaryingError::InvalidPerPrimitive | VaryingError::MissingPerPrimitive => {
            return foreign_words("mesh and task shaders");
        }
        VaryingError::PerVertexNotArrayOfThree | VaryingError::InvalidPerVertexSampling => {
            return foreign_words("inputs for each vertex of a triangle");
        }
    };
    Sentence::plain(text)
}

/// As WGSL spells it, as far as it follows from naga's name.
fn built_in_name(built_in: naga::BuiltIn) -> String {
    use naga::common::wgsl::TryToWgsl;
    built_in
        .try_to_wgsl()
        .map_or_else(|| spaced_name(&format!("{built_in:?}")).replace(' ', "_"), str::to_owned)
}
