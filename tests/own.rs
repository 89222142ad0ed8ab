//! Shaders of users on the screen: what is drawn of a file in each language, on each executor that
//! every system has, against numbers that are computed by hand.

use lamplight::bundle::{Language, SourceClip, Stage};
use lamplight::compose::{Composed, Options};
use lamplight::diagnostic::Diagnostics;
use lamplight::execute::executors::{self, ExecutorEntry};
use lamplight::execute::on_thread;
use lamplight::generate::{add_numbers, program_numbers};
use lamplight::permute::Settings;
use lamplight::picture::own::table::{Origin, Row};
use lamplight::picture::own::{
    GivenValue, OwnPicture, OwnRequest, OwnText, choose_stages, named_scene, parse_value,
    prepare_own,
};
use lamplight::picture::{Picture, Shot, Surroundings};
use lamplight::resolve::{self, Packages};
use lamplight::source::SourceSet;
use lamplight::{compose, project};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

const SIZE: u32 = 16;

pub fn tests() -> Vec<Trial> {
    let executors =
        [&executors::eval::EXECUTOR, &executors::vulkan::EXECUTOR, &executors::gl::EXECUTOR];
    let drawn = executors
        .into_iter()
        .map(|entry| Trial::test(format!("own::drawn_on_{}", entry.name), move || drawn_on(entry)));
    let others = [
        Trial::test("own::given", given as fn() -> Outcome),
        Trial::test("own::refused", refused as fn() -> Outcome),
    ];
    drawn.chain(others).collect()
}

/// A shader with what is drawn of it.
struct Case {
    name: &'static str,
    /// Each text with its stage; WGSL has none.
    texts: &'static [(Option<Stage>, &'static str)],
    uniforms: &'static [(&'static str, &'static str)],
    model: Option<&'static str>,
    linear: bool,
    /// The colour codes of the pixel in a column and row.
    expected: fn(f64, f64) -> [f64; 3],
}

/// The code of a linear number (IEC 61966-2-1).
fn encoded(linear: f64) -> f64 {
    255.0
        * if linear <= 0.003_130_8 {
            12.92 * linear
        } else {
            1.055 * linear.powf(1.0 / 2.4) - 0.055
        }
}

const CASES: &[Case] = &[
    // The normal of the plane is +y.
    Case {
        name: "wesl fragment on a model",
        texts: &[(
            None,
            "import lamplight::brdf::diffuse::lambert;
             @fragment fn fs_main(@location(0) vNormal: vec3f, @location(1) uv: vec2f) -> @location(0) vec4f {
                 return vec4f(vNormal * 0.5 + lambert(vNormal, vec3f(0.0, 0.25, 0.0)), 1.0);
             }",
        )],
        uniforms: &[],
        model: Some("plane"),
        linear: true,
        expected: |_, _| [encoded(0.25), encoded(0.75), encoded(0.25)],
    },
    // WebGPU counts pixels from the top. A number alone is grey.
    Case {
        name: "wgsl fragment over the picture",
        texts: &[(
            None,
            "@fragment fn fs_main(@builtin(position) at: vec4f, @location(3) uv: vec2f) -> @location(0) f32 {
                 return 0.5 * at.y / 16.0 + 0.5 * uv.y;
             }",
        )],
        uniforms: &[],
        model: None,
        linear: true,
        expected: |_, y| [encoded(y / 16.0); 3],
    },
    // Three vertices from their index; the time and a member that is given.
    Case {
        name: "wgsl with both stages",
        texts: &[(
            None,
            "struct Given { time: f32, tint: vec3f }
             @group(0) @binding(0) var<uniform> given: Given;
             struct Between { @builtin(position) at: vec4f, @location(0) place: vec2f }
             @vertex fn vs_main(@builtin(vertex_index) index: u32) -> Between {
                 var corners = array<vec2f, 3>(vec2f(-1.0, -1.0), vec2f(3.0, -1.0), vec2f(-1.0, 3.0));
                 return Between(vec4f(corners[index], 0.5, 1.0), corners[index]);
             }
             @fragment fn fs_main(between: Between) -> @location(0) vec4f {
                 return vec4f(0.5 + 0.5 * between.place.y, given.time, given.tint.y, 1.0);
             }",
        )],
        uniforms: &[("tint", "0,0.5,0")],
        model: None,
        linear: true,
        expected: |_, y| [encoded(1.0 - y / 16.0), encoded(0.25), encoded(0.5)],
    },
    // OpenGL counts pixels from the bottom, and dFdy with them.
    Case {
        name: "glsl fragment over the picture",
        texts: &[(
            Some(Stage::Fragment),
            "#version 330 core
             out vec4 colour;
             void main() {
                 float up = dFdy(gl_FragCoord.y);
                 colour = vec4(gl_FragCoord.xy / 16.0, up * 0.25, 1.0);
             }",
        )],
        uniforms: &[],
        model: None,
        linear: false,
        expected: |x, y| [255.0 * x / 16.0, 255.0 * (1.0 - y / 16.0), 63.75],
    },
    // Both stages have push constants, which are two buffers here.
    Case {
        name: "glsl for Vulkan",
        texts: &[
            (
                Some(Stage::Vertex),
                "#version 450
                 layout(location = 0) in vec2 inPos;
                 layout(push_constant) uniform Place { vec2 shift; } place;
                 void main() { gl_Position = vec4(inPos + place.shift, 0.0, 1.0); }",
            ),
            (
                Some(Stage::Fragment),
                "#version 450
                 layout(location = 0) out vec4 colour;
                 layout(push_constant) uniform Shade { layout(offset = 16) vec3 tint; } shade;
                 void main() { colour = vec4(shade.tint, 1.0); }",
            ),
        ],
        uniforms: &[("tint", "0,0.5,1")],
        model: None,
        linear: true,
        expected: |_, _| [0.0, encoded(0.5), 255.0],
    },
    // The square of clip space, with v from the bottom, as OpenGL has it.
    Case {
        name: "glsl with both stages",
        texts: &[
            (
                Some(Stage::Vertex),
                "#version 330 core
                 layout(location = 2) in vec2 aPos;
                 in vec3 aNormal;
                 in vec2 aTexCoord;
                 uniform float scale;
                 out vec2 uv;
                 out vec3 normal;
                 void main() { uv = aTexCoord; normal = aNormal; gl_Position = vec4(aPos * scale, 0.0, 1.0); }",
            ),
            (
                Some(Stage::Fragment),
                "#version 330 core
                 in vec3 normal;
                 in vec2 uv;
                 out vec4 colour;
                 void main() { colour = vec4(uv, normal.z * 0.5 * float(gl_FrontFacing), 1.0); }",
            ),
        ],
        uniforms: &[],
        model: None,
        linear: false,
        expected: |x, y| [255.0 * x / 16.0, 255.0 * (1.0 - y / 16.0), 127.5],
    },
];

fn composed(text: &str, stage: Option<Stage>) -> Result<(Composed, resolve::Graph), Diagnostics> {
    let (path, language) = match stage {
        None => ("own.wesl", Language::Wesl),
        Some(Stage::Vertex) => ("own.vert", Language::Glsl),
        Some(_) => ("own.frag", Language::Glsl),
    };
    let mut packages = Packages::of_text(path, text.to_owned());
    packages.add(project::library_package());
    let graph = resolve::load(&mut SourceSet::default(), &packages, path, language)?;
    let composed = compose::compose(&graph, &Settings::default(), &Options::default())?;
    Ok((composed, graph))
}

fn read_texts(texts: &[(Option<Stage>, &str)]) -> Result<Vec<OwnText>, Diagnostics> {
    let mut read: Vec<_> =
        texts.iter().map(|(stage, text)| composed(text, *stage)).collect::<Result<_, _>>()?;
    if let [(vertex, one), (fragment, other)] = read.as_mut_slice() {
        let [of_vertex, of_fragment] = program_numbers(Some(one), Some(other));
        add_numbers(vertex, &of_vertex);
        add_numbers(fragment, &of_fragment);
    }
    let text = |(composed, _): &(Composed, resolve::Graph)| {
        OwnText::read(composed, SourceClip::Auto).map(|(text, _)| text)
    };
    read.iter().map(text).collect()
}

fn shot() -> Shot {
    Shot {
        size: [SIZE; 2],
        samples: 1,
        exposure: 0.0,
        cascades: 1,
        language: Language::Wesl,
        surroundings: Surroundings::Usual,
    }
}

fn prepared(case: &Case, entries: &[String]) -> Result<OwnPicture, Diagnostics> {
    let stages = choose_stages(&read_texts(case.texts)?, entries)?;
    let value = |(name, text): &(&str, &str)| GivenValue {
        name: (*name).to_owned(),
        value: parse_value(text).unwrap(),
        origin: Origin::Option,
        span: None,
    };
    let request = OwnRequest {
        scene: case.model.and_then(named_scene),
        given: case.uniforms.iter().map(value).collect(),
        textures: Default::default(),
        time: 0.25,
        linear: case.linear,
        vertices: None,
        inputs: Default::default(),
    };
    prepare_own(&stages, &request, &shot())
}

fn drawn(case: &Case, entry: &ExecutorEntry) -> Result<Picture, Failed> {
    let draw = || {
        let painter = entry.start().map_err(|_| Vec::new())?;
        prepared(case, &[])?.take(painter.as_ref(), &shot())
    };
    let found = on_thread(draw).ok_or("the renderer stopped")?;
    found.map_err(|problems| format!("{}: {problems:?}", case.name).into())
}

/// Each pixel in the middle of the picture has its colour, within one code: drivers round
/// interpolated numbers differently.
fn drawn_on(entry: &ExecutorEntry) -> Outcome {
    for case in CASES {
        let picture = drawn(case, entry)?;
        for at in [[5, 6], [8, 8], [10, 9]] {
            let [x, y] = at.map(|one: u32| f64::from(one) + 0.5);
            let expected = (case.expected)(x, y);
            let found = picture.pixel(at).map(f64::from);
            let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off <= 1.0, "{}: {at:?} is {found:?}, not {expected:?}", case.name);
        }
    }
    Ok(())
}

/// The table says what each input got and why.
fn given() -> Outcome {
    let case = Case {
        texts: &[(
            None,
            "struct Scene { view_proj: mat4x4f, eye: vec3f, what: f32 }
             @group(0) @binding(0) var<uniform> scene: Scene;
             @group(1) @binding(0) var albedo: texture_2d<f32>;
             @group(1) @binding(1) var smp: sampler;
             @group(1) @binding(2) var<storage> rows: array<f32>;
             @fragment fn fs_main(@location(0) n: vec3f, @location(1) uv: vec2f, @location(2) extra: vec3f)
                 -> @location(0) vec4f {
                 let x = scene.view_proj[0] * scene.what * rows[0];
                 return textureSample(albedo, smp, uv) + x + vec4f(n + extra + scene.eye, 1.0);
             }",
        )],
        uniforms: &[("eye", "1,2,3")],
        ..CASES[0]
    };
    let prepared = prepared(&case, &[]).map_err(|errors| format!("{errors:?}"))?;
    let row = |row: &Row| (row.name.clone(), row.ty.clone(), row.value.clone(), row.from);
    let found: Vec<_> = prepared.rows.iter().map(row).collect();
    let expected = [
        ("n", "vec3f", "normal", Origin::Name),
        ("uv", "vec2f", "uv", Origin::Name),
        ("extra", "vec3f", "0", Origin::Zero),
        ("scene.view_proj", "mat4x4f", "projection * view", Origin::Name),
        ("scene.eye", "vec3f", "1, 2, 3", Origin::Option),
        ("scene.what", "f32", "0", Origin::Zero),
        ("albedo", "texture_2d<f32>", "checker", Origin::Type),
    ];
    let expected = expected
        .map(|(name, ty, value, from)| (name.to_owned(), ty.to_owned(), value.to_owned(), from));
    assert_eq!(found, expected);
    let notes = prepared.notes.join("\n");
    assert!(notes.contains("`rows` holds zeros") && notes.contains("`scene.what`"), "{notes}");
    Ok(())
}

/// What cannot be drawn gives an error that says why, and where.
fn refused() -> Outcome {
    const COLOR: &str = "-> @location(0) vec4f { return vec4f(1.0); }";
    let wgsl = |text: String| vec![(None, text)];
    let cases = [
        (wgsl("@compute @workgroup_size(1) fn main() {}".into()), "no fragment stage to draw: `main` is a compute stage"),
        (wgsl("const a = 1;".into()), "there is no entry point to draw"),
        (wgsl(format!("@fragment fn a() {COLOR} @fragment fn b() {COLOR}")), "several fragment stages: a, b"),
        (wgsl("@fragment fn a() -> @location(0) vec4u { return vec4u(1u); }".into()), "returns vec4u at location 0"),
        (wgsl("@fragment fn a() -> @builtin(frag_depth) f32 { return 1.0; }".into()), "`a` returns no colour"),
        (
            wgsl("@vertex fn v() -> @builtin(position) vec4f { return vec4f(1.0); }
                  @fragment fn f(@location(1) uv: vec2f) -> @location(0) vec4f { return uv.xyxy; }".into()),
            "the fragment stage `f` takes `uv` at location 1, where the vertex stage `v` returns nothing",
        ),
        (
            wgsl("@group(0) @binding(0) var<storage, read_write> rows: array<f32>;
                  @fragment fn f() -> @location(0) vec4f { rows[0] = 1.0; return vec4f(rows[0]); }".into()),
            "`rows: array<f32>`: the stage may write to it",
        ),
        (
            wgsl("@group(0) @binding(0) var many: texture_2d_array<f32>;
                  @fragment fn f() -> @location(0) vec4f { return textureLoad(many, vec2u(), 0, 0); }".into()),
            "nothing can be bound to `many: texture_2d_array<f32>`",
        ),
        (
            wgsl("override size: f32; @fragment fn f() -> @location(0) vec4f { return vec4f(size); }".into()),
            "the override `size` has no value",
        ),
    ];
    for (texts, expected) in cases {
        let texts: Vec<(Option<Stage>, &str)> =
            texts.iter().map(|(stage, text)| (*stage, text.as_str())).collect();
        let read = read_texts(&texts).and_then(|read| choose_stages(&read, &[]));
        let request = OwnRequest {
            scene: None,
            given: Vec::new(),
            textures: Default::default(),
            time: 0.0,
            linear: true,
            vertices: None,
            inputs: Default::default(),
        };
        let found = read.and_then(|stages| prepare_own(&stages, &request, &shot()).map(|_| ()));
        let errors = found.err().unwrap_or_default();
        let message: String = errors.iter().map(|error| error.message.clone()).collect();
        assert!(message.contains(expected), "expected `{expected}`, found {message}");
    }
    Ok(())
}
