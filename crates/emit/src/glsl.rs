//! What the GLSL targets share: combined samplers, names and coordinates.

use naga::back::glsl::{Options, PipelineOptions, ReflectionInfo, Version, Writer, WriterFlags};
use naga::proc::BoundsCheckPolicies;
use naga::{Expression, SampleLevel};

use super::depths;
use super::invariants;
use super::lacks::{self, has_since};
use super::padding;
use super::plain::{self, Needs};
use super::reflect::place_of;
use super::remainder;
use super::rename;
use super::slots::{EXPLICIT_LIMIT, Numbering, UsedBinding, assign_slots, native_reflection};
use super::text::BoundedText;
use super::{EmitSource, Emitted};
use lamplight_bundle::{BindingKind, ClipConvention, Combined, Native};
use lamplight_validate::functions;

/// The uniform that naga adds for WebGPU's first instance, which OpenGL does not count from.
const FIRST_INSTANCE: &str = "naga_vs_first_instance";

/// What lines before the first declaration begin with: directives, and precisions in GLSL ES.
pub const HEADER: &[&str] = &["#", "precision "];

/// Writes GLSL of one version.
pub fn write_glsl(
    source: &EmitSource<'_>,
    version: Version,
    numbering: Numbering,
) -> Result<Emitted, String> {
    let floats = depths::as_floats(source.module)?;
    let (module, info) =
        floats.as_ref().map_or((source.module, source.info), |(module, info)| (module, info));
    if let Some(reason) = lacks::first_lack(module, version) {
        return Err(reason);
    }
    let padded = padding::with_padding(module, info)?;
    let (module, info) = padded.as_ref().map_or((module, info), |(module, info)| (module, info));
    write_padded(&EmitSource { module, info, ..*source }, version, numbering)
}

/// Writes GLSL of a module whose structures have no gaps.
fn write_padded(
    source: &EmitSource<'_>,
    version: Version,
    numbering: Numbering,
) -> Result<Emitted, String> {
    let plainer = invariants::without_invariant_inputs(source.module, source.stage);
    let source = &EmitSource { module: plainer.as_ref().unwrap_or(source.module), ..*source };
    let plain = plain::with_plain_forms(source.module, source.info, first_needs(version))?;
    let (module, info) =
        plain.as_ref().map_or((source.module, source.info), |(module, info)| (module, info));
    // The forms above have choices of their own.
    let separate = plain::with_plain_forms(module, info, last_needs(version))?;
    let (module, info) = separate.as_ref().map_or((module, info), |(module, info)| (module, info));
    let source = &EmitSource { module, info, ..*source };
    let changed = rename::rename_taken(source.module, &is_taken);
    let source = &EmitSource { module: changed.as_ref().unwrap_or(source.module), ..*source };
    let defined = remainder::with_defined_remainders(source.module, source.info)?;
    let (module, info) =
        defined.as_ref().map_or((source.module, source.info), |(module, info)| (module, info));
    let source = &EmitSource { module, info, ..*source };
    let options = writer_options(source, version, numbering)?;
    // The entry point may be among what was renamed above.
    let entry = source.module.entry_points.get(source.index).ok_or("there is no entry point")?;
    let pipeline = PipelineOptions {
        shader_stage: source.stage,
        entry_point: entry.name.clone(),
        multiview: None,
    };
    let mut text = BoundedText::default();
    let written = Writer::new(
        &mut text,
        source.module,
        source.info,
        &options,
        &pipeline,
        bounds_policies(source, version),
    )
    .and_then(|mut writer| writer.write());
    let mut info = written.map_err(|error| in_words(source, &text, &error))?;
    let mut text = with_mask_elements(with_known_extensions(text.0, source.module));
    if defined.is_some() {
        text = remainder::with_plain_parameters(text);
    }
    name_blocks(source, &mut text, &mut info);
    let mut native = glsl_reflection(source, &info, numbering);
    let is_used = text.contains(&format!("uniform uint {FIRST_INSTANCE};"));
    native.first_instance = is_used.then(|| FIRST_INSTANCE.to_owned());
    Ok(Emitted { bytes: text.into_bytes(), native })
}

/// The text with the extensions that it needs.
fn with_known_extensions(text: String, module: &naga::Module) -> String {
    // naga omits the prefix of this one extension's name, and no driver knows it without.
    let text = text.replacen("#extension ARB_", "#extension GL_ARB_", 1);
    // Nothing else needs the extension, which naga asks for where it is not sure.
    match text.contains("textureLod") || compares_with_bias(module) {
        true => text,
        false => text.replacen("#extension GL_EXT_texture_shadow_lod : require\n", "", 1),
    }
}

/// Whether a comparison has a bias, as those of GLSL may.
fn compares_with_bias(module: &naga::Module) -> bool {
    functions(module).any(|function| {
        function.expressions.iter().any(|(_, value)| {
            matches!(
                value,
                Expression::ImageSample { level: SampleLevel::Bias(_), depth_ref: Some(_), .. }
            )
        })
    })
}

/// The text with the first element of the masks of samples, which are arrays of signed numbers.
fn with_mask_elements(text: String) -> String {
    const MASK: &str = "gl_SampleMask";
    if !text.contains(MASK) {
        return text;
    }
    let text = text.replace("gl_SampleMaskIn", "uint(gl_SampleMaskIn[0])");
    let line = |line: &str| match line.split_once("gl_SampleMask = ") {
        Some((before, value)) => {
            let value = value.trim_end().trim_end_matches(';');
            format!("{before}gl_SampleMask[0] = int({value});\n")
        }
        None => line.to_owned(),
    };
    text.split_inclusive('\n').map(line).collect()
}

fn first_needs(version: Version) -> Needs {
    Needs {
        whole_offsets: true,
        defined_divisors: true,
        bounded_integers: true,
        clamped_bytes: !has_since(version, 400, Some(310)),
        clamped_words: !has_since(version, 420, Some(300)),
        enclosed_bytes: true,
        enclosed_subtrahends: true,
        separate_choices: false,
        unpacked_choices: false,
        masked_shifts: true,
    }
}

fn last_needs(version: Version) -> Needs {
    Needs { separate_choices: !has_since(version, 450, Some(310)), ..Needs::default() }
}

/// naga checks loads of textures, which needs the number of their levels. GLSL has a function for
/// it from 4.30.
fn bounds_policies(source: &EmitSource<'_>, version: Version) -> BoundsCheckPolicies {
    match version {
        Version::Desktop(430..) => source.bounds_policies(),
        _ => BoundsCheckPolicies::default(),
    }
}

/// Words that extensions reserve, and that compilers of GLSL refuse whether an extension is enabled
/// or not. naga does not avoid them.
const WORDS: &[&str] = &[
    "devicecoherent",
    "fcoopmatNV",
    "icoopmatNV",
    "nonprivate",
    "pervertexEXT",
    "pervertexNV",
    "queuefamilycoherent",
    "samplerExternalOES",
    "shadercallcoherent",
    "subgroupcoherent",
    "ucoopmatNV",
    "workgroupcoherent",
];

/// How the names of types with a size begin, such as `f16vec2`. One of `KINDS` follows.
const SIZED: &[&str] = &["f16", "f32", "f64", "i16", "i32", "i64", "i8", "u16", "u32", "u64", "u8"];
const KINDS: &[&str] = &["image", "mat", "sampler", "subpass", "texture", "vec"];

fn is_taken(name: &str) -> bool {
    let behind = |start: &&str| name.strip_prefix(*start);
    let is_sized =
        SIZED.iter().filter_map(behind).any(|rest| KINDS.iter().any(|kind| rest.starts_with(kind)));
    let number = ["uint", "int", "float"].iter().find_map(behind);
    let is_number = number.is_some_and(|bits| matches!(bits, "8_t" | "16_t" | "32_t" | "64_t"));
    // naga itself makes names with this beginning, so it would put `gen_` before the author's. `gl`
    // is taken since naga would call a second variable of that name `gl_1`.
    let is_nagas = name.starts_with("_group");
    is_sized || is_number || is_nagas || WORDS.contains(&name) || name.trim_end_matches('_') == "gl"
}

fn writer_options(
    source: &EmitSource<'_>,
    version: Version,
    numbering: Numbering,
) -> Result<Options, String> {
    let mut options = Options {
        version,
        writer_flags: match source.conventions.clip {
            ClipConvention::Wgpu => WriterFlags::ADJUST_COORDINATE_SPACE,
            ClipConvention::Native => WriterFlags::empty(),
        },
        ..Options::default()
    };
    if numbering == Numbering::Explicit {
        for (UsedBinding { place: binding, .. }, index) in assign_slots(source, numbering) {
            let slot = index.and_then(|index| u8::try_from(index).ok()).ok_or_else(|| {
                format!(
                    "@group({}) @binding({}) has no number: this target takes groups and bindings below {EXPLICIT_LIMIT}",
                    binding.group, binding.binding
                )
            })?;
            options.binding_map.insert(binding, slot);
        }
    }
    Ok(options)
}

/// What naga's writer says, in words.
fn in_words(
    source: &EmitSource<'_>,
    text: &BoundedText,
    error: &naga::back::glsl::Error,
) -> String {
    match error {
        naga::back::glsl::Error::ImageMultipleSamplers => several_samplers(source),
        naga::back::glsl::Error::MissingFeatures(features) => missing_words(*features),
        error => text.explain(error),
    }
}

/// The texture that an entry point samples with several samplers, with their names.
fn several_samplers(source: &EmitSource<'_>) -> String {
    let name = |handle: naga::Handle<naga::GlobalVariable>| {
        let name = source.module.global_variables[handle].name.as_deref();
        format!("`{}`", name.unwrap_or_default())
    };
    let used = &source.info.get_entry_point(source.index).sampling_set;
    let mut pairs: Vec<_> = used.iter().map(|key| (key.image, key.sampler)).collect();
    pairs.sort();
    let twice = pairs.windows(2).find(|pair| pair[0].0 == pair[1].0);
    let what = twice.map_or_else(
        || "a texture is sampled with several samplers".to_owned(),
        |pair| {
            let (image, one, other) = (name(pair[0].0), name(pair[0].1), name(pair[1].1));
            format!("{image} is sampled with {one} and with {other}")
        },
    );
    format!(
        "{what}, and this language joins each texture with one sampler\nhelp: take one sampler for \
         both, or bind the texture twice"
    )
}

/// What a version of the language lacks, in words.
fn missing_words(features: naga::back::glsl::Features) -> String {
    let names: Vec<String> = features
        .iter_names()
        .map(|(name, _)| match name {
            "BUFFER_STORAGE" => "storage buffers".to_owned(),
            "COMPUTE_SHADER" => "compute shaders".to_owned(),
            "DYNAMIC_ARRAY_SIZE" => "arrays whose size is not constant".to_owned(),
            "IMAGE_LOAD_STORE" => "storage textures".to_owned(),
            "CUBE_TEXTURES_ARRAY" => "arrays of cube textures".to_owned(),
            _ => name.to_lowercase().replace('_', " "),
        })
        .collect();
    format!("the language lacks {}", names.join(", "))
}

/// What stands between the name of a block's type and its group and binding.
pub const BLOCK: &str = "_block_";

/// The keywords that declare a block.
const BLOCK_KEYWORDS: [&str; 2] = ["uniform", "buffer"];

/// The name of a block's type in the form that the block's own name begins with. naga ends names
/// with an underscore, and browsers refuse two in a row in GLSL ES.
pub fn before_block(ty: &str) -> &str {
    ty.trim_end_matches('_')
}

/// Names blocks after their group and binding. naga numbers them in the order of the text, so that
/// a block's name would depend on what else the permutation has.
fn name_blocks(source: &EmitSource<'_>, text: &mut String, info: &mut ReflectionInfo) {
    for (handle, name) in &mut info.uniforms {
        let numbered = name.rsplit_once(BLOCK).map(|(ty, number)| {
            (ty, number.trim_start_matches(|digit: char| digit.is_ascii_digit()))
        });
        if let (Some((ty, stage)), Some([group, binding])) =
            (numbered, place_of(source.module, *handle))
        {
            let own = format!("{}{BLOCK}{group}_{binding}{stage}", before_block(ty));
            // Only the name behind the keyword is replaced: a structure of the author may have the
            // same name.
            for keyword in BLOCK_KEYWORDS {
                if let Some(at) = text.find(&format!("{keyword} {name} {{")) {
                    let start = at + keyword.len() + 1;
                    text.replace_range(start..start + name.len(), &own);
                }
            }
            *name = own;
        }
    }
}

/// The reflection. Samplers are combined with the textures that they are used with, and only the
/// combined names have units.
fn glsl_reflection(source: &EmitSource<'_>, info: &ReflectionInfo, numbering: Numbering) -> Native {
    let mut native = native_reflection(source, "main", numbering);
    let samplers: Vec<_> = assign_slots(source, numbering)
        .into_iter()
        .map(|(used, _)| used)
        .filter(|used| matches!(used.kind, BindingKind::Sampler | BindingKind::ComparisonSampler))
        .map(|used| [used.place.group, used.place.binding])
        .collect();
    native.slots.retain(|slot| !samplers.contains(&[slot.group, slot.binding]));
    native.combined = combined_samplers(source, info);
    let blocks = info
        .uniforms
        .iter()
        .filter_map(|(handle, name)| Some((place_of(source.module, *handle)?, name.clone())));
    let textures = native.combined.iter().map(|combined| (combined.texture, combined.name.clone()));
    let names: std::collections::BTreeMap<_, _> = blocks.chain(textures).collect();
    for slot in &mut native.slots {
        slot.name = names.get(&[slot.group, slot.binding]).cloned();
    }
    native
}

fn combined_samplers(source: &EmitSource<'_>, info: &ReflectionInfo) -> Vec<Combined> {
    let mut found: Vec<Combined> = info
        .texture_mapping
        .iter()
        .filter_map(|(name, mapping)| {
            let sampler = mapping.sampler.and_then(|sampler| place_of(source.module, sampler));
            Some(Combined {
                texture: place_of(source.module, mapping.texture)?,
                sampler,
                name: name.clone(),
            })
        })
        .collect();
    found.sort();
    found
}
