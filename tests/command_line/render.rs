//! `lamplight render FILE`: what is printed about a picture, what `--watch` does, and wrong usage.

use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use libtest_mimic::Failed;

use super::package::{Package, equal};
use super::{Case, Outcome};

pub const CASES: &[Case] = &[
    ("picture_of_a_file", picture),
    ("picture_in_a_terminal", in_terminal),
    ("picture_that_follows_its_files", watched),
    ("picture_of_endless_loops", endless),
    ("picture_with_wrong_options", wrong_options),
];

const SHADER: &str = "import package::part::tone;
@group(0) @binding(0) var<uniform> tint: vec3f;
@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(tone() * tint, 1.0);
}
";
const RED: &str = "fn tone() -> vec3f { return vec3f(1.0, 0.0, 0.0); }\n";
const DRAW: &str = "render own.wesl --executor eval --size 4x4";

fn package() -> Result<Package, Failed> {
    Package::new(&[("own.wesl", SHADER), ("part.wesl", RED)])
}

/// The colour of the upper left pixel of a picture.
fn corner(path: &Path) -> Result<[u8; 3], Failed> {
    let picture = lamplight::picture::Picture::from_png(&fs::read(path)?)?;
    Ok(picture.pixel([0, 0]))
}

/// The table is on standard error, and what was drawn on standard output. Options take precedence over
/// the file beside the shader.
fn picture() -> Outcome {
    let package = package()?;
    let run = package.run(&format!("{DRAW} --uniform tint=1,1,1"))?.ends(0)?;
    equal(run.err.contains("uniform  tint  vec3f  1, 1, 1  option"), true)?;
    equal(run.out.starts_with("own.png: 4 x 4 of own.wesl over the whole picture"), true)?;
    run.says(&["note: every pixel has the colour #ff0000"])?;
    equal(corner(&package.path("own.png"))?, [255, 0, 0])?;
    package.write("own.uniforms.toml", "[uniforms]\ntint = [0.0, 1.0, 1.0]\n")?;
    let run = package.run(DRAW)?.ends(0)?;
    run.says(&["0, 1, 1  file", "note: every pixel is black"])?;
    let run = package.run(&format!("{DRAW} --uniform tint=#ff0000 --json"))?.ends(0)?;
    let answer: serde_json::Value = serde_json::from_str(&run.out)?;
    equal(answer["inputs"][0]["from"].as_str(), Some("option"))?;
    equal(answer["picture"].as_str(), Some("own.png"))?;
    package.write("own.uniforms.toml", "[uniforms]\ntimt = 1\n")?;
    let run = package.run(DRAW)?.ends(1)?;
    run.says(&[
        "no stage reads a uniform `timt`",
        "own.uniforms.toml:2:8",
        "did you mean `tint`?",
    ])?;
    Ok(())
}

/// Loops without an end are ended in both stages.
fn endless() -> Outcome {
    const TEXT: &str = "@group(0) @binding(0) var<uniform> most: u32;
@vertex fn vs_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    var corners = array<vec2f, 3>(vec2f(-1.0, -1.0), vec2f(3.0, -1.0), vec2f(-1.0, 3.0));
    loop { if most > 0u { break; } }
    return vec4f(corners[index], 0.5, 1.0);
}
@fragment fn fs_main() -> @location(0) vec4f {
    loop { if most > 0u { break; } }
    return vec4f(0.0, 1.0, 0.0, 1.0);
}
";
    let package = Package::new(&[("own.wesl", TEXT)])?;
    package.run("render own.wesl --executor eval --size 1x1")?.ends(0)?;
    equal(corner(&package.path("own.png"))?, [0, 255, 0])
}

/// Nothing is written where the terminal shows the picture, unless a file is named.
fn in_terminal() -> Outcome {
    let package = package()?;
    let shown = format!("{DRAW} --uniform tint=1,1,1 --terminal=blocks");
    let run = package.run(&shown)?.ends(0)?;
    equal(run.out.matches("\x1b[38;2;255;0;0m\x1b[48;2;255;0;0m\u{2580}").count(), 8)?;
    equal(package.path("own.png").exists(), false)?;
    package.run(&format!("{shown} -o shown.png"))?.ends(0)?;
    equal(corner(&package.path("shown.png"))?, [255, 0, 0])
}

/// Ends the command, whatever happens.
struct Watching(Child);

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn waits_for(what: &str, mut holds: impl FnMut() -> bool) -> Outcome {
    let start = Instant::now();
    while !holds() {
        if start.elapsed() > Duration::from_secs(60) {
            return Err(format!("{what} did not come").into());
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    Ok(())
}

/// A change of an imported module is drawn; a mistake is printed, and the last picture stays.
fn watched() -> Outcome {
    let package = package()?;
    let errors = package.path("errors.txt");
    let mut command = package.command("", &format!("{DRAW} --watch --uniform tint=1,1,1"));
    command.stdout(Stdio::null()).stderr(fs::File::create(&errors)?);
    let _watching = Watching(command.spawn()?);
    let path = package.path("own.png");
    let shows = |color| corner(&path).is_ok_and(|found| found == color);
    waits_for("the first picture", || shows([255, 0, 0]))?;
    package.write("part.wesl", &RED.replace("vec3f(1.0, 0.0, 0.0)", "oops"))?;
    let printed = || fs::read_to_string(&errors).unwrap_or_default();
    waits_for("the error", || printed().contains("part.wesl:1:29"))?;
    equal(shows([255, 0, 0]), true)?;
    package.write("part.wesl", &RED.replace("1.0, 0.0", "0.0, 1.0"))?;
    waits_for("the second picture", || shows([0, 255, 0]))
}

fn wrong_options() -> Outcome {
    let package = package()?;
    package.write(
        "toy.glsl",
        "void mainImage(out vec4 c, in vec2 at) { c = vec4(at, 0.0, 1.0); }\n",
    )?;
    for (arguments, code, expected) in [
        ("render none.wesl", 1, "there is no file or folder `none.wesl`"),
        ("render toy.glsl --executor eval", 1, "`--wrap shadertoy` makes a shader of `mainImage`"),
        ("render own.wesl --scene casters", 2, "`--model NAME` takes scenes too"),
        ("render own.wesl --program forward", 2, "`--program` is for presets"),
        ("render hpg_4_spot --time 2", 2, "`--time` is for a shader of your own"),
        ("render hpg_4_spot --camera 0,0,1,0,0,0", 2, "`--camera` needs `--model`"),
        ("render model.glb --executor eval", 1, "there is no preset `model.glb`"),
        ("render own.wesl --executor eval --model shpere", 1, "did you mean `sphere`?"),
        ("render own.wesl --executor eval --texture t=nose", 1, "did you mean `noise`?"),
        ("render own.wesl --executor eval --texture t=noise", 1, "no stage reads a texture `t`"),
        (
            "render own.wesl --executor eval --uniform tint=1,2",
            1,
            "takes 3 numbers, and 2 are given",
        ),
        ("render own.wesl --uniform tint=red", 2, "`red` is no number"),
        ("render own.wesl --terminal=vt100", 2, "expected one of: kitty, iterm, sixel, blocks"),
        ("render own.wesl --executor eval --entry vs_main", 1, "there is no entry point `vs_main`"),
    ] {
        package.run(arguments)?.ends(code)?.says(&[expected])?;
    }
    Ok(())
}
