//! The examples do what they say.

#[path = "../examples/build_script/build.rs"]
#[allow(dead_code)]
mod build_script;
#[path = "../examples/load_bundle.rs"]
#[allow(dead_code)]
mod load_bundle;

use std::process::Command;

use lamplight::bundle::{self, Bundle, Target};
use lamplight::generate::{Request, in_memory};
use lamplight::permute::Quoted;
use lamplight::project;
use libtest_mimic::{Failed, Trial};

use crate::snapshot::root;

pub fn trials() -> Vec<Trial> {
    vec![
        Trial::test("examples::load_bundle", loads_a_bundle),
        Trial::test("examples::plain_glsl", plain_glsl_compiles),
        Trial::test("examples::build_script", build_script_compiles),
    ]
}

fn loads_a_bundle() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("shaders.lamplight");
    let (mut sources, manifest) = project::library_manifest().map_err(|(_, problems)| format!("{problems:?}"))?;
    let id = sources.add("key", "ambient=none,lights=none");
    let request = Request {
        program: Some("forward".into()),
        only: Some(Quoted::whole(&sources, id)),
        targets: vec![Target::WGSL],
        ..Request::default()
    };
    let made = in_memory(&mut sources, &project::library(), &manifest, &request, &|_| {}).map_err(|problems| format!("{problems:?}"))?;
    bundle::write_file(&made.contents, &path)?;
    let path = path.to_string_lossy().into_owned();
    // Mesa's thread-local state must be gone before the process ends.
    let pixel =
        lamplight::harness::on_thread(|| load_bundle::draw(&path).map_err(|error| error.to_string())).ok_or("the example panicked")??;
    if pixel == [255, 128, 0, 255] || pixel == [255, 127, 0, 255] {
        Ok(())
    } else {
        Err(format!("the pixel is {pixel:?}, not orange").into())
    }
}

fn plain_glsl_compiles() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    run(Command::new(env!("CARGO_BIN_EXE_lamplight")).arg("export").arg(folder.path()))?;
    let include = format!("-I{}", folder.path().display());
    let shader = root().join("examples/plain_glsl/spot.frag");
    run(Command::new("glslangValidator").args(["-V", "-o", "/dev/null", &include]).arg(shader))
}

fn run(command: &mut Command) -> Result<(), Failed> {
    let output = command.output()?;
    let words = [output.stdout, output.stderr].concat();
    if output.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&words).into_owned().into()) }
}

fn build_script_compiles() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("shaders.lamplight");
    build_script::compile(&root().join("examples/build_script/shaders"), &path).map_err(|error| error.to_string())?;
    let bundle = Bundle::open(&path)?;
    let lamp = bundle.program("lamp")?.shader("fs_main")?;
    for key in ["default", "specular", "cone=exponent,specular"] {
        lamp.get(key, Target::SPIRV)?;
    }
    Ok(())
}
