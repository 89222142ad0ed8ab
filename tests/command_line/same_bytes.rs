//! `compile` gives exactly the bytes that `gen` ships for the same settings. Otherwise, what a user
//! looks at with `compile` would not be what the engine loads.

use std::path::Path;
use std::process::Command;

use lamplight::bundle::{Bundle, Language, Target, pack};
use lamplight::diagnostic::render::{Form, render};
use lamplight::emit::targets;
use lamplight::generate::{Request, in_memory};
use lamplight::permute::Quoted;
use lamplight::project;
use lamplight::source::SourceSet;
use libtest_mimic::Failed;

use super::{Case, Outcome};
use crate::snapshot;

pub const CASES: &[Case] = &[("compile_is_gen", compile_is_gen)];

/// The programs of the library, and permutations that are compared.
const PERMUTATIONS: &[(&str, &str)] = &[
    ("forward", "default"),
    ("forward", "frequency=vertex,lights=point,max_lights=1"),
    ("forward", "lights=spot,max_lights=4,shadow=pcf_3x3,shadow_light=spot,specular=ggx"),
    ("forward", "ambient=sh9,two_sided"),
    ("depth", "default"),
    ("depth_view", "default"),
    ("blur", "default"),
    ("moments", "default"),
];

/// The name of a stage, and the end of a GLSL root file's name for it.
const STAGES: &[(&str, &str)] = &[("vert", ".vert.glsl"), ("frag", ".frag.glsl")];

fn compile_is_gen() -> Outcome {
    let (mut outputs, mut glsl) = (0, 0);
    for (program, key) in PERMUTATIONS {
        let bundle = generated(program, key)?;
        let found = compare(&bundle, program, key)?;
        outputs += found.0;
        glsl += found.1;
    }
    if outputs < 100 || glsl < 40 {
        let what = format!("compared {outputs} outputs, {glsl} of them from GLSL");
        return Err(format!("{what}: expected at least 100 and 40").into());
    }
    Ok(())
}

fn generated(program: &str, key: &str) -> Result<Bundle, Failed> {
    let mut sources = SourceSet::default();
    let manifest = snapshot::root().join("shaderlib/lamplight.toml");
    let made = project::declared(&manifest, &mut sources).and_then(|(manifest, packages)| {
        let id = sources.add("key", key);
        let request = Request {
            program: Some(program.to_owned()),
            only: Some(Quoted::whole(&sources, id)),
            targets: Target::ALL.to_vec(),
            ..Request::default()
        };
        in_memory(&mut sources, &packages, &manifest, &request, &|_| ())
    });
    let made = made.map_err(|errors| render(&sources, &errors, Form::Human))?;
    Ok(Bundle::from_bytes(pack(&made.contents)?)?)
}

/// Compiles the files of a program and compares every output with the bundle's. Gives the number of
/// outputs, and the number of those from GLSL.
fn compare(bundle: &Bundle, program: &str, key: &str) -> Result<(usize, usize), Failed> {
    let folder = tempfile::tempdir()?;
    let known = bundle.program(program)?;
    let (mut count, mut glsl) = (0, 0);
    for (language, entry) in known.entries() {
        let shader = known.entry(language, entry)?;
        let stage = shader.get(key, Target::WGSL)?.reflection.stage.suffix();
        let (file, name) = root(program, language, entry, stage)?;
        compile(&file, key, &name, folder.path())?;
        for target in Target::ALL {
            let found = output(folder.path(), &file, &name, stage, *target)?;
            if found != shader.get(key, *target)?.bytes {
                let what = format!("{program} {entry} {language:?} {target} `{key}`");
                return Err(format!("{what}: `compile` and `gen` differ").into());
            }
            count += 1;
            glsl += usize::from(language == Language::Glsl);
        }
    }
    Ok((count, glsl))
}

/// The root file of an entry point and the entry point's name in it.
fn root(
    program: &str,
    language: Language,
    entry: &str,
    stage: &str,
) -> Result<(String, String), Failed> {
    let (sources, manifest) = project::library_manifest()
        .map_err(|(sources, errors)| render(&sources, &errors, Form::Human))?;
    drop(sources);
    let program = manifest.program(program).ok_or("no such program")?;
    let ending = STAGES.iter().find(|(name, _)| *name == stage).ok_or("no such stage")?.1;
    let wanted = |path: &&str| match language {
        Language::Wesl => path.ends_with(".wesl"),
        Language::Glsl => path.ends_with(ending),
    };
    let path = program.files().map(|file| file.path.as_str()).find(wanted).ok_or("no file")?;
    let name = if language == Language::Wesl { entry } else { "main" };
    Ok((path.to_owned(), name.to_owned()))
}

fn compile(file: &str, key: &str, entry: &str, out: &Path) -> Outcome {
    let settings: Vec<String> = key
        .split(',')
        .filter(|part| *part != "default")
        .map(|part| if part.contains('=') { part.to_owned() } else { format!("{part}=true") })
        .collect();
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    command.current_dir(snapshot::root().join("shaderlib")).arg("compile").arg(file);
    if !settings.is_empty() {
        command.args(["--set", &settings.join(",")]);
    }
    command.args(["--target", "all", "--entry", entry, "-o"]).arg(out);
    let output = command.output()?;
    if output.status.success() {
        return Ok(());
    }
    Err(String::from_utf8_lossy(&output.stderr).into_owned().into())
}

/// The bytes of the file that `compile` wrote for a target.
fn output(
    folder: &Path,
    file: &str,
    entry: &str,
    stage: &str,
    target: Target,
) -> Result<Vec<u8>, Failed> {
    let stem = Path::new(file).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let stem = stem.split('.').next().unwrap_or_default();
    let known = targets::find(target).ok_or("the target has no file")?;
    let ending = match known.glsl {
        Some(_) => format!("{target}.{stage}"),
        None => format!("{stage}.{}", known.extension),
    };
    let path = folder.join(format!("{stem}.{entry}.{ending}"));
    std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()).into())
}
