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

type Outcome = Result<(), Failed>;

const LAMPLIGHT: &str = env!("CARGO_BIN_EXE_lamplight");

pub fn tests() -> Vec<Trial> {
    let rows = ROWS.iter().map(|row| Trial::test(format!("heat::{}", row.name), || known(row)));
    let others = [
        Trial::test("heat::of_a_preset", of_a_preset as fn() -> Outcome),
        Trial::test("heat::picture_of_the_guide", picture_of_the_guide as fn() -> Outcome),
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
    let found = on_thread(|| heat(row)).ok_or("the renderer stopped")?;
    let map = found.map_err(|problems| format!("{problems:?}"))?;
    for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
        let (found, expected) = (map.value([x, y]).map(|value| value[0]), (row.expected)(x, y));
        if found != expected {
            return Err(format!("pixel {x},{y} has {found:?}, not {expected:?}").into());
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
