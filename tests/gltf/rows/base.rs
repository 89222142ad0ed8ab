//! The metallic-roughness material, alpha, and sides.

use serde_json::json;

use super::{PRINTED, Row, beside, bulging, extended, metal, plain, row, textured};
use crate::gltf::model::{Mesh, Model};

fn rows_first() -> Vec<Row> {
    vec![
        row("base_color_factor", "3.9.2", "multiplied with texture and vertex colour", || {
            let colors = vec![[1.0, 0.6, 0.9, 1.0], [0.7, 1.0, 0.8, 1.0], [0.6, 0.9, 1.0, 1.0]];
            textured(Mesh { colors: Some(colors), ..bulging() }, |index| {
                let mut material = plain(json!({}));
                material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": index });
                material
            })
        }),
        row("base_color_texture", "3.9.2", "decoded from sRGB before it is filtered", || {
            textured(bulging(), |index| {
                let mut material = plain(json!({}));
                material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": index });
                material
            })
        }),
        row("vertex_colors", "3.9.2", "linear, multiplied with the factor", || {
            let colors = vec![[1.0, 0.2, 0.1, 1.0], [0.3, 1.0, 0.5, 1.0], [0.2, 0.4, 1.0, 1.0]];
            Model::of(Mesh { colors: Some(colors), ..bulging() }, plain(json!({})))
        }),
        row("metallic_factor", "appendix B", "mix of a dielectric and a metal", || {
            let mut material = metal(0.4);
            material["pbrMetallicRoughness"]["metallicFactor"] = json!(0.6);
            Model::of(bulging(), material)
        }),
        row("roughness_smooth", "appendix B", "metal of roughness 0.15", || {
            Model::of(bulging(), metal(0.15))
        }),
        row(
            "roughness_full",
            "appendix B",
            "metal of roughness 1; facets reflect several times, as B.2.3 suggests, by Turquin (2019)",
            || Model::of(bulging(), metal(1.0)),
        ),
        row("roughness_printed", "B.3", "the same metal by the sample implementation", || {
            Model::of(bulging(), metal(1.0))
        })
        .with(PRINTED)
        .differs("light that facets reflect several times is added, as B.2.3 suggests"),
        row("roughness_zero", "B.3.2", "a highlight without roughness", || {
            Model::of(bulging(), metal(0.0))
        })
        .differs("highlights of lamps are never narrower than those of roughness 0.045"),
    ]
}

fn rows_second() -> Vec<Row> {
    vec![
        row("metallic_roughness_texture", "3.9.2", "metal in blue, roughness in green", || {
            textured(bulging(), |index| {
                let mut material = metal(0.9);
                material["pbrMetallicRoughness"]["metallicRoughnessTexture"] =
                    json!({ "index": index });
                material
            })
        }),
        row("emissive_factor", "3.9.3", "added", || {
            Model::of(bulging(), plain(json!({ "emissiveFactor": [0.2, 0.1, 0.4] })))
        }),
        row("emissive_texture", "3.9.3", "decoded from sRGB, times the factor", || {
            textured(bulging(), |index| {
                plain(json!({
                    "emissiveFactor": [0.5, 1.0, 0.8], "emissiveTexture": { "index": index } }))
            })
        }),
        row("emissive_strength", "KHR_materials_emissive_strength", "times the emission", || {
            let mut material =
                extended("KHR_materials_emissive_strength", json!({ "emissiveStrength": 5.0 }));
            material["emissiveFactor"] = json!([0.2, 0.1, 0.4]);
            Model::of(bulging(), material)
        }),
        row("alpha_mask", "3.9.4", "points below the cutoff are left out", || masked(0.4, 90)),
        row("alpha_mask_zero", "3.9.4", "no point is below a cutoff of 0", || masked(0.0, 0)),
        row("alpha_opaque", "3.9.4", "alpha counts for nothing", || {
            let mut material = plain(json!({ "alphaMode": "OPAQUE" }));
            material["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.8, 0.5, 0.3, 0.2]);
            Model::of(bulging(), material)
        }),
        row("alpha_opaque_beside_mask", "3.9.4", "vertex alpha counts for nothing too", || {
            let mut model = masked(0.4, 90);
            let material = model.add_material(plain(json!({})));
            let colors = Some(vec![[1.0, 1.0, 1.0, 0.1]; 3]);
            // Behind the other one, so that the mask has the only edge.
            let behind = json!({ "translation": [0.0, 0.0, -0.3], "scale": [1.2, 1.2, 1.2] });
            model.add(Mesh { material, colors, ..bulging() }, behind);
            model
        }),
        row("alpha_blend", "3.9.4", "over what is behind, sorted at each pixel", blended),
    ]
}

fn rows_third() -> Vec<Row> {
    vec![
        row("alpha_blend_with_mask", "3.9.4", "both in one model; vertex alpha counts", || {
            let mut model = blended();
            let mut material = plain(json!({ "alphaMode": "MASK" }));
            material["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.2, 0.9, 0.3, 0.9]);
            let material = model.add_material(material);
            let colors = Some(vec![[1.0, 1.0, 1.0, 0.9]; 3]);
            let part = Mesh { material, colors, ..bulging() };
            model.add(part, json!({ "translation": [0.0, 0.0, 0.1] }));
            model
        }),
        row("double_sided", "3.9.5", "backs have the opposite normal", || {
            Model::of(bulging().turned(), plain(json!({ "doubleSided": true })))
        }),
        row("single_sided", "3.9.5", "backs are not drawn", || {
            let mut model = Model::of(bulging(), plain(json!({})));
            let mut back = bulging().turned();
            back.material = model.add_material(plain(json!({})));
            model.add(back, json!({ "translation": [0.0, 0.0, 0.3] }));
            model
        }),
        row("unlit", "KHR_materials_unlit", "the colour alone", || {
            textured(bulging(), |index| {
                let mut material = extended("KHR_materials_unlit", json!({}));
                material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": index });
                material
            })
        }),
    ]
}

fn rows_fourth() -> Vec<Row> {
    vec![row(
        "unlit_beside_lit",
        "KHR_materials_unlit",
        "as a surface that emits its colour",
        || {
            let mut model = Model::of(bulging(), plain(json!({})));
            let texture = model.add_texture(super::pattern(), json!({}));
            let mut material = extended("KHR_materials_unlit", json!({}));
            material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
            let material = model.add_material(material);
            let part = Mesh { material, ..bulging() };
            model.add(part, beside());
            model
        },
    )]
}

pub fn rows() -> Vec<Row> {
    [rows_first(), rows_second(), rows_third(), rows_fourth()].concat()
}

/// Two surfaces before an opaque one, the nearer of which is first in the document and double-sided.
fn blended() -> Model {
    let mut model = Model::new();
    let texture = model.add_texture(super::pattern(), json!({}));
    let color = |alpha: f64| {
        let mut material = plain(json!({ "alphaMode": "BLEND", "doubleSided": true }));
        material["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.3, 0.6, 0.9, alpha]);
        material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
        material
    };
    let [near, far] = [0.7, 0.4].map(|alpha| model.add_material(color(alpha)));
    let behind = model.add_material(plain(json!({})));
    let colors = Some(vec![[1.0, 1.0, 1.0, 1.0], [1.0, 1.0, 1.0, 0.2], [1.0, 0.5, 1.0, 0.6]]);
    let part = Mesh { material: near, colors, ..bulging() };
    model.add(part, json!({ "translation": [0.0, 0.0, 0.4] }));
    let part = Mesh { material: far, ..bulging().turned() };
    model.add(part, json!({ "translation": [0.0, 0.0, 0.2] }));
    model.add(Mesh { material: behind, ..bulging() }, json!({}));
    model.add_usual_lamps();
    model
}

/// A pattern whose alpha is low in half of its columns and high in the others.
fn masked(cutoff: f64, low: u8) -> Model {
    let mut pixels = super::pattern();
    for (index, texel) in pixels.texels.iter_mut().enumerate() {
        texel[3] = if index % 4 < 2 { low } else { 200 };
    }
    super::textured_by(bulging(), pixels, json!({ "magFilter": 9728 }), move |index| {
        let mut material = plain(json!({ "alphaMode": "MASK", "alphaCutoff": cutoff }));
        material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": index });
        material["pbrMetallicRoughness"]["baseColorFactor"] = json!([1.0, 1.0, 1.0, 0.8]);
        material
    })
}
