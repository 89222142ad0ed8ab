//! Models of users: a glTF file as a scene.
//!
//! `bytes -> document -> meshes in their places, lamps, textures -> scene`
//!
//! What the programs do not have is left out, and a note says so. What is broken is an error that
//! names its place in the document. All memory is bounded by [`limits`](lamplight_files::limits).

mod accessor;
mod bake;
mod base;
mod channels;
mod deform;
mod document;
mod files;
mod mesh;
mod nodes;
mod surface;
mod tangents;
mod texture;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::{DVec3, DVec4};

pub use self::files::Files;
use self::files::{BufferBytes, buffer_bytes, structure_bytes};
pub use self::surface::Lacks;
use self::surface::Means;
use self::texture::Sheet;
use crate::sets::{Eye, Lamp, LampKind, Scene};
use lamplight_files::limits::{MODEL_BYTES, MODEL_JSON_BYTES};
use lamplight_validate::catch_panics;

/// A model, ready to be drawn.
#[derive(Debug)]
pub struct Model {
    pub scene: Scene,
    /// Width over height of what its camera shows, if the document says so.
    pub aspect: Option<f64>,
    /// What was left out, each once.
    pub notes: BTreeSet<String>,
    /// Values of the axes of `forward` that show it, such as `specular=ggx`.
    pub axes: Vec<String>,
    /// Values of its axes that show the layers of the materials, such as `clearcoat=true`, and the
    /// textures that multiply their factors.
    pub layers: Vec<String>,
    /// The textures that at least one material has, by the names of their bindings.
    textures: BTreeSet<&'static str>,
    /// The means of the textures of each object.
    means: Vec<Means>,
}

impl Model {
    /// Widens the view for a picture of another form than the camera's, so that it shows all that
    /// the camera does (glTF 2.0, 3.10.2). `shape` is its width over its height.
    pub fn fit(&mut self, shape: f64) {
        let eye = &mut self.scene.eye;
        if let Some(aspect) = self.aspect.filter(|aspect| *aspect > shape) {
            let half = (0.5 * eye.fov_y).tan() * aspect / shape;
            eye.fov_y = (2.0 * half.atan()).min(3.0);
        }
    }

    /// The scene for a permutation. The means of textures that the permutation does not have are
    /// multiplied into the factors of the materials. The second value is a note that lists such
    /// textures, if there are any.
    pub fn scene_of(mut self, lacks: Lacks) -> (Scene, Option<String>) {
        for (object, means) in self.scene.objects.iter_mut().zip(&self.means) {
            means.apply(&mut object.material, lacks);
        }
        let shown = |name: &&&str| match **name {
            "base_map" | "normal_map" => false,
            "occlusion_map" => lacks.occlusion,
            _ => lacks.maps,
        };
        let names: Vec<&str> = self.textures.iter().filter(shown).copied().collect();
        let note = "textures that the permutation does not have count with their mean, and those of \
            extensions not at all";
        (self.scene, (!names.is_empty()).then(|| format!("{note}: {}", names.join(", "))))
    }
}

/// From where a model is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum View {
    /// The first camera of the model, or a place before it that sees all of it.
    Own,
    /// The camera with that number in the document.
    Camera(usize),
    /// A place and what is looked at.
    At(DVec3, DVec3),
}

/// A document that is being read, and what is gathered from it.
struct GltfReader<'b> {
    document: &'b gltf::Document,
    buffers: &'b [BufferBytes<'b>],
    files: &'b Files<'b>,
    notes: BTreeSet<String>,
    /// Means of images, by number and whether they are colours.
    means: BTreeMap<(usize, bool), DVec4>,
    /// Pixels of images, counted each time that one is decoded.
    decoded: u64,
    /// How many vertices morph targets and joints have moved, counted for each of these.
    moved: usize,
    /// Whether no material that is drawn is lit.
    all_unlit: bool,
}

/// Reads a glTF file without others beside it: binary, or a document whose data are in it.
///
/// # Errors
/// Those of [`read_model_beside`].
pub fn read_model(bytes: &[u8], view: View) -> Result<Model, String> {
    read_model_beside(bytes, view, &|path| Err(format!("`{path}` is not read")))
}

/// Reads a glTF file: binary (`.glb`), or a document (`.gltf`). `files` reads those that it names.
///
/// # Errors
/// In words, with the place in the document: a file that is not glTF, or that is broken or too
/// large.
pub fn read_model_beside(bytes: &[u8], view: View, files: &Files<'_>) -> Result<Model, String> {
    if bytes.len() as u64 > MODEL_BYTES {
        return Err(format!("{} bytes are more than {MODEL_BYTES}", bytes.len()));
    }
    let (json, blob) = document_and_bytes(bytes)?;
    if structure_bytes(json) > MODEL_JSON_BYTES {
        return Err(format!("its document has more bytes than {MODEL_JSON_BYTES}"));
    }
    // The crate that reads documents panics at some that are broken.
    let read = || -> Result<Model, String> {
        let mut notes = BTreeSet::new();
        let document = document::read_document(json, &mut notes)?;
        let buffers = buffer_bytes(&document, blob, files)?;
        let (document, buffers) = (&document, &buffers[..]);
        let mut reader = GltfReader {
            document,
            buffers,
            files,
            notes,
            means: BTreeMap::new(),
            decoded: 0,
            moved: 0,
            all_unlit: false,
        };
        model_scene(&mut reader, view)
    };
    catch_panics(read).unwrap_or_else(|reason| Err(format!("the document is broken: {reason}")))
}

/// The JSON document of a file, and the bytes of the buffer in a binary one.
fn document_and_bytes(bytes: &[u8]) -> Result<(&[u8], &[u8]), String> {
    const HEADER: usize = 12;
    if !bytes.starts_with(b"glTF") {
        return match bytes.trim_ascii_start().first() {
            Some(b'{') => Ok((bytes, &[])),
            _ => {
                Err("the file is not a binary glTF file (`.glb`), nor a document of glTF"
                    .to_owned())
            }
        };
    }
    let version = word_at(bytes, 4)?;
    if version != 2 {
        return Err(format!("glTF of version {version} is not read, only of version 2"));
    }
    let (json, after) = chunk_bytes(bytes, HEADER, b"JSON")?;
    if after + 8 > bytes.len() {
        return Ok((json, &[]));
    }
    let length = json.len();
    let unpadded = format!(
        "the chunk at byte {HEADER} has {length} bytes; glTF wants multiples of 4, filled with spaces"
    );
    let (blob, _) = chunk_bytes(bytes, after, b"BIN\0")
        .map_err(|problem| if length.is_multiple_of(4) { problem } else { unpadded })?;
    Ok((json, blob))
}

/// The bytes of the chunk that begins at a place, and where the next one begins.
fn chunk_bytes<'b>(
    bytes: &'b [u8],
    at: usize,
    kind: &[u8; 4],
) -> Result<(&'b [u8], usize), String> {
    let length = word_at(bytes, at)? as usize;
    let end = (at + 8).checked_add(length).filter(|end| *end <= bytes.len());
    let end = end
        .ok_or_else(|| format!("the chunk at byte {at} has {length} bytes, more than the file"))?;
    if &bytes[at + 4..at + 8] != kind {
        return Err(format!("the chunk at byte {at} is not `{}`", kind.escape_ascii()));
    }
    Ok((&bytes[at + 8..end], end.next_multiple_of(4)))
}

fn word_at(bytes: &[u8], at: usize) -> Result<u32, String> {
    let four = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
    four.map(u32::from_le_bytes).ok_or_else(|| format!("the file ends at byte {}", bytes.len()))
}

fn model_scene(reader: &mut GltfReader<'_>, view: View) -> Result<Model, String> {
    let placed = nodes::walk_scene(reader)?;
    reader.all_unlit = drawn_materials(reader.document, &placed).all(|one| one.unlit());
    let sheet = texture::texture_sheet(reader, &placed)?;
    let mut found = Vec::new();
    let mut corners = 0;
    let skins = deform::skins(reader, &placed)?;
    for part in &placed.parts {
        found.extend(mesh::mesh_objects(reader, (part, &skins), &sheet, &mut corners)?);
    }
    let (objects, means): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    if objects.is_empty() {
        return Err(no_triangles(reader.document));
    }
    let bounds = nodes::bounding_ball(&objects);
    let camera = model_camera(&placed, view)?;
    let eye = model_eye(camera, &bounds, view);
    if is_too_far(&bounds, &eye) {
        reader.notes.insert(format!(
            "it reaches further than {FARTHEST:e}, or is seen from further away: numbers of 32 bits \
             overflow there, and the picture may be empty"
        ));
    }
    if objects.iter().all(|object| object.seen_from(eye.position).is_empty()) {
        reader.notes.insert(
            "nothing is seen: all faces turn their backs to the viewer, and no material is \
             double-sided"
                .to_owned(),
        );
    }
    let (lamps, numbers) = nodes::model_lamps(reader, &placed, &bounds, &eye);
    let mut layers = if reader.all_unlit { Vec::new() } else { surface::layer_axes(&objects) };
    let is_mapped = |name: &&str| !matches!(*name, "base_map" | "normal_map" | "occlusion_map");
    if sheet.names.iter().any(is_mapped) {
        layers.push("material_maps=true".to_owned());
    }
    let is_given = !numbers.is_empty();
    let axes = model_axes(reader, &placed, &sheet, (&lamps, is_given));
    if sheet.names.contains("occlusion_map") {
        layers.push("occlusion=map".to_owned());
    }
    let mut scene = Scene::of_model(objects, eye, lamps);
    scene.lamp_numbers = numbers;
    scene.own_maps = sheet.maps.map(Arc::new);
    let aspect = camera.and_then(|camera| camera.aspect).filter(|aspect| *aspect > 0.0);
    let notes = std::mem::take(&mut reader.notes);
    Ok(Model { scene, aspect, notes, axes, layers, textures: sheet.names, means })
}

/// Why a model without triangles is not drawn.
fn no_triangles(document: &gltf::Document) -> String {
    if document.meshes().any(|mesh| mesh.primitives().next().is_some()) {
        return "nothing in the model is drawn: its scene has points and lines at most".to_owned();
    }
    "the model has no triangles".to_owned()
}

/// The farthest distance for which the functions of the library give finite results.
const FARTHEST: f64 = 1e9;

fn is_too_far(bounds: &nodes::Ball, eye: &Eye) -> bool {
    let reach = bounds.middle.length() + bounds.radius;
    [reach, eye.position.length(), eye.target.length()]
        .iter()
        .any(|far| far.is_nan() || *far > FARTHEST)
}

/// The materials of everything that is drawn.
fn drawn_materials<'d>(
    document: &'d gltf::Document,
    placed: &nodes::PlacedNodes,
) -> impl Iterator<Item = gltf::Material<'d>> {
    let meshes = placed.parts.iter().filter_map(|part| document.meshes().nth(part.mesh));
    meshes.flat_map(|mesh| mesh.primitives().map(|part| part.material()).collect::<Vec<_>>())
}

/// The values of axes for the model: microfacets as in glTF, as many lamps as there are, and
/// textures where there are any.
fn model_axes(
    reader: &GltfReader<'_>,
    placed: &nodes::PlacedNodes,
    sheet: &Sheet,
    (lamps, is_given): (&[Lamp], bool),
) -> Vec<String> {
    let mut drawn = drawn_materials(reader.document, placed);
    let masked = drawn.any(|material| surface::is_masked(&material)).then_some("alpha_test=true");
    if reader.all_unlit {
        let textured =
            if sheet.names.contains("base_map") { "base_map=true" } else { "base_map=false" };
        let mut chosen = ["lights=none", "ambient=none", textured].map(str::to_owned).to_vec();
        chosen.extend(masked.map(str::to_owned));
        return chosen;
    }
    let most = [1, 4, 10].into_iter().find(|most| lamps.len() <= *most).unwrap_or(10);
    let shadow = match lamps.first().map(|lamp| lamp.kind) {
        Some(LampKind::Directional) => "shadow=pcf_3x3,shadow_light=directional",
        Some(LampKind::Spot) => "shadow=pcf_3x3,shadow_light=spot",
        _ => "shadow=none",
    };
    // Metals and layers reflect their surroundings, and every surface does a little.
    let mut chosen = format!("specular=ggx,ambient=ibl,max_lights={most},{shadow}");
    let has = |kinds: &[LampKind]| is_given && lamps.iter().any(|lamp| kinds.contains(&lamp.kind));
    if has(&[LampKind::Point, LampKind::Spot]) {
        chosen += ",attenuation=range_gltf";
    }
    if has(&[LampKind::Spot]) {
        chosen += ",cone=cone_scale_offset";
    }
    if sheet.names.contains("base_map") {
        chosen += ",base_map=true";
    }
    if sheet.names.contains("normal_map") {
        chosen += ",normal_map=true";
    }
    if drawn_materials(reader.document, placed).any(|material| material.double_sided()) {
        chosen += ",two_sided=true";
    }
    chosen.split(',').chain(masked).map(str::to_owned).collect()
}

/// The camera of the document for a view. `None` if the view has another place.
fn model_camera(
    placed: &nodes::PlacedNodes,
    view: View,
) -> Result<Option<&nodes::GltfCamera>, String> {
    let index = match view {
        View::At(..) => return Ok(None),
        View::Own => return Ok(placed.cameras.first()),
        View::Camera(index) => index,
    };
    let camera = placed.cameras.iter().find(|camera| camera.index == index);
    let known = || placed.cameras.iter().map(|camera| camera.index.to_string());
    let missing = || match known().next() {
        None => "it has no camera in its scene".to_owned(),
        Some(_) => format!(
            "it has no camera {index} in its scene, only {}",
            known().collect::<Vec<_>>().join(", ")
        ),
    };
    camera.ok_or_else(missing).map(Some)
}

fn model_eye(camera: Option<&nodes::GltfCamera>, bounds: &nodes::Ball, view: View) -> Eye {
    let (near, far) = (0.005 * bounds.radius, 40.0 * bounds.radius);
    let looking = |position: DVec3, target: DVec3, fov_y: f64| Eye {
        position,
        target,
        fov_y,
        near,
        far: far.max(2.0 * position.distance(bounds.middle)),
    };
    match (camera, view) {
        (Some(camera), _) => camera.eye(bounds),
        (None, View::At(position, target)) => looking(position, target, 0.7),
        (None, View::Own | View::Camera(_)) => {
            let towards = DVec3::new(0.35, 0.28, 1.0).normalize();
            let position = bounds.middle + towards * bounds.radius / (0.5_f64 * 0.7).sin() * 1.02;
            looking(position, bounds.middle, 0.7)
        }
    }
}
