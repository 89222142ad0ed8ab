//! A fragment stage drawn on a model by itself: what an author has before there is a program.
//!
//! A vertex stage is written that gives it its inputs. Each is taken from one of [`SOURCES`], which
//! its name suggests or somebody chose. Uniforms that have no number are 0.5 in each component, or
//! 1 for integers. Matrices are the identity.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;
use std::sync::Arc;

use glam::{DMat4, DQuat, DVec2, DVec3};

use super::Shot;
use super::controls::Uniform;
use super::frame::{BufferLeaf, ReadyStage, Stages, bound_loops, buffer_leaves, pack_buffer};
use super::mesh::object_mesh;
use super::pixels::Background;
use super::prepared::PreparedPass;
use super::textures::{binding_sampler, plain_texture};
use super::values::PassCamera;
use lamplight_bundle::{Binding, BindingKind, Language, Reflection, Varying};
use lamplight_compose::resolve::{self, Packages};
use lamplight_compose::{self as compose, Composed, Options, SourceMap};
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_emit::reflect;
use lamplight_execute::fixture::Fixture;
use lamplight_execute::frame::{Buffers, PipelineState};
use lamplight_glsl::wgsl::Clip;
use lamplight_permute::Settings;
use lamplight_scenes::Shape;
use lamplight_scenes::sets::{Eye, Material, Object};
use lamplight_validate::{Validated, glsl_as_wgsl, of_translation, validate};

/// What an input can be given: a name, and the words in names of inputs that suggest it. The
/// vertex stage has a variable of each name, of type `vec3f`.
pub const SOURCES: &[(&str, &[&str])] = &[
    ("normal", &["normal", "n"]),
    ("tangent", &["tangent", "t"]),
    ("to_light", &["light", "lamp", "l"]),
    ("to_eye", &["eye", "view", "viewer", "camera", "v"]),
    ("half_way", &["half", "h"]),
    ("color", &["color", "colour", "albedo"]),
    ("uv", &["uv", "texcoord", "tex", "st"]),
    ("position", &["position", "pos", "world", "p"]),
    ("zero", &["zero"]),
    ("one", &["one"]),
];

/// A model, by its name.
pub type SketchModel = (&'static str, fn() -> Shape);

/// What there is to draw on. Each fits in a ball of radius 1.2 around the origin.
pub const MODELS: &[SketchModel] = &[
    ("sphere", || Shape::sphere(1.0, (96, 48))),
    ("torus", || Shape::torus(0.68, 0.32, (96, 48))),
    ("cube", || Shape::cuboid(DVec3::splat(0.6), 1)),
    ("vase", vase),
    ("plane", || {
        Shape::patch(DVec3::new(-0.8, 0.0, 0.8), DVec3::X * 1.6, DVec3::NEG_Z * 1.6, (1, 1))
    }),
];

fn vase() -> Shape {
    let profile = [(0.02, -0.9), (0.4, -0.9), (0.62, -0.4), (0.3, 0.25), (0.22, 0.6), (0.42, 0.9)];
    Shape::lathe(&profile.map(|(radius, height)| DVec2::new(radius, height)), (96, 64))
}

/// A fragment stage, ready to be drawn.
pub struct Sketch {
    stage: ReadyStage,
}

/// How it is drawn.
#[derive(Debug, Clone, Default)]
pub struct SketchOptions {
    /// One of [`MODELS`]; otherwise the first.
    pub model: String,
    /// How far the viewer has walked around the model, and how high, in radians.
    pub turn: [f64; 2],
    /// The place of the light, in world space.
    pub lamp: DVec3,
    /// Names of [`SOURCES`] by the names of inputs.
    pub inputs: BTreeMap<String, String>,
    /// Numbers by the paths of uniforms.
    pub uniforms: BTreeMap<String, Vec<f64>>,
}

/// How many trips the loops of a fragment may make. A text that never ends would otherwise stop the
/// device, and with it the browser.
const TRIPS: u32 = 4096;

/// Bytes of a uniform buffer that every device takes.
pub(crate) const UNIFORM_BYTES: u32 = 64 << 10;

/// How many uniforms get controls.
pub(crate) const LISTED: usize = 256;

/// The name that the stage has while it is drawn.
const ENTRY: &str = "fs_main";

impl Sketch {
    /// A fragment entry point of a text: the first, unless one is named. What runs leads back to
    /// the author's places. GLSL is translated.
    ///
    /// # Errors
    /// What is wrong with the text, and those of [`Self::new`].
    pub fn of_text(composed: &Composed, entry: Option<&str>) -> Result<Self, Diagnostics> {
        let translated = match composed.language {
            Language::Wesl => None,
            Language::Glsl => Some(glsl_as_wgsl(composed, Clip::Kept)?),
        };
        let read = translated.as_ref().unwrap_or(composed);
        let validated = validate(read).map_err(|errors| match translated.is_some() {
            true => errors.into_iter().map(of_translation).collect(),
            false => errors,
        })?;
        let map = Arc::new(read.map.clone());
        Self::made(validated, entry, read.text.as_str().into(), map)
            .map_err(|problem| vec![problem])
    }

    /// A fragment entry point of a module: the first, unless one is named.
    ///
    /// # Errors
    /// There is none of that name, or it returns no colour.
    pub fn new(validated: Validated, entry: Option<&str>) -> Result<Self, Diagnostic> {
        Self::made(validated, entry, "".into(), Arc::default())
    }

    fn made(
        mut validated: Validated,
        entry: Option<&str>,
        text: Arc<str>,
        map: Arc<SourceMap>,
    ) -> Result<Self, Diagnostic> {
        let is_fragment = |point: &&mut naga::EntryPoint| {
            point.stage == naga::ShaderStage::Fragment
                && entry.is_none_or(|entry| point.name == entry)
        };
        let points = &mut validated.module.entry_points;
        let name = points.iter_mut().find(is_fragment).map(|point| point.name.clone());
        let name =
            name.ok_or_else(|| sketch_refused("there is no fragment entry point to draw"))?;
        for point in points {
            if point.name == name {
                ENTRY.clone_into(&mut point.name);
            } else if point.name == ENTRY {
                point.name.clone_from(&name);
            }
        }
        let reflection = reflect(&validated, ENTRY)?;
        let written = Arc::new(validated.clone());
        bound_loops(&mut validated.module, TRIPS);
        let is_large = |one: &Binding| {
            one.kind == BindingKind::Uniform && one.size.is_none_or(|size| size > UNIFORM_BYTES)
        };
        if let Some(large) = reflection.bindings.iter().find(|one| is_large(one)) {
            let reason = format!("`{}` has more than {UNIFORM_BYTES} bytes", large.name);
            return Err(sketch_refused(&reason));
        }
        let is_color = |one: &Varying| one.location == Some(0) && one.ty == "vec4<f32>";
        if !reflection.outputs.iter().any(is_color) {
            return Err(sketch_refused(&format!("`{name}` returns no `vec4f` at location 0")));
        }
        let validated = Arc::new(validated);
        let functions = Arc::from(Vec::new());
        let entry = ENTRY;
        let stage = ReadyStage { validated, entry, reflection, text, map, written, functions };
        Ok(Self { stage })
    }

    /// The inputs with the names of their sources.
    pub fn inputs(&self, setting: &SketchOptions) -> Vec<(String, String, &'static str)> {
        let located = self.stage.reflection.inputs.iter().filter(|one| one.location.is_some());
        located.map(|one| (input_label(one), one.ty.clone(), source_of(one, setting))).collect()
    }

    /// The uniforms with their numbers, as many as a page has room for. Matrices are left out.
    pub fn uniforms(&self, setting: &SketchOptions) -> Vec<Uniform> {
        let blocks =
            self.stage.reflection.bindings.iter().filter(|one| one.kind == BindingKind::Uniform);
        let uniform = |leaf: BufferLeaf<'_>| Uniform {
            program: String::new(),
            numbers: uniform_numbers(setting, &leaf.path, leaf.ty),
            ty: leaf.ty.to_owned(),
            path: leaf.path,
        };
        let leaves = blocks.flat_map(buffer_leaves).filter(|leaf| !leaf.ty.starts_with("mat"));
        leaves.take(LISTED).map(uniform).collect()
    }

    /// The sketch on its model, ready to be photographed.
    ///
    /// # Errors
    /// A binding that nothing can be bound to, and an input that no vertex stage can give.
    pub fn prepare(
        &self,
        setting: &SketchOptions,
        shot: &Shot,
    ) -> Result<PreparedPass, Diagnostics> {
        let vertex = vertex_stage(vertex_text(&self.stage.reflection, setting))?;
        let eye = PassCamera::of_viewer(&turned_eye(setting.turn), shot);
        let (mut buffers, mut fixtures) = (Buffers::new(), BTreeMap::new());
        for binding in &self.stage.reflection.bindings {
            let place = (binding.group, binding.binding);
            match bound_input(binding, setting, shot).map_err(|problem| vec![problem])? {
                SketchBinding::Buffer(bytes) => drop(buffers.insert(place, bytes)),
                SketchBinding::Fixture(fixture) => drop(fixtures.insert(place, Arc::new(fixture))),
            }
        }
        let own = |name: &str| {
            vertex.reflection.bindings.iter().find(|binding| binding.name == name).cloned()
        };
        if let Some(binding) = own("around") {
            let lamp = setting.lamp.to_array().to_vec();
            let bytes = pack_buffer(&binding, &|_| Some(lamp.clone()));
            let place = (binding.group, binding.binding);
            buffers.insert(place, bytes.map_err(|problem| vec![problem])?);
        }
        let camera = own("camera");
        let mesh = object_mesh(&model(&setting.model), &vertex.reflection, false, None);
        Ok(PreparedPass {
            stages: Stages { vertex, fragment: Some(self.stage.clone()) },
            items: vec![(mesh, Buffers::new())],
            buffers,
            fixtures,
            levels: BTreeMap::new(),
            state: PipelineState { depth_test: true, ..PipelineState::default() },
            plain: Vec::new(),
            camera,
            eye,
            background: Background::backdrop(eye),
            encoded: false,
            fine: 1,
            farther: Vec::new(),
            blended: None,
        })
    }
}

fn sketch_refused(message: &str) -> Diagnostic {
    Diagnostic::error(codes::PICTURE_INVALID, message)
}

fn model(name: &str) -> Object {
    let (_, shape) = MODELS.iter().find(|(known, _)| *known == name).unwrap_or(&MODELS[0]);
    white_object(shape())
}

/// A shape of the colour white at the origin.
pub(crate) fn white_object(shape: Shape) -> Object {
    Object::made(shape, DMat4::IDENTITY, DVec3::ONE, Material::default())
}

/// The viewer, who has walked around the model and up, by angles in radians.
pub(crate) fn turned_eye([around, up]: [f64; 2]) -> Eye {
    let up = up.clamp(0.05 - FRAC_PI_2, FRAC_PI_2 - 0.05);
    let turned = DQuat::from_rotation_y(around) * DQuat::from_rotation_x(-up);
    Eye { position: turned * DVec3::Z * 4.0, target: DVec3::ZERO, fov_y: 0.6, near: 0.5, far: 10.0 }
}

/// The name of an input, or its place.
pub(crate) fn input_label(input: &Varying) -> String {
    let place = || format!("location({})", input.location.unwrap_or_default());
    input.name.clone().unwrap_or_else(place)
}

/// The source of an input: the one that was chosen, or that its name suggests.
fn source_of(input: &Varying, setting: &SketchOptions) -> &'static str {
    let name = input_label(input);
    let chosen = setting.inputs.get(&name);
    if let Some((source, _)) =
        SOURCES.iter().find(|(source, _)| Some(*source) == chosen.map(String::as_str))
    {
        return source;
    }
    let name = name.to_lowercase();
    let has = |word: &&str| name.split('_').any(|part| part == *word);
    match SOURCES.iter().find(|(_, words)| words.iter().any(has)) {
        Some((source, _)) => source,
        None if input.ty.starts_with("vec2") => "uv",
        None => "position",
    }
}

fn uniform_numbers(setting: &SketchOptions, path: &str, ty: &str) -> Vec<f64> {
    let digit =
        |at: usize| ty.as_bytes().get(at).map_or(1, |one| usize::from(one.wrapping_sub(48)));
    if ty.starts_with("mat") {
        let (columns, rows) = (digit(3), digit(5));
        let entry = |index: usize| f64::from(u8::from(index / rows.max(1) == index % rows.max(1)));
        return (0..columns * rows).map(entry).collect();
    }
    let count = if ty.starts_with("vec") { digit(3) } else { 1 };
    // Numbers that were chosen before the type changed do not fit any more.
    match setting.uniforms.get(path).filter(|numbers| numbers.len() == count) {
        Some(numbers) => numbers.clone(),
        None => vec![if is_integer(ty) { 1.0 } else { 0.5 }; count],
    }
}

fn is_integer(ty: &str) -> bool {
    ty.contains("i32") || ty.contains("u32")
}

enum SketchBinding {
    Buffer(Vec<u8>),
    Fixture(Fixture),
}

fn bound_input(
    binding: &Binding,
    setting: &SketchOptions,
    shot: &Shot,
) -> Result<SketchBinding, Diagnostic> {
    match binding.kind {
        BindingKind::Uniform => {
            let leaves: BTreeMap<String, Vec<f64>> = buffer_leaves(binding)
                .into_iter()
                .map(|leaf| (leaf.path.clone(), uniform_numbers(setting, &leaf.path, leaf.ty)))
                .collect();
            Ok(SketchBinding::Buffer(pack_buffer(binding, &|path| leaves.get(path).cloned())?))
        }
        BindingKind::Sampler | BindingKind::ComparisonSampler => {
            Ok(SketchBinding::Fixture(binding_sampler(binding)))
        }
        BindingKind::Texture => plain_texture(&binding.name, &binding.ty, &shot.surroundings)
            .map(|texture| SketchBinding::Fixture(Fixture::Texture(texture)))
            .ok_or_else(|| unbound(binding)),
        BindingKind::Storage | BindingKind::StorageTexture | BindingKind::Immediate => {
            Err(unbound(binding))
        }
    }
}

fn unbound(binding: &Binding) -> Diagnostic {
    sketch_refused(&format!(
        "nothing can be bound to `{}: {}` in a sketch",
        binding.name, binding.ty
    ))
}

/// The vertex stage `vs_main` of a text in WESL.
///
/// # Errors
/// Those of naga, for an input whose type no vertex stage can give.
pub(crate) fn vertex_stage(text: String) -> Result<ReadyStage, Diagnostics> {
    const PATH: &str = "vertex.wesl";
    let packages = Packages::of_text(PATH, text);
    let graph = resolve::load(&mut SourceSet::default(), &packages, PATH, Language::Wesl)?;
    let composed = compose::compose(&graph, &Settings::default(), &Options::default())?;
    let validated = Arc::new(validate(&composed)?);
    let reflection = reflect(&validated, "vs_main").map_err(|problem| vec![problem])?;
    Ok(ReadyStage::made(validated, "vs_main", reflection, composed.text.into()))
}

/// The vertex stage that gives a fragment stage what it asks for.
fn vertex_text(fragment: &Reflection, setting: &SketchOptions) -> String {
    let is_taken =
        |place: &u32| fragment.bindings.iter().any(|one| one.group == 0 && one.binding == *place);
    let mut free = (0..).filter(|place| !is_taken(place));
    let [camera, around] = [(); 2].map(|()| free.next().unwrap_or_default());
    let (outputs, lines) = given_inputs(fragment, &|input| given_value(input, setting));
    format!(
        "struct Camera {{
    clip_from_world: mat4x4f,
    world_from_view: mat4x4f,
}}
struct Around {{
    lamp: vec3f,
}}
@group(0) @binding({camera}) var<uniform> camera: Camera;
@group(0) @binding({around}) var<uniform> around: Around;
struct Given {{
    @builtin(position) clip: vec4f,
{outputs}}}
@vertex
fn vs_main(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec3f,
    @location(3) st: vec2f,
    @location(5) along: vec4f,
) -> Given {{
    let uv = vec3f(st, 0.0);
    let tangent = along.xyz;
    let to_light = around.lamp - position;
    let to_eye = camera.world_from_view[3].xyz - position;
    let half_way = normalize(normalize(to_light) + normalize(to_eye));
    let zero = vec3f(0.0);
    let one = vec3f(1.0);
    var given: Given;
    given.clip = camera.clip_from_world * vec4f(position, 1.0);
{lines}    return given;
}}
"
    )
}

/// The outputs of a vertex stage that gives a fragment stage its inputs, and the statements that
/// write them. `value` is the expression for an input.
pub(crate) fn given_inputs(
    fragment: &Reflection,
    value: &dyn Fn(&Varying) -> String,
) -> (String, String) {
    let (mut outputs, mut lines) = (String::new(), String::new());
    for input in &fragment.inputs {
        let Some(location) = input.location else { continue };
        let (ty, interpolation) = (&input.ty, interpolation_text(input));
        let _ =
            writeln!(outputs, "    @location({location}) {interpolation}given_{location}: {ty},");
        let _ = writeln!(lines, "    given.given_{location} = {};", value(input));
    }
    (outputs, lines)
}

fn interpolation_text(input: &Varying) -> String {
    match (input.interpolation.as_deref(), input.sampling.as_deref()) {
        (Some(kind), Some(sampling)) => format!("@interpolate({kind}, {sampling}) "),
        (Some(kind), None) => format!("@interpolate({kind}) "),
        (None, _) if is_integer(&input.ty) => "@interpolate(flat) ".to_owned(),
        (None, _) => String::new(),
    }
}

fn given_value(input: &Varying, setting: &SketchOptions) -> String {
    let (ty, source) = (&input.ty, source_of(input, setting));
    match ty.as_bytes().get(3) {
        Some(b'2') if ty.starts_with("vec") => format!("{ty}({source}.xy)"),
        Some(b'3') if ty.starts_with("vec") => format!("{ty}({source})"),
        Some(b'4') if ty.starts_with("vec") => format!("{ty}(vec4f({source}, 1.0))"),
        _ => format!("{ty}({source}.x)"),
    }
}
