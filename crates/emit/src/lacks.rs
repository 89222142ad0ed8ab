//! Refuses what naga would write although the language lacks it, or gives it another meaning.
//!
//! Older versions of GLSL lack some functions, whose names naga writes all the same. For
//! `frexp` it writes a function of its own based on `log2`, which is wrong for negative numbers and
//! for small ones. In std140 a column of a matrix of two rows takes 16 bytes, but 8 bytes in WGSL
//! and in the reflection.

use naga::back::glsl::Version;
use naga::{
    AddressSpace, Binding, Block, BuiltIn, Expression, Function, Handle, ImageClass,
    ImageDimension, ImageQuery, MathFunction, Module, SampleLevel, Scalar, Span, Statement, Type,
    TypeInner, VectorSize,
};

use super::{columns, depths, immediates, located, targets};
use lamplight_bundle::Target;
use lamplight_compose::Composed;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_validate::{
    CAPABILITIES, NOT_EVERY, Validated, first_use, functions, inner_blocks, lacking,
};

/// Something that GLSL did not have from the start.
struct Later {
    /// What GLSL calls it.
    name: &'static str,
    /// The first version of GLSL that has it.
    desktop: u16,
    /// The first version of GLSL ES that has it, if one does.
    embedded: Option<u16>,
}

impl Later {
    const fn since(name: &'static str, desktop: u16, embedded: Option<u16>) -> Self {
        Self { name, desktop, embedded }
    }

    /// Its name, if a version lacks it.
    fn lacking(&self, version: Version) -> Option<&'static str> {
        (!has_since(version, self.desktop, self.embedded)).then_some(self.name)
    }
}

/// Whether a version has what came with a version of GLSL, and with one of GLSL ES.
pub fn has_since(version: Version, desktop: u16, embedded: Option<u16>) -> bool {
    match version {
        Version::Desktop(number) => number >= desktop,
        Version::Embedded { version: number, is_webgl: _ } => {
            embedded.is_some_and(|first| number >= first)
        }
    }
}

const BIT_COUNT: Later = Later::since("`bitCount`", 400, Some(310));
const EXTRACT: Later = Later::since("`bitfieldExtract`", 400, Some(310));
const INSERT: Later = Later::since("`bitfieldInsert`", 400, Some(310));
const REVERSE: Later = Later::since("`bitfieldReverse`", 400, Some(310));
const LOWEST_BIT: Later = Later::since("`findLSB`", 400, Some(310));
const HIGHEST_BIT: Later = Later::since("`findMSB`", 400, Some(310));
const FREXP: Later = Later::since("`frexp`", 400, Some(310));
const LDEXP: Later = Later::since("`ldexp`", 400, Some(310));
const HALF: Later = Later::since("`unpackHalf2x16`", 420, Some(300));
const PACK_HALF: Later = Later::since("`packHalf2x16`", 420, Some(300));
const PACK_BYTES: Later = Later::since("`packUnorm4x8` and `packSnorm4x8`", 400, Some(310));
const PACK_SIGNED: Later = Later::since("`packSnorm2x16`", 420, Some(300));
const PACK_UNSIGNED: Later = Later::since("`packUnorm2x16`", 400, Some(300));
const GATHER: Later = Later::since("`textureGather`", 400, Some(310));
const LEVELS: Later = Later::since("`textureQueryLevels`", 430, None);
const SAMPLES: Later = Later::since("`textureSamples`", 450, None);
const NESTED: Later = Later::since("array of arrays", 430, Some(310));
const SAMPLE_ID: Later = Later::since("`gl_SampleID`", 400, Some(320));
const MULTISAMPLED: Later = Later::since("multisampled textures", 150, Some(310));
const LAYER_OFFSETS: Later = Later::since("offsets in comparisons of layers", 430, None);
const SAMPLE_MASK: Later = Later::since("`gl_SampleMask`", 400, Some(320));

/// Functions of WGSL, with what naga writes for them.
const LATER: &[(MathFunction, Later)] = &[
    (MathFunction::CountOneBits, BIT_COUNT),
    (MathFunction::CountTrailingZeros, LOWEST_BIT),
    (MathFunction::Dot4I8Packed, EXTRACT),
    (MathFunction::Dot4U8Packed, EXTRACT),
    (MathFunction::ExtractBits, EXTRACT),
    (MathFunction::FirstLeadingBit, HIGHEST_BIT),
    (MathFunction::FirstTrailingBit, LOWEST_BIT),
    (MathFunction::Frexp, FREXP),
    (MathFunction::InsertBits, INSERT),
    (MathFunction::Ldexp, LDEXP),
    (MathFunction::Pack2x16float, PACK_HALF),
    (MathFunction::Pack2x16snorm, PACK_SIGNED),
    (MathFunction::Pack2x16unorm, PACK_UNSIGNED),
    (MathFunction::Pack4x8snorm, PACK_BYTES),
    (MathFunction::Pack4x8unorm, PACK_BYTES),
    (MathFunction::Pack4xI8, INSERT),
    (MathFunction::Pack4xI8Clamp, INSERT),
    (MathFunction::Pack4xU8, INSERT),
    (MathFunction::Pack4xU8Clamp, INSERT),
    (MathFunction::QuantizeToF16, HALF),
    (MathFunction::ReverseBits, REVERSE),
    (MathFunction::Unpack2x16float, HALF),
    (MathFunction::Unpack4xI8, EXTRACT),
    (MathFunction::Unpack4xU8, EXTRACT),
];

const TWO_ROWS: &str =
    "a matrix of two rows in a uniform block has another layout in GLSL: use vectors";

/// Refuses what only other targets have: types, arrays of bindings, clip distances.
///
/// # Errors
/// `not-portable`, with the name of the target.
pub fn check_capabilities(
    composed: &Composed,
    validated: &Validated,
    wanted: &[Target],
) -> Result<(), Diagnostics> {
    let entries = targets::ALL.iter().filter(|entry| wanted.contains(&entry.target));
    if let Some(error) = (!validated.portable).then(|| doubled(composed, validated)).flatten() {
        return Err(vec![error]);
    }
    let found: Diagnostics = entries
        .filter_map(|entry| {
            let capabilities = CAPABILITIES.union(entry.capabilities);
            let error = lacking(composed, validated, capabilities)?;
            let what = error.message.strip_prefix(NOT_EVERY).unwrap_or(&error.message);
            let message = format!("target `{}` does not have{what}", entry.target);
            Some(Diagnostic { message, ..error })
        })
        .collect();
    if found.is_empty() { Ok(()) } else { Err(found) }
}

/// Functions that no target computes with 64 bits.
const SINGLE: &[MathFunction] = &[
    MathFunction::Acos,
    MathFunction::Acosh,
    MathFunction::Asin,
    MathFunction::Asinh,
    MathFunction::Atan,
    MathFunction::Atan2,
    MathFunction::Atanh,
    MathFunction::Cos,
    MathFunction::Cosh,
    MathFunction::Degrees,
    MathFunction::Exp,
    MathFunction::Exp2,
    MathFunction::Log,
    MathFunction::Log2,
    MathFunction::Pow,
    MathFunction::Radians,
    MathFunction::Sin,
    MathFunction::Sinh,
    MathFunction::Tan,
    MathFunction::Tanh,
];

/// The error about a function of 64-bit numbers that no target has.
fn doubled(composed: &Composed, validated: &Validated) -> Option<Diagnostic> {
    let Validated { module, info, portable: _ } = validated;
    let functions = module.functions.iter().map(|(handle, function)| (&info[handle], function));
    let points = module.entry_points.iter().enumerate();
    let points = points.map(|(index, point)| (info.get_entry_point(index), &point.function));
    let (function, span) = functions.chain(points).find_map(|(info, function)| {
        function.expressions.iter().find_map(|(handle, expression)| match expression {
            Expression::Math { fun, arg, .. } if SINGLE.contains(fun) => {
                let scalar = info[*arg].ty.inner_with(&module.types).scalar();
                let is_double = scalar.is_some_and(|scalar| scalar.width == 8);
                is_double.then(|| (*fun, function.expressions.get_span(handle)))
            }
            _ => None,
        })
    })?;
    let name = format!("{function:?}").to_lowercase();
    let message = format!("no target computes `{name}` with numbers of 64 bits");
    let error = Diagnostic::error(codes::NOT_PORTABLE, message);
    let place = span.to_range().and_then(|range| composed.map.lookup(range));
    Some(place.into_iter().fold(error, |error, span| error.at(span, "it is called here")))
}

/// Refuses what targets lack, at the author's places where `composed` knows them.
///
/// # Errors
/// `emit-failed` for each.
pub fn check_lacks(
    composed: &Composed,
    validated: &Validated,
    wanted: &[Target],
) -> Result<(), Diagnostics> {
    let (module, mut found) = (&validated.module, Diagnostics::new());
    let mut refuse = |message: String, span: Span, label: &str| {
        let place = span.to_range().and_then(|range| composed.map.lookup(range));
        let error = Diagnostic::error(codes::EMIT_FAILED, message);
        found.push(place.into_iter().fold(error, |error, span| error.at(span, label)));
    };
    for (message, span, label) in lacking_in_glsl(module, wanted) {
        refuse(message, span, label);
    }
    for (message, span) in lacking_immediates(module, wanted) {
        refuse(message, span, "these immediates");
    }
    if wanted.contains(&Target::HLSL) {
        for (reason, span, label) in lost_in_hlsl(validated) {
            refuse(format!("target `hlsl`: {reason}"), span, label);
        }
        if counts_groups(module) {
            refuse(
                format!("target `hlsl`: {GROUP_COUNT}"),
                group_count(composed),
                "it is read here",
            );
        }
    }
    if wanted.contains(&Target::SPIRV) {
        for span in discards_in_continuing(module) {
            refuse(format!("target `spirv`: {DISCARD}"), span, "it is in here");
        }
        for span in half_matrices(module) {
            refuse(format!("target `spirv`: {HALF_MATRIX}"), span, "it is in here");
        }
    }
    if found.is_empty() { Ok(()) } else { Err(found) }
}

/// What versions of GLSL lack, with labels of the places.
fn lacking_in_glsl(module: &Module, wanted: &[Target]) -> Vec<(String, Span, &'static str)> {
    let entries = targets::ALL.iter().filter(|entry| wanted.contains(&entry.target));
    let versions: Vec<_> = entries.filter_map(|entry| Some((entry.target, entry.glsl?))).collect();
    if versions.is_empty() {
        return Vec::new();
    }
    let floats = depths::as_floats(module).ok().flatten();
    let in_glsl = floats.as_ref().map_or(module, |(module, _)| module);
    let mut found = Vec::new();
    for (target, version) in versions {
        let lacking = lacking_features(in_glsl, version);
        found.extend(
            lacking.map(|(what, span)| (lack_message(target, what), span, "it is written so")),
        );
        let message = format!("target `{target}`: {TWO_ROWS}");
        found.extend(two_rows(module).map(|span| (message.clone(), span, "it is in here")));
    }
    found
}

/// Immediates that are no uniform buffer, for the targets that have one in their place.
fn lacking_immediates(module: &Module, wanted: &[Target]) -> Vec<(String, Span)> {
    let Some((reason, span)) = immediates::lack(module) else { return Vec::new() };
    let entries = targets::ALL.iter().filter(|one| !one.immediates && wanted.contains(&one.target));
    entries.map(|entry| (format!("target `{}`: {reason}", entry.target), span)).collect()
}

/// What naga's HLSL would lay or read otherwise, with the words at its place.
fn lost_in_hlsl(validated: &Validated) -> Vec<(&'static str, Span, &'static str)> {
    let module = &validated.module;
    let taken = columns::taken_from_values(module, &validated.info);
    let gaps = located::lost_gaps(module).into_iter();
    taken
        .map(|span| (columns::TAKEN, span, "it is taken here"))
        .chain(gaps.map(|span| (located::LOCATED, span, "the buffer")))
        .collect()
}

/// naga writes the index of the workgroup in its place.
pub const GROUP_COUNT: &str =
    "the language has no `num_workgroups`: pass the number in a uniform buffer";

/// Whether some entry point reads the number of workgroups.
pub fn counts_groups(module: &Module) -> bool {
    entry_values(module).any(|(ty, binding)| {
        let is_count = |binding: Option<&Binding>| {
            matches!(binding, Some(Binding::BuiltIn(BuiltIn::NumWorkGroups)))
        };
        match &module.types[ty].inner {
            TypeInner::Struct { members, span: _ } => {
                members.iter().any(|member| is_count(member.binding.as_ref()))
            }
            _ => is_count(binding),
        }
    })
}

/// Where a text names the number of workgroups.
fn group_count(composed: &Composed) -> Span {
    let is_word = |c: char| c == '_' || c.is_alphanumeric();
    let find = |name: &str| {
        let is_whole = |at: usize| {
            let (before, after) = (&composed.text[..at], &composed.text[at + name.len()..]);
            !before.ends_with(is_word) && !after.starts_with(is_word)
        };
        let mut found = composed.text.match_indices(name).map(|(at, _)| at);
        let start = found.find(|at| is_whole(*at))?;
        Some(Span::new(u32::try_from(start).ok()?, u32::try_from(start + name.len()).ok()?))
    };
    ["num_workgroups", "gl_NumWorkGroups"].into_iter().find_map(find).unwrap_or_default()
}

const DISCARD: &str = "a loop cannot end an invocation in `continuing`: discard in its body";

const HALF_MATRIX: &str = "a matrix of `f16` in a uniform block has another layout in Vulkan 1.0: use \
     vectors, or a storage buffer";

/// Why SPIR-V cannot express a module.
pub fn spirv_lack(module: &Module) -> Option<String> {
    if !discards_in_continuing(module).is_empty() {
        return Some(DISCARD.to_owned());
    }
    half_matrices(module).next().is_some().then(|| HALF_MATRIX.to_owned())
}

/// The uniform blocks with a matrix of `f16`, whose columns are not 16 bytes apart.
fn half_matrices(module: &Module) -> impl Iterator<Item = Span> {
    let is_half = |rows: VectorSize, scalar: Scalar| {
        // naga writes those of two rows as vectors.
        scalar == Scalar::F16 && rows != VectorSize::Bi
    };
    let blocks = module.global_variables.iter();
    let blocks = blocks.filter(|(_, one)| one.space == AddressSpace::Uniform);
    blocks
        .filter(move |(_, one)| has_matrix(module, one.ty, &is_half))
        .map(|(handle, _)| module.global_variables.get_span(handle))
}

/// The places of `continuing` blocks that discard. SPIR-V must get back to the start of the loop from
/// there.
fn discards_in_continuing(module: &Module) -> Vec<Span> {
    fn discards(block: &Block) -> bool {
        block.iter().any(|statement| {
            matches!(statement, Statement::Kill)
                || inner_blocks(statement).into_iter().any(discards)
        })
    }
    fn find(block: &Block, found: &mut Vec<Span>) {
        for (statement, span) in block.span_iter() {
            if let Statement::Loop { body: _, continuing, break_if: _ } = statement
                && discards(continuing)
            {
                found.push(*span);
            }
            inner_blocks(statement).into_iter().for_each(|inner| find(inner, found));
        }
    }
    let mut found = Vec::new();
    for function in functions(module) {
        find(&function.body, &mut found);
    }
    found
}

fn lack_message(target: Target, what: &str) -> String {
    format!("target `{target}`: the language has no {what}, which is needed here")
}

/// The first thing in the module that a version of GLSL lacks.
pub fn first_lack(module: &Module, version: Version) -> Option<String> {
    if two_rows(module).next().is_some() {
        return Some(TWO_ROWS.to_owned());
    }
    let (what, _) = lacking_features(module, version).next()?;
    Some(format!("the language has no {what}, which is needed"))
}

/// The places of uniform blocks that have matrices of two rows.
fn two_rows(module: &Module) -> impl Iterator<Item = Span> {
    let blocks = module.global_variables.iter();
    let blocks = blocks
        .filter(|(_, one)| one.space == AddressSpace::Uniform || immediates::is_immediate(one));
    blocks
        .filter(|(_, one)| has_matrix(module, one.ty, &|rows, _| rows == VectorSize::Bi))
        .map(|(handle, _)| module.global_variables.get_span(handle))
}

/// Whether a type has a matrix of a kind in it.
fn has_matrix(
    module: &Module,
    ty: Handle<Type>,
    is_such: &dyn Fn(VectorSize, Scalar) -> bool,
) -> bool {
    match &module.types[ty].inner {
        TypeInner::Matrix { rows, columns: _, scalar } => is_such(*rows, *scalar),
        TypeInner::Array { base, size: _, stride: _ } => has_matrix(module, *base, is_such),
        TypeInner::Struct { members, span: _ } => {
            members.iter().any(|member| has_matrix(module, member.ty, is_such))
        }
        _ => false,
    }
}

fn lacking_features(
    module: &Module,
    version: Version,
) -> impl Iterator<Item = (&'static str, Span)> {
    let expressions = functions(module).flat_map(move |function| {
        let expressions = function.expressions.iter();
        expressions.filter_map(move |(handle, expression)| {
            let what = later_builtin(module, function, version, expression)?;
            Some((what, function.expressions.get_span(handle)))
        })
    });
    later_values(module, version)
        .chain(expressions)
        .chain(arrays_of_arrays(module, version))
        .chain(multisampled(module, version))
}

/// Front ends declare types of textures that nothing uses.
fn multisampled(module: &Module, version: Version) -> impl Iterator<Item = (&'static str, Span)> {
    let what = MULTISAMPLED.lacking(version);
    module.global_variables.iter().filter_map(move |(handle, variable)| {
        match module.types[variable.ty].inner {
            TypeInner::Image {
                dim: _,
                arrayed: _,
                class:
                    ImageClass::Sampled { kind: _, multi: true } | ImageClass::Depth { multi: true },
            } => what.map(|what| (what, module.global_variables.get_span(handle))),
            _ => None,
        }
    })
}

fn arrays_of_arrays(
    module: &Module,
    version: Version,
) -> impl Iterator<Item = (&'static str, Span)> {
    let what = NESTED.lacking(version);
    module.types.iter().filter_map(move |(handle, ty)| match &ty.inner {
        TypeInner::Array { base, size: _, stride: _ } => {
            let is_array = matches!(
                module.types[*base].inner,
                TypeInner::Array { base: _, size: _, stride: _ }
            );
            what.filter(|_| is_array).map(|what| (what, first_use(module, &|ty| ty == handle)))
        }
        _ => None,
    })
}

/// The name, in GLSL, of something that a version lacks.
fn later_builtin(
    module: &Module,
    function: &Function,
    version: Version,
    expression: &Expression,
) -> Option<&'static str> {
    match expression {
        Expression::ImageSample { .. } => later_sample(module, function, version, expression),
        Expression::Math { fun, .. } => {
            let (_, later) = LATER.iter().find(|(known, _)| known == fun)?;
            later.lacking(version)
        }
        Expression::ImageQuery { query: ImageQuery::NumLevels, .. } => LEVELS.lacking(version),
        Expression::ImageQuery { query: ImageQuery::NumSamples, .. } => SAMPLES.lacking(version),
        Expression::ImageQuery { query: ImageQuery::NumLayers, image }
            if is_storage(module, function, *image) =>
        {
            Some(STORAGE_LAYERS)
        }
        _ => None,
    }
}

/// The name, in GLSL, of a way to sample that a version lacks, or that naga does not write for it.
fn later_sample(
    module: &Module,
    function: &Function,
    version: Version,
    expression: &Expression,
) -> Option<&'static str> {
    let Expression::ImageSample {
        image,
        sampler: _,
        gather,
        coordinate: _,
        array_index: _,
        offset,
        level,
        depth_ref,
        clamp_to_edge: _,
    } = expression
    else {
        return None;
    };
    if depth_ref.is_none() && is_depth(module, function, *image) {
        return Some(PLAIN_DEPTH);
    }
    if gather.is_some()
        && let Some(lacking) = GATHER.lacking(version)
    {
        return Some(lacking);
    }
    let (dim, is_array, _) =
        image_kind(module, function, *image).filter(|_| depth_ref.is_some())?;
    let is_cube = dim == ImageDimension::Cube;
    match level {
        _ if gather.is_some() => (is_array || is_cube).then_some(GATHERED_LAYERS),
        SampleLevel::Zero | SampleLevel::Exact(_) if is_array && is_cube => Some(CUBE_LEVELS),
        _ if is_array && offset.is_some() => LAYER_OFFSETS.lacking(version),
        _ => None,
    }
}

const GATHERED_LAYERS: &str = "gathering of comparisons from layers or cubes, as naga writes it";
const CUBE_LEVELS: &str = "comparison at a given level of an array of cubes";
const STORAGE_LAYERS: &str = "number of layers of a storage texture, as naga writes it";
const PLAIN_DEPTH: &str = "depth texture that is sampled without a comparison";

fn is_depth(module: &Module, function: &Function, image: Handle<Expression>) -> bool {
    image_class(module, function, image) == Some(ImageClass::Depth { multi: false })
}

fn is_storage(module: &Module, function: &Function, image: Handle<Expression>) -> bool {
    let class = image_class(module, function, image);
    matches!(class, Some(ImageClass::Storage { format: _, access: _ }))
}

fn image_class(
    module: &Module,
    function: &Function,
    image: Handle<Expression>,
) -> Option<ImageClass> {
    image_kind(module, function, image).map(|(_, _, class)| class)
}

/// The dimensions of a texture, whether it has layers, and its class.
fn image_kind(
    module: &Module,
    function: &Function,
    image: Handle<Expression>,
) -> Option<(ImageDimension, bool, ImageClass)> {
    let ty = match &function.expressions[image] {
        Expression::GlobalVariable(variable) => module.global_variables[*variable].ty,
        Expression::FunctionArgument(index) => function.arguments[*index as usize].ty,
        _ => return None,
    };
    match module.types[ty].inner {
        TypeInner::Image { dim, arrayed, class } => Some((dim, arrayed, class)),
        _ => None,
    }
}

/// The types and bindings of what enters and leaves entry points.
fn entry_values(module: &Module) -> impl Iterator<Item = (Handle<Type>, Option<&Binding>)> {
    module.entry_points.iter().flat_map(|point| {
        let Function {
            arguments,
            result,
            name: _,
            local_variables: _,
            expressions: _,
            named_expressions: _,
            body: _,
            diagnostic_filter_leaf: _,
        } = &point.function;
        let given = arguments.iter().map(|given| (given.ty, given.binding.as_ref()));
        given.chain(result.iter().map(|result| (result.ty, result.binding.as_ref())))
    })
}

/// The built-in values of entry points that a version lacks.
fn later_values(module: &Module, version: Version) -> impl Iterator<Item = (&'static str, Span)> {
    let values = entry_values(module);
    let built_in = move |binding: Option<&Binding>| match binding {
        Some(Binding::BuiltIn(BuiltIn::SampleIndex)) => SAMPLE_ID.lacking(version),
        Some(Binding::BuiltIn(BuiltIn::SampleMask)) => SAMPLE_MASK.lacking(version),
        _ => None,
    };
    values.filter_map(move |(ty, binding)| match &module.types[ty].inner {
        TypeInner::Struct { members, span: _ } => {
            let what = members.iter().find_map(|member| built_in(member.binding.as_ref()))?;
            Some((what, module.types.get_span(ty)))
        }
        _ => built_in(binding).map(|what| (what, Span::UNDEFINED)),
    })
}
