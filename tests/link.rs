//! The linker, which translates each function once. A text has the same bytes whether its functions
//! were translated for it or taken from other texts. A text that cannot be divided into functions
//! is compiled as a whole, with a reason.

mod alone;
mod glsl;
mod parts;
mod texts;
mod writers;

use std::collections::BTreeMap;
use std::path::Path;

use lamplight::bundle::{Hash, Language, Unit, write_directory};
use lamplight::diagnostic::render::{Form, render};
use lamplight::generate::{Generated, Request, in_memory};
use lamplight::link::Reason;
use lamplight::permute::{Manifest, Quoted};
use lamplight::project;
use lamplight::resolve::Packages;
use lamplight::source::SourceSet;
use lamplight::validators;
use libtest_mimic::{Failed, Trial};

use crate::link_compare as compare;

use alone::{agree, forward};
use glsl::{constants_like_members, derivatives_without_places, unused_functions};
use texts::{NAMES, NAMES_MANIFEST, ROWS, ROWS_MANIFEST, TRAPS, TRAPS_MANIFEST};
use writers::{
    blocks_beside_structures, entry_points, kept_matrices, kept_names, lacking,
    matrices_from_values, matrices_of_two_rows, returned_arrays, types_like_members,
    variables_named_after_structures, written_textures,
};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

/// Every 23rd permutation of `forward` is also compiled alone, or as a whole.
const STEP: usize = 23;

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 25] = [
        ("marks_are_found_in_longer_names", parts::marks_are_found_in_longer_names),
        ("sets_hold_what_was_put_in", parts::sets_hold_what_was_put_in),
        ("a_fragment_is_written_with_other_names", parts::a_fragment_is_written_with_other_names),
        (
            "words_are_plain_where_no_reference_touches_them",
            parts::words_are_plain_where_no_reference_touches_them,
        ),
        ("forward_alone_and_together", forward),
        ("traps_alone_and_together", traps),
        ("names_alone_and_together", names),
        ("whole_and_linked", whole_and_linked),
        ("reasons", reasons),
        ("warnings_are_not_lost", warnings),
        ("warnings_beside_aliases", warnings_beside_aliases),
        ("an_entry_point_called_like_others", entry_points),
        ("unused_functions_of_glsl", unused_functions),
        ("constants_of_glsl_like_members", constants_like_members),
        ("derivatives_of_glsl_without_places", derivatives_without_places),
        ("names_of_hlsl_and_glsl", kept_names),
        ("blocks_beside_structures", blocks_beside_structures),
        ("types_like_members", types_like_members),
        ("variables_named_after_structures", variables_named_after_structures),
        ("functions_that_old_glsl_lacks", lacking),
        ("arrays_of_matrices_of_two_rows", matrices_of_two_rows),
        ("arrays_of_matrices_are_kept", kept_matrices),
        ("arrays_of_matrices_from_values", matrices_from_values),
        ("functions_that_return_arrays", returned_arrays),
        ("textures_that_functions_write", written_textures),
    ];
    cases.into_iter().map(|(name, case)| Trial::test(format!("link::{name}"), case)).collect()
}

/// Makes a manifest's permutations, or one of them.
fn made(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    key: Option<&str>,
) -> Result<Generated, Failed> {
    let request = request(sources, key);
    let made = in_memory(sources, packages, manifest, &request, &|_| ());
    Ok(made.map_err(|problems| render(sources, &problems, Form::Human))?)
}

/// Asks for all permutations, or for that of a key.
fn request(sources: &mut SourceSet, key: Option<&str>) -> Request {
    let only = key.map(|key| {
        let id = sources.add("key", key);
        Quoted::whole(sources, id)
    });
    Request { only, ..Request::default() }
}

/// Of a unit: language, entry point and key.
type Name<'g> = (Language, &'g String, &'g String);

/// The hash of each unit.
fn hashes(generated: &Generated) -> BTreeMap<Name<'_>, Hash> {
    let languages = generated.contents.programs.values().flat_map(|program| &program.languages);
    let entries = languages.flat_map(|(language, entries)| {
        entries.iter().map(move |(name, entry)| (*language, name, entry))
    });
    let keys = entries.flat_map(|(language, name, entry)| {
        entry.keys.iter().map(move |(key, hash)| ((language, name, key), *hash))
    });
    keys.collect()
}

/// Each unit.
fn units(generated: &Generated) -> BTreeMap<Name<'_>, &Unit> {
    let programs = &generated.contents.programs;
    let unit = |(language, name, key), hash| {
        let entries = programs.values().filter_map(|program| program.languages.get(&language));
        let mut found = entries.filter_map(|entries| entries.get(name)?.units.get(&hash));
        found.next().map(|unit| ((language, name, key), unit))
    };
    hashes(generated).into_iter().filter_map(|(name, hash)| unit(name, hash)).collect()
}

fn all_linked(generated: &Generated) -> Outcome {
    match generated.summary.whole.first() {
        Some(whole) => {
            Err(format!("every text should be linked; compiled as a whole: {whole:?}").into())
        }
        None => Ok(()),
    }
}

/// A linked output has the declarations that naga writes for the whole text, except for their names
/// and their order. It has all functions, and those other declarations that are used. This test
/// fails if a version of naga writes a function in a way that depends on the rest of its module,
/// which the linker assumes it does not.
fn whole_and_linked() -> Outcome {
    let folder = tempfile::tempdir()?;
    for (name, manifest, text) in [
        ("traps", TRAPS_MANIFEST, TRAPS),
        ("rows", ROWS_MANIFEST, ROWS),
        ("names", NAMES_MANIFEST, NAMES),
    ] {
        let (mut sources, packages, manifest) = package(folder.path(), name, manifest, text)?;
        compare::all(&mut sources, &packages, &manifest, 1)?;
    }
    let (mut sources, mut manifest) = project::library_manifest()
        .map_err(|(sources, problems)| render(&sources, &problems, Form::Human))?;
    manifest.programs.retain(|program| program.name == "forward");
    // naga's GLSL front end numbers values and orders statements by what else the module has, so
    // outputs of GLSL sources cannot be compared as texts. `frames` and `metal` draw them instead.
    manifest.programs.iter_mut().for_each(|program| program.glsl = None);
    compare::all(&mut sources, &project::library_packages(), &manifest, STEP)
}

/// Writes a package of one module to a folder, and reads it.
fn package(
    folder: &Path,
    name: &str,
    manifest: &str,
    text: &str,
) -> Result<(SourceSet, Packages, Manifest), Failed> {
    std::fs::write(folder.join("lamplight.toml"), manifest)?;
    std::fs::write(folder.join(format!("{name}.wesl")), text)?;
    let mut sources = SourceSet::default();
    let read = (|| {
        let manifest = project::read_manifest(&folder.join("lamplight.toml"), &mut sources)?;
        Ok((project::packages(folder, &mut sources)?, manifest))
    })();
    let (packages, manifest) = read.map_err(|problems: lamplight::diagnostic::Diagnostics| {
        render(&sources, &problems, Form::Human)
    })?;
    Ok((sources, packages, manifest))
}

/// Texts with much that naga's writers number, rename or add have the same bytes alone and
/// together.
fn traps() -> Outcome {
    alone_and_together("traps", TRAPS_MANIFEST, TRAPS)?;
    alone_and_together("rows", ROWS_MANIFEST, ROWS)
}

/// Names with a meaning to a writer have the same bytes alone and together.
fn names() -> Outcome {
    alone_and_together("names", NAMES_MANIFEST, NAMES)
}

fn alone_and_together(name: &str, manifest: &str, text: &str) -> Outcome {
    let folder = tempfile::tempdir()?;
    let (mut sources, packages, manifest) = package(folder.path(), name, manifest, text)?;
    let mut together = agree(&mut sources, &packages, &manifest, 1)?;
    all_linked(&together)?;
    let contents = std::mem::take(&mut together.contents);
    let out = folder.path().join("out");
    write_directory(&contents, &out)?;
    validate_all(&out)
}

/// The validators accept every output of a bundle.
fn validate_all(out: &Path) -> Outcome {
    let outputs = validators::outputs(lamplight::bundle::blob_files(out)?)?;
    match validators::validate_outputs(&outputs, None, &|_, _| ())?.first() {
        None if !outputs.is_empty() => Ok(()),
        Some(refusal) => Err(format!("an output is refused: {refusal:?}").into()),
        None => Err(format!("{} has no outputs to validate", out.display()).into()),
    }
}

/// A fragment shader with the declarations `more` and the statements `body`.
fn fragment(more: &str, body: &str) -> String {
    format!(
        "@group(0) @binding(0) var map: texture_2d<f32>; @group(0) @binding(1) var smp: sampler;
@group(0) @binding(2) var<uniform> u: vec4f;
{more}
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {{
    {body}
    return u + textureSampleLevel(map, smp, at, 0.0);
}}"
    )
}

/// The targets of a program that are compiled as a whole, with the reason.
fn reasons_of(text: &str, targets: &str) -> Result<BTreeMap<String, Reason>, Failed> {
    let folder = tempfile::tempdir()?;
    let manifest = format!("[program.one]\nwesl = \"one.wesl\"\n{targets}\n");
    let (mut sources, packages, manifest) = package(folder.path(), "one", &manifest, text)?;
    let made = made(&mut sources, &packages, &manifest, None)?;
    Ok(made.summary.whole.into_iter().map(|whole| (whole.target, whole.reason)).collect())
}

/// Declarations and statements with which a text can be linked.
const LINKED: &[(&str, &str)] = &[
    ("", "let d = dpdx(at.x); if d > 0.0 { discard; }"),
    ("fn f(x: f32) -> f32 { return fwidth(x); }", "let d = f(at.x);"),
    ("fn tap_3(x: f32) -> f32 { return x; }", "let d = tap_3(at.x);"),
    ("fn d(x: f32) -> f32 { return x; }", "let d = d(at.x);"),
    ("", "if textureDimensions(map).x > 3u { let d = dpdx(at.x); }"),
    ("alias Map = texture_2d<f32>; fn f(m: Map) -> f32 { return 1.0; }", "let d = f(map);"),
    (
        "struct Light { a: f32, b: f32 } fn ConstructLight(x: f32) -> Light { return Light(x, x); }",
        "let d = ConstructLight(1.0);",
    ),
    ("fn member(x: f32) -> f32 { return x; }", "let d = member(1.0);"),
    ("fn fs_mainInput(x: f32) -> f32 { return x; }", "let d = fs_mainInput(1.0);"),
    ("const a = 1.0; struct S { a: f32 }", "let d = S(a);"),
    ("fn naga_f(x: f32) -> f32 { return x; }", "let d = naga_f(1.0);"),
    (
        "fn a_b_(x: f32) -> f32 { return x; } fn a_b(x: f32) -> f32 { return x; }",
        "let d = a_b(1.0) + a_b_(2.0);",
    ),
    ("const other = 0.5;", "let d = modf(at.x * other).fract;"),
    ("const value = 0.5;", "let d = i32(at.x * value);"),
    ("const ret = 0.5; struct Pair { a: f32, b: f32 }", "let d = Pair(at.x, ret);"),
    (
        "alias Color = vec4f; var<private> table: array<Color, 2>;",
        "let d = array<vec4f, 2>(u, u); table = d;",
    ),
    ("fn é(x: f32) -> f32 { return x; }", "let d = é(1.0);"),
    ("const_assert true;", ""),
    ("fn SamplerState(x: f32) -> f32 { return x; }", "let d = SamplerState(1.0);"),
];

/// Declarations and statements with which a text is compiled as a whole, and the reason.
const WHOLE: &[(&str, &str, Reason)] = &[
    ("override o: f32 = 1.0;", "let d = o;", Reason::Override),
    ("@group(0) @binding(3) var<storage> s: array<f32>;", "let d = s[0];", Reason::StorageBuffer),
    (
        "@group(0) @binding(3) var< storage , read > s: vec4f;",
        "let d = s.x;",
        Reason::StorageBuffer,
    ),
    ("fn Zqbqz(x: f32) -> f32 { return x; }", "let d = Zqbqz(1.0);", Reason::MarkedName),
];

/// A text is compiled as a whole only for a known reason. If more texts were, `gen` would be slow
/// without anybody noticing.
fn reasons() -> Outcome {
    for (more, body) in LINKED {
        let reasons = reasons_of(&fragment(more, body), "")?;
        if !reasons.is_empty() {
            return Err(format!("`{more} {body}` should be linked, found {reasons:?}").into());
        }
    }
    let each = |text: fn(i32) -> String| (0..2050).map(text).collect::<String>();
    let constants = each(|index| format!("const C{index} = {index};\n"));
    let sum = format!("var sum = 0;{}", each(|index| format!(" sum += C{index};")));
    let many = (constants.as_str(), sum.as_str(), Reason::Large);
    for (more, body, reason) in WHOLE.iter().chain([&many]) {
        // Only these targets are asked for, since not every target has storage buffers.
        let targets = "targets = [\"spirv\", \"wgsl\"]";
        let reasons = reasons_of(&fragment(more, body), targets)?;
        if reasons.len() != 2 || reasons.values().any(|found| found != reason) {
            let what = format!("expected {reason:?} for both targets, found {reasons:?}");
            return Err(format!("`{more} {body}`: {what}").into());
        }
    }
    Ok(())
}

/// A derivative in non-uniform control flow gives a warning, for the permutation alone and among
/// others.
fn warnings() -> Outcome {
    let text = "
@group(0) @binding(0) var map: texture_2d<f32>;
@group(0) @binding(1) var smp: sampler;
@if(parted) fn far(at: vec2f) -> bool { return at.x > 0.5; }
@else fn far(at: vec2f) -> bool { return true; }
fn sampled(at: vec2f) -> vec4f { if far(at) { return textureSample(map, smp, at); } return vec4f(); }
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f { return sampled(at); }
";
    warned(text)
}

/// The same with an alias. naga takes the array of an alias for another type than the array of its
/// type, so it accepts this text only with the alias replaced. The warning must not be lost then.
fn warnings_beside_aliases() -> Outcome {
    let text = "
alias Colour = vec4f;
var<private> colours: array<Colour, 2>;
@group(0) @binding(0) var map: texture_2d<f32>;
@group(0) @binding(1) var smp: sampler;
@if(parted) fn far(at: vec2f) -> bool { return at.x > 0.5; }
@else fn far(at: vec2f) -> bool { return true; }
fn sampled(at: vec2f) -> vec4f { if far(at) { return textureSample(map, smp, at); } return vec4f(); }
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    colours = array<vec4f, 2>(at.xyxy, at.xxyy);
    return sampled(at) + colours[1];
}
";
    warned(text)
}

/// A program gives one warning, for its permutation `parted`. It is for Vulkan: for browsers it
/// would be an error.
fn warned(text: &str) -> Outcome {
    let program = "[program.small]\nwesl = \"small.wesl\"\ntargets = [\"spirv\"]";
    let manifest = format!("{program}\naxis.parted = {{ values = [false, true] }}\n");
    let folder = tempfile::tempdir()?;
    let (mut sources, packages, manifest) = package(folder.path(), "small", &manifest, text)?;
    let together = made(&mut sources, &packages, &manifest, None)?.warnings.len();
    let alone = made(&mut sources, &packages, &manifest, Some("parted"))?.warnings.len();
    if (together, alone) == (1, 1) {
        Ok(())
    } else {
        Err(format!("expected 1 warning, found {together} together and {alone} alone").into())
    }
}
