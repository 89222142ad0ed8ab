//! The rows of the table: each a property, the text that defines it, what the library does, and a model.

mod base;
mod extensions;
mod geometry;
mod lamps;
mod textures;

use serde_json::{Value, json};

use super::brdf::Choices;
use super::model::{Mesh, Model, Pixels};

/// A property of the specification.
#[derive(Clone)]
pub struct Row {
    pub name: &'static str,
    /// Where the text defines it.
    pub text: &'static str,
    /// What the library does.
    pub about: &'static str,
    pub make: fn() -> Model,
    pub choices: Choices,
    pub expected: Expected,
}

/// Whether the picture is that of the text.
#[derive(Clone, Copy)]
pub enum Expected {
    Agrees,
    /// On purpose, for a reason.
    Differs {
        why: &'static str,
    },
}

/// The sample implementation of appendix B as it is printed.
const PRINTED: Choices = Choices {
    multiple: false,
    film_of_viewer: false,
    mirrored_fresnel: false,
    transformed_tangents: false,
    simple_sheen: false,
};
/// The same with what B.2.3 suggests.
const SUGGESTED: Choices = Choices { multiple: true, ..PRINTED };

/// A row that agrees.
fn row(name: &'static str, text: &'static str, about: &'static str, make: fn() -> Model) -> Row {
    Row { name, text, about, make, choices: SUGGESTED, expected: Expected::Agrees }
}

impl Row {
    fn with(self, choices: Choices) -> Self {
        Self { choices, ..self }
    }

    fn differs(self, why: &'static str) -> Self {
        Self { expected: Expected::Differs { why }, ..self }
    }
}

/// All rows in the order of the page.
pub fn all() -> Vec<Row> {
    base::rows()
        .into_iter()
        .chain(textures::rows())
        .chain(extensions::rows())
        .chain(lamps::rows())
        .chain(geometry::rows())
        .collect()
}

/// A material that is no metal and of medium roughness, with further members.
fn plain(more: Value) -> Value {
    let mut material = json!({ "pbrMetallicRoughness": {
        "baseColorFactor": [0.8, 0.5, 0.3, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.4 } });
    for (name, value) in more.as_object().expect("an object") {
        material[name] = value.clone();
    }
    material
}

/// The same with one extension.
fn extended(name: &str, own: Value) -> Value {
    plain(json!({ "extensions": { name: own } }))
}

/// A metal.
fn metal(roughness: f64) -> Value {
    json!({ "pbrMetallicRoughness": {
        "baseColorFactor": [0.9, 0.7, 0.4, 1.0], "metallicFactor": 1.0, "roughnessFactor": roughness } })
}

/// The mesh of most rows.
fn bulging() -> Mesh {
    Mesh::bulging(0.6)
}

/// The place of a second mesh that covers the right half of the picture.
fn beside() -> Value {
    json!({ "translation": [0.9, -0.1, 0.5], "scale": [0.8, 0.8, 0.8] })
}

/// An image of four by four pixels of many values, none of them near 0.
fn pattern() -> Pixels {
    let texel = |index: u32| {
        let part = |step: u32, low: u32| (low + (index * step) % (256 - low)) as u8;
        [part(53, 60), part(97, 90), part(151, 70), part(39, 128)]
    };
    Pixels { width: 4, height: 4, texels: (0..16).map(texel).collect() }
}

/// A model of the usual mesh whose material has a texture of the pattern: `material` gets the texture's
/// number.
fn textured(mesh: Mesh, material: impl Fn(usize) -> Value) -> Model {
    textured_by(mesh, pattern(), json!({}), material)
}

fn textured_by(
    mesh: Mesh,
    pixels: Pixels,
    sampler: Value,
    material: impl Fn(usize) -> Value,
) -> Model {
    let mut model = Model::new();
    let texture = model.add_texture(pixels, sampler);
    model.add_material(material(texture));
    model.add(mesh, json!({}));
    model.add_usual_lamps();
    model
}
