//! Tangents of meshes that have none, by the definition of MikkTSpace (Mikkelsen 2008, "Simulation of
//! Wrinkled Surfaces Revisited"), which glTF 2.0 names in 3.7.2.1. A corner has the mean of the directions
//! along u of the faces around its vertex, each laid into the plane of the vertex's normal and weighted by
//! the angle that the face has there. Faces count together if edges at the vertex connect them and their
//! images have the same handedness.

use glam::{DVec2, DVec3, DVec4};

/// A vertex is the same in several faces if all of it is the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    pub position: DVec3,
    pub normal: DVec3,
    pub uv: DVec2,
}

pub type Face = [Vertex; 3];

/// The tangents of all corners. Bitangents are against v, which points down in the image.
pub fn tangents(faces: &[Face]) -> Vec<[DVec4; 3]> {
    let corner = |face: usize, corner: usize| {
        let n = faces[face][corner].normal;
        let around = around(faces, face, corner);
        let sum: DVec3 = around
            .iter()
            .map(|(face, at)| along(&faces[*face], n) * angle(&faces[*face], *at))
            .sum();
        let sign = if is_mirrored(&faces[face]) { -1.0 } else { 1.0 };
        sum.normalize_or_zero().extend(sign)
    };
    (0..faces.len()).map(|face| [0, 1, 2].map(|at| corner(face, at))).collect()
}

/// The faces that count at a corner, each with its corner there.
fn around(faces: &[Face], face: usize, corner: usize) -> Vec<(usize, usize)> {
    let vertex = faces[face][corner];
    let is_mirror = is_mirrored(&faces[face]);
    let at = |(index, face): (usize, &Face)| {
        let corner = face.iter().position(|own| *own == vertex)?;
        (is_mirrored(face) == is_mirror).then_some((index, corner))
    };
    let mut others: Vec<_> = faces.iter().enumerate().filter_map(at).collect();
    let mut found = Vec::new();
    let mut next = vec![(face, corner)];
    while let Some(member) = next.pop() {
        others.retain(|other| *other != member);
        found.push(member);
        let far =
            |(face, at): (usize, usize)| [faces[face][(at + 1) % 3], faces[face][(at + 2) % 3]];
        let ends = far(member);
        let connected = |other: &(usize, usize)| far(*other).iter().any(|end| ends.contains(end));
        next.extend(others.extract_if(.., |other| connected(other)));
    }
    found
}

/// The edges of a face from its first corner, in the world and in the image.
fn edges(face: &Face) -> ([DVec3; 2], [DVec2; 2]) {
    let [a, b, c] = face;
    ([b.position - a.position, c.position - a.position], [b.uv - a.uv, c.uv - a.uv])
}

/// Whether the image is seen from behind. With v down, it is not if the corners turn right in it.
fn is_mirrored(face: &Face) -> bool {
    let (_, [s, t]) = edges(face);
    s.perp_dot(t) > 0.0
}

/// The unit direction in the plane of a normal in which u grows fastest while v stays.
fn along(face: &Face, normal: DVec3) -> DVec3 {
    let ([ab, ac], [s, t]) = edges(face);
    laid((ab * t.y - ac * s.y) / s.perp_dot(t), normal)
}

/// The angle of a face at a corner, in the plane of the normal there.
fn angle(face: &Face, corner: usize) -> f64 {
    let own = face[corner];
    let edge = |at: usize| laid(face[at % 3].position - own.position, own.normal);
    edge(corner + 1).dot(edge(corner + 2)).clamp(-1.0, 1.0).acos()
}

fn laid(vector: DVec3, normal: DVec3) -> DVec3 {
    (vector - normal * normal.dot(vector)).normalize_or_zero()
}
