//! The library's own programs. Some permutations are recorded as texts, which people review; all
//! are recorded by hashes; and the validator of each target reads a part of the outputs.

mod recorded;

use std::process::Command;
use std::sync::{Arc, Mutex, PoisonError};

use lamplight::bundle::key::{has_value, without_axis, write as write_key};
use lamplight::bundle::{Artifact, Contents, EntryContents, Hash, Language, Target, Unit};
use lamplight::compose::{Keep, Options, compose};
use lamplight::diagnostic::render::{Form, render};
use lamplight::generate::{Request, in_memory};
use lamplight::permute::{Program, Quoted, Settings, key};
use lamplight::source::SourceSet;
use lamplight::validate::on_large_stack;
use lamplight::validators;
use lamplight::{project, resolve};
use libtest_mimic::{Failed, Trial};

use crate::snapshot;

/// Permutations of `forward` whose texts and outputs people review: one for each thing that changes
/// the structure of the shader. Each has a short name for the folder of its snapshots, since paths
/// with whole keys would be too long for some systems.
const REVIEWED: &[(&str, &str)] = &[
    ("default", "default"),
    ("unlit", "lights=none"),
    ("two_sided_shadow", "shadow=pcf_3x3,two_sided"),
    ("vertex_point", "frequency=vertex,lights=point,specular=phong"),
    ("flat_spots", "frequency=flat,lights=spot,max_lights=10"),
    ("flat_sh9", "ambient=sh9,frequency=flat,lights=spot,specular=phong,two_sided"),
    ("ibl_materials", "ambient=ibl,base_map,diffuse=oren_nayar,material=array,specular=ggx"),
    ("vogel_sun", "shadow=pcf_vogel,shadow_light=directional,specular=ggx"),
    ("vsm_fog", "base_map,fog=exp2,lights=spot,shadow=vsm,specular=ggx"),
    (
        "vertex_window",
        "ambient_attenuated,attenuation=inverse_square_window,cone=hard,frequency=vertex,lights=spot",
    ),
    (
        "gltf_glass",
        "ambient=ibl,clearcoat,dispersion,lights=directional,metallic_roughness,specular=ggx,transmission,volume",
    ),
    ("pcss_sun", "lights=directional,max_lights=1,shadow=pcss,shadow_light=directional"),
    (
        "hemisphere_materials",
        "ambient=hemisphere,base_map,diffuse=half_lambert,lights=point,material=array,specular=phong",
    ),
];

/// The name of a test, and what it does.
type NamedTrial = (&'static str, fn() -> Result<(), Failed>);

/// The tests that ask for [`contents`], each once.
const OF_CONTENTS: [NamedTrial; 4] = [
    ("library::hashes", hashes),
    ("library::difference_is_shown", difference_is_shown),
    ("library::values_have_effect", values_have_effect),
    ("library::validators", validators_accept),
];

pub fn tests() -> Vec<Trial> {
    let reviewed = REVIEWED
        .iter()
        .map(|(name, key)| Trial::test(format!("library::reviewed::{name}"), || review(name, key)));
    let whole = OF_CONTENTS.iter().copied();
    reviewed.chain(whole.map(|(name, run)| Trial::test(name, run))).collect()
}

/// Compares the composed texts and the outputs of a permutation with its snapshots.
fn review(name: &str, text: &str) -> Result<(), Failed> {
    let (mut sources, manifest) = project::library_manifest()
        .map_err(|(sources, errors)| render(&sources, &errors, Form::Human))?;
    let program = manifest.program("forward").ok_or("no program `forward`")?;
    let id = sources.add("key", text);
    let point = key::parse(&program.space, &Quoted::whole(&sources, id))
        .map_err(|errors| render(&sources, &errors, Form::Human))?;
    let settings = program.space.settings(&point);
    let request = Request {
        program: Some("forward".to_owned()),
        only: Some(Quoted::whole(&sources, id)),
        ..Request::default()
    };
    let made = in_memory(&mut sources, &project::library_packages(), &manifest, &request, &|_| ());
    let made = made.map_err(|errors| render(&sources, &errors, Form::Human))?;
    let shipped = made.contents.programs.get("forward").ok_or("no program `forward` is made")?;
    for (path, language, entry) in roots(program) {
        // A bundle names a GLSL stage after the entry point of its WESL twin.
        let label =
            if path.ends_with(".vert.glsl") || entry == "vs_main" { "vs_main" } else { "fs_main" };
        let unit = shipped
            .languages
            .get(&language)
            .and_then(|entries| entries.get(label)?.units.values().next());
        let unit = unit.ok_or_else(|| format!("{path}: {label} is not made"))?;
        let stem = path.rsplit('/').next().unwrap_or_default();
        let file = |target: &str| {
            if language == Language::Wesl {
                format!("{stem}.{entry}.{target}")
            } else {
                format!("{stem}.{target}")
            }
        };
        let folder = format!("shaderlib/programs/forward/{name}");
        let text = composed(&mut sources, (path, language, entry), &settings)?;
        snapshot::check(&folder, &file("composed"), &text)?;
        for &target in Target::ALL {
            let shader = unit
                .targets
                .get(target.name())
                .ok_or_else(|| format!("{path}: {target} is not made"))?;
            snapshot::check(&folder, &file(target.name()), &readable(target, &shader.bytes)?)?;
        }
    }
    Ok(())
}

/// A root file with its language and an entry point.
type Root<'a> = (&'a str, Language, &'static str);

/// The composed text of a root file under some settings.
fn composed(
    sources: &mut SourceSet,
    (path, language, entry): Root<'_>,
    settings: &Settings,
) -> Result<String, Failed> {
    let packages = project::library_packages();
    let graph = resolve::load(sources, &packages, path, language)
        .map_err(|errors| render(sources, &errors, Form::Human))?;
    let keep = if language == Language::Wesl {
        Keep::Items(vec![entry.to_owned()])
    } else {
        Keep::EntryPoints
    };
    let composed = compose(&graph, settings, &Options { keep, ..Options::default() });
    Ok(composed.map_err(|errors| render(sources, &errors, Form::Human))?.text)
}

/// The root files of a program in both languages, with their entry points.
fn roots(program: &Program) -> Vec<Root<'_>> {
    let wesl = program.wesl.iter().flat_map(|file| [("vs_main", file), ("fs_main", file)]);
    let glsl = program.glsl.iter().flat_map(|glsl| [&glsl.vertex, &glsl.fragment]).flatten();
    let wesl = wesl.map(|(entry, file)| (file.path.as_str(), Language::Wesl, entry));
    wesl.chain(glsl.map(|file| (file.path.as_str(), Language::Glsl, "main"))).collect()
}

/// An output as text. SPIR-V is disassembled by spirv-dis.
fn readable(target: Target, bytes: &[u8]) -> Result<String, Failed> {
    if target != Target::SPIRV {
        return Ok(String::from_utf8(bytes.to_vec())?);
    }
    let file = tempfile::NamedTempFile::new()?;
    std::fs::write(file.path(), bytes)?;
    let output =
        Command::new("spirv-dis").args(["--no-color", "--no-header"]).arg(file.path()).output()?;
    if output.status.success() {
        Ok(String::from_utf8(output.stdout)?)
    } else {
        Err(String::from_utf8_lossy(&output.stderr).into_owned().into())
    }
}

/// A bundle that tests share, or why it could not be made.
type SharedContents = Result<Arc<Contents>, String>;

/// The bundle of the library's whole manifest. It is made once for all tests, and dropped with the
/// last of them, since it takes several gigabytes.
fn contents() -> Result<Arc<Contents>, Failed> {
    static MADE: Mutex<(usize, Option<SharedContents>)> = Mutex::new((0, None));
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    made.0 += 1;
    let contents = made.1.get_or_insert_with(|| on_large_stack(library).map(Arc::new)).clone();
    if made.0 == OF_CONTENTS.len() {
        made.1 = None;
    }
    Ok(contents?)
}

fn library() -> Result<Contents, String> {
    let (mut sources, manifest) = project::library_manifest()
        .map_err(|(sources, errors)| render(&sources, &errors, Form::Human))?;
    let generated = in_memory(
        &mut sources,
        &project::library_packages(),
        &manifest,
        &Request::default(),
        &|_| {},
    );
    generated
        .map(|generated| generated.contents)
        .map_err(|errors| render(&sources, &errors, Form::Human))
}

/// Every output of every permutation has the bytes that were recorded.
fn hashes() -> Result<(), Failed> {
    recorded::check(&*contents()?)
}

/// Each value of each static axis changes some output, in both languages. A value without effect in
/// one language would mean that the twins differ.
fn values_have_effect() -> Result<(), Failed> {
    let mut idle = Vec::new();
    for (name, program) in &contents()?.programs {
        for axis in program.axes.iter().filter(|axis| axis.mode == "static") {
            for value in axis.values.iter().filter(|value| **value != axis.default) {
                let setting = write_key([(axis.name.as_str(), value.as_str())]);
                for (language, entries) in &program.languages {
                    if !entries.values().any(|entry| differs_by(entry, &axis.name, value)) {
                        idle.push(format!("`{name}`: `{setting}` changes nothing in {language:?}"));
                    }
                }
            }
        }
    }
    if idle.is_empty() { Ok(()) } else { Err(idle.join("\n").into()) }
}

/// Whether some key with the value gives another output than the same key without it.
fn differs_by(entry: &EntryContents, axis: &str, value: &str) -> bool {
    let mut with_value = entry.keys.iter().filter(|(key, _)| has_value(key, axis, value));
    with_value.any(|(key, unit)| {
        entry.keys.get(&without_axis(key, axis)).is_some_and(|other| other != unit)
    })
}

/// If the output of one key changes, the message has the key and the difference. An equal bundle
/// has no differences.
fn difference_is_shown() -> Result<(), Failed> {
    let old = contents()?;
    let mut new = Contents::clone(&old);
    let blur =
        new.programs.get_mut("blur").and_then(|blur| blur.languages.get_mut(&Language::Wesl));
    let entry = blur.and_then(|entries| entries.get_mut("fs_main")).ok_or("no `blur`")?;
    let unit = entry.keys.get("direction=across").and_then(|unit| entry.units.get_mut(unit));
    let text = unit.and_then(|unit| unit.targets.get_mut("glsl330")).ok_or("no GLSL 3.30")?;
    text.bytes = String::from_utf8(text.bytes.to_vec())?
        .replace("version 330", "version 440")
        .into_bytes()
        .into();
    let same = recorded::difference(&old, &old)?;
    let difference = recorded::difference(&old, &new)?;
    let parts = [
        "blur wesl fs_main: 1 of 2 keys",
        "blur [direction=across] wesl fs_main: glsl330 differ",
        "-#version 330 core",
        "+#version 440 core",
    ];
    match same.is_empty() && parts.iter().all(|part| difference.contains(part)) {
        true => Ok(()),
        false => {
            let what = format!("expected no difference, found:\n{same}");
            Err(format!("{what}\n---\nexpected {parts:?}, found:\n{difference}").into())
        }
    }
}

/// Every eightieth output of each target is validated here, and each one with a new line. The
/// nightly tests take every seventh, and `cargo xtask gen --validate all` takes all.
const VALIDATED: usize = 80;
const VALIDATED_AT_NIGHT: usize = 7;
/// The fewest outputs of a target that must be validated.
const LEAST_VALIDATED: usize = 100;

/// The validator of each target accepts a part of its outputs, in which every line of all outputs
/// occurs, but for the numbers of generated names. Tint is not asked here, since its package comes
/// from npm; `cargo xtask gen` asks it.
fn validators_accept() -> Result<(), Failed> {
    let (folder, contents) = (tempfile::tempdir()?, contents()?);
    let mut some: Vec<validators::Output> = Vec::new();
    for target in Target::ALL {
        let before = some.len();
        for (hash, unit, artifact) in chosen_outputs(&contents, *target)? {
            let file = folder.path().join(format!("{}.{}", some.len(), artifact.extension));
            std::fs::write(&file, &artifact.bytes)?;
            let (stage, entry) = (unit.reflection.stage, artifact.native.entry_name.clone());
            some.push(validators::Output {
                target: *target,
                stage,
                entry,
                file,
                unit: hash,
                reflection: unit.reflection.clone(),
                native: artifact.native.clone(),
                description: validators::describe(&unit.reflection, &artifact.native),
            });
        }
        let found = some.len() - before;
        if found < LEAST_VALIDATED {
            let expected = format!("expected {LEAST_VALIDATED}");
            return Err(format!("{target}: {found} outputs to validate, {expected}").into());
        }
    }
    let refusals = validators::validate_outputs(&some, None, &|_, _| ())?;
    if refusals.is_empty() {
        return Ok(());
    }
    let listed: Vec<String> =
        refusals.iter().take(5).map(|refusal| format!("{refusal:?}")).collect();
    Err(format!("{} of {} refused:\n{}", refusals.len(), some.len(), listed.join("\n")).into())
}

/// Outputs of a target at even distances, and those with a line that no output before them has. SPIR-V
/// has no lines, so the lines of GLSL 4.50 choose its outputs.
fn chosen_outputs(
    contents: &Contents,
    target: Target,
) -> Result<Vec<(Hash, &Unit, &Artifact)>, Failed> {
    let with_lines = if target == Target::SPIRV { Target::GLSL450 } else { target };
    let (mut seen, mut found) = (validators::SeenText::default(), Vec::new());
    let languages = contents.programs.values().flat_map(|program| program.languages.values());
    let units = languages.flat_map(|entries| entries.values()).flat_map(|one| &one.units);
    let distance = if crate::is_whole() { VALIDATED_AT_NIGHT } else { VALIDATED };
    for (index, (hash, unit)) in units.enumerate() {
        let [text, output] = [with_lines, target].map(|one| unit.targets.get(one.name()));
        let (Some(text), Some(output)) = (text, output) else {
            return Err(format!("a unit has no output for {target}").into());
        };
        let text = std::str::from_utf8(&text.bytes)?;
        if seen.add(text).line {
            found.push((false, text, (*hash, unit, output)));
        } else if index.is_multiple_of(distance) {
            found.push((true, text, (*hash, unit, output)));
        }
    }
    // A later output often has the lines of several before it.
    let mut seen = validators::SeenText::default();
    found.reverse();
    found.retain(|(is_at_distance, text, _)| seen.add(text).line || *is_at_distance);
    Ok(found.into_iter().map(|(_, _, output)| output).collect())
}
