//! Walks the nodes of a scene: meshes, cameras and lights with their transforms.

use std::collections::BTreeSet;

use glam::{DMat4, DVec3};
use gltf::camera::Projection;
use gltf::khr_lights_punctual::Kind;

use super::GltfReader;
use crate::sets::{Eye, Lamp, LampKind, Object};
use lamplight_files::limits::{MODEL_NESTING, MODEL_NODES};

/// A mesh and its transform to world space.
pub struct PlacedMesh {
    pub mesh: usize,
    pub world_from_mesh: DMat4,
}

/// A camera and its transform to world space.
pub struct GltfCamera {
    world_from_camera: DMat4,
    fov_y: f64,
    planes: (f64, Option<f64>),
}

/// All meshes, cameras and lights of a scene.
#[derive(Default)]
pub struct PlacedNodes {
    pub parts: Vec<PlacedMesh>,
    pub cameras: Vec<GltfCamera>,
    /// Of each light: its colour times its intensity (in lux if it is directional, else in
    /// candela), its kind, its transform to world space, and half the angle of its cone.
    lights: Vec<(DVec3, LampKind, DMat4, f64)>,
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
        take_node(reader, &node, world, &mut placed);
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

fn take_node(
    reader: &mut GltfReader<'_>,
    node: &gltf::Node<'_>,
    world: DMat4,
    placed: &mut PlacedNodes,
) {
    if node.skin().is_some() {
        reader.notes.insert("skins are ignored: the model is drawn in its rest pose".to_owned());
    }
    placed
        .parts
        .extend(node.mesh().map(|mesh| PlacedMesh { mesh: mesh.index(), world_from_mesh: world }));
    let camera = node.camera();
    match camera.as_ref().map(gltf::Camera::projection) {
        Some(Projection::Perspective(view)) => placed.cameras.push(GltfCamera {
            world_from_camera: world,
            fov_y: f64::from(view.yfov()),
            planes: (f64::from(view.znear()), view.zfar().map(f64::from)),
        }),
        Some(Projection::Orthographic(_)) => {
            reader.notes.insert("orthographic cameras are ignored".to_owned());
        }
        None => {}
    }
    placed.lights.extend(node.light().map(|light| {
        let color = DVec3::from_array(light.color().map(f64::from)) * f64::from(light.intensity());
        let (kind, angle) = match light.kind() {
            Kind::Directional => (LampKind::Directional, 0.7),
            Kind::Point => (LampKind::Point, 0.7),
            Kind::Spot { outer_cone_angle, .. } => (LampKind::Spot, f64::from(outer_cone_angle)),
        };
        (color, kind, world, angle.clamp(0.02, 1.5))
    }));
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

/// The model's lamps, at most ten; without any, one of our own.
pub fn model_lamps(placed: &PlacedNodes, bounds: &Ball, eye: &Eye) -> Vec<Lamp> {
    const MOST: usize = 10;
    if placed.lights.is_empty() {
        return vec![key_lamp(bounds, eye)];
    }
    let lamp = |(color, kind, world, half_angle): &(DVec3, LampKind, DMat4, f64)| {
        let position = world.transform_point3(DVec3::ZERO);
        let axis = world.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Y);
        let reach = position.distance(bounds.middle).max(0.1 * bounds.radius);
        let (position, target) = match kind {
            LampKind::Directional => (bounds.middle - axis * 3.0 * bounds.radius, bounds.middle),
            LampKind::Point => (position, bounds.middle),
            LampKind::Spot => (position, position + axis * reach),
        };
        // Candelas become lux at the target. A white diffuse surface reflects that over pi as
        // radiance.
        let falloff = if *kind == LampKind::Directional { 1.0 } else { reach * reach };
        let color = *color / falloff / std::f64::consts::PI;
        Lamp { color, position, target, half_angle: *half_angle, kind: *kind }
    };
    placed.lights.iter().take(MOST).map(lamp).collect()
}

impl GltfCamera {
    /// The camera as the viewer of the scene.
    pub fn eye(&self, bounds: &Ball) -> Eye {
        let position = self.world_from_camera.transform_point3(DVec3::ZERO);
        let ahead = self.world_from_camera.transform_vector3(DVec3::NEG_Z);
        let ahead = ahead.normalize_or(DVec3::NEG_Z);
        let (near, far) = self.planes;
        let near = if near > 0.0 { near } else { 0.005 * bounds.radius };
        let all = position.distance(bounds.middle) + 2.0 * bounds.radius;
        Eye {
            position,
            target: position + ahead * position.distance(bounds.middle).max(near),
            fov_y: self.fov_y.clamp(0.02, 3.0),
            near,
            far: far.unwrap_or(all).max(1.001 * near),
        }
    }
}
