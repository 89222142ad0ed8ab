//! Tangents where a model has none: those of MikkTSpace, which glTF names (glTF 2.0, 3.7.2.1).

use std::collections::BTreeMap;

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{DVec3, DVec4};

use crate::shape::{Shape, Vertex};

/// The triangles of a shape, and the tangents of their corners.
struct Corners<'s> {
    shape: &'s Shape,
    tangents: Vec<Option<[f32; 4]>>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> &Vertex {
        &self.shape.vertices[self.shape.indices[3 * face + corner] as usize]
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.shape.indices.len() / 3
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.vertex(face, corner).position.as_vec3().to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.vertex(face, corner).normal.as_vec3().to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.vertex(face, corner).light_uv.as_vec2().to_array()
    }

    fn set_tangent(&mut self, found: Option<TangentSpace>, face: usize, corner: usize) {
        self.tangents[3 * face + corner] = found.map(|found| found.tangent_encoded());
    }
}

/// The most triangles in one point. MikkTSpace goes from each to the next by a call of its own, and
/// compares all of them with one another.
const CROWD: usize = 1000;

/// Whether more triangles meet in a point than tangents are found for.
pub fn is_crowded(shape: &Shape) -> bool {
    let place = |index: &u32| {
        let Vertex { position, .. } = &shape.vertices[*index as usize];
        position.as_vec3().to_array().map(f32::to_bits)
    };
    let mut places: Vec<[u32; 3]> = shape.indices.iter().map(place).collect();
    places.sort_unstable();
    places.chunk_by(|one, other| one == other).any(|same| same.len() > CROWD)
}

/// Gives all vertices tangents in any direction, for surfaces that do not show it.
pub fn with_any_tangents(shape: Shape) -> Shape {
    shape.map(|vertex| vertex.tangent = vertex_tangent(vertex, None))
}

/// Gives all vertices tangents along u of the second coordinates, which are those of the normal map. A
/// vertex whose triangles have several is divided. Green in a normal map points up in the image, which
/// is against v in glTF, so the sign of MikkTSpace is turned.
pub fn set_tangents(shape: Shape) -> Shape {
    let tangents = vec![None; shape.indices.len()];
    let mut corners = Corners { shape: &shape, tangents };
    // Without coordinates there is nothing to find.
    let mut coordinates = shape.vertices.iter().map(|vertex| vertex.light_uv);
    let first = coordinates.next();
    let is_made =
        coordinates.any(|uv| Some(uv) != first) && generate_tangents(&mut corners).is_ok();
    let tangents = if is_made { corners.tangents } else { vec![None; shape.indices.len()] };
    let Shape { mut vertices, mut indices } = shape;
    let mut is_set = vec![false; vertices.len()];
    let mut divided: BTreeMap<(u32, [u64; 4]), u32> = BTreeMap::new();
    for (index, found) in indices.iter_mut().zip(tangents) {
        let at = *index as usize;
        let tangent = vertex_tangent(&vertices[at], found);
        if !is_set[at] {
            is_set[at] = true;
            vertices[at].tangent = tangent;
        } else if vertices[at].tangent != tangent {
            let key = (*index, tangent.to_array().map(f64::to_bits));
            *index = *divided.entry(key).or_insert_with(|| {
                vertices.push(Vertex { tangent, ..vertices[at] });
                vertices.len() as u32 - 1
            });
        }
    }
    Shape { vertices, indices }
}

/// A tangent at right angles to the normal. A triangle without an area in the image has any.
fn vertex_tangent(vertex: &Vertex, found: Option<[f32; 4]>) -> DVec4 {
    let normal = vertex.normal.try_normalize().unwrap_or(DVec3::Y);
    let [x, y, z, sign] = found.unwrap_or_default().map(f64::from);
    let along = DVec3::new(x, y, z);
    let flat = (along - normal * normal.dot(along)).normalize_or_zero();
    if !flat.is_finite() || flat == DVec3::ZERO {
        return normal.any_orthonormal_vector().extend(1.0);
    }
    flat.extend(-sign)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    /// A triangle whose coordinates grow along x and fall along y: the image stands upright.
    fn upright(across: f64) -> Shape {
        let corner = |x: f64, y: f64| Vertex {
            position: DVec3::new(x, y, 0.0),
            normal: DVec3::Z,
            color: DVec3::ONE,
            alpha: 1.0,
            uv: DVec2::ZERO,
            light_uv: DVec2::new(across * x, 1.0 - y),
            tangent: DVec4::ZERO,
        };
        let vertices = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)];
        Shape { vertices, indices: vec![0, 1, 2] }
    }

    #[test]
    fn bitangents_point_up_in_the_image() {
        for (across, tangent) in [(1.0, [1.0, 0.0, 0.0, 1.0]), (-1.0, [-1.0, 0.0, 0.0, -1.0])] {
            let found = set_tangents(upright(across)).vertices;
            let is_right = |vertex: &Vertex| vertex.tangent == DVec4::from_array(tangent);
            assert!(found.iter().all(is_right), "{found:?}");
        }
    }

    /// Two triangles with one edge, of which one has a mirrored image: the vertices at the edge have two
    /// tangents.
    #[test]
    fn mirrored_images_divide_vertices() {
        let mut shape = upright(1.0);
        shape.vertices.push(Vertex { position: DVec3::NEG_X, ..shape.vertices[0] });
        shape.vertices[3].light_uv = DVec2::new(1.0, 1.0);
        shape.indices.extend([0, 2, 3]);
        let Shape { vertices, indices } = set_tangents(shape);
        assert_eq!(vertices.len(), 6);
        let of = |corner: usize| vertices[indices[corner] as usize].tangent;
        assert!((0..3).all(|corner| of(corner) == DVec4::new(1.0, 0.0, 0.0, 1.0)));
        assert!((3..6).all(|corner| of(corner) == DVec4::new(-1.0, 0.0, 0.0, -1.0)));
    }

    #[test]
    fn fans_are_crowded() {
        let mut shape = upright(1.0);
        assert!(!is_crowded(&shape));
        shape.indices = [0, 1, 2].repeat(CROWD + 1);
        assert!(is_crowded(&shape));
        let found = with_any_tangents(upright(1.0)).vertices;
        assert!(found.iter().all(|vertex| vertex.tangent.truncate().dot(vertex.normal) == 0.0));
    }

    #[test]
    fn faces_without_an_image_have_a_tangent() {
        let mut shape = upright(1.0);
        shape.vertices.iter_mut().for_each(|vertex| vertex.light_uv = DVec2::ZERO);
        let found = set_tangents(shape).vertices;
        assert!(found.iter().all(|vertex| vertex.tangent.truncate().dot(vertex.normal) == 0.0));
        assert!(found.iter().all(|vertex| vertex.tangent.w == 1.0));
    }
}
