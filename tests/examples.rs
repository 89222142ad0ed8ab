//! Runs the examples and checks their results.

#[path = "../examples/hot_reload.rs"]
#[expect(dead_code, reason = "`main` is run by the example alone")]
mod hot_reload;
#[path = "../examples/load_bundle.rs"]
#[expect(dead_code, reason = "`main` is run by the example alone")]
mod load_bundle;
#[path = "../examples/wesl_crate/main.rs"]
#[expect(dead_code, reason = "`main` is run by the example alone")]
mod wesl_crate;

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};

use lamplight::bundle::{self, Target};
use lamplight::generate::{Request, in_memory};
use lamplight::permute::Quoted;
use lamplight::project;
use libtest_mimic::{Failed, Trial};

use crate::guide;
use crate::snapshot::root;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("examples::load_bundle", loads_a_bundle),
        Trial::test("examples::hot_reload", swaps_while_it_draws),
        Trial::test("examples::plain_glsl", plain_glsl_compiles),
        Trial::test("examples::readme_glsl", readme_glsl_compiles),
        Trial::test("examples::wesl_crate", wesl_crate_links),
        Trial::test("examples::build_script", build_script_compiles),
    ]
}

/// The example that loads a bundle draws an orange pixel.
fn loads_a_bundle() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("shaders.lamplight");
    let (mut sources, manifest) =
        project::library_manifest().map_err(|(_, problems)| format!("{problems:?}"))?;
    let id = sources.add("key", "ambient=none,lights=none");
    let request = Request {
        program: Some("forward".into()),
        only: Some(Quoted::whole(&sources, id)),
        targets: vec![Target::WGSL],
        ..Request::default()
    };
    let made = in_memory(&mut sources, &project::library_packages(), &manifest, &request, &|_| {})
        .map_err(|problems| format!("{problems:?}"))?;
    bundle::write_file(&made.contents, &path)?;
    let path = path.to_string_lossy().into_owned();
    // Mesa keeps state for each thread. It must be dropped before the process ends.
    let pixel = lamplight::execute::on_thread(|| {
        load_bundle::draw(&path).map_err(|error| error.to_string())
    })
    .ok_or("the example panicked")??;
    if pixel == [255, 128, 0, 255] || pixel == [255, 127, 0, 255] {
        Ok(())
    } else {
        Err(format!("the pixel is {pixel:?}, not orange").into())
    }
}

/// While `watch` follows an edit of the shader, the example of hot reload prints what the guide's
/// page says that it prints.
fn swaps_while_it_draws() -> Result<(), Failed> {
    let page = std::fs::read_to_string(root().join("docs/guide/hot-reload.md"))?;
    let folder = tempfile::tempdir()?;
    for name in ["lamplight.toml", "surface.wesl"] {
        std::fs::write(folder.path().join(name), guide::shown_file(&page, name)?)?;
    }
    let shader = folder.path().join("surface.wesl");
    let mut watch = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(["watch", "--no-cache", "--out", "live.lamplight"])
        .current_dir(folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()?;
    let bundle = folder.path().join("live.lamplight");
    let started = guide::waits_for(|| bundle.is_file());
    let mut lines = Vec::new();
    // The shader is edited after the first frame, so that the shader is replaced while frames are
    // drawn.
    let drawn = lamplight::execute::on_thread(|| {
        let mut report = |line: String| {
            if lines.is_empty() {
                let text = std::fs::read_to_string(&shader).unwrap_or_default();
                let _ = std::fs::write(&shader, text.replace("0.5", "0.25"));
            }
            lines.push(line);
        };
        hot_reload::draw(&bundle, 1, &mut report).map_err(|error| error.to_string())
    });
    watch.kill()?;
    watch.wait()?;
    if !started {
        return Err("`watch` wrote nothing".into());
    }
    drawn.ok_or("the example panicked")??;
    guide::shows_output(&page, "--example hot_reload", &lines)
}

/// The GLSL example of README compiles with glslc alone, from exported files.
fn readme_glsl_compiles() -> Result<(), Failed> {
    let readme = std::fs::read_to_string(root().join("README.md"))?;
    let folder = tempfile::tempdir()?;
    run(Command::new(env!("CARGO_BIN_EXE_lamplight")).arg("export").arg(folder.path()))?;
    let shader = folder.path().join("lamp.frag");
    std::fs::write(&shader, guide::shown_file(&readme, "lamp.frag")?)?;
    let include = format!("-I{}", folder.path().display());
    run(Command::new("glslc").args(["-o", "/dev/null", &include]).arg(shader)).map(drop)
}

/// The example in plain GLSL compiles with glslangValidator alone, from exported files.
fn plain_glsl_compiles() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    run(Command::new(env!("CARGO_BIN_EXE_lamplight")).arg("export").arg(folder.path()))?;
    let include = format!("-I{}", folder.path().display());
    let shader = root().join("examples/plain_glsl/spot.frag");
    run(Command::new("glslangValidator").args(["-V", "-o", "/dev/null", &include]).arg(shader))
        .map(drop)
}

/// The `wesl` crate links a shader that imports the library, as the example shows.
fn wesl_crate_links() -> Result<(), Failed> {
    let linked = wesl_crate::link().map_err(|error| error.to_string())?;
    let module =
        naga::front::wgsl::parse_str(&linked).map_err(|error| error.emit_to_string(&linked))?;
    if module.entry_points.len() == 1 {
        Ok(())
    } else {
        let count = module.entry_points.len();
        Err(format!("expected one entry point, found {count}:\n{linked}").into())
    }
}

/// The build script compiles all permutations, and the example's program finds each of them.
fn build_script_compiles() -> Result<(), Failed> {
    let printed = cargo(
        &root(),
        &["run", "--quiet", "--frozen", "--package", "lamplight-build-script-example"],
    )?;
    let keys: Vec<&str> =
        printed.lines().filter_map(|line| Some(line.split_once(": ")?.0)).collect();
    let expected = ["cone=exponent", "cone=exponent,specular", "default", "specular"];
    match keys == expected {
        true => Ok(()),
        false => Err(format!("the program found {keys:?}, expected {expected:?}").into()),
    }
}

/// Runs cargo, as a user of the examples does.
pub fn cargo(folder: &Path, arguments: &[&str]) -> Result<String, Failed> {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    // What is built here is rarely built again.
    run(Command::new(program).env("CARGO_INCREMENTAL", "0").current_dir(folder).args(arguments))
}

/// Runs a command. Gives its standard output, or fails with all of its output.
pub fn run(command: &mut Command) -> Result<String, Failed> {
    let output = command
        .output()
        .map_err(|error| format!("{command:?} does not start ({error}): see `cargo xtask test`"))?;
    if output.status.success() {
        return Ok(String::from_utf8(output.stdout)?);
    }
    let words = [output.stdout, output.stderr].concat();
    Err(String::from_utf8_lossy(&words).into_owned().into())
}
