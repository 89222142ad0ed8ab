//! Meshes with the attributes that a vertex stage of the author's reads.

use glam::{DVec3, DVec4};

use lamplight_bundle::{Reflection, Varying};
use lamplight_execute::frame::{Mesh, VertexAttribute, VertexFormat};
use lamplight_scenes::sets::Object;
use lamplight_scenes::{Shape, Vertex};
use naga::{ArraySize, Module, TypeInner};

use super::inputs::{Source, attribute_source};
use super::shape::NumberType;

/// The mesh of an object for a vertex stage.
pub fn attribute_mesh(object: &Object, vertex: &Reflection) -> Mesh {
    let inputs: Vec<&Varying> =
        vertex.inputs.iter().filter(|input| input.location.is_some()).collect();
    let attribute = |input: &&Varying| VertexAttribute {
        location: input.location.unwrap_or_default(),
        format: format_of(&input.ty),
    };
    let words = |corner: &Vertex| {
        let of = |input: &&Varying| attribute_words(input, corner, object.color);
        inputs.iter().flat_map(of).collect::<Vec<u32>>()
    };
    Mesh {
        attributes: inputs.iter().map(attribute).collect(),
        words: object.shape.vertices.iter().flat_map(words).collect(),
        indices: object.shape.indices.clone(),
    }
}

/// Triangles without attributes: the stage makes them from the vertex index.
pub fn indexed_mesh(vertices: u32) -> Mesh {
    Mesh { attributes: Vec::new(), words: Vec::new(), indices: (0..vertices).collect() }
}

/// The square that fills the picture, for stages that use positions as they are.
pub fn clip_square() -> Shape {
    Shape::patch(DVec3::new(-1.0, -1.0, 0.0), DVec3::X * 2.0, DVec3::Y * 2.0, (1, 1))
}

/// How many vertices a stage makes that only reads their index: as many as its longest array of
/// vectors has, if that is whole triangles, else three.
pub fn vertex_count(module: &Module) -> u32 {
    let is_vector = |ty| matches!(module.types[ty].inner, TypeInner::Vector { .. });
    let length = |ty: &naga::Type| match ty.inner {
        TypeInner::Array { base, size: ArraySize::Constant(count), stride: _ } => {
            Some(count.get()).filter(|_| is_vector(base))
        }
        _ => None,
    };
    let lengths = module.types.iter().filter_map(|(_, ty)| length(ty));
    lengths.filter(|count| count.is_multiple_of(3) && *count <= MOST).max().unwrap_or(3)
}

/// The most vertices of a stage that only reads their index.
pub const MOST: u32 = 1 << 20;

fn format_of(ty: &str) -> VertexFormat {
    let rows = NumberType::of(ty).rows;
    match (ty.contains('f'), ty.contains("u32"), rows) {
        (true, _, 1) => VertexFormat::Float32,
        (true, _, 2) => VertexFormat::Float32x2,
        (true, _, 3) => VertexFormat::Float32x3,
        (true, _, _) => VertexFormat::Float32x4,
        (_, true, 1) => VertexFormat::Uint32,
        (_, true, 2) => VertexFormat::Uint32x2,
        (_, true, 3) => VertexFormat::Uint32x3,
        (_, true, _) => VertexFormat::Uint32x4,
        (_, _, 1) => VertexFormat::Sint32,
        (_, _, 2) => VertexFormat::Sint32x2,
        (_, _, 3) => VertexFormat::Sint32x3,
        _ => VertexFormat::Sint32x4,
    }
}

fn attribute_words(input: &Varying, corner: &Vertex, tint: DVec3) -> Vec<u32> {
    let direction = |vector: DVec3| vector.extend(0.0);
    let along = corner.tangent.truncate();
    let numbers = match attribute_source(input).0 {
        Source::Position => corner.position.extend(1.0),
        Source::Normal => direction(corner.normal),
        Source::Tangent => corner.tangent,
        Source::Bitangent => direction(corner.normal.cross(along) * corner.tangent.w),
        Source::Uv => corner.uv.extend(0.0).extend(1.0),
        Source::Color => (corner.color * tint).extend(1.0),
        _ => DVec4::ZERO,
    };
    let ty = NumberType::of(&input.ty);
    let word = |number: f64| if ty.is_integer { 0 } else { (number as f32).to_bits() };
    numbers.to_array().into_iter().take(ty.rows).map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::{attribute_mesh, vertex_count};
    use crate::own::inputs::tests::input;
    use glam::{DMat4, DVec3};
    use lamplight_bundle::{Reflection, Stage};
    use lamplight_execute::frame::VertexFormat;
    use lamplight_scenes::Shape;
    use lamplight_scenes::sets::{Material, Object};

    /// Attributes have what their names say, in the order of the stage; integers are 0.
    #[test]
    fn attributes_by_name() {
        let inputs = vec![
            input("aNormal", "vec3<f32>", 0),
            input("joints", "vec4<u32>", 1),
            input("aPos", "vec4<f32>", 3),
        ];
        let reflection = Reflection { inputs, ..Reflection::of(Stage::Vertex) };
        let shape = Shape::patch(DVec3::new(2.0, 3.0, 4.0), DVec3::X, DVec3::Y, (1, 1));
        let object = Object::made(shape, DMat4::IDENTITY, DVec3::ONE, Material::default());
        let mesh = attribute_mesh(&object, &reflection);
        let formats: Vec<_> =
            mesh.attributes.iter().map(|one| (one.location, one.format)).collect();
        let expected = [
            (0, VertexFormat::Float32x3),
            (1, VertexFormat::Uint32x4),
            (3, VertexFormat::Float32x4),
        ];
        assert_eq!(formats, expected);
        let first: Vec<f32> = mesh.words[..11].iter().map(|word| f32::from_bits(*word)).collect();
        assert_eq!(first, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0, 3.0, 4.0, 1.0]);
    }

    #[test]
    fn vertices_of_an_array() -> Result<(), String> {
        let read = |text: &str| naga::front::wgsl::parse_str(text).map_err(|e| e.to_string());
        let six = "@vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
            var at = array<vec2f, 6>(); var weights = array<f32, 9>();
            return vec4f(at[i], weights[i], 1.0); }";
        assert_eq!(vertex_count(&read(six)?), 6);
        assert_eq!(vertex_count(&read(&six.replace("6>", "4>"))?), 3);
        Ok(())
    }
}
