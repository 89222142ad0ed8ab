//! One scene in each client, from one bundle: OpenGL 3.3 and OpenGL ES 3 in C by `lamplight_gl.h`,
//! Vulkan in C by `lamplight_vk.h`, wgpu by `lamplight-wgpu`, WebGPU and WebGL 2 by
//! `@lamplight/bundle`. All 18 keys give the same pictures, but for edges. A client with a mistake
//! gives another one. What each client does for Lamplight has few lines.

mod cmake;
mod layouts;
mod rust_wgpu;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use lamplight::browser::serve::{HttpServer, ServedFiles};
use lamplight::browser::{Browser, PATIENCE};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

const LAMPLIGHT: &str = env!("CARGO_BIN_EXE_lamplight");

/// The most lines of a sample that concern Lamplight.
const MOST_LINES: usize = 20;

const KEYS: usize = 18;
const WIDTH: usize = 48;
const HEIGHT: usize = 40;
const PICTURE: usize = WIDTH * HEIGHT * 4;

/// The most that a channel may differ between clients, of 255.
const MOST_DIFFERENCE: u8 = 1;

/// The most texels of a picture that may differ by more: rasterizers decide otherwise on edges, and
/// textures are read otherwise where two texels meet.
const MOST_EDGES: usize = WIDTH * HEIGHT / 100;

pub fn tests() -> Vec<Trial> {
    let mut tests = vec![
        Trial::test("clients::draw_the_same", draw_the_same),
        Trial::test("clients::mistakes_are_seen", mistakes_are_seen),
        Trial::test("clients::depth_in_web_gl2", depth_in_web_gl2),
        cmake::test(),
        Trial::test("clients::layouts_fit_their_shaders", layouts::fit),
    ];
    tests.extend(
        ["gl.c", "vk.c", "rust_wgpu.rs", "web_gpu.mjs", "web_gl2.mjs"].map(|name| {
            Trial::test(format!("clients::few_lines::{name}"), move || few_lines(name))
        }),
    );
    tests
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn run(command: &mut Command) -> Outcome {
    let output = command.output()?;
    match output.status.success() {
        true => Ok(()),
        false => Err(format!("{command:?}: {}", String::from_utf8_lossy(&output.stderr)).into()),
    }
}

/// A copy of the sources, with the bundle and its bindings.
fn prepared() -> Result<tempfile::TempDir, Failed> {
    let folder = tempfile::tempdir()?;
    for file in std::fs::read_dir(root().join("tests/clients"))? {
        let file = file?;
        std::fs::copy(file.path(), folder.path().join(file.file_name()))?;
    }
    for file in std::fs::read_dir(root().join("include"))? {
        let file = file?;
        std::fs::copy(file.path(), folder.path().join(file.file_name()))?;
    }
    let lamplight = |arguments: &[&str]| {
        run(Command::new(LAMPLIGHT).current_dir(folder.path()).args(arguments))
    };
    lamplight(&["gen", "--no-cache", "-o", "lit.lamplight"])?;
    lamplight(&["bindings", "lit.lamplight", "--lang", "c", "-o", "lit.h"])?;
    Ok(folder)
}

/// A client in C: its source, definitions and libraries.
struct Client {
    name: &'static str,
    arguments: &'static [&'static str],
}

const GL33: Client = Client { name: "gl33", arguments: &["gl.c", "-lEGL", "-lOpenGL"] };
const GLES: Client = Client { name: "gles", arguments: &["gl.c", "-DES", "-lEGL", "-lGLESv2"] };
/// With the headers of the package `libvulkan-dev`.
const VULKAN: Client = Client { name: "vulkan", arguments: &["vk.c", "-lvulkan"] };

/// Lavapipe, where Vulkan has several drivers.
const LAVAPIPE: &str = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json";

/// What a client in C draws, from a number of picture on.
fn drawn_in_c(folder: &Path, client: &Client, first: usize) -> Result<Vec<u8>, Failed> {
    let mut command = Command::new("cc");
    command.current_dir(folder).args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]);
    run(command.args(["-I.", "-o", client.name]).args(client.arguments))?;
    let mut command = Command::new(folder.join(client.name));
    command.env("VK_ICD_FILENAMES", LAVAPIPE);
    run(command.current_dir(folder).args(["lit.lamplight", "out.bin", &first.to_string()]))?;
    Ok(std::fs::read(folder.join("out.bin"))?)
}

/// The files of the clients in a browser.
const SERVED: [&str; 4] = ["scene.mjs", "web_gpu.mjs", "web_gl2.mjs", "lit.lamplight"];

/// What a client in a browser draws.
fn drawn_by_web(folder: &Path, module: &str, served: &[&str]) -> Result<Vec<u8>, Failed> {
    let mut files = BTreeMap::from([(
        "index.html".to_owned(),
        b"<!doctype html><title>t</title><link rel=icon href=data:,>".to_vec(),
    )]);
    let mut add = |path: PathBuf, name: String| -> Outcome {
        files.insert(name, std::fs::read(path)?);
        Ok(())
    };
    for name in served {
        add(folder.join(name), (*name).to_owned())?;
    }
    for file in std::fs::read_dir(root().join("packages/bundle/src"))? {
        let file = file?;
        add(file.path(), format!("bundle/{}", file.file_name().to_string_lossy()))?;
    }
    let server = HttpServer::start(ServedFiles::Memory(files))?;
    let page = Browser::shared()?.open(&server.address(""))?;
    page.loaded(PATIENCE)?;
    let script = format!("import('./{module}').then(({{ pictures }}) => pictures())");
    let drawn = page.evaluate(&script, PATIENCE * 3)?;
    let pictures: Vec<Vec<u8>> = serde_json::from_value(drawn)?;
    Ok(pictures.concat())
}

/// How many texels of a picture differ by more than clients may.
fn differing(one: &[u8], other: &[u8]) -> usize {
    let texels = one.as_chunks::<4>().0.iter().zip(other.as_chunks::<4>().0);
    let differs = |(one, other): &(&[u8; 4], &[u8; 4])| {
        one.iter().zip(*other).any(|(one, other)| one.abs_diff(*other) > MOST_DIFFERENCE)
    };
    texels.filter(differs).count()
}

fn draw_the_same() -> Outcome {
    let folder = prepared()?;
    let wanted = drawn_in_c(folder.path(), &GL33, 0)?;
    let pictures: Vec<&[u8]> = wanted.chunks(PICTURE).collect();
    if pictures.len() != KEYS {
        return Err(format!("{} pictures, not {KEYS}", pictures.len()).into());
    }
    for (number, one) in pictures.iter().enumerate() {
        if pictures[..number].iter().any(|other| differing(one, other) <= MOST_EDGES) {
            return Err(format!("picture {number} is one of those before it").into());
        }
    }
    let others = [
        ("OpenGL ES 3", drawn_in_c(folder.path(), &GLES, 0)?),
        ("Vulkan", drawn_in_c(folder.path(), &VULKAN, 0)?),
        ("wgpu", rust_wgpu::pictures(std::fs::read(folder.path().join("lit.lamplight"))?)?),
        ("WebGL 2", drawn_by_web(folder.path(), "web_gl2.mjs", &SERVED)?),
        ("WebGPU", drawn_by_web(folder.path(), "web_gpu.mjs", &SERVED)?),
    ];
    for (client, drawn) in &others {
        let counts: Vec<usize> = wanted
            .chunks(PICTURE)
            .zip(drawn.chunks(PICTURE))
            .map(|(one, other)| differing(one, other))
            .collect();
        println!("{client}: {counts:?} texels differ");
        if drawn.len() != wanted.len() || counts.iter().any(|count| *count > MOST_EDGES) {
            return Err(format!("{client} draws otherwise: {counts:?} texels differ").into());
        }
    }
    Ok(())
}

/// The library's `depth` draws a map in WebGL 2, which links no program without a fragment stage: with
/// its own, and with the one that the adapter adds. A rectangle at the depth 0.5 fills the left half.
fn depth_in_web_gl2() -> Outcome {
    let folder = tempfile::tempdir()?;
    std::fs::copy(root().join("tests/clients/depth.mjs"), folder.path().join("depth.mjs"))?;
    run(Command::new(LAMPLIGHT)
        .current_dir(folder.path())
        .args(["gen", "--no-cache", "--program", "depth", "--target", "essl300"])
        .args(["-o", "depth.lamplight", "--manifest"])
        .arg(root().join("shaderlib/lamplight.toml")))?;
    let drawn = drawn_by_web(folder.path(), "depth.mjs", &["depth.mjs", "depth.lamplight"])?;
    let half = |index: usize| if index % 8 < 4 { 127..=128 } else { 255..=255 };
    let is_right = drawn.iter().enumerate().all(|(index, depth)| half(index).contains(depth));
    if drawn.len() == 2 * 64 && is_right {
        return Ok(());
    }
    Err(format!("{} depths: {drawn:?}", drawn.len()).into())
}

/// Each mistake changes the last picture, which has everything in it.
fn mistakes_are_seen() -> Outcome {
    const MISTAKES: [(&str, &str, &str, &str); 4] = [
        // The name of the macro of a constant that no shader has.
        ("a forgotten constant", "lamplight_gl.h", "\"#define %s %s", "\"#define _%s %s"),
        (
            "a flipped axis",
            "gl.c",
            "top_first ? y : HEIGHT - 1 - y",
            "top_first ? HEIGHT - 1 - y : y",
        ),
        (
            "a wrong stride",
            "scene.h",
            "memcpy(lamps.all[i].position",
            "memcpy((char *)&lamps + 28 * i",
        ),
        (
            "a transposed matrix",
            "scene.h",
            "normal_from_object[1][2] = -0.4f",
            "normal_from_object[2][1] = -0.4f",
        ),
    ];
    let folder = prepared()?;
    let right = drawn_in_c(folder.path(), &GL33, KEYS - 1)?;
    for (what, file, before, after) in MISTAKES {
        let place = folder.path().join(file);
        let text = std::fs::read_to_string(&place)?;
        let wrong = text.replace(before, after);
        if wrong == text {
            return Err(format!("{what}: there is no `{before}`").into());
        }
        std::fs::write(&place, wrong)?;
        let drawn = drawn_in_c(folder.path(), &GL33, KEYS - 1)?;
        std::fs::write(&place, text)?;
        let count = differing(&right, &drawn);
        println!("{what}: {count} texels differ");
        if count <= MOST_EDGES {
            return Err(format!("{what} is not seen: {count} texels differ").into());
        }
    }
    Ok(())
}

/// Counts the lines with the mark, and those between a mark and its end.
pub fn few_lines(name: &str) -> Outcome {
    let folder = root().join("tests/clients");
    let mut text = std::fs::read_to_string(folder.join(name))?;
    if name.ends_with(".c") {
        text += &std::fs::read_to_string(folder.join("scene.h"))?;
    }
    let (mut count, mut is_inside) = (0, false);
    for line in text.lines().map(str::trim) {
        match line.trim_start_matches(['/', '*', ' ']).trim_end_matches([' ', '*', '/']) {
            "lamplight" => is_inside = true,
            "lamplight end" => is_inside = false,
            "" => {}
            _ if is_inside || line.contains("/* lamplight */") || line.contains("// lamplight") => {
                count += 1;
            }
            _ => {}
        }
    }
    println!("{name}: {count} lines");
    match count {
        1..=MOST_LINES if !is_inside => Ok(()),
        _ => Err(format!("{count} lines, not 1 to {MOST_LINES}").into()),
    }
}
