//! Runs naga's parser and validator on a composed text, and reports errors in the author's terms
//! and places.
//!
//! naga recurses over what it reads, and it panics on some inputs. So its input is bounded first
//! ([`limits`]), and every call runs on a large stack with panics caught ([`guard`]).

mod advice;
mod alias;
mod alignments;
mod atomics;
mod bitcasts;
mod browsers;
mod constants;
mod endless;
mod every;
mod foreign;
mod gathers;
mod guard;
mod halves;
mod hints;
mod limits;
mod locate;
mod loops;
mod operands;
mod pointers;
mod report;
mod sandbox;
mod sizes;
mod translated;
mod uses;
mod words;

pub use alias::{NamesGlobal, may_alias};
pub use alignments::has_lost_alignments;
pub use bitcasts::has_changed_shapes;
pub use browsers::{has_lints, lint_derivatives, lint_wgsl};
pub use every::validate_every;
pub use guard::{catch_panics, guard, on_large_stack};
pub use hints::glsl_words;
pub use limits::{LIMITS, NagaLimits};
pub use operands::{
    change_operands, change_used, computed, inner_blocks, inner_blocks_mut, operands, result_mut,
    used,
};
#[doc(hidden)]
pub use sandbox::{STAGE, SandboxJob, SandboxOutputs, try_in_sandbox};
pub use translated::{
    TranslatedGlsl, glsl_as_plain_wgsl, glsl_as_wgsl, of_translation, of_translations,
    positions_of, translate_glsl, validate_translation,
};
pub use uses::{first_use, functions, makes_scalar};
pub use words::NOT_EVERY;

use naga::front::wgsl;
use naga::valid::{Capabilities, ModuleInfo, ValidationError, ValidationFlags, Validator};

use pointers::{PlacedPointers, Unplaced};

use lamplight_bundle::{Language, Stage};
use lamplight_compose::Composed;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_files::limits::PLACED_EXPRESSIONS;

/// A module that naga accepts, with what it found out about it.
#[derive(Debug, Clone)]
pub struct Validated {
    /// As naga's front end read it.
    pub module: naga::Module,
    /// What naga's validator found out about it.
    pub info: ModuleInfo,
    /// Whether every target has what the module needs.
    pub portable: bool,
}

/// What every target of the crate supports. Sample shading and cube arrays are included, since naga
/// takes them for granted; the targets without cube arrays refuse them. So are `pack2x16float`
/// and what is like it, which the targets without it refuse. Types of 16 or 64 bits are not
/// included.
pub const CAPABILITIES: Capabilities = Capabilities::MULTISAMPLED_SHADING
    .union(Capabilities::CUBE_ARRAY_TEXTURES)
    .union(Capabilities::IMMEDIATES)
    .union(Capabilities::SHADER_FLOAT16_IN_FLOAT32);

/// What at least one target supports. Each target says in its file what it has of it.
pub const SOME_TARGET_HAS: Capabilities = CAPABILITIES
    .union(Capabilities::SHADER_FLOAT16)
    .union(Capabilities::FLOAT64)
    .union(Capabilities::SHADER_INT64)
    .union(Capabilities::CLIP_DISTANCES)
    .union(Capabilities::DUAL_SOURCE_BLENDING)
    .union(Capabilities::SUBGROUP)
    .union(Capabilities::PRIMITIVE_INDEX)
    .union(Capabilities::TEXTURE_EXTERNAL)
    .union(Capabilities::STORAGE_TEXTURE_16BIT_NORM_FORMATS)
    .union(BINDING_ARRAYS);

/// Arrays of textures, samplers and buffers, with any index.
pub const BINDING_ARRAYS: Capabilities = Capabilities::TEXTURE_AND_SAMPLER_BINDING_ARRAY
    .union(Capabilities::TEXTURE_AND_SAMPLER_BINDING_ARRAY_NON_UNIFORM_INDEXING)
    .union(Capabilities::STORAGE_TEXTURE_BINDING_ARRAY)
    .union(Capabilities::STORAGE_TEXTURE_BINDING_ARRAY_NON_UNIFORM_INDEXING)
    .union(Capabilities::BUFFER_BINDING_ARRAY)
    .union(Capabilities::BUFFER_BINDING_ARRAY_NON_UNIFORM_INDEXING)
    .union(Capabilities::STORAGE_BUFFER_BINDING_ARRAY)
    .union(Capabilities::STORAGE_BUFFER_BINDING_ARRAY_NON_UNIFORM_INDEXING);

/// Parses and validates what every target has.
///
/// # Errors
/// `limit-exceeded` before naga sees the text; `glsl-error` for mistakes in GLSL and `glsl-not-translated`
/// for what WGSL has no counterpart of; `wgsl-error` from naga's parser or validator, in the author's places;
/// `not-portable` for what only some targets have; `naga-internal` where it panicked,
/// `naga-exhausted` where it would have ended the process.
pub fn validate(composed: &Composed) -> Result<Validated, Diagnostics> {
    let validated = validate_for_some(composed)?;
    match lacking(composed, &validated, CAPABILITIES) {
        Some(error) => Err(vec![error]),
        None => Ok(validated),
    }
}

/// Parses and validates what at least one target has. [`lacking`] reports what a
/// target lacks of it.
///
/// # Errors
/// As [`validate`]; `not-portable` for what no target has.
pub fn validate_for_some(composed: &Composed) -> Result<Validated, Diagnostics> {
    if composed.language == Language::Glsl {
        let translated = glsl_as_wgsl(composed, Default::default())?;
        return validate_for_some(&translated).map_err(of_translations);
    }
    try_in_sandbox(composed, composed, || None).map_err(|error| vec![error])?;
    read_text(composed)
}

/// As [`validate_for_some`], for a text in WESL that went through the sandbox together with what is done to
/// it afterwards.
pub fn validate_unguarded(composed: &Composed) -> Result<Validated, Diagnostics> {
    limits::check_limits(composed).map_err(|error| vec![error])?;
    read_text(composed)
}

/// The error about something that a module needs beyond some capabilities, `not-portable`.
pub fn lacking(
    composed: &Composed,
    validated: &Validated,
    capabilities: Capabilities,
) -> Option<Diagnostic> {
    if validated.portable {
        return None;
    }
    let module = &validated.module;
    let error = with_capabilities(module, ValidationFlags::all(), capabilities).err()?;
    let error = report::validation_error(composed, module, &error);
    // naga finds some types that it lacks only where they are converted.
    Some(match error.code == codes::NOT_PORTABLE {
        true => error,
        false => {
            let what =
                lacking_scalar(module, capabilities).unwrap_or("the type of this".to_owned());
            let message = format!("{NOT_EVERY} {what}");
            Diagnostic { code: codes::NOT_PORTABLE, message, notes: Vec::new(), ..error }
        }
    })
}

/// The first type of numbers that a module uses, beyond some capabilities.
fn lacking_scalar(module: &naga::Module, capabilities: Capabilities) -> Option<String> {
    let scalars = [
        ("f16", naga::Scalar::F16, Capabilities::SHADER_FLOAT16),
        ("f64", naga::Scalar::F64, Capabilities::FLOAT64),
        ("i64", naga::Scalar::I64, Capabilities::SHADER_INT64),
        ("u64", naga::Scalar::U64, Capabilities::SHADER_INT64),
    ];
    let mut lacking = scalars.into_iter().filter(|(_, _, needed)| !capabilities.contains(*needed));
    let (name, _, _) =
        lacking.find(|(_, scalar, _)| uses::first_scalar(module, *scalar).is_defined())?;
    Some(format!("the type `{name}`"))
}

fn read_text(composed: &Composed) -> Result<Validated, Diagnostics> {
    on_large_stack(|| {
        guard(&composed.text, || {
            let read = |composed: &Composed| {
                parse_text(composed).and_then(|module| analyse_module(composed, module))
            };
            read(composed).or_else(|errors| match with_variables(composed) {
                Some(changed) => read(&changed).map_err(|_| errors),
                None => Err(errors),
            })
        })
    })
    .map_err(|error| vec![error])
    .and_then(|result| result)
}

/// A text in which naga computes nothing of what a `let` holds; `None` where that is the same text. It
/// needs a large stack.
fn with_variables(composed: &Composed) -> Option<Composed> {
    let text = lamplight_rules::with_variables(&composed.text)?;
    Some(Composed { text, ..composed.clone() })
}

/// Whether a text is small enough to be compiled without the sandbox.
///
/// # Errors
/// `limit-exceeded` where naga should not see it at all.
pub fn is_small(composed: &Composed) -> Result<bool, Diagnostic> {
    limits::check_limits(composed).map(|large| large.is_none())
}

fn parse_text(composed: &Composed) -> Result<naga::Module, Diagnostics> {
    parse_wgsl(&composed.text).map_err(|error| vec![report::wgsl_error(composed, &error)])
}

/// Parses WGSL. Some functions of constants naga refuses, with several messages, since it does not
/// compute them; then their values are put into the text. It needs a large stack.
///
/// # Errors
/// Those of naga, with the places of the text.
pub fn parse_wgsl(text: &str) -> Result<naga::Module, wgsl::ParseError> {
    let read = lamplight_rules::without_unread(text);
    let text = read.as_deref().unwrap_or(text);
    match wgsl::parse_str(text) {
        Ok(module) if !has_abstract_numbers(&module) => Ok(module),
        read => match lamplight_rules::fold(text) {
            Some(folded) => wgsl::parse_str(&folded),
            None => read,
        },
    }
}

/// Whether a function has a number without a type. naga's front end leaves these in the arguments of
/// such a function where another argument is not constant, and its validator refuses them.
fn has_abstract_numbers(module: &naga::Module) -> bool {
    use naga::{Expression, Literal};
    let functions = module.functions.iter().map(|(_, function)| function);
    let points = module.entry_points.iter().map(|point| &point.function);
    functions.chain(points).flat_map(|function| function.expressions.iter()).any(
        |(_, expression)| {
            matches!(
                expression,
                Expression::Literal(Literal::AbstractInt(_) | Literal::AbstractFloat(_))
            )
        },
    )
}

/// Whether no type or value of a module is too large to be written out.
pub fn is_bounded(module: &naga::Module) -> bool {
    sizes::check_sizes(module).is_none()
}

/// Puts into a module what naga needs, for one function at a time: `false` where that is not enough,
/// and the module must be compiled as a whole.
pub fn prepare_part(module: &mut naga::Module) -> bool {
    prepare(module).is_ok()
        && !pointers::has_pointers_to_place(module)
        && !atomics::may_be_refused(module)
}

/// Puts into a module what naga needs to write it rightly.
fn prepare(module: &mut naga::Module) -> Result<(), naga::Span> {
    gathers::make_invocations_unsigned(module);
    endless::return_values(module);
    loops::store_loop_values(module)
}

fn analyse_module(composed: &Composed, mut module: naga::Module) -> Result<Validated, Diagnostics> {
    if let Some(large) = sizes::check_sizes(&module) {
        let error = Diagnostic::error(codes::LIMIT_EXCEEDED, large.message);
        let range = large.span.to_range().unwrap_or(0..0);
        return Err(vec![match composed.map.lookup(range.clone()) {
            Some(span) => error.at(span, "declared here"),
            None => error,
        }]);
    }
    if let Some(name) = compute_with_inputs(&module) {
        return Err(vec![inputs_of_compute(composed, name)]);
    }
    halves::refuse_exponents(composed, &module).map_err(|error| vec![error])?;
    alignments::refuse_lost_alignments(composed, &module).map_err(|error| vec![error])?;
    // A pointer that is placed no longer shows what else leads there.
    let original = match pointers::has_pointers_to_place(&module) {
        true => replace_by_placed(composed, &mut module).map_err(|error| vec![error])?,
        false => None,
    };
    prepare(&mut module).map_err(|span| vec![not_carried(composed, span)])?;
    let portable = info_of(&module);
    let is_portable = portable.is_ok();
    let info = portable
        .or_else(|_| info_for_some(&module))
        .map_err(|error| vec![report::validation_error(composed, &module, &error)])?;
    alias::refuse_aliases(composed, original.as_ref().unwrap_or(&module))
        .and_then(|()| atomics::refuse_atomic_values(composed, &module, &info))
        .and_then(|()| bitcasts::refuse_changed_shapes(composed, &module, &info))
        .map_err(|error| vec![error])?;
    Ok(Validated { module, info, portable: is_portable })
}

/// Places the pointers of a module, and returns the module as it was; `None` where it is not valid,
/// and stays as it is.
fn replace_by_placed(
    composed: &Composed,
    module: &mut naga::Module,
) -> Result<Option<naga::Module>, Diagnostic> {
    match pointers::place_pointers(module) {
        Ok(PlacedPointers { module: placed, uncalled }) => {
            if let Some(uncalled) = &uncalled {
                info_for_some(uncalled)
                    .map_err(|error| report::validation_error(composed, uncalled, &error))?;
            }
            Ok(Some(std::mem::replace(module, placed)))
        }
        Err(Unplaced::Invalid) => Ok(None),
        Err(Unplaced::Many(span)) => {
            let message = format!(
                "the functions that are made for the places of their pointers have more than \
                 {PLACED_EXPRESSIONS} expressions"
            );
            let error = Diagnostic::error(codes::LIMIT_EXCEEDED, message);
            Err(match span.to_range().and_then(|range| composed.map.lookup(range)) {
                Some(span) => error.at(span, "the limit is reached in this function"),
                None => error,
            })
        }
    }
}

/// The error about a value that a `continuing` block cannot have.
fn not_carried(composed: &Composed, span: naga::Span) -> Diagnostic {
    let message = "what `atomicCompareExchangeWeak` returns cannot be used in `continuing`: some \
        targets would call it again";
    let error = Diagnostic::error(codes::NOT_PORTABLE, message)
        .note("help: give its members names in the body: `let old = result.old_value;`");
    match span.to_range().and_then(|range| composed.map.lookup(range)) {
        Some(span) => error.at(span, "this value"),
        None => error,
    }
}

/// naga's error about a module.
pub type Invalid = Box<naga::WithSpan<ValidationError>>;

/// What naga finds out about a module that it accepts, and that every target has.
pub fn info_of(module: &naga::Module) -> Result<ModuleInfo, Invalid> {
    with_capabilities(module, ValidationFlags::all(), CAPABILITIES)
}

/// The same for what at least one target has.
pub fn info_for_some(module: &naga::Module) -> Result<ModuleInfo, Invalid> {
    with_capabilities(module, ValidationFlags::all(), SOME_TARGET_HAS)
}

/// The same for a module that was made from a valid one: the analysis without the checks.
pub fn info_unchecked(module: &naga::Module) -> Result<ModuleInfo, Invalid> {
    with_capabilities(module, ValidationFlags::empty(), SOME_TARGET_HAS)
}

fn with_capabilities(
    module: &naga::Module,
    flags: ValidationFlags,
    capabilities: Capabilities,
) -> Result<ModuleInfo, Invalid> {
    Validator::new(flags, capabilities).validate(module).map_err(Box::new)
}

/// Finds a compute shader with an input that only another stage could give, or with a result that no
/// stage takes, and says what it does. naga accepts it, and its writers fail on it with an internal
/// error.
fn compute_with_inputs(module: &naga::Module) -> Option<(&str, &'static str)> {
    let is_location = |binding: &Option<naga::Binding>| {
        matches!(
            binding,
            Some(naga::Binding::Location {
                location: _,
                interpolation: _,
                sampling: _,
                blend_src: _,
                per_primitive: _
            })
        )
    };
    let takes = |argument: &naga::FunctionArgument| match &module.types[argument.ty].inner {
        naga::TypeInner::Struct { members, span: _ } => {
            members.iter().any(|member| is_location(&member.binding))
        }
        _ => is_location(&argument.binding),
    };
    let mut points = module.entry_points.iter();
    points.find_map(|point| {
        let what = match point.stage {
            naga::ShaderStage::Compute if point.function.arguments.iter().any(takes) => {
                "takes an input with `@location`"
            }
            naga::ShaderStage::Compute if point.function.result.is_some() => "returns a value",
            _ => return None,
        };
        Some((point.name.as_str(), what))
    })
}

fn inputs_of_compute(composed: &Composed, (name, what): (&str, &str)) -> Diagnostic {
    let message = format!("the compute shader `{name}` {what}");
    let error = Diagnostic::error(codes::WGSL_ERROR, message).note(
        "a compute shader has built-in inputs only, and writes to buffers and textures: no stage \
         comes before it or after it",
    );
    let start = composed.text.find(&format!("fn {name}")).map(|at| at + 3);
    match start.and_then(|start| composed.map.lookup(start..start + name.len())) {
        Some(span) => error.at(span, "this entry point"),
        None => error,
    }
}

/// A stage as naga names it.
pub fn naga_stage(stage: Stage) -> naga::ShaderStage {
    match stage {
        Stage::Vertex => naga::ShaderStage::Vertex,
        Stage::Fragment => naga::ShaderStage::Fragment,
        Stage::Compute => naga::ShaderStage::Compute,
    }
}
