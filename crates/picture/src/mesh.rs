//! Makes meshes from shapes, with the attributes that a vertex stage reads.

use glam::DVec3;
use lamplight_bundle::{Reflection, Varying};
use lamplight_execute::frame::{Mesh, VertexAttribute, VertexFormat};
use lamplight_scenes::sets::Object;
use lamplight_scenes::{Shape, Vertex};

/// The mesh of an object for a vertex stage: of all triangles, or of those that a viewer at `eye`
/// sees. With `faceted`, each triangle has vertices of its own, with the normal of its face.
pub fn object_mesh(
    object: &Object,
    vertex: &Reflection,
    faceted: bool,
    eye: Option<DVec3>,
) -> Mesh {
    let attributes = vertex_attributes(vertex);
    let indices = match eye {
        Some(eye) => object.seen_from(eye),
        None => object.shape.indices.clone(),
    };
    let own = faceted.then(|| {
        let vertices = object.shape.vertices.clone();
        Shape { vertices, indices: indices.clone() }.faceted()
    });
    let shape: &Shape = own.as_ref().unwrap_or(&object.shape);
    let indices = own.as_ref().map_or(indices, |own| own.indices.clone());
    let words = |(index, corner): (usize, &Vertex)| {
        let one = |attribute: &VertexAttribute| {
            let count = component_count(*attribute);
            match attribute.location {
                MIDDLE => number_words(face_middle(shape, index).extend(0.0).to_array(), count),
                location => corner_numbers(corner, location, object.material_index, count),
            }
        };
        attributes.iter().flat_map(one).collect::<Vec<u32>>()
    };
    let words = shape.vertices.iter().enumerate().flat_map(words).collect();
    Mesh { attributes, words, indices }
}

/// The location of the middle of a face. `programs/published.wesl` reads it.
const MIDDLE: u32 = 7;

/// The middle of the face that a corner of a faceted shape belongs to. Faces of such shapes share
/// no corners.
fn face_middle(shape: &Shape, corner: usize) -> DVec3 {
    let first = corner - corner % 3;
    let face = shape.vertices.iter().skip(first).take(3);
    face.map(|vertex| vertex.position).sum::<DVec3>() / 3.0
}

/// The attributes that the stage reads, in its order.
pub fn vertex_attributes(vertex: &Reflection) -> Vec<VertexAttribute> {
    let attribute = |input: &Varying| {
        Some(VertexAttribute { location: input.location?, format: vertex_format(&input.ty) })
    };
    vertex.inputs.iter().filter_map(attribute).collect()
}

fn vertex_format(ty: &str) -> VertexFormat {
    match ty {
        "u32" => VertexFormat::Uint32,
        "f32" => VertexFormat::Float32,
        ty if ty.starts_with("vec2") => VertexFormat::Float32x2,
        ty if ty.starts_with("vec3") => VertexFormat::Float32x3,
        _ => VertexFormat::Float32x4,
    }
}

fn component_count(attribute: VertexAttribute) -> usize {
    attribute.format.words() as usize
}

/// The words that `forward` reads at a location. `programs/forward.wesl` has the table of
/// locations.
fn corner_numbers(corner: &Vertex, location: u32, material: u32, count: usize) -> Vec<u32> {
    let numbers = match location {
        0 => corner.position.extend(1.0).to_array(),
        1 => corner.normal.extend(0.0).to_array(),
        2 => corner.color.extend(corner.alpha).to_array(),
        3 => corner.uv.extend(0.0).extend(0.0).to_array(),
        4 => corner.light_uv.extend(0.0).extend(0.0).to_array(),
        5 => corner.tangent.to_array(),
        _ => return vec![material; count],
    };
    number_words(numbers, count)
}

fn number_words(numbers: [f64; 4], count: usize) -> Vec<u32> {
    numbers.iter().take(count).map(|number| (*number as f32).to_bits()).collect()
}
