//! Fragment stages that are drawn by themselves. Their inputs come from the model, their loops end,
//! and what cannot be drawn says so.

use std::collections::BTreeMap;

use lamplight::bundle::Language;
use lamplight::compose::{self, Options};
use lamplight::diagnostic::Diagnostics;
use lamplight::execute::{executors, on_thread};
use lamplight::permute::Settings;
use lamplight::picture::sketch::{MODELS, Sketch, SketchOptions};
use lamplight::picture::{Picture, Shot, Surroundings};
use lamplight::resolve::{self, Packages};
use lamplight::scene::environment;
use lamplight::source::SourceSet;
use lamplight::validate::validate;
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 4] = [
        ("inputs", inputs),
        ("uniforms", uniforms),
        ("loops_end", loops_end),
        ("refused", refused),
    ];
    cases.into_iter().map(|(name, case)| Trial::test(format!("sketch::{name}"), case)).collect()
}

const SIZE: u32 = 33;

fn sketch(text: &str) -> Result<Sketch, Diagnostics> {
    const PATH: &str = "stage.wesl";
    let packages = Packages::of_text(PATH, text.to_owned());
    let graph = resolve::load(&mut SourceSet::default(), &packages, PATH, Language::Wesl)?;
    let composed = compose::compose(&graph, &Settings::default(), &Options::default())?;
    Sketch::new(validate(&composed)?, None).map_err(|problem| vec![problem])
}

/// The picture of a stage.
fn drawn(text: &str, setting: &SketchOptions) -> Result<Picture, Failed> {
    let sky = environment("studio").ok_or("no environment")?;
    let shot = Shot {
        size: [SIZE; 2],
        samples: 1,
        exposure: 0.0,
        cascades: 1,
        language: Language::Wesl,
        surroundings: Surroundings::Formula(sky),
    };
    let draw = || {
        let painter = executors::vulkan::EXECUTOR.start().map_err(|_| Vec::new())?;
        let picture = sketch(text)?.prepare(setting, &shot)?.photograph(painter.as_ref(), &shot)?;
        Ok(picture.develop())
    };
    let found = on_thread(draw).ok_or("the renderer stopped")?;
    found.map_err(|problems: Diagnostics| format!("{text}: {problems:?}").into())
}

/// The pixel in the middle.
fn middle(picture: &Picture) -> [u8; 3] {
    let at = 3 * (SIZE * (SIZE / 2) + SIZE / 2) as usize;
    [0, 1, 2].map(|channel| picture.pixels[at + channel])
}

/// The stage gets the normal of the model. In the middle of the picture it points to the viewer,
/// except on the plane, and on the torus, which has its hole there. A chosen source replaces the
/// one that the name suggests.
fn inputs() -> Outcome {
    const TEXT: &str = "@fragment fn fs_main(@location(0) world_normal: vec3f, @location(3) k: f32)
        -> @location(0) vec4f { return vec4f(normalize(world_normal), k); }";
    for (model, _) in MODELS.iter().filter(|(name, _)| !matches!(*name, "plane" | "torus")) {
        let setting = SketchOptions { model: (*model).to_owned(), ..SketchOptions::default() };
        let [red, green, blue] = middle(&drawn(TEXT, &setting)?);
        assert!(blue > 200.max(red).max(green), "{model}: {red}, {green}, {blue}");
    }
    let inputs = BTreeMap::from([("world_normal".to_owned(), "zero".to_owned())]);
    let zero = "@fragment fn fs_main(@location(0) world_normal: vec3f) -> @location(0) vec4f {
        return vec4f(world_normal + vec3f(1.0, 0.0, 0.0), 1.0); }";
    let setting = SketchOptions { inputs, ..SketchOptions::default() };
    assert_eq!(middle(&drawn(zero, &setting)?), [255, 0, 0]);
    Ok(())
}

/// Uniforms are listed with their types and numbers, and have the number that somebody chose.
fn uniforms() -> Outcome {
    const TEXT: &str =
        "struct Knobs { tint: vec3f, steps: u32, all: array<vec4f, 2>, turn: mat3x3f }
        @group(0) @binding(0) var<uniform> knobs: Knobs;
        @fragment fn fs_main() -> @location(0) vec4f {
            return vec4f(knobs.turn * knobs.tint, 1.0) * f32(knobs.steps) + 0.0 * knobs.all[1];
        }";
    let uniforms = BTreeMap::from([("knobs.tint".to_owned(), vec![1.0, 0.0, 1.0])]);
    let setting = SketchOptions { uniforms, ..SketchOptions::default() };
    assert_eq!(middle(&drawn(TEXT, &setting)?), [255, 0, 255]);
    let sketch = sketch(TEXT).map_err(|problems| format!("{problems:?}"))?;
    let listed = sketch.uniforms(&setting).into_iter();
    let listed: Vec<_> = listed.map(|one| (one.path, one.ty, one.numbers)).collect();
    let row =
        |path: &str, ty: &str, numbers: &[f64]| (path.to_owned(), ty.to_owned(), numbers.to_vec());
    let expected = [
        row("knobs.tint", "vec3<f32>", &[1.0, 0.0, 1.0]),
        row("knobs.steps", "u32", &[1.0]),
        row("knobs.all[0]", "vec4<f32>", &[0.5; 4]),
        row("knobs.all[1]", "vec4<f32>", &[0.5; 4]),
    ];
    assert_eq!(listed, expected);
    Ok(())
}

/// The loops of a stage make at most 4,096 trips in all. Here the first call makes 2,048, and the
/// second, which would hardly end by itself, makes the rest. If the stage has a derivative, the
/// trips of each call are limited separately.
fn loops_end() -> Outcome {
    let text = |ends: &str| {
        format!(
            "fn spin(most: u32) -> f32 {{
                var trips = 0u;
                loop {{
                    if trips == most {{ break; }}
                    trips += 1u;
                    {ends}
                }}
                return f32(trips);
            }}
            @fragment fn fs_main(@location(0) uv: vec2f) -> @location(0) vec4f {{
                let first = spin(2048u);
                return vec4f(first / 4096.0, spin(0xffffffffu) / 4096.0, 0.0, 1.0);
            }}"
        )
    };
    // 2,047 trips are left: one was counted when the first loop found that it is done.
    let [red, green, _] = middle(&drawn(&text(""), &SketchOptions::default())?);
    assert_eq!([red, green], [188, 187]);
    let derived =
        text("").replace("let first = spin(2048u);", "let first = spin(2048u) + 0.0 * dpdx(uv.x);");
    let [red, green, _] = middle(&drawn(&derived, &SketchOptions::default())?);
    assert_eq!([red, green], [188, 255]);
    Ok(())
}

/// What cannot be drawn gives an error that says why.
fn refused() -> Outcome {
    let cases = [
        ("@compute @workgroup_size(1) fn main() {}", "no fragment entry point"),
        ("@fragment fn fs_main() -> @location(0) f32 { return 1.0; }", "no `vec4f` at location 0"),
        (
            "@group(0) @binding(0) var<storage> rows: array<f32>;
             @fragment fn fs_main() -> @location(0) vec4f { return vec4f(rows[0]); }",
            "nothing can be bound to `rows",
        ),
    ];
    for (text, expected) in cases {
        let message = match drawn(text, &SketchOptions::default()) {
            Ok(_) => "nothing".to_owned(),
            Err(error) => error.message().unwrap_or_default().to_owned(),
        };
        assert!(message.contains(expected), "{text}: expected `{expected}`, found {message}");
    }
    Ok(())
}
