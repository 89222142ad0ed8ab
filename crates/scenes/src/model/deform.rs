//! Vertices that morph targets and skins move: as the model is at rest.

use std::collections::{BTreeMap, BTreeSet};

use crate::model::GltfReader;
use crate::model::nodes::{PlacedMesh, PlacedNodes};
use crate::shape::Vertex;
use glam::{DMat3, DMat4, DVec3};
use gltf::Semantic;
use lamplight_files::limits::MODEL_MOVED;

/// Adds the targets of a primitive, each times its weight, as the node or else the mesh gives it.
///
/// # Errors
/// Numbers that are not there, and too many vertices.
pub fn morph(
    reader: &mut GltfReader<'_>,
    primitive: &gltf::Primitive<'_>,
    part: &PlacedMesh,
    vertices: &mut [Vertex],
    place: &str,
) -> Result<(), String> {
    for (index, target) in primitive.morph_targets().enumerate() {
        let weight = part.weights.get(index).copied().unwrap_or(0.0);
        if weight == 0.0 {
            continue;
        }
        let parts = [target.positions(), target.normals(), target.tangents()];
        let rows = parts.iter().flatten().map(gltf::Accessor::count);
        let rows = rows.fold(0, usize::saturating_add);
        count_moved(reader, rows, place)?;
        let moves = |accessor: Option<gltf::Accessor<'_>>, name: &str| {
            let place = format!("{place}.targets[{index}].{name}");
            let rows = accessor.map(|accessor| reader.rows(&accessor, &place)).transpose()?;
            let rows = rows.unwrap_or_default().into_iter();
            let moved = rows.map(|[x, y, z, _]| weight * DVec3::new(x, y, z));
            Ok::<Vec<DVec3>, String>(moved.collect())
        };
        let places = moves(target.positions(), "POSITION")?;
        let normals = moves(target.normals(), "NORMAL")?;
        let tangents = moves(target.tangents(), "TANGENT")?;
        for (vertex, moved) in vertices.iter_mut().zip(places) {
            vertex.position += moved;
        }
        for (vertex, moved) in vertices.iter_mut().zip(normals) {
            vertex.normal += moved;
        }
        for (vertex, moved) in vertices.iter_mut().zip(tangents) {
            vertex.tangent += moved.extend(0.0);
        }
    }
    for vertex in vertices {
        vertex.normal = vertex.normal.normalize_or_zero();
    }
    Ok(())
}

/// The joints of a skin: from the mesh as it was bound to the world.
pub struct Skinning {
    world_from_bound: Vec<DMat4>,
}

/// Those of the skins that are drawn, by their numbers.
pub type Skins = BTreeMap<usize, Skinning>;

/// The skins of all meshes in their places. The place of such a mesh itself counts for nothing (glTF
/// 2.0, 3.7.3.2). A skin whose joints are not in the scene is ignored, with a note.
///
/// # Errors
/// Matrices that are not there.
pub fn skins(reader: &mut GltfReader<'_>, placed: &PlacedNodes) -> Result<Skins, String> {
    let used: BTreeSet<usize> = placed.parts.iter().filter_map(|part| part.skin).collect();
    let mut skins = Skins::new();
    for skin in reader.document.skins().filter(|skin| used.contains(&skin.index())) {
        let place = format!("skins[{}]", skin.index());
        let at = format!("{place}.inverseBindMatrices");
        let inverse = match skin.inverse_bind_matrices() {
            Some(accessor) => reader.matrices(&accessor, &at)?,
            None => vec![DMat4::IDENTITY; skin.joints().count()],
        };
        let worlds = skin.joints().map(|joint| placed.worlds.get(&joint.index()).copied());
        let Some(worlds) = worlds.collect::<Option<Vec<DMat4>>>() else {
            reader.notes.insert(format!("{place} is ignored: its joints are not in the scene"));
            continue;
        };
        if inverse.len() < worlds.len() {
            let (has, joints) = (inverse.len(), worlds.len());
            return Err(format!("{at}: {has} matrices for {joints} joints"));
        }
        let world_from_bound =
            worlds.iter().zip(&inverse).map(|(world, own)| *world * *own).collect();
        skins.insert(skin.index(), Skinning { world_from_bound });
    }
    Ok(skins)
}

/// Counts the vertices that something moves.
fn count_moved(reader: &mut GltfReader<'_>, count: usize, place: &str) -> Result<(), String> {
    reader.moved = reader.moved.saturating_add(count);
    if reader.moved <= MODEL_MOVED {
        return Ok(());
    }
    Err(format!("{place}: morph targets and joints move more than {MODEL_MOVED} vertices"))
}

impl Skinning {
    /// Moves the vertices of a primitive to the world. The result is whether that mirrors them.
    ///
    /// # Errors
    /// Joints that are not there, and too many vertices.
    pub fn apply(
        &self,
        reader: &mut GltfReader<'_>,
        primitive: &gltf::Primitive<'_>,
        vertices: &mut [Vertex],
        place: &str,
    ) -> Result<bool, String> {
        let mut sums = vec![(DMat4::ZERO, 0.0); vertices.len()];
        for set in 0.. {
            let pair = (Semantic::Joints(set), Semantic::Weights(set));
            let (Some(joints), Some(weights)) = (primitive.get(&pair.0), primitive.get(&pair.1))
            else {
                break;
            };
            count_moved(reader, joints.count().max(weights.count()), place)?;
            let joints = reader.rows(&joints, &format!("{place}.attributes.JOINTS_{set}"))?;
            let weights = reader.rows(&weights, &format!("{place}.attributes.WEIGHTS_{set}"))?;
            for ((sum, joints), weights) in sums.iter_mut().zip(joints).zip(weights) {
                for (joint, weight) in joints.into_iter().zip(weights) {
                    if weight <= 0.0 {
                        continue;
                    }
                    let matrix = self.world_from_bound.get(joint as usize);
                    let missing = || format!("{place}: there is no joint {joint} in its skin");
                    sum.0 += *matrix.ok_or_else(missing)? * weight;
                    sum.1 += weight;
                }
            }
        }
        let mut is_mirrored = false;
        for (vertex, (sum, weight)) in vertices.iter_mut().zip(sums) {
            // A vertex without weights is at the place of the first joint.
            let first = || self.world_from_bound.first().copied().unwrap_or(DMat4::IDENTITY);
            let matrix = if weight > 0.0 { sum * (1.0 / weight) } else { first() };
            is_mirrored |= matrix.determinant() < 0.0;
            move_vertex(vertex, matrix);
        }
        Ok(is_mirrored)
    }
}

fn move_vertex(vertex: &mut Vertex, matrix: DMat4) {
    let linear = DMat3::from_mat4(matrix);
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    // The cofactors, which are the inverse transpose up to a factor, also where there is none.
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let sign = linear.determinant().signum();
    vertex.position = matrix.transform_point3(vertex.position);
    vertex.normal = (cofactors * vertex.normal * sign).normalize_or_zero();
    let along = (linear * vertex.tangent.truncate()).normalize_or_zero();
    vertex.tangent = along.extend(vertex.tangent.w * sign);
}
