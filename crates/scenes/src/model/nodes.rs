//! Walks the nodes of a scene: meshes, cameras and lights with their transforms.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DMat4, DQuat, DVec3, DVec4};
use gltf::camera::Projection;
use gltf::khr_lights_punctual::Kind;
use serde_json::Value;

use super::GltfReader;
use crate::sets::{Eye, Lamp, LampKind, LampNumbers, Object};
use lamplight_files::limits::{MODEL_NESTING, MODEL_NODES};

/// A mesh and its transform to world space.
pub struct PlacedMesh {
    pub mesh: usize,
    pub world_from_mesh: DMat4,
    /// The number of its skin.
    pub skin: Option<usize>,
    /// The weights of its morph targets.
    pub weights: Vec<f64>,
}

/// A camera and its transform to world space.
pub struct GltfCamera {
    /// Its number in the document.
    pub index: usize,
    world_from_camera: DMat4,
    extent: Extent,
    /// Width over height of what it shows, if the document says so.
    pub aspect: Option<f64>,
    planes: (f64, Option<f64>),
}

/// How much a camera shows from bottom to top.
enum Extent {
    /// An angle, radians.
    Angle(f64),
    /// Half of a length, for an orthographic camera.
    HalfHeight(f64),
}

/// A light and its transform to world space.
struct GltfLight {
    /// Its colour times its intensity: in lux if it is directional, else in candela.
    color: DVec3,
    kind: LampKind,
    world_from_light: DMat4,
    numbers: LampNumbers,
}

/// All meshes, cameras and lights of a scene.
#[derive(Default)]
pub struct PlacedNodes {
    pub parts: Vec<PlacedMesh>,
    pub cameras: Vec<GltfCamera>,
    lights: Vec<GltfLight>,
    /// From each node to the world.
    pub worlds: BTreeMap<usize, DMat4>,
}

/// A ball around all vertices.
pub struct Ball {
    pub middle: DVec3,
    pub radius: f64,
}

/// Walks the scene that the document shows.
pub fn walk_scene(reader: &mut GltfReader<'_>) -> Result<PlacedNodes, String> {
    let document = reader.document;
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let roots = match scene {
        Some(scene) => scene.nodes().collect(),
        None => parentless(reader)?,
    };
    let mut placed = PlacedNodes::default();
    let mut open: Vec<_> = roots.into_iter().map(|node| (node, DMat4::IDENTITY, 0)).collect();
    open.reverse();
    let (mut seen, mut ancestors) = (0, Vec::new());
    while let Some((node, parent, depth)) = open.pop() {
        seen += 1;
        let place = format!("nodes[{}]", node.index());
        ancestors.truncate(depth);
        if ancestors.contains(&node.index()) {
            return Err(format!("{place}: the node is its own descendant"));
        }
        ancestors.push(node.index());
        if seen > MODEL_NODES || depth > MODEL_NESTING {
            return Err(format!(
                "{place}: more than {MODEL_NODES} nodes, or nesting deeper than {MODEL_NESTING}"
            ));
        }
        let own = node.transform().matrix().map(|column| column.map(f64::from));
        let world = parent * DMat4::from_cols_array_2d(&own);
        if !world.is_finite() {
            return Err(format!("{place}: its place is not finite"));
        }
        // A node that is hidden hides its descendants.
        if is_hidden(&node) {
            continue;
        }
        placed.worlds.entry(node.index()).or_insert(world);
        take_node(reader, &node, world, &mut placed)?;
        open.extend(node.children().map(|child| (child, world, depth + 1)));
    }
    Ok(placed)
}

/// The nodes that are no node's child, for a document without scenes.
fn parentless<'d>(reader: &mut GltfReader<'d>) -> Result<Vec<gltf::Node<'d>>, String> {
    let document = reader.document;
    let children: BTreeSet<usize> =
        document.nodes().flat_map(|node| node.children()).map(|child| child.index()).collect();
    let roots: Vec<_> = document.nodes().filter(|node| !children.contains(&node.index())).collect();
    if roots.is_empty() {
        return Err("the model has no scene".to_owned());
    }
    reader.notes.insert("it has no scene: all of its nodes are drawn".to_owned());
    Ok(roots)
}

/// Whether KHR_node_visibility hides a node.
fn is_hidden(node: &gltf::Node<'_>) -> bool {
    let value = node.extension_value("KHR_node_visibility");
    value.and_then(|own| own.get("visible")).and_then(Value::as_bool) == Some(false)
}

fn take_node(
    reader: &mut GltfReader<'_>,
    node: &gltf::Node<'_>,
    world: DMat4,
    placed: &mut PlacedNodes,
) -> Result<(), String> {
    if let Some(mesh) = node.mesh() {
        let weights = node.weights().or(mesh.weights()).unwrap_or_default();
        let at = |own: DMat4| PlacedMesh {
            mesh: mesh.index(),
            world_from_mesh: world * own,
            skin: node.skin().map(|skin| skin.index()),
            weights: weights.iter().map(|weight| f64::from(*weight)).collect(),
        };
        placed.parts.extend(mesh_instances(reader, node)?.into_iter().map(at));
        if placed.parts.len() > MODEL_NODES {
            return Err(format!("nodes[{}]: more than {MODEL_NODES} meshes", node.index()));
        }
    }
    let camera = node.camera();
    placed.cameras.extend(camera.map(|camera| placed_camera(&camera, world)));
    placed.lights.extend(node.light().map(|light| placed_light(&light, world)));
    Ok(())
}

fn placed_camera(camera: &gltf::Camera<'_>, world: DMat4) -> GltfCamera {
    let (extent, aspect, planes) = match camera.projection() {
        Projection::Perspective(view) => {
            let planes = (f64::from(view.znear()), view.zfar().map(f64::from));
            let angle = f64::from(view.yfov()).clamp(0.02, 3.0);
            (Extent::Angle(angle), view.aspect_ratio().map(f64::from), planes)
        }
        Projection::Orthographic(view) => {
            let [x, y] = [view.xmag(), view.ymag()].map(|size| f64::from(size).abs().max(1e-9));
            let planes = (f64::from(view.znear()), Some(f64::from(view.zfar())));
            (Extent::HalfHeight(y), Some(x / y), planes)
        }
    };
    GltfCamera { index: camera.index(), world_from_camera: world, extent, aspect, planes }
}

/// Where EXT_mesh_gpu_instancing repeats a node's mesh, in the space of the node: once, without it.
fn mesh_instances(reader: &GltfReader<'_>, node: &gltf::Node<'_>) -> Result<Vec<DMat4>, String> {
    // A skin has its place from its joints.
    let value = node.extension_value(INSTANCING).filter(|_| node.skin().is_none());
    let Some(value) = value else { return Ok(vec![DMat4::IDENTITY]) };
    let place = format!("nodes[{}].extensions.{INSTANCING}.attributes", node.index());
    let rows = |name: &str| -> Result<Option<Vec<[f64; 4]>>, String> {
        let Some(number) = value.get("attributes").and_then(|all| all.get(name)) else {
            return Ok(None);
        };
        let index = number.as_u64().and_then(|index| usize::try_from(index).ok());
        let accessor = index.and_then(|index| reader.document.accessors().nth(index));
        let missing = || format!("{place}.{name}: there is no accessor {number}");
        reader.rows(&accessor.ok_or_else(missing)?, &format!("{place}.{name}")).map(Some)
    };
    let parts = [rows("TRANSLATION")?, rows("ROTATION")?, rows("SCALE")?];
    let counts: Vec<usize> = parts.iter().flatten().map(Vec::len).collect();
    let Some(count) = counts.first().copied() else { return Ok(vec![DMat4::IDENTITY]) };
    if counts.iter().any(|other| *other != count) {
        return Err(format!("{place}: the attributes have not the same number of rows"));
    }
    let [moved, turned, scaled] = parts;
    let row = |part: &Option<Vec<[f64; 4]>>, index: usize, usual: [f64; 4]| {
        DVec4::from_array(part.as_ref().map_or(usual, |rows| rows[index]))
    };
    let instance = |index: usize| {
        let turn = DQuat::from_vec4(row(&turned, index, [0.0, 0.0, 0.0, 1.0]));
        let turn = if turn.length_squared() > 0.0 { turn.normalize() } else { DQuat::IDENTITY };
        DMat4::from_scale_rotation_translation(
            row(&scaled, index, [1.0; 4]).truncate(),
            turn,
            row(&moved, index, [0.0; 4]).truncate(),
        )
    };
    Ok((0..count).map(instance).collect())
}

/// The name of the extension.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// A light at the place of its node.
fn placed_light(light: &gltf::khr_lights_punctual::Light<'_>, world: DMat4) -> GltfLight {
    // The angles of lights that are no spots count for nothing.
    let (kind, inner, outer) = match light.kind() {
        Kind::Directional => (LampKind::Directional, 0.0, 0.7),
        Kind::Point => (LampKind::Point, 0.0, 0.7),
        Kind::Spot { inner_cone_angle, outer_cone_angle } => {
            (LampKind::Spot, f64::from(inner_cone_angle), f64::from(outer_cone_angle))
        }
    };
    GltfLight {
        color: DVec3::from_array(light.color().map(f64::from)) * f64::from(light.intensity()),
        kind,
        world_from_light: world,
        numbers: LampNumbers { inner, outer, range: light.range().map_or(0.0, f64::from) },
    }
}

/// A ball around the vertices of all objects.
pub fn bounding_ball(objects: &[Object]) -> Ball {
    let points = || {
        objects.iter().flat_map(|object| object.shape.vertices.iter().map(|vertex| vertex.position))
    };
    let (low, high) = points()
        .fold((DVec3::MAX, DVec3::MIN), |(low, high), point| (low.min(point), high.max(point)));
    let middle = 0.5 * (low + high);
    let radius = points().map(|point| point.distance(middle)).fold(0.0, f64::max);
    Ball { middle, radius: radius.max(1e-6) }
}

/// A lamp above the viewer's left shoulder, with all of the model in its cone.
fn key_lamp(bounds: &Ball, eye: &Eye) -> Lamp {
    let towards = (eye.position - bounds.middle).normalize_or(DVec3::Z);
    let left = DVec3::Y.cross(towards).normalize_or(DVec3::X) * -1.0;
    let direction = (1.2 * DVec3::Y + towards + 0.9 * left).normalize_or(DVec3::Y);
    let distance = 3.5 * bounds.radius;
    Lamp {
        color: DVec3::splat(1.0),
        position: bounds.middle + direction * distance,
        target: bounds.middle,
        half_angle: 1.15 * (bounds.radius / distance).asin(),
        kind: LampKind::Spot,
    }
}

/// The model's lamps with their numbers, at most ten; without any, one of our own.
pub fn model_lamps(
    reader: &mut GltfReader<'_>,
    placed: &PlacedNodes,
    bounds: &Ball,
    eye: &Eye,
) -> (Vec<Lamp>, Vec<LampNumbers>) {
    const MOST: usize = 10;
    if placed.lights.is_empty() {
        return (vec![key_lamp(bounds, eye)], Vec::new());
    }
    let count = placed.lights.len();
    if count > MOST {
        reader.notes.insert(format!("of {count} lamps, the first {MOST} are drawn"));
    }
    let lights = placed.lights.iter().take(MOST);
    let (lamps, numbers): (Vec<Lamp>, _) =
        lights.map(|light| (light.lamp(bounds), light.numbers)).unzip();
    reader.notes.extend(exposure_note(&lamps));
    (lamps, numbers)
}

/// The exposure for lamps that together are far too bright: a white surface in the middle of the
/// model has the sum of their colours.
fn exposure_note(lamps: &[Lamp]) -> Option<String> {
    /// Pictures show up to 1. Some more is a highlight.
    const BRIGHT: f64 = 8.0;
    let sum: DVec3 = lamps.iter().map(|lamp| lamp.color).sum();
    let brightest = sum.max_element();
    let stops = -brightest.log2().round();
    let note = "its lamps light a white surface with";
    (brightest > BRIGHT && stops.is_finite()).then(|| {
        format!("{note} {brightest:.0} times what a picture shows: try --exposure {stops}")
    })
}

impl GltfLight {
    fn lamp(&self, bounds: &Ball) -> Lamp {
        let position = self.world_from_light.transform_point3(DVec3::ZERO);
        let axis = self.world_from_light.transform_vector3(DVec3::NEG_Z);
        let axis = axis.normalize_or(DVec3::NEG_Y);
        let reach = position.distance(bounds.middle).max(0.1 * bounds.radius);
        let (position, target) = match self.kind {
            LampKind::Directional => (bounds.middle - axis * 3.0 * bounds.radius, bounds.middle),
            LampKind::Point => {
                (position, position + (bounds.middle - position).normalize_or(axis) * reach)
            }
            LampKind::Spot => (position, position + axis * reach),
        };
        // Candelas become lux at the target. A white diffuse surface reflects that over pi as
        // radiance.
        let falloff = if self.kind == LampKind::Directional { 1.0 } else { reach * reach };
        let color = self.color / falloff / std::f64::consts::PI;
        // The angle of a shadow map.
        let half_angle = self.numbers.outer.clamp(0.02, 1.5);
        Lamp { color, position, target, half_angle, kind: self.kind }
    }
}

/// From how far away an orthographic camera sees the middle of the model, as a multiple of what it shows
/// and of the model: a pixel of 1,000 is then off by one at the model's front and back.
const FAR_OFF: f64 = 1000.0;

impl GltfCamera {
    /// The camera as the viewer of the scene.
    pub fn eye(&self, bounds: &Ball) -> Eye {
        let position = self.world_from_camera.transform_point3(DVec3::ZERO);
        let ahead = self.world_from_camera.transform_vector3(DVec3::NEG_Z);
        let ahead = ahead.normalize_or(DVec3::NEG_Z);
        let (near, far) = self.planes;
        let fov_y = match self.extent {
            Extent::Angle(angle) => angle,
            // Seen from far away through a narrow angle, lines of sight are parallel.
            Extent::HalfHeight(half) => {
                let back = FAR_OFF * half.max(bounds.radius);
                // Everything is moved away from the camera, so that the middle is that far off.
                let moved = back - ahead.dot(bounds.middle - position);
                let near = (moved + near).max(back / FAR_OFF);
                let far = (moved + far.unwrap_or_default()).max(1.001 * near);
                let position = position - ahead * moved;
                let target = position + ahead * back;
                return Eye { position, target, fov_y: 2.0 * (half / back).atan(), near, far };
            }
        };
        let near = if near > 0.0 { near } else { 0.005 * bounds.radius };
        let all = position.distance(bounds.middle) + 2.0 * bounds.radius;
        Eye {
            position,
            target: position + ahead * position.distance(bounds.middle).max(near),
            fov_y,
            near,
            far: far.unwrap_or(all).max(1.001 * near),
        }
    }
}
