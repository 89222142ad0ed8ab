//! Normals of triangle meshes, and how they are transformed.

use std::collections::BTreeMap;

use glam::{DMat3, DMat4, DVec3};

/// The normal of a vertex that belongs to no triangle with an area.
pub const UNUSED_NORMAL: DVec3 = DVec3::Z;

/// Why the normals of a mesh cannot be computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshError {
    /// The number of corners is not a multiple of three.
    Incomplete {
        /// How many there are.
        corners: usize,
    },
    /// An index is beyond the last vertex.
    Beyond {
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
}

impl std::fmt::Display for MeshError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Incomplete { corners } => {
                write!(f, "{corners} vertices make no whole number of triangles")
            }
            Self::Beyond { index, vertices } => {
                write!(f, "the index {index} is beyond the last of {vertices} vertices")
            }
        }
    }
}

impl std::error::Error for MeshError {}

/// The unit normal of each triangle, `(b - a) x (c - a)`: a viewer whom it points to sees the
/// corners counter-clockwise.
///
/// Parameters: `positions` in any space; `indices` of the triangles' corners, or `None` where each
/// three positions are a triangle.
/// Returns: one for each triangle; zero for a degenerate one.
///
/// # Errors
/// An incomplete triangle, an index beyond the positions.
pub fn face_normals(positions: &[DVec3], indices: Option<&[u32]>) -> Result<Vec<DVec3>, MeshError> {
    Ok(index_triangles(positions, indices)?
        .iter()
        .map(|corners| double_area(positions, *corners).normalize_or_zero())
        .collect())
}

/// The unit normal of each vertex: the sum over its triangles, each weighted by its area.
///
/// Without `indices`, positions that are equal are one vertex: their normals are the same.
///
/// Returns: one for each position; [`UNUSED_NORMAL`] where no triangle with an area uses it.
/// Source: Newcastle University graphics tutorials, normals of indexed meshes; the weights are what
/// the sum of cross products gives.
///
/// # Errors
/// As of [`face_normals`].
pub fn smooth_normals(
    positions: &[DVec3],
    indices: Option<&[u32]>,
) -> Result<Vec<DVec3>, MeshError> {
    let triangles = index_triangles(positions, indices)?;
    let vertex = if indices.is_some() {
        (0..positions.len()).collect()
    } else {
        welded_positions(positions)
    };
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for corners in triangles {
        let area = double_area(positions, corners);
        corners.iter().for_each(|corner| sums[vertex[*corner]] += area);
    }
    Ok(vertex.iter().map(|vertex| sums[*vertex].try_normalize().unwrap_or(UNUSED_NORMAL)).collect())
}

/// A vector along the normal of a triangle, whose length is twice the area.
fn double_area(positions: &[DVec3], [a, b, c]: [usize; 3]) -> DVec3 {
    (positions[b] - positions[a]).cross(positions[c] - positions[a])
}

fn index_triangles(
    positions: &[DVec3],
    indices: Option<&[u32]>,
) -> Result<Vec<[usize; 3]>, MeshError> {
    let corners: Vec<usize> = match indices {
        None => (0..positions.len()).collect(),
        Some(indices) => match indices.iter().find(|index| **index as usize >= positions.len()) {
            Some(index) => {
                return Err(MeshError::Beyond { index: *index, vertices: positions.len() });
            }
            None => indices.iter().map(|index| *index as usize).collect(),
        },
    };
    match corners.as_chunks() {
        (triangles, []) => Ok(triangles.to_vec()),
        _ => Err(MeshError::Incomplete { corners: corners.len() }),
    }
}

/// For each position, the first one that is equal to it. 0 and -0 are equal.
fn welded_positions(positions: &[DVec3]) -> Vec<usize> {
    let mut first = BTreeMap::new();
    let key = |position: &DVec3| position.to_array().map(|part| (part + 0.0).to_bits());
    positions
        .iter()
        .enumerate()
        .map(|(index, position)| *first.entry(key(position)).or_insert(index))
        .collect()
}

/// The matrix that takes normals where `model` takes points: the inverse transpose of its upper
/// 3 x 3 part. The results need normalising.
///
/// Edges: where `model` flattens space, the cofactors, which are the inverse transpose times the
/// determinant and still give the normal of what it flattens to.
pub fn normal_matrix(model: DMat4) -> DMat3 {
    let m = DMat3::from_mat4(model);
    let cofactors = DMat3::from_cols(
        m.y_axis.cross(m.z_axis),
        m.z_axis.cross(m.x_axis),
        m.x_axis.cross(m.y_axis),
    );
    let determinant = m.x_axis.dot(cofactors.x_axis);
    if determinant == 0.0 { cofactors } else { cofactors * (1.0 / determinant) }
}
