//! Heat maps: numbers of each pixel that are computed by hand, of texts in both languages and of a
//! preset, and their pictures.

use std::path::Path;
use std::process::Command;

use lamplight::bundle::{Language, SourceClip};
use lamplight::compose::{self, Options};
use lamplight::diagnostic::Diagnostics;
use lamplight::execute::on_thread;
use lamplight::execute::raster::Measure;
use lamplight::permute::Settings;
use lamplight::picture::own::{OwnRequest, OwnText, choose_stages, prepare_own};
use lamplight::picture::{HeatMap, Shot, Surroundings};
use lamplight::resolve::{self, Packages};
use lamplight::source::SourceSet;
use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

type Outcome = Result<(), Failed>;

const LAMPLIGHT: &str = env!("CARGO_BIN_EXE_lamplight");

pub fn tests() -> Vec<Trial> {
    let rows = ROWS.iter().map(|row| Trial::test(format!("heat::{}", row.name), || known(row)));
    let others = [
        Trial::test("heat::of_a_preset", of_a_preset as fn() -> Outcome),
        Trial::test("heat::picture_of_the_guide", picture_of_the_guide as fn() -> Outcome),
        Trial::test("heat::blended", blended as fn() -> Outcome),
        Trial::test("heat::cost_of_turns", cost_of_turns as fn() -> Outcome),
        Trial::test("heat::error_of_a_difference", error_of_a_difference as fn() -> Outcome),
        Trial::test("heat::refused", refused as fn() -> Outcome),
    ];
    rows.chain(others).collect()
}

const SIZE: u32 = 16;

/// What is shown of a text, and what each pixel must have, from its column and row.
struct Row {
    name: &'static str,
    file: &'static str,
    text: &'static str,
    show: &'static str,
    expected: fn(u32, u32) -> Option<f32>,
}

const WGSL: &str = "@fragment
fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let share = floor(at.x) / 16.0;
    var place = vec3f(at.xy, 1.0);
    var turns = 0;
    for (var i = 0; i < i32(at.y); i++) {
        turns += 2;
    }
    if at.x > 8.0 {
        let inside = share + f32(turns);
        place.z = inside;
    }
    let zero = floor(at.y) - 3.0;
    return vec4f(zero / zero, share, place.z, 1.0);
}
";

const GLSL: &str = "#version 330 core
out vec4 color;
void main() {
    float up = floor(gl_FragCoord.y);
    float twice = 0.0;
    int i = 0;
    while (i < 3) {
        twice += 2.0 * up;
        i += 1;
    }
    color = vec4(twice);
}
";

const BRANCHES: &str = "fn twice(given: f32) -> f32 {
    return 2.0 * given;
}

@fragment
fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    var sum = 0.25;
    if at.x > 8.0 {
        var first: f32;
        let never = 0.0;
        sum += first + never + twice(at.x);
    } else {
        var second = 2.0;
        if at.y > 4.0 {
            second = 3.0;
        }
        sum += second;
    }
    if at.y < 2.0 {
        return vec4f(sum);
    }
    var last = 0.5;
    return vec4f(sum + last);
}
";

const GLSL_BRANCH: &str = "#version 330 core
out vec4 color;
void main() {
    float sum = 0.25;
    if (gl_FragCoord.x > 8.0) {
        float inside = 0.0;
        sum += inside;
    }
    color = vec4(sum);
}
";

const DOMAIN: &str = "@fragment
fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let zero = at.x - at.x;
    let below = select(1.0, -1.0, floor(at.y) == 3.0);
    let root = sqrt(below);
    return vec4f(atan2(zero, zero), pow(zero, zero), log(zero), max(root, 0.0));
}
";

const ROWS: &[Row] = &[
    Row {
        name: "a_value",
        file: "own.wesl",
        text: WGSL,
        show: "share",
        expected: |x, _| Some(x as f32 / 16.0),
    },
    Row {
        name: "an_integer",
        file: "own.wesl",
        text: WGSL,
        show: "turns",
        expected: |_, y| Some(2.0 * y as f32),
    },
    Row {
        name: "a_component_at_its_last_value",
        file: "own.wesl",
        text: WGSL,
        show: "place.z",
        expected: |x, y| Some(if x < 8 { 1.0 } else { x as f32 / 16.0 + 2.0 * y as f32 }),
    },
    Row {
        name: "a_value_in_a_branch",
        file: "own.wesl",
        text: WGSL,
        show: "inside",
        expected: |x, y| (x >= 8).then_some(x as f32 / 16.0 + 2.0 * y as f32),
    },
    // The turn in which a loop ends is one, too.
    Row {
        name: "iterations",
        file: "own.wesl",
        text: WGSL,
        show: "iterations",
        expected: |_, y| Some(y as f32 + 1.0),
    },
    // One for each turn of the loop, and the `if`.
    Row {
        name: "branches",
        file: "own.wesl",
        text: WGSL,
        show: "branches",
        expected: |_, y| Some(y as f32 + 2.0),
    },
    // 0 / 0 in one row.
    Row {
        name: "nan",
        file: "own.wesl",
        text: WGSL,
        show: "nan",
        expected: |_, y| Some(if y == 3 { 2.0 } else { 0.0 }),
    },
    Row {
        name: "a_variable_in_a_branch",
        file: "own.wesl",
        text: BRANCHES,
        show: "first",
        expected: |x, _| (x >= 8).then_some(0.0),
    },
    Row {
        name: "a_variable_in_the_other_branch",
        file: "own.wesl",
        text: BRANCHES,
        show: "second",
        expected: |x, y| (x < 8).then_some(if y < 4 { 2.0 } else { 3.0 }),
    },
    Row {
        name: "a_variable_behind_a_return",
        file: "own.wesl",
        text: BRANCHES,
        show: "last",
        expected: |_, y| (y >= 2).then_some(0.5),
    },
    Row {
        name: "a_constant_in_a_branch",
        file: "own.wesl",
        text: BRANCHES,
        show: "never",
        expected: |x, _| (x >= 8).then_some(0.0),
    },
    Row {
        name: "a_parameter",
        file: "own.wesl",
        text: BRANCHES,
        show: "given",
        expected: |x, _| (x >= 8).then_some(x as f32 + 0.5),
    },
    Row {
        name: "a_variable_in_a_branch_of_glsl",
        file: "own.frag",
        text: GLSL_BRANCH,
        show: "inside",
        expected: |x, _| (x >= 8).then_some(0.0),
    },
    // `atan2(0, 0)` is no NaN, and the root of -1 is one, which is not returned.
    Row {
        name: "nan_outside_of_a_domain",
        file: "own.wesl",
        text: DOMAIN,
        show: "nan",
        expected: |_, y| Some(if y == 3 { 1.0 } else { 0.0 }),
    },
    // OpenGL's rows begin below.
    Row {
        name: "glsl",
        file: "own.frag",
        text: GLSL,
        show: "twice",
        expected: |_, y| Some(6.0 * (15 - y) as f32),
    },
    Row {
        name: "glsl_iterations",
        file: "own.frag",
        text: GLSL,
        show: "iterations",
        expected: |_, _| Some(4.0),
    },
    // Nothing of this text is rounded.
    Row {
        name: "no_error",
        file: "own.wesl",
        text: "@fragment fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {
            return vec4f(0.5, 0.25, 1.0, 1.0);
        }",
        show: "error",
        expected: |_, _| Some(0.0),
    },
];

fn heat(row: &Row) -> Result<HeatMap, Diagnostics> {
    let language = if row.file.ends_with(".frag") { Language::Glsl } else { Language::Wesl };
    let packages = Packages::of_text(row.file, row.text.to_owned());
    let graph = resolve::load(&mut SourceSet::default(), &packages, row.file, language)?;
    let composed = compose::compose(&graph, &Settings::default(), &Options::default())?;
    let (text, _) = OwnText::read(&composed, SourceClip::Auto)?;
    let stages = choose_stages(&[text], &[])?;
    let request = OwnRequest {
        scene: None,
        given: Vec::new(),
        textures: Default::default(),
        time: 1.0,
        linear: true,
        vertices: None,
        inputs: Default::default(),
    };
    let shot = Shot {
        size: [SIZE; 2],
        samples: 1,
        exposure: 0.0,
        cascades: 1,
        language: Language::Wesl,
        surroundings: Surroundings::Usual,
    };
    prepare_own(&stages, &request, &shot)?.measure(&Measure::named(row.show), &shot)
}

/// Each pixel has its number.
fn known(row: &'static Row) -> Outcome {
    let map = measured(row)?;
    for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
        let (found, expected) = (map.value([x, y]).map(|value| value[0]), (row.expected)(x, y));
        if found != expected {
            return Err(format!("pixel {x},{y} has {found:?}, not {expected:?}").into());
        }
    }
    Ok(())
}

fn measured(row: &'static Row) -> Result<HeatMap, Failed> {
    let found = on_thread(|| heat(row)).ok_or("the renderer stopped")?;
    Ok(found.map_err(|problems| format!("{problems:?}"))?)
}

/// Each turn of a loop costs the same, and the part of the loop grows with the number of its turns: a
/// row has as many as its number.
fn cost_of_turns() -> Outcome {
    const ROW: Row =
        Row { name: "cost", file: "own.wesl", text: WGSL, show: "cost", expected: |_, _| None };
    let map = measured(&ROW)?;
    let cost = |x, y| map.value([x, y]).map_or(f32::NAN, |value| value[0]);
    for x in [0, 15] {
        let (none, turn) = (cost(x, 0), cost(x, 1) - cost(x, 0));
        let is_so = (0..SIZE).all(|y| cost(x, y) == none + turn * y as f32);
        // A turn adds to `turns` and to `i`, compares and branches; the fragment has five operations.
        if !is_so || turn < 4.0 || none < 5.0 {
            let all: Vec<f32> = (0..SIZE).map(|y| cost(x, y)).collect();
            return Err(format!("column {x}: {all:?}").into());
        }
    }
    // The branch that only the right half takes.
    if cost(15, 3) <= cost(0, 3) {
        return Err("a branch that is taken costs nothing".into());
    }
    Ok(())
}

/// A third is added to 2^y, whose last bit is 2^(y - 23), and 2^y is taken away again. The sum is rounded,
/// by WGSL to either side; the difference is exact. So a bound is at least what f32 is wrong by, and at
/// most two last bits.
fn error_of_a_difference() -> Outcome {
    const ROW: Row = Row {
        name: "difference",
        file: "own.wesl",
        text: "@fragment fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {
            let large = f32(1u << u32(at.y));
            let sum = large + 0.33333334;
            return vec4f(sum - large);
        }",
        show: "error",
        expected: |_, _| None,
    };
    let map = measured(&ROW)?;
    // The sum of 0.33333334 in f32, which is this number, and of a power of two is known in f64.
    let third = f64::from(0.333_333_34_f32);
    for y in 2..SIZE {
        let large = f64::from(1_u32 << y);
        let wrong = (f64::from((large + third) as f32) - large - third).abs();
        let found = map.value([5, y]).map_or(f32::NAN, |value| value[0]);
        let most = 2.0 * f64::from(y as i32 - 23).exp2();
        if wrong == 0.0 || f64::from(found) < wrong || f64::from(found) > most {
            return Err(format!("row {y}: {found} is not between {wrong} and {most}").into());
        }
    }
    Ok(())
}

/// A model of three squares, one behind the other, with the bytes of their corners: an opaque one, of
/// which a blended one covers the left half, and a blended one behind it.
fn squares() -> (Value, Vec<u8>) {
    let corners = [[-1.0_f32, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0]];
    let mut buffer: Vec<u8> = corners.iter().flatten().flat_map(|one| one.to_le_bytes()).collect();
    buffer.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    let square = |material: u32| {
        json!({ "primitives": [{
        "attributes": { "POSITION": 0 }, "indices": 1, "material": material,
    }] })
    };
    let material = |red: f64, alpha: f64, mode: &str| {
        json!({
            "alphaMode": mode,
            "pbrMetallicRoughness": { "baseColorFactor": [red, 0.0, 0.0, alpha], "metallicFactor": 0.0 },
        })
    };
    let document = json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0, 1, 2] }],
        "nodes": [
            { "mesh": 0 },
            { "mesh": 1, "translation": [-0.5, 0.0, 0.001], "scale": [0.5, 1.0, 1.0] },
            { "mesh": 2, "translation": [0.0, 0.0, -0.001] },
        ],
        "meshes": [square(0), square(1), square(2)],
        "materials": [
            material(0.5, 1.0, "OPAQUE"), material(0.25, 0.5, "BLEND"), material(0.75, 0.5, "BLEND"),
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
              "min": [-1, -1, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 12 },
        ],
        "buffers": [{ "byteLength": buffer.len(), "uri": "squares.bin" }],
    });
    (document, buffer)
}

/// Each pixel has the number of the nearest surface, also where that is blended over another one.
fn blended() -> Outcome {
    let (document, buffer) = squares();
    let scratch = tempfile::tempdir()?;
    std::fs::write(scratch.path().join("squares.bin"), buffer)?;
    std::fs::write(scratch.path().join("squares.gltf"), document.to_string())?;
    let model = ["--model", "squares.gltf", "--camera", "0,0,5,0,0,0", "--size", "32x32"];
    let shown = [&model[..], &["--show", "base.r", "--json", "--out", "heat.png"]].concat();
    let (said, errors) = render(&shown, scratch.path())?;
    let found: Value =
        serde_json::from_str(&said).map_err(|error| format!("{error}: {said}{errors}"))?;
    let number = |name: &str| found[name].as_f64().unwrap_or(f64::NAN);
    // The halves are as large as each other.
    let is_right = (number("lowest"), number("highest")) == (0.25, 0.5)
        && number("pixels") > 50.0
        && 2.0 * number("at_highest") == number("pixels");
    if !is_right {
        return Err(format!("unexpected: {found}").into());
    }
    // The debugger shows the same fragment: the left half, and the right one.
    for (pixel, color) in [("12,16", "0.25 0 0 0.5"), ("20,16", "0.5 0 0 1")] {
        let asked = [&["debug"], &model[..], &["--pixel", pixel]].concat();
        let output = Command::new(LAMPLIGHT).args(asked).current_dir(scratch.path()).output()?;
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let is_given =
            |line: &str| line.split_once("in.color").is_some_and(|(_, rest)| rest.trim() == color);
        if !said.lines().any(is_given) {
            let errors = String::from_utf8_lossy(&output.stderr).into_owned();
            return Err(format!("pixel {pixel}: {said}{errors}").into());
        }
    }
    Ok(())
}

fn render(arguments: &[&str], folder: &Path) -> Result<(String, String), Failed> {
    let output =
        Command::new(LAMPLIGHT).arg("render").args(arguments).current_dir(folder).output()?;
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    Ok((text(output.stdout), text(output.stderr)))
}

/// A preset has numbers where its objects are, and two runs give the same bytes.
fn of_a_preset() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let draw = |out: &str| {
        let shown = ["hpg_4_spot", "--show", "n", "--size", "40x40", "--json", "--out", out];
        render(&shown, scratch.path())
    };
    let (said, errors) = draw("one.png")?;
    draw("two.png")?;
    let found: serde_json::Value =
        serde_json::from_str(&said).map_err(|error| format!("{error}: {said}{errors}"))?;
    let number = |name: &str| found[name].as_f64().unwrap_or(f64::NAN);
    // Components of unit vectors.
    let is_unit =
        (-1.0..0.0).contains(&number("lowest")) && (0.5..=1.0).contains(&number("highest"));
    if !is_unit || number("pixels") < 100.0 || number("nan") != 0.0 {
        return Err(format!("unexpected: {found}").into());
    }
    let bytes = |name: &str| std::fs::read(scratch.path().join(name));
    if bytes("one.png")? != bytes("two.png")? {
        return Err("two runs give different bytes".into());
    }
    Ok(())
}

/// The guide's picture is what its command draws of its file.
fn picture_of_the_guide() -> Outcome {
    let scratch = tempfile::tempdir()?;
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide/debug.md");
    let text = crate::guide::shown_file(&std::fs::read_to_string(page)?, "highlight.wesl")?;
    std::fs::write(scratch.path().join("highlight.wesl"), text)?;
    let shown = ["highlight.wesl", "--show", "rv", "--size", "192x192"];
    let (said, errors) = render(&shown, scratch.path())?;
    let drawn = std::fs::read(scratch.path().join("highlight.rv.png"))
        .map_err(|error| format!("{error}: {said}{errors}"))?;
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/heat.png");
    if std::env::var_os("INSTA_UPDATE").is_some_and(|update| update == "always") {
        std::fs::write(&kept, &drawn)?;
    }
    match std::fs::read(&kept).is_ok_and(|kept| kept == drawn) {
        true => Ok(()),
        false => Err("docs/heat.png is another picture: cargo xtask record heat".into()),
    }
}

/// A name that no variable has is answered with the nearest, and options that make no sense are
/// refused.
fn refused() -> Outcome {
    let scratch = tempfile::tempdir()?;
    std::fs::write(scratch.path().join("own.wesl"), WGSL)?;
    for (shown, expected) in [
        (&["--show", "shar"][..], "did you mean `share`?"),
        (&["--show", "place.w"], "`place` has no `w`"),
        (&["--show", "share", "--watch"], "`--show` has no `--watch`"),
        (&["--show", "share", "--samples", "4"], "cannot be used with"),
    ] {
        let arguments = [&["own.wesl", "--size", "8x8"], shown].concat();
        let (_, errors) = render(&arguments, scratch.path())?;
        if !errors.contains(expected) {
            return Err(format!("{shown:?}: expected `{expected}` in {errors}").into());
        }
    }
    Ok(())
}
