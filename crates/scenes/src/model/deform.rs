//! Vertices that morph targets and skins move: as the model is at rest.

use crate::model::GltfReader;
use crate::model::nodes::{PlacedMesh, PlacedNodes};
use crate::shape::Vertex;
use glam::{DMat3, DMat4, DVec3};
use gltf::Semantic;

/// Adds the targets of a primitive, each times its weight, as the node or else the mesh gives it.
pub fn morph(
    reader: &GltfReader<'_>,
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

impl Skinning {
    /// That of a mesh in its place; `None` if it has no skin. The place of the mesh itself then counts
    /// for nothing (glTF 2.0, 3.7.3.2).
    ///
    /// # Errors
    /// Matrices that are not there.
    pub fn of(
        reader: &mut GltfReader<'_>,
        part: &PlacedMesh,
        placed: &PlacedNodes,
    ) -> Result<Option<Self>, String> {
        let Some(index) = part.skin else { return Ok(None) };
        let skin =
            reader.document.skins().nth(index).ok_or("a node has a skin that is not there")?;
        let place = format!("skins[{index}].inverseBindMatrices");
        let inverse = match skin.inverse_bind_matrices() {
            Some(accessor) => reader.matrices(&accessor, &place)?,
            None => vec![DMat4::IDENTITY; skin.joints().count()],
        };
        let worlds: Option<Vec<DMat4>> =
            skin.joints().map(|joint| placed.worlds.get(&joint.index()).copied()).collect();
        let Some(worlds) = worlds else {
            let note = format!("skins[{index}] is ignored: its joints are not in the scene");
            reader.notes.insert(note);
            return Ok(None);
        };
        if inverse.len() < worlds.len() {
            let (has, joints) = (inverse.len(), worlds.len());
            return Err(format!("{place}: {has} matrices for {joints} joints"));
        }
        let world_from_bound = worlds.iter().zip(&inverse).map(|(world, own)| *world * *own);
        Ok(Some(Self { world_from_bound: world_from_bound.collect() }))
    }

    /// Moves the vertices of a primitive to the world. The result is whether that mirrors them.
    ///
    /// # Errors
    /// Joints that are not there.
    pub fn apply(
        &self,
        reader: &GltfReader<'_>,
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
