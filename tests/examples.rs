//! Runs the examples and checks their results.

#[path = "../examples/hot_reload.rs"]
#[expect(dead_code, reason = "`main` is run by the example alone")]
mod hot_reload;
#[path = "../examples/load_bundle.rs"]
#[expect(dead_code, reason = "`main` is run by the example alone")]
mod load_bundle;
#[path = "../examples/shadow_pass.rs"]
#[expect(dead_code, reason = "`main` is run by the example alone")]
mod shadow_pass;
#[path = "../examples/wesl_crate/main.rs"]
#[expect(dead_code, reason = "`main` is run by the example alone")]
mod wesl_crate;

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};

use glam::DVec3;
use lamplight::bundle::{self, Contents, Target};
use lamplight::generate::{Request, in_memory};
use lamplight::permute::Quoted;
use lamplight::project;
use libtest_mimic::{Failed, Trial};

use crate::guide;
use crate::snapshot::root;

pub fn tests() -> Vec<Trial> {
    let tests = [
        Trial::test("examples::load_bundle", loads_a_bundle),
        Trial::test("examples::hot_reload", swaps_while_it_draws),
        Trial::test("examples::shadow_pass", shadow_falls_where_rays_say),
        Trial::test("examples::plain_glsl", plain_glsl_compiles),
        Trial::test("examples::readme_glsl", readme_glsl_compiles),
        Trial::test("examples::wesl_crate", wesl_crate_links),
    ];
    // It compiles the library once more, with other features, which takes minutes.
    let at_night = [Trial::test("examples::build_script", build_script_compiles)];
    tests.into_iter().chain(at_night.into_iter().filter(|_| crate::is_whole())).collect()
}

/// The example that loads a bundle draws an orange pixel.
fn loads_a_bundle() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("shaders.lamplight");
    bundle::write_file(&permutation("forward", "ambient=none,lights=none")?, &path)?;
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

/// One permutation of a program of the library, in WGSL.
fn permutation(program: &str, key: &str) -> Result<Contents, Failed> {
    let (mut sources, manifest) =
        project::library_manifest().map_err(|(_, problems)| format!("{problems:?}"))?;
    let id = sources.add("key", key);
    let request = Request {
        program: Some(program.into()),
        only: Some(Quoted::whole(&sources, id)),
        targets: vec![Target::WGSL],
        ..Request::default()
    };
    let made = in_memory(&mut sources, &project::library_packages(), &manifest, &request, &|_| {})
        .map_err(|problems| format!("{problems:?}"))?;
    Ok(made.contents)
}

/// The example draws the shadow of the box where rays to the lamp meet the box, and nowhere else.
fn shadow_falls_where_rays_say() -> Result<(), Failed> {
    let opened = |program, key| {
        let bytes = bundle::pack(&permutation(program, key)?)?;
        Ok::<_, Failed>(bundle::Bundle::from_bytes(bytes)?)
    };
    let (depth, forward) = (opened("depth", "default")?, opened("forward", shadow_pass::KEY)?);
    let pixels = lamplight::execute::on_thread(|| {
        shadow_pass::draw(&depth, &forward).map_err(|error| error.to_string())
    })
    .ok_or("the example panicked")??;
    let [width, height] = shadow_pass::SIZE;
    let (mut lit, mut dark, mut wrong) = (0, 0, Vec::new());
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let Some(is_lit) = lit_by_rays(x, y) else { continue };
        let green = pixels[(4 * (y * width + x) + 1) as usize];
        // In shadow there is a tenth of ambient light: 0.075, which is 78 as sRGB.
        if (green > 120) != is_lit {
            wrong.push((x, y, green));
        }
        lit += usize::from(is_lit);
        dark += usize::from(!is_lit);
    }
    println!("{lit} pixels of the floor are lit, {dark} are in shadow, {} are wrong", wrong.len());
    if wrong.is_empty() && lit > 4000 && dark > 400 {
        Ok(())
    } else {
        Err(format!("{lit} lit, {dark} in shadow, wrong: {wrong:?}").into())
    }
}

/// Whether the lamp shines onto the floor that a pixel shows: `None` for what shows no floor, is near
/// the rim of the cone, or near the edge of the shadow, where the filter is.
fn lit_by_rays(x: u32, y: u32) -> Option<bool> {
    let [width, height] = shadow_pass::SIZE.map(f64::from);
    let ndc = [2.0 * (f64::from(x) + 0.5) / width - 1.0, 1.0 - 2.0 * (f64::from(y) + 0.5) / height];
    let back = shadow_pass::clip_from_world().inverse();
    let at = |depth: f64| back.project_point3(DVec3::new(ndc[0], ndc[1], depth));
    let (near, far) = (at(0.0), at(1.0));
    let floor = near.lerp(far, near.y / (near.y - far.y));
    let axis = -shadow_pass::LAMP.normalize();
    let in_cone = axis.dot((floor - shadow_pass::LAMP).normalize()) > 28.0_f64.to_radians().cos();
    if !in_cone || meets_box(near, floor, 0.05) {
        return None;
    }
    let hidden = |margin| meets_box(floor, shadow_pass::LAMP, margin);
    (hidden(0.08) == hidden(-0.08)).then(|| !hidden(0.0))
}

/// Whether the way between two points meets the box, which is larger by a margin.
fn meets_box(from: DVec3, to: DVec3, margin: f64) -> bool {
    let [low, high] = shadow_pass::BOX;
    let way = to - from;
    let (one, other) = ((low - margin - from) / way, (high + margin - from) / way);
    one.min(other).max_element().max(0.0) < one.max(other).min_element().min(1.0)
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
