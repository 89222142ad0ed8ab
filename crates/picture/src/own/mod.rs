//! A user's own shader on the screen.
//!
//! `texts -> stages -> what they ask for, and what they get -> prepared pass -> picture`
//!
//! A fragment stage alone gets a vertex stage that is made for it ([`made`]). An own vertex stage gets
//! the attributes of a mesh by their names ([`attributes`]). Uniforms are what somebody gave
//! ([`values`]), or else what their names mean ([`defaults`], [`matrices`]), or else zero. The
//! [table](table) says which.
//!
//! Shaders for OpenGL count pixels from the bottom. They are drawn upside down, so that coordinates,
//! derivatives and the sides of triangles are those of OpenGL, and the picture is turned afterwards.

mod around;
mod attributes;
mod bindings;
mod defaults;
mod file;
mod images;
mod inputs;
mod made;
mod matrices;
mod models;
mod placed;
mod shape;
mod stages;
pub mod table;
mod textures;
mod values;
mod words;

pub use attributes::MOST as MOST_VERTICES;
pub use defaults::{UniformRole, uniform_role};
pub use file::{OwnSettings, read_settings};
pub use images::decode_image;
pub use inputs::SOURCES;
pub use models::{model_names, named_scene, turned_scene};
pub use stages::{OwnStage, OwnStages, OwnText, choose_stages};
pub use textures::{NAMED as NAMED_TEXTURES, holds_numbers, named_sky, named_texture};
pub use values::{GivenValue, UniformValue, parse_value};

use std::collections::BTreeMap;

use glam::{DMat4, DVec3};

use lamplight_bundle::{Binding, Varying};
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_emit::reflect;
use lamplight_execute::Session;
use lamplight_execute::frame::{Buffers, Mesh, PipelineState};
use lamplight_execute::raster::Measure;
use lamplight_scenes::sets::{Object, Scene, TextureMap};

use self::around::{Around, around_of};
use self::attributes::{attribute_mesh, clip_square, indexed_mesh, vertex_count};
use self::bindings::BoundStages;
use self::inputs::{Hint, Source, attribute_source, chosen_source};
use self::shape::{NumberType, short_type};
use self::table::{Origin, Row, RowKind};
use crate::controls::Uniform;
use crate::frame::{ReadyStage, Stages};
use crate::heat::HeatMap;
use crate::mesh::object_mesh;
use crate::pixels::Background;
use crate::prepared::{PictureFragment, PreparedPass};
use crate::sketch::{input_label, white_object};
use crate::values::PassCamera;
use crate::{Picture, Shot, Surroundings};

/// What is drawn with a user's shader, and how.
pub struct OwnRequest {
    /// The model or scene; `None` for what fits the stages.
    pub scene: Option<Scene>,
    /// Values of uniforms. Options take precedence over files.
    pub given: Vec<GivenValue>,
    /// Textures by name.
    pub textures: BTreeMap<String, GivenTexture>,
    /// Seconds.
    pub time: f64,
    /// Whether the shader returns linear light, which is then encoded for the display.
    pub linear: bool,
    /// How many vertices a stage makes that only reads their index.
    pub vertices: Option<u32>,
    /// The names of [`SOURCES`] that inputs of a lone fragment stage are taken from, by the names of
    /// the inputs. The others have the one that their name suggests.
    pub inputs: BTreeMap<String, String>,
}

/// A texture that somebody gave.
#[derive(Clone)]
pub struct GivenTexture {
    pub content: TextureContent,
    /// As it was written.
    pub text: String,
    pub origin: Origin,
    /// Its place in a file.
    pub span: Option<Span>,
}

/// What a texture holds.
#[derive(Clone)]
pub enum TextureContent {
    Map(TextureMap),
    /// For a cube.
    Sky(Surroundings),
}

/// A user's shader, ready to be drawn.
pub struct OwnPicture {
    pass: PreparedPass,
    /// What the shader was given.
    pub rows: Vec<Row>,
    /// What a person has to know beside the rows.
    pub notes: Vec<String>,
    /// Whether it is drawn over the whole picture, and not on a model.
    pub is_flat: bool,
    /// The uniforms with their numbers, as many as a page has room for. Matrices are left out.
    pub uniforms: Vec<Uniform>,
    is_upside_down: bool,
}

/// The error about a shader that cannot be drawn.
pub(crate) fn refused(message: &str) -> Diagnostic {
    Diagnostic::error(codes::PICTURE_INVALID, message)
}

/// An error about a value or a texture that somebody gave, at its place in a file if it is from one.
fn at_given(error: Diagnostic, span: Option<Span>) -> Diagnostic {
    match span {
        Some(span) => error.at(span, "given here"),
        None => error,
    }
}

/// What the stages are drawn on.
enum Ground {
    /// A triangle over the picture.
    Triangle,
    /// The square of clip space.
    Square,
    /// As many vertices without attributes.
    Indices(u32),
    Model,
}

/// Makes stages ready to be drawn.
///
/// # Errors
/// A value or a texture for something that no stage has, or that does not fit; a binding that nothing
/// can be bound to, at its place.
pub fn prepare_own(
    stages: &OwnStages,
    request: &OwnRequest,
    shot: &Shot,
) -> Result<OwnPicture, Diagnostics> {
    let ground = ground_of(stages, request);
    let usual = models::default_scene();
    let scene = request.scene.as_ref().unwrap_or(&usual);
    let bound = BoundStages::new(stages, request, shot)?;
    let clip = stages.vertex.as_ref().unwrap_or(&stages.fragment).clip;
    let mut around = around_of(scene.eye, &scene.lamps, clip, request.time, shot);
    (around.seen_normals, around.seen_model) = bound.seen_matrices();
    let (vertex, camera) = match &stages.vertex {
        None => made_stage(&stages.fragment.ready, &ground, &request.inputs)?,
        Some(vertex) => placed_stage(stages, &vertex.ready)?,
    };
    let objects = ground_objects(&ground, scene);
    let item = |object: &Object| {
        let around = around.of_object(object);
        let mut buffers = bound.buffers(&around)?;
        if stages.vertex.is_none() {
            buffers.extend(made_buffers(&vertex, object, &around)?);
        }
        Ok((ground_mesh(&ground, stages, object, &vertex), buffers))
    };
    let items: Vec<(Mesh, Buffers)> =
        objects.iter().map(item).collect::<Result<_, Diagnostics>>()?;
    let first = objects.first().map_or_else(|| around.clone(), |object| around.of_object(object));
    let ((rows, notes), uniforms) = (bound.rows(&first), bound.uniforms(&first));
    let rows = input_rows(stages, &request.inputs).into_iter().chain(rows).collect();
    let (is_flat, is_upside_down) = (!matches!(ground, Ground::Model), stages.is_for_opengl());
    let (eye, background) = viewer(stages, scene, shot);
    let pass = PreparedPass {
        stages: Stages { vertex, fragment: Some(stages.fragment.ready.clone()) },
        items,
        buffers: bound.shared,
        fixtures: bound.fixtures,
        levels: bound.levels,
        state: state_of(is_flat, is_upside_down),
        plain: Vec::new(),
        camera,
        eye,
        background,
        encoded: !request.linear,
        fine: 1,
        farther: Vec::new(),
        blended: None,
    };
    Ok(OwnPicture { pass, rows, notes, is_flat, uniforms, is_upside_down })
}

fn state_of(is_flat: bool, is_upside_down: bool) -> PipelineState {
    PipelineState { depth_test: !is_flat, mirrored: is_upside_down, ..PipelineState::default() }
}

/// A sky is drawn at the far plane itself, where only a test that lets equal depths pass shows it. So
/// all depths of an author's stage are a little smaller.
const BEFORE_FAR: f64 = 1.0 - 1e-5;

/// The matrix that the positions of the vertex stage are multiplied with, and what is behind
/// everything. An own stage has its own projection, so only the turn of the picture is left.
fn viewer(stages: &OwnStages, scene: &Scene, shot: &Shot) -> (PassCamera, Background) {
    let eye = PassCamera::of_viewer(&scene.eye, shot);
    let up = if stages.is_for_opengl() { -1.0 } else { 1.0 };
    let clip_from_world = match &stages.vertex {
        None => DMat4::from_scale(DVec3::new(1.0, up, 1.0)) * eye.clip_from_world,
        Some(_) => DMat4::from_scale(DVec3::new(1.0, up, BEFORE_FAR)),
    };
    (PassCamera { clip_from_world, ..eye }, Background::backdrop(eye))
}

impl OwnPicture {
    /// The pass that draws it, and whether the rows of its picture come in the other order.
    pub fn into_pass(self) -> (PreparedPass, bool) {
        (self.pass, self.is_upside_down)
    }

    /// Draws it.
    ///
    /// # Errors
    /// The painter's.
    pub fn take(&self, painter: &dyn Session, shot: &Shot) -> Result<Picture, Diagnostics> {
        let picture = self.pass.photograph(painter, shot)?.develop();
        Ok(if self.is_upside_down { picture.upside_down() } else { picture })
    }

    /// Measures the fragment that each pixel shows.
    ///
    /// # Errors
    /// Those of [`PreparedPass::measure`].
    pub fn measure(&self, measure: &Measure, shot: &Shot) -> Result<HeatMap, Diagnostics> {
        let map = self.pass.measure(measure, shot)?;
        Ok(if self.is_upside_down { map.upside_down() } else { map })
    }

    /// The fragments that cover a pixel of the picture, the visible one first.
    ///
    /// # Errors
    /// Those of [`PreparedPass::fragments_at`].
    pub fn fragments_at(
        &self,
        [x, y]: [u32; 2],
        shot: &Shot,
    ) -> Result<Vec<PictureFragment>, Diagnostics> {
        let row = if self.is_upside_down { shot.size[1].saturating_sub(1 + y) } else { y };
        self.pass.fragments_at([x, row], shot)
    }
}

fn ground_of(stages: &OwnStages, request: &OwnRequest) -> Ground {
    let is_free = request.scene.is_none();
    let Some(vertex) = &stages.vertex else {
        let is_flat = is_free && made::is_flat(&stages.fragment.ready.reflection);
        return if is_flat { Ground::Triangle } else { Ground::Model };
    };
    let reflection = &vertex.ready.reflection;
    let located = || reflection.inputs.iter().filter(|input| input.location.is_some());
    if located().next().is_none() {
        let made = vertex_count(&vertex.ready.validated.module);
        return Ground::Indices(request.vertices.unwrap_or(made));
    }
    let is_planar = located().any(|input| {
        attribute_source(input).0 == Source::Position && NumberType::of(&input.ty).rows == 2
    });
    let has_matrix = reflection.bindings.iter().any(bindings::has_matrix);
    if is_free && (is_planar || !has_matrix) { Ground::Square } else { Ground::Model }
}

fn ground_objects(ground: &Ground, scene: &Scene) -> Vec<Object> {
    match ground {
        Ground::Model => scene.objects.clone(),
        Ground::Square | Ground::Triangle | Ground::Indices(_) => {
            vec![white_object(clip_square())]
        }
    }
}

fn ground_mesh(ground: &Ground, stages: &OwnStages, object: &Object, vertex: &ReadyStage) -> Mesh {
    match (ground, &stages.vertex) {
        (Ground::Triangle, _) => Mesh::default(),
        (Ground::Indices(count), _) => indexed_mesh(*count),
        (_, Some(own)) => attribute_mesh(object, &own.ready.reflection),
        (_, None) => object_mesh(object, &vertex.reflection, false, None),
    }
}

type StageWithCamera = (ReadyStage, Option<Binding>);

/// The vertex stage that is made for a fragment stage.
fn made_stage(
    fragment: &ReadyStage,
    ground: &Ground,
    inputs: &BTreeMap<String, String>,
) -> Result<StageWithCamera, Diagnostics> {
    let is_flat = matches!(ground, Ground::Triangle);
    let vertex = made::made_vertex(&fragment.reflection, is_flat, inputs)?;
    let camera = vertex.reflection.bindings.iter().find(|one| one.name == "camera").cloned();
    Ok((vertex, camera))
}

/// The author's vertex stage, with the matrix that moves its positions.
fn placed_stage(stages: &OwnStages, vertex: &ReadyStage) -> Result<StageWithCamera, Diagnostics> {
    let fragment = &stages.fragment.ready.reflection;
    let taken = |place: &(u32, u32)| {
        let mut all = vertex.reflection.bindings.iter().chain(&fragment.bindings);
        all.any(|one| (one.group, one.binding) == *place)
    };
    let place = (0..).map(|binding| (0, binding)).find(|place| !taken(place)).unwrap_or_default();
    let validated = placed::placed_vertex(&vertex.validated, place).map_err(|error| vec![error])?;
    let reflection = reflect(&validated, vertex.entry).map_err(|error| vec![error])?;
    let is_it = |one: &&Binding| (one.group, one.binding) == place;
    let camera = reflection.bindings.iter().find(is_it).cloned();
    let camera = camera.map(|one| Binding { name: placed::PLACE.to_owned(), ..one });
    Ok((ReadyStage { validated: validated.into(), reflection, ..vertex.clone() }, camera))
}

/// The buffers of the made vertex stage, but that of the camera.
fn made_buffers(
    vertex: &ReadyStage,
    object: &Object,
    around: &Around<'_>,
) -> Result<Buffers, Diagnostics> {
    let columns = |matrix: DMat4| matrix.to_cols_array().to_vec();
    let number = |path: &str| {
        let normals = || DMat4::from_mat3(lamplight_scene::normal_matrix(object.world_from_object));
        Some(match path {
            "object.world_from_object" => columns(object.world_from_object),
            "object.normal_from_object" => columns(normals()),
            "object.color" => object.color.extend(1.0).to_array().to_vec(),
            "around.view_from_world" => columns(around.step(1)),
            "around.light_from_world" => columns(around.light_from_world()),
            "around.lamp" => around.lamp(0).position.extend(1.0).to_array().to_vec(),
            "around.eye" => around.eye.position.extend(1.0).to_array().to_vec(),
            _ => return None,
        })
    };
    let own = vertex.reflection.bindings.iter().filter(|one| one.name != "camera");
    let buffer = |binding: &Binding| {
        let bytes = crate::frame::pack_buffer(binding, &number).map_err(|error| vec![error])?;
        Ok(((binding.group, binding.binding), bytes))
    };
    own.map(buffer).collect()
}

/// A row for each input of the first stage.
fn input_rows(stages: &OwnStages, inputs: &BTreeMap<String, String>) -> Vec<Row> {
    let (kind, reflection) = match &stages.vertex {
        Some(vertex) => (RowKind::Attribute, &vertex.ready.reflection),
        None => (RowKind::Input, &stages.fragment.ready.reflection),
    };
    let located = reflection.inputs.iter().filter(|input| input.location.is_some());
    let row = |input: &Varying| {
        let (source, hint) = match kind {
            RowKind::Attribute => attribute_source(input),
            _ => chosen_source(input, inputs),
        };
        let from = match hint {
            Hint::Chosen => Origin::Option,
            Hint::Name => Origin::Name,
            Hint::Type => Origin::Type,
            Hint::Nothing => Origin::Zero,
        };
        let (name, ty) = (input_label(input), short_type(&input.ty));
        Row { kind, name, ty, value: source.text().to_owned(), from }
    };
    located.map(row).collect()
}
