//! The extensions of materials.

use serde_json::{Value, json};

use super::{Choices, Row, SUGGESTED, bulging, extended, metal, row, textured};
use crate::gltf::model::{Mesh, Model};

/// The film as the glTF Sample Renderer has it.
const OF_VIEWER: Choices = Choices { film_of_viewer: true, ..SUGGESTED };
const MIRRORED: Choices = Choices { mirrored_fresnel: true, ..SUGGESTED };
const SIMPLE_SHEEN: Choices = Choices { simple_sheen: true, ..SUGGESTED };

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
        row("anisotropy_grazing", BRUSH, "a lamp near the plane of the surface", || {
            let mut material = extended(BRUSH, json!({ "anisotropyStrength": 0.6 }));
            material["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.0, 0.0, 0.0, 1.0]);
            let mut model = Model::new();
            model.add_material(material);
            model.add(Mesh::bulging(0.0).with_tangents(), json!({}));
            let turn = glam::DQuat::from_rotation_x(-1.47).to_array();
            let lamp = json!({ "type": "directional", "intensity": 20000.0 });
            model.add_lamp(lamp, json!({ "rotation": turn }));
            model
        })
        .differs("the visibility is not limited to 1, as in the appendix"),
        row("iridescence", FILM, "by the angle of the viewer, as the glTF Sample Renderer", || {
            film(0.0)
        })
        .with(OF_VIEWER),
        row("iridescence_half", FILM, "by the angle of the half vector, as printed", || film(0.0))
            .differs("the film has the colours of the viewer's angle, for all lamps at once"),
        row("iridescence_metal", FILM, "on a metal, by the angle of the viewer", || film(1.0))
            .with(OF_VIEWER)
            .differs("light that facets reflect several times is added to the film too"),
        row("iridescence_mixed", FILM, "on a mix of a dielectric and a metal", || film(0.5))
            .with(OF_VIEWER)
            .differs("one film over the mix of both, in place of the mix of two films"),
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

fn film(metallic: f64) -> Model {
    let mut material = extended(
        "KHR_materials_iridescence",
        json!({ "iridescenceFactor": 1.0, "iridescenceIor": 1.8,
        "iridescenceThicknessMaximum": 420.0 }),
    );
    material["pbrMetallicRoughness"]["metallicFactor"] = json!(metallic);
    Model::of(bulging(), material)
}

/// A lamp behind the surface beside the usual ones.
fn lit_from_behind(mut model: Model) -> Model {
    let lamp = json!({ "type": "point", "color": [0.9, 1.0, 0.8], "intensity": 9.0 });
    model.add_lamp(lamp, json!({ "translation": [-0.5, 0.3, -1.2] }));
    model
}

const GLASS: &str = "KHR_materials_transmission";
const LEAF: &str = "KHR_materials_diffuse_transmission";
const MIRROR: &str = "the Fresnel term is that of the lamp's mirror image before the surface";

fn passing() -> Vec<Row> {
    let mirrored = [
        row("transmission", GLASS, "lamps behind a thin rough sheet", glass),
        row("transmission_texture", GLASS, "factor in red", || {
            lit_from_behind(mapped(
                GLASS,
                json!({ "transmissionFactor": 0.9 }),
                &["transmissionTexture"],
            ))
        }),
        row("diffuse_transmission", LEAF, "light from behind is scattered", leaf),
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
    ];
    let printed = [
        row("transmission_half", GLASS, "by the half vector of the lamp, as printed", glass),
        row("diffuse_transmission_half", LEAF, "by the half vector of the lamp, as printed", leaf),
    ];
    let mirrored = mirrored.map(|row| row.with(MIRRORED));
    mirrored.into_iter().chain(printed.map(|row| row.differs(MIRROR))).collect()
}

fn glass() -> Model {
    lit_from_behind(of(GLASS, json!({ "transmissionFactor": 0.7 })))
}

fn leaf() -> Model {
    lit_from_behind(of(
        LEAF,
        json!({ "diffuseTransmissionFactor": 0.6,
            "diffuseTransmissionColorFactor": [0.3, 0.9, 0.2] }),
    ))
}
