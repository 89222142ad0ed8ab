//! A scene for OpenGL, drawn from the outputs of every target, and by Mesa from the text as it is.
//!
//! Nothing in the scene is symmetric. Its triangles hide each other, pass through each other, and
//! some are nearer than the middle of OpenGL's range of depths, where another clip space would cut
//! them off. The pictures must agree but for the pixels at the edges of triangles.

use std::collections::BTreeMap;
use std::sync::Arc;

use lamplight::bundle::{BindingKind, Bundle, Language, Target};
use lamplight::execute::executors;
use lamplight::execute::fixture::{Address, Fixture, FixtureSampler, FixtureTexture, TextureKind};
use lamplight::execute::frame::{
    Buffers, DrawItem, Drawing, EntryPoint, Mesh, VertexAttribute, VertexFormat,
};
use lamplight::execute::shipped::Shipped;
use lamplight::execute::{Session, ShippedPair, on_thread};
use libtest_mimic::{Failed, Trial};

use crate::validators::{Package, expect};

const VERTEX: &str = include_str!("opengl_scene/scene.vs");
const FRAGMENT: &str = include_str!("opengl_scene/scene.fs");

/// The uniforms as they are written, and in a block. Both have the same members, so the bodies of the
/// shaders are the same.
const LAMP: &str = "struct Lamp { vec3 direction; vec3 colour; };\n";
const MEMBERS: [&str; 6] = [
    "mat4 projection",
    "mat4 view",
    "Lamp lamp",
    "float scale",
    "bool is_cut",
    // glslang would put what follows an array elsewhere in HLSL than Direct3D does.
    "vec3 tints[2]",
];

const MANIFEST: &str =
    "[program.scene]\nglsl = { vertex = \"scene.vs\", fragment = \"scene.fs\" }\n";

const SIZE: [u32; 2] = [128, 80];
/// How far channels of one pixel may be apart: drivers interpolate with different roundings.
const NEAR: f32 = 2e-3;
/// The share of pixels that may be farther apart: those at edges, where drivers choose differently.
const MOST_AT_EDGES: f64 = 0.015;
/// The least share of pixels that something is drawn in.
const LEAST_DRAWN: f64 = 0.3;

pub fn tests() -> Vec<Trial> {
    let test = |name: &str, is_loose: bool| {
        Trial::test(format!("opengl_scene::{name}"), move || {
            on_thread(move || drawn(is_loose)).ok_or("panicked")?.map_err(Failed::from)
        })
    };
    vec![
        test("block", false),
        test("loose_uniforms", true),
        Trial::test("opengl_scene::other_conventions_are_noticed", || {
            on_thread(others_are_noticed).ok_or("panicked")?.map_err(Failed::from)
        }),
    ]
}

/// The text of a stage with its uniforms in a block, or outside of one.
fn with_uniforms(text: &str, is_loose: bool) -> String {
    let declared: String = match is_loose {
        true => MEMBERS.map(|member| format!("uniform {member};\n")).concat(),
        false => {
            let members = MEMBERS.map(|member| format!("    {member};\n")).concat();
            format!("layout(std140) uniform Scene {{\n{members}}};\n")
        }
    };
    text.replace("UNIFORMS", &format!("{LAMP}{declared}"))
}

fn bundle_of(is_loose: bool, options: &[&str]) -> Result<Bundle, String> {
    let package = Package::new(MANIFEST, "").map_err(failed)?;
    for (name, text) in [("scene.vs", VERTEX), ("scene.fs", FRAGMENT)] {
        let text = with_uniforms(text, is_loose);
        std::fs::write(package.path(name), text).map_err(|error| error.to_string())?;
    }
    let arguments = [&["gen", "--no-cache", "-o", "scene.lamplight"][..], options].concat();
    let output = package.run(&arguments).map_err(failed)?;
    expect(&output, 0, &[]).map_err(failed)?;
    let bytes =
        std::fs::read(package.path("scene.lamplight")).map_err(|error| error.to_string())?;
    Bundle::from_bytes(bytes).map_err(|error| error.to_string())
}

fn failed(error: Failed) -> String {
    error.message().unwrap_or("failed").to_owned()
}

fn stages(bundle: &Bundle, target: Target) -> Result<[Shipped; 2], String> {
    let stage = |entry: &str| -> Result<Shipped, String> {
        let found = bundle
            .program("scene")
            .and_then(|program| program.entry(Language::Glsl, entry)?.get("default", target))
            .map_err(|error| error.to_string())?;
        let (native, reflection) = ((*found.native).clone(), (*found.reflection).clone());
        Ok(Shipped { target, bytes: found.bytes.to_vec(), native, reflection })
    };
    Ok([stage("vertex")?, stage("fragment")?])
}

/// The author's texts in the place of the outputs for OpenGL, with the names that they have there.
fn original(bundle: &Bundle) -> Result<[Shipped; 2], String> {
    let mut stages = stages(bundle, Target::GLSL330)?;
    for (stage, text) in stages.iter_mut().zip([VERTEX, FRAGMENT]) {
        stage.bytes = with_uniforms(text, false).into_bytes();
        let native = &mut stage.native;
        native.clip = None;
        native.slots.iter_mut().for_each(|slot| slot.name = Some("Scene".to_owned()));
        native.combined.iter_mut().for_each(|pair| pair.name = "albedo".to_owned());
    }
    Ok(stages)
}

/// A picture as rows of pixels from the top.
type Picture = Vec<[f32; 4]>;

fn draw(session: &dyn Session, [vertex, fragment]: &[Shipped; 2]) -> Result<Picture, String> {
    let buffers = buffers_of(vertex);
    let fixtures = fixtures_of(fragment)?;
    let mesh = mesh();
    let items = [DrawItem { mesh: &mesh, buffers: &buffers }];
    // Shipped stages are drawn in the place of these.
    let module = naga::Module::default();
    let point = EntryPoint { module: &module, entry: "" };
    let mut drawing = Drawing::of_items([point, point], &items, &fixtures, SIZE);
    drawing.state.depth_test = true;
    let frames = session.draw_shipped(ShippedPair { vertex, fragment }, &drawing);
    let words = frames.map_err(|error| error.message)?.remove(0).targets.remove(0);
    let pixels = words.as_chunks::<4>().0;
    Ok(pixels.iter().map(|pixel| pixel.map(f32::from_bits)).collect())
}

/// The name of an executor, and a session of it.
type OpenDriver = (&'static str, Box<dyn Session>);

fn open(target: Target) -> Result<Vec<OpenDriver>, String> {
    let sessions = executors::shipping(target).map(|(entry, shipping)| {
        let session = (shipping.open)().map_err(|missing| entry.missing(&missing))?;
        Ok((entry.name, session))
    });
    sessions.collect()
}

/// What Mesa draws of the text. OpenGL's first row is the lowest.
fn draw_original(bundle: &Bundle) -> Result<Picture, String> {
    let sessions = open(Target::GLSL330)?;
    let (_, session) = sessions.first().ok_or("nothing draws GLSL")?;
    let picture = draw(&**session, &original(bundle)?)?;
    let rows: Vec<&[[f32; 4]]> = picture.chunks(SIZE[0] as usize).rev().collect();
    Ok(rows.concat())
}

fn drawn(is_loose: bool) -> Result<(), String> {
    let bundle = bundle_of(is_loose, &[])?;
    let expected = draw_original(&bundle)?;
    let is_drawn = |pixel: &&[f32; 4]| pixel[3] == 1.0;
    let share = expected.iter().filter(is_drawn).count() as f64 / expected.len() as f64;
    if share < LEAST_DRAWN {
        return Err(format!("the scene covers {share} of the picture"));
    }
    for target in Target::ALL {
        let stages = stages(&bundle, *target)?;
        for (name, session) in open(*target)? {
            let found = draw(&*session, &stages).map_err(|error| format!("{name}: {error}"))?;
            let apart = share_apart(&expected, &found);
            println!("{name} draws {target}: {:.2} % at edges", 100.0 * apart);
            if apart > MOST_AT_EDGES {
                return Err(format!("{name} draws {target}: {apart} of the pixels differ"));
            }
        }
    }
    Ok(())
}

/// Positions that are converted from another clip space make another picture.
fn others_are_noticed() -> Result<(), String> {
    let expected = draw_original(&bundle_of(false, &[])?)?;
    let sessions = open(Target::GLSL330)?;
    let (_, session) = sessions.first().ok_or("nothing draws GLSL")?;
    for space in ["vulkan", "webgpu"] {
        let bundle = bundle_of(false, &["--source-clip", space])?;
        let found = draw(&**session, &stages(&bundle, Target::GLSL330)?)?;
        let apart = share_apart(&expected, &found);
        if apart <= 2.0 * MOST_AT_EDGES {
            return Err(format!("for {space}, only {apart} of the pixels differ"));
        }
    }
    Ok(())
}

fn share_apart(expected: &[[f32; 4]], found: &[[f32; 4]]) -> f64 {
    let is_apart = |(left, right): (&[f32; 4], &[f32; 4])| {
        left.iter().zip(right).any(|(left, right)| {
            let is_near = (left - right).abs() <= NEAR;
            left.to_bits() != right.to_bits() && !is_near
        })
    };
    let apart = expected.iter().zip(found).filter(|pair| is_apart(*pair)).count();
    apart as f64 / expected.len() as f64
}

/// The block by the rules of `std140`, for the binding of each stage.
fn buffers_of(vertex: &Shipped) -> Buffers {
    // A frustum that is not symmetric, as `glFrustum` makes it: left -0.5, right 0.9, bottom -0.4,
    // top 0.6, near 1, far 9.
    let projection = [
        [2.0 / 1.4, 0.0, 0.0, 0.0],
        [0.0, 2.0, 0.0, 0.0],
        [0.4 / 1.4, 0.2, -10.0 / 8.0, -1.0],
        [0.0, 0.0, -18.0 / 8.0, 0.0],
    ];
    // A rotation about z by the angle of 3, 4, 5, and a step back.
    let view =
        [[0.8, 0.6, 0.0, 0.0], [-0.6, 0.8, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.2, -0.1, -2.5, 1.0]];
    let tints = [[0.7, 0.2, 0.1, 0.0], [0.1, 0.5, 0.9, 0.25]];
    let lamp = [[0.48, 0.64, 0.6, 0.0], [0.9, 0.8, 0.3, 0.0]];
    let mut words: Vec<u32> = Vec::new();
    let rows = projection.iter().chain(&view).chain(&lamp);
    words.extend(rows.flatten().map(|value: &f32| value.to_bits()));
    words.extend([0.5_f32.to_bits(), 1, 0, 0]);
    words.extend(tints.iter().flatten().map(|value: &f32| value.to_bits()));
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let uniform = vertex.reflection.bindings.iter().filter(|one| one.kind == BindingKind::Uniform);
    uniform.map(|one| ((one.group, one.binding), bytes.clone())).collect()
}

/// A texture of three by two texels, none of which is another one.
fn fixtures_of(fragment: &Shipped) -> Result<BTreeMap<(u32, u32), Arc<Fixture>>, String> {
    let texels: Vec<f32> = (0..6)
        .flat_map(|at| {
            let at = at as f32;
            [0.15 * at, 1.0 - 0.12 * at, 0.3 + 0.1 * at, if at == 4.0 { 0.0 } else { 1.0 }]
        })
        .collect();
    let kind = TextureKind::Color2d;
    let texture = Fixture::Texture(FixtureTexture { kind, width: 3, height: 2, texels });
    let sampler =
        Fixture::Sampler(FixtureSampler { compare: None, linear: true, address: Address::Repeat });
    let mut fixtures = BTreeMap::new();
    for binding in &fragment.reflection.bindings {
        let fixture = match binding.kind {
            BindingKind::Uniform => continue,
            BindingKind::Sampler => &sampler,
            BindingKind::Texture => &texture,
            other => return Err(format!("a binding of the kind {other:?}")),
        };
        fixtures.insert((binding.group, binding.binding), Arc::new(fixture.clone()));
    }
    Ok(fixtures)
}

/// Five triangles: two that pass through each other, one before and one behind them, and one that
/// the near plane cuts.
fn mesh() -> Mesh {
    let triangles: [[[f32; 3]; 3]; 5] = [
        [[-1.2, -0.4, 0.3], [1.1, -0.7, -1.2], [0.2, 1.3, -0.4]],
        [[-0.9, 0.9, -1.4], [1.5, 0.6, 0.2], [0.1, -1.1, -0.1]],
        [[0.4, 0.1, 0.9], [0.9, 0.2, 1.1], [0.5, 0.6, 0.8]],
        [[-3.0, -2.0, -4.0], [2.0, -2.5, -4.5], [-0.5, 3.0, -5.0]],
        [[-0.9, -0.5, 1.0], [-0.4, -0.6, 2.2], [-0.7, 0.3, 0.6]],
    ];
    let float = |location, format| VertexAttribute { location, format };
    let attributes = vec![
        float(0, VertexFormat::Float32x3),
        float(1, VertexFormat::Float32x3),
        float(2, VertexFormat::Float32x2),
    ];
    let mut words = Vec::new();
    for (number, triangle) in (0..).zip(triangles) {
        for (corner, place) in (0..).zip(triangle) {
            let turn = 0.3 * (number as f32) - 0.4;
            let normal = [turn, 0.5 - 0.4 * corner as f32, 0.8];
            let uv =
                [0.9 * corner as f32 + 0.1 * number as f32, 0.7 * ((corner + number) % 3) as f32];
            words.extend(place.iter().chain(&normal).chain(&uv).map(|value| value.to_bits()));
        }
    }
    Mesh { attributes, words, indices: Vec::new() }
}
