//! Whole programs: permutations of `forward` drawn on each driver, and every sampled fragment
//! computed again by the evaluator from the very inputs the driver gave it.

use std::collections::BTreeMap;
use std::sync::Arc;

use lamplight::bundle::{Kind as BindingKind, Reflection};
use lamplight::compose::{self, Options};
use lamplight::diagnostic::render::{Form, render};
use lamplight::emit::reflect;
use lamplight::eval::{self, Bounded, Function, Kind, Machine, Number, Program, Resources};
use lamplight::harness::fixture::{Address, Compare, Fixture, Sampler, Texture, TextureKind};
use lamplight::harness::frame::{Attribute, BACKENDS, Drawing, Mesh, Renderer, pack, probe};
use lamplight::harness::kernel::{SENTINEL, TARGET_WIDTH};
use lamplight::harness::on_thread;
use lamplight::permute::{Setting, Settings, manifest};
use lamplight::resolve::{self, Packages};
use lamplight::source::{Embedded, Files, Package, SourceSet};
use lamplight::validate::{Validated, validate};
use libtest_mimic::{Failed, Trial};

/// Pixels from top to bottom.
const HEIGHT: u32 = 64;
/// Most fragments in which a comparison is too close to call, or that have no bound.
const OPEN: f64 = 0.1;

/// Permutations: what differs from the defaults.
const KEYS: &[&str] = &[
    "",
    "lights=directional,specular=phong,ambient=none",
    "lights=point,specular=blinn_phong,attenuation=inverse_square_window,fog=exp2",
    "lights=spot,specular=ggx,cone=smooth,ambient=hemisphere,saturate=true",
    "lights=mixed,specular=blinn_phong_normalized,ambient=sh9,two_sided=true,material=array",
    "lights=spot,frequency=vertex,ambient_attenuated=true",
    "lights=directional,frequency=flat,diffuse=oren_nayar,viewer=infinite",
    "lights=directional,shadow=pcf_3x3,shadow_light=directional",
    "lights=spot,shadow=pcf_castano_5,shadow_light=spot,fog=linear",
    "lights=point,shadow=hard,shadow_light=point,specular=ggx",
    "lights=spot,shadow=vsm,diffuse=wrap",
    "lights=mixed,ambient=ibl,base_map=true,normal_map=true",
    "lights=none,ambient=constant,lightmap=true",
];

/// A permutation with everything it is drawn with.
struct Scene {
    validated: Validated,
    mesh: Mesh,
    buffers: BTreeMap<(u32, u32), Vec<u8>>,
    fixtures: BTreeMap<(u32, u32), Arc<Fixture>>,
}

pub fn trials() -> Vec<Trial> {
    BACKENDS.iter().map(|(name, _)| Trial::test(format!("frames/forward/{name}"), move || run(name))).collect()
}

fn run(backend: &'static str) -> Result<(), Failed> {
    let outcome = on_thread(|| {
        let renderer = Renderer::open(backend).map_err(|unavailable| unavailable.reason)?;
        let one = |key: &&str| { eprintln!("KEY {key}"); scene(key).and_then(|scene| agrees(&renderer, &scene)).map_err(|error| format!("[{key}] {error}")) };
        let failures: Vec<String> = KEYS.iter().filter_map(|key| one(key).err()).collect();
        if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
    });
    outcome.ok_or("panicked")?.map_err(Failed::from)
}

fn settings(sources: &mut SourceSet, key: &str) -> Result<Settings, String> {
    let text = Embedded.read("lamplight.toml").ok().flatten().ok_or("no manifest")?;
    let id = sources.add("lamplight.toml", text);
    let manifest = manifest::parse(sources, id).map_err(|problems| render(sources, &problems, Form::Human))?;
    let space = &manifest.program("forward").ok_or("no forward")?.space;
    let mut settings = space.settings(&space.default_assignment());
    for part in key.split(',').filter(|part| !part.is_empty()) {
        let (name, value) = part.split_once('=').ok_or("no `=`")?;
        settings.values.insert(name.to_owned(), Setting::parse(value)).ok_or_else(|| format!("no axis `{name}`"))?;
    }
    Ok(settings)
}

fn scene(key: &str) -> Result<Scene, String> {
    let packages = Packages { root: Package { name: "lamplight".to_owned(), files: Box::new(Embedded) }, dependencies: Vec::new() };
    let mut sources = SourceSet::default();
    let settings = settings(&mut sources, key)?;
    let graph = resolve::wesl::load(&mut sources, &packages, "programs/forward.wesl");
    let graph = graph.map_err(|problems| render(&sources, &problems, Form::Human))?;
    let validated = compose::wesl::compose(&graph, &settings, &Options::default()).and_then(|composed| validate(&composed));
    let validated = validated.map_err(|problems| render(&sources, &problems, Form::Human))?;
    let stages = ["vs_main", "fs_main"].map(|entry| reflect(&validated, entry).map_err(|problem| problem.message));
    let [vertex, fragment] = stages;
    let (vertex, fragment) = (vertex?, fragment?);
    let (mut buffers, mut fixtures) = (BTreeMap::new(), BTreeMap::new());
    for binding in vertex.bindings.iter().chain(&fragment.bindings) {
        let place = (binding.group, binding.binding);
        match binding.kind {
            BindingKind::Uniform => drop(buffers.insert(place, pack(binding, &number))),
            _ => drop(fixtures.insert(place, Arc::new(fixture(binding.kind, &binding.name, &binding.ty)))),
        }
    }
    Ok(Scene { mesh: mesh(&vertex), validated, buffers, fixtures })
}

/// A number for every uniform, sensible where it matters.
fn number(path: &str) -> Vec<f64> {
    let (_, name) = path.rsplit_once('.').unwrap_or(("", path));
    let index = path.split(['[', ']']).nth(1).and_then(|index| index.parse::<f64>().ok()).unwrap_or(0.0);
    let vary = |low: f64, high: f64, count: usize| -> Vec<f64> {
        let step = |i: usize| ((i as f64 + 1.0) * 0.618 + index * 0.271 + path.len() as f64 * 0.137).fract();
        (0..count).map(|i| low + (high - low) * step(i)).collect()
    };
    match name {
        "world_from_view" => vec![1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0.2, 0.3, 3., 1.],
        "clip_from_world" if path.starts_with("camera") => vec![0.9, 0., 0., 0., 0., 0.9, 0., 0., 0., 0., 0.2, 0.1, 0., 0., 0.5, 1.],
        "clip_from_world" => vec![0.5, 0., 0., 0., 0., 0.5, 0., 0.05, 0.1, 0., -0.3, 0., 0.03, 0.02, 0.5, 1.],
        "world_from_object" => vec![1.05, 0., 0., 0., 0., 1.05, 0., 0., 0., 0., 1.05, 0., 0., 0., 0., 1.],
        "normal_from_object" => vec![1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.],
        "count" => vec![3.0],
        "kind" => vec![index + 1.0],
        "light" => vec![0.0],
        "range" | "far" => vec![12.0],
        "near" => vec![0.1],
        "position" => vec![0.7 - index, 0.5, 1.5 + 0.3 * index],
        "axis" => [vec![-0.36, -0.48, -0.8], vec![0.0, -0.28, -0.96], vec![0.6, 0.0, -0.8]][index as usize % 3].clone(),
        "exponent" => vec![4.0 + index],
        "shininess" => vec![16.0],
        "cutoff" => vec![0.5],
        "inner" => vec![0.9],
        "outer" => vec![0.45],
        "attenuation" => vec![1.0, 0.1, 0.05],
        "roughness" => vec![0.45],
        "up" => vec![0.0, 1.0, 0.0],
        "min_w" | "min_variance" | "texel" => vec![0.01],
        "bias" => vec![0.003],
        "start" => vec![1.0],
        "end" => vec![6.0],
        "exponents" => vec![5.0, 5.0],
        "radius" => vec![2.0],
        _ => vary(0.1, 0.9, 4),
    }
}

/// A texture or sampler for a binding: smooth colours, depths with an edge.
fn fixture(kind: BindingKind, name: &str, ty: &str) -> Fixture {
    let sampler = |linear, compare| Fixture::Sampler(Sampler { compare, linear, address: Address::Clamp });
    match kind {
        BindingKind::ComparisonSampler => sampler(true, Some(Compare::LessEqual)),
        BindingKind::Sampler => sampler(name != "depth_sampler", None),
        _ => {
            let kind = match (ty.contains("depth"), ty.contains("cube")) {
                (true, true) => TextureKind::DepthCube,
                (true, false) => TextureKind::Depth2d,
                (false, true) => TextureKind::ColorCube,
                (false, false) => TextureKind::Color2d,
            };
            let texels = 8 * 8 * kind.layers() as usize;
            let value = |index: usize| {
                let (x, y) = ((index % 8) as f32, (index / 8 % 8) as f32);
                if kind.is_depth() { if x < 4.0 { 0.25 } else { 0.9 } } else { (20.0 + 3.0 * x + 2.0 * y) / 64.0 }
            };
            let channel = |index: usize| (0..kind.channels()).map(move |channel| value(index) + channel as f32 / 16.0);
            Fixture::Texture(Texture { kind, width: 8, height: 8, texels: (0..texels).flat_map(channel).collect() })
        }
    }
}

/// A bumpy sheet in front of the viewer: 8 x 8 squares from -1 to 1.
fn mesh(vertex: &Reflection) -> Mesh {
    let mut attributes = Vec::new();
    for input in vertex.inputs.iter().filter(|input| input.location.is_some()) {
        let format = match input.ty.as_str() {
            "u32" => wgpu::VertexFormat::Uint32,
            ty if ty.starts_with("vec2") => wgpu::VertexFormat::Float32x2,
            ty if ty.starts_with("vec3") => wgpu::VertexFormat::Float32x3,
            _ => wgpu::VertexFormat::Float32x4,
        };
        attributes.push(Attribute { location: input.location.unwrap(), format });
    }
    let corner = |x: u32, y: u32| {
        let (u, v) = (f64::from(x) / 8.0, f64::from(y) / 8.0);
        let (px, py) = (2.0 * u - 1.0, 2.0 * v - 1.0);
        let bump = 0.3 * (3.0 * px).sin() * (2.0 * py).cos();
        let attribute = |attribute: &Attribute| -> Vec<u32> {
            let values = match attribute.location {
                0 => vec![px, py, bump],
                1 => vec![-0.9 * (3.0 * px).cos() * (2.0 * py).cos(), 0.6 * (3.0 * px).sin() * (2.0 * py).sin(), 1.0],
                2 => vec![0.9, 0.5 + 0.4 * u, 0.9 - 0.4 * v, 1.0],
                5 => vec![1.0, 0.0, 0.9 * (3.0 * px).cos(), 1.0],
                6 => return vec![x % 3],
                _ => vec![0.1 + 0.8 * u, 0.1 + 0.8 * v],
            };
            values.iter().map(|value| (*value as f32).to_bits()).collect()
        };
        attributes.iter().flat_map(attribute).collect::<Vec<u32>>()
    };
    let squares =
        (0..64).flat_map(|square| [(0, 0), (1, 0), (0, 1), (0, 1), (1, 0), (1, 1)].map(|(x, y)| (square % 8 + x, square / 8 + y)));
    let words = squares.flat_map(|(x, y)| corner(x, y)).collect();
    Mesh { attributes, words }
}

fn agrees(renderer: &Renderer, scene: &Scene) -> Result<(), String> {
    let program = Program::new(&scene.validated.module, &scene.validated.info).map_err(|error| error.to_string())?;
    let id = program.function("fs_main").ok_or("no fs_main")?;
    let signature = program.signature(id).ok_or("no fs_main")?;
    let colors = probe::colors(&scene.validated.module, "fs_main").ok_or("no colours")?;
    let found = draw(renderer, scene, &colors)?;
    let inputs = inputs(renderer, scene, signature.arguments.len())?;
    let mut machine = Machine::<Bounded>::new(&program).map_err(|error| error.to_string())?;
    machine.bind(resources(scene)).map_err(|error| error.to_string())?;
    let (mut tried, mut open) = (0, 0);
    for quad in quads(&found) {
        let arguments = quad.map(|pixel| slots(signature, &inputs[pixel]));
        machine.forget();
        let wanted = machine.quad(id, [0, 1, 2, 3].map(|lane| arguments[lane].as_slice())).map_err(|error| error.to_string())?;
        let doubt = !machine.findings().is_empty();
        for (pixel, wanted) in quad.iter().zip(wanted) {
            let colour = found[4 * pixel..4 * pixel + 4].iter().map(|word| f64::from(f32::from_bits(*word)));
            tried += 1;
            open += usize::from(doubt || wanted.iter().any(|value| !value.error().is_finite()));
            let far = colour.clone().zip(&wanted).find(|(found, wanted)| !((found - wanted.value()).abs() <= wanted.error()));
            if let (Some((found, wanted)), false) = (far, doubt) {
                let (x, y) = (*pixel as u32 % TARGET_WIDTH, *pixel as u32 / TARGET_WIDTH);
                return Err(format!("pixel ({x}, {y}): found {found}, wanted {} within {:e}", wanted.value(), wanted.error()));
            }
        }
    }
    if tried < 200 {
        return Err(format!("only {tried} fragments"));
    }
    if open as f64 > OPEN * f64::from(tried) { Err(format!("{open} of {tried} fragments are open")) } else { Ok(()) }
}

fn draw(renderer: &Renderer, scene: &Scene, module: &naga::Module) -> Result<Vec<u32>, String> {
    let drawing = Drawing {
        module,
        vertex: "vs_main",
        fragment: "fs_main",
        mesh: &scene.mesh,
        buffers: &scene.buffers,
        fixtures: &scene.fixtures,
        height: HEIGHT,
    };
    renderer.draw(&drawing).map_err(|problem| problem.message)
}

/// The words of every pixel's inputs.
fn inputs(renderer: &Renderer, scene: &Scene, words: usize) -> Result<Vec<Vec<u32>>, String> {
    let mut pixels = vec![Vec::new(); (TARGET_WIDTH * HEIGHT) as usize];
    for first in (0..words).step_by(4) {
        let module = probe::inputs(&scene.validated.module, "fs_main", first).ok_or("no inputs")?;
        let found = draw(renderer, scene, &module)?;
        pixels.iter_mut().zip(found.chunks(4)).for_each(|(pixel, words)| pixel.extend_from_slice(words));
    }
    pixels.iter_mut().for_each(|pixel| pixel.truncate(words));
    Ok(pixels)
}

/// Whole quads all over the frame, in the order the evaluator takes them.
fn quads(found: &[u32]) -> impl Iterator<Item = [usize; 4]> + '_ {
    let quads = (0..HEIGHT / 2).flat_map(|y| (0..TARGET_WIDTH / 2).map(move |x| (2 * x, 2 * y))).step_by(29);
    let pixels = quads.map(|(x, y)| [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| ((y + j) * TARGET_WIDTH + x + i) as usize));
    pixels.filter(|quad| quad.iter().all(|pixel| found[4 * pixel] != SENTINEL))
}

fn slots(signature: &Function, words: &[u32]) -> Vec<Bounded> {
    let slot = |(kind, word): (&Kind, &u32)| match kind {
        Kind::Float => Bounded::from_f64(f64::from(f32::from_bits(*word))),
        _ => Bounded::from_word(*word),
    };
    signature.arguments.iter().zip(words).map(slot).collect()
}

fn resources(scene: &Scene) -> Resources {
    let mut resources = Resources { buffers: scene.buffers.clone(), ..Resources::default() };
    for (place, fixture) in &scene.fixtures {
        match &**fixture {
            Fixture::Texture(texture) => drop(resources.textures.insert(*place, eval::Texture::from(texture))),
            Fixture::Sampler(sampler) => drop(resources.samplers.insert(*place, eval::Sampler::from(*sampler))),
        }
    }
    resources
}
