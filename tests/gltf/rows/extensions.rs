//! The extensions of materials.

use serde_json::{Value, json};

use super::{Choices, LIBRARY, Row, bulging, extended, metal, row, textured};
use crate::gltf::model::{Mesh, Model};

/// The film as the library and the glTF Sample Renderer have it.
const OF_VIEWER: Choices = Choices { film_of_viewer: true, ..LIBRARY };
const SIMPLE_SHEEN: Choices = Choices { simple_sheen: true, ..LIBRARY };

fn of(name: &str, own: Value) -> Model {
    Model::of(bulging(), extended(name, own))
}

/// Each texture of an extension, with the pattern.
fn mapped(name: &str, own: Value, fields: &[&str]) -> Model {
    textured(bulging(), |index| {
        let mut own = own.clone();
        for field in fields {
            own[*field] = json!({ "index": index });
        }
        extended(name, own)
    })
}

pub fn rows() -> Vec<Row> {
    reflecting().into_iter().chain(layered()).chain(passing()).collect()
}

fn reflecting() -> Vec<Row> {
    const SPECULAR: &str = "KHR_materials_specular";
    vec![
        row("ior", "KHR_materials_ior", "reflectance by the index", || {
            of("KHR_materials_ior", json!({ "ior": 2.2 }))
        }),
        row("ior_zero", "KHR_materials_ior", "0 reflects all", || {
            of("KHR_materials_ior", json!({ "ior": 0.0 }))
        }),
        row("specular_factor", SPECULAR, "weight of the reflection", || {
            of(SPECULAR, json!({ "specularFactor": 0.3 }))
        }),
        row("specular_color", SPECULAR, "colour of the reflection", || {
            of(SPECULAR, json!({ "specularColorFactor": [4.0, 1.0, 0.5] }))
        }),
        row("specular_textures", SPECULAR, "colour in sRGB, weight in alpha", || {
            mapped(
                SPECULAR,
                json!({ "specularColorFactor": [3.0, 2.0, 1.0] }),
                &["specularColorTexture", "specularTexture"],
            )
        }),
    ]
}

fn layered_first() -> Vec<Row> {
    const COAT: &str = "KHR_materials_clearcoat";
    const SHEEN: &str = "KHR_materials_sheen";
    const BRUSH: &str = "KHR_materials_anisotropy";
    vec![
        row("clearcoat", COAT, "above everything else, emission too", || {
            let mut material =
                extended(COAT, json!({ "clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.25 }));
            material["emissiveFactor"] = json!([0.1, 0.2, 0.1]);
            Model::of(bulging(), material)
        }),
        row("clearcoat_textures", COAT, "factor in red, roughness in green", || {
            mapped(
                COAT,
                json!({ "clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.6 }),
                &["clearcoatTexture", "clearcoatRoughnessTexture"],
            )
        }),
        row("sheen", SHEEN, "with the visibility of Ashikhmin, which the text allows", || {
            of(SHEEN, json!({ "sheenColorFactor": [0.6, 0.4, 0.8], "sheenRoughnessFactor": 0.5 }))
        })
        .with(SIMPLE_SHEEN)
        .differs("the albedo of the sheen is a fit within 0.04 of the integral"),
        row("sheen_charlie", SHEEN, "against the visibility of Charlie", || {
            of(SHEEN, json!({ "sheenColorFactor": [0.6, 0.4, 0.8], "sheenRoughnessFactor": 0.5 }))
        })
        .differs("the visibility is the one that the text names for slow devices"),
        row("sheen_textures", SHEEN, "colour in sRGB, roughness in alpha", || {
            mapped(
                SHEEN,
                json!({ "sheenColorFactor": [0.6, 0.4, 0.8], "sheenRoughnessFactor": 0.9 }),
                &["sheenColorTexture", "sheenRoughnessTexture"],
            )
        })
        .with(SIMPLE_SHEEN),
        row("anisotropy", BRUSH, "highlight along the turned tangent", || {
            let own = json!({ "anisotropyStrength": 0.6, "anisotropyRotation": 0.7 });
            let mut material = metal(0.35);
            material["extensions"] = json!({ BRUSH: own });
            Model::of(Mesh::bulging(0.1).with_tangents(), material)
        })
        .differs("what facets reflect several times is that of an isotropic surface as rough"),
    ]
}

fn layered_second() -> Vec<Row> {
    const BRUSH: &str = "KHR_materials_anisotropy";
    const FILM: &str = "KHR_materials_iridescence";
    vec![
        row("anisotropy_dielectric", BRUSH, "the same on a dielectric", || {
            let own = json!({ "anisotropyStrength": 0.6, "anisotropyRotation": 0.7 });
            Model::of(Mesh::bulging(0.1).with_tangents(), extended(BRUSH, own))
        }),
        row("iridescence", FILM, "by the angle of the viewer, as the glTF Sample Renderer", || {
            film(1.0)
        })
        .with(OF_VIEWER),
        row("iridescence_half", FILM, "by the angle of the half vector, as printed", || film(1.0))
            .differs("the film has the colours of the viewer's angle, for all lamps at once"),
        row("iridescence_textures", FILM, "factor in red, thickness in green", || {
            mapped(
                FILM,
                json!({ "iridescenceFactor": 1.0, "iridescenceIor": 1.8,
                "iridescenceThicknessMinimum": 200.0, "iridescenceThicknessMaximum": 500.0 }),
                &["iridescenceTexture", "iridescenceThicknessTexture"],
            )
        })
        .with(OF_VIEWER),
    ]
}

fn layered() -> Vec<Row> {
    [layered_first(), layered_second()].concat()
}

fn film(factor: f64) -> Model {
    of(
        "KHR_materials_iridescence",
        json!({ "iridescenceFactor": factor, "iridescenceIor": 1.8,
        "iridescenceThicknessMaximum": 420.0 }),
    )
}

/// A lamp behind the surface beside the usual ones.
fn lit_from_behind(mut model: Model) -> Model {
    let lamp = json!({ "type": "point", "color": [0.9, 1.0, 0.8], "intensity": 9.0 });
    model.add_lamp(lamp, json!({ "translation": [-0.5, 0.3, -1.2] }));
    model
}

fn passing() -> Vec<Row> {
    const GLASS: &str = "KHR_materials_transmission";
    const LEAF: &str = "KHR_materials_diffuse_transmission";
    vec![
        row("transmission", GLASS, "lamps behind a thin rough sheet", || {
            lit_from_behind(of(GLASS, json!({ "transmissionFactor": 0.7 })))
        }),
        row("transmission_texture", GLASS, "factor in red", || {
            lit_from_behind(mapped(
                GLASS,
                json!({ "transmissionFactor": 0.9 }),
                &["transmissionTexture"],
            ))
        }),
        row("diffuse_transmission", LEAF, "light from behind is scattered", || {
            lit_from_behind(of(
                LEAF,
                json!({ "diffuseTransmissionFactor": 0.6,
                "diffuseTransmissionColorFactor": [0.3, 0.9, 0.2] }),
            ))
        }),
        row("diffuse_transmission_textures", LEAF, "colour in sRGB, factor in alpha", || {
            lit_from_behind(mapped(
                LEAF,
                json!({ "diffuseTransmissionFactor": 0.9 }),
                &["diffuseTransmissionTexture", "diffuseTransmissionColorTexture"],
            ))
        }),
        row(
            "volume",
            "KHR_materials_volume",
            "light from behind is absorbed by Beer's law",
            || {
                let mut material = extended(LEAF, json!({ "diffuseTransmissionFactor": 0.6 }));
                material["extensions"]["KHR_materials_volume"] = json!({ "thicknessFactor": 0.5,
                "attenuationDistance": 0.7, "attenuationColor": [0.3, 0.9, 0.6] });
                lit_from_behind(Model::of(bulging(), material))
            },
        ),
    ]
}
