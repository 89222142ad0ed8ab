//! What can be changed in a picture.

use lamplight_picture as picture;
use lamplight_picture::own::{UniformRole, uniform_role};
use lamplight_scenes::sets::LampKind;
use serde::Serialize;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::wasm_bindgen;

use super::exchange::PictureRequest;
use super::{plan, shot, with_kept};
use crate::diagnostic::{Diagnostic, diagnostics};
use crate::{Answer, answer};

/// The lamps of a picture, and the numbers of its uniforms.
#[derive(Default, Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct PictureControls {
    /// From world space to the picture, column by column, and back.
    pub clip_from_world: Vec<f64>,
    pub world_from_clip: Vec<f64>,
    pub lamps: Vec<LampInfo>,
    pub uniforms: Vec<UniformInfo>,
    pub diagnostics: Vec<Diagnostic>,
}

/// A lamp that shines.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct LampInfo {
    pub index: u32,
    /// `directional`, `point` or `spot`.
    pub kind: String,
    /// In world space.
    pub position: Vec<f64>,
}

/// A scalar or a vector of a uniform buffer.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct UniformInfo {
    /// The program that reads it.
    pub program: String,
    /// Such as `lamps.lights[2].color`.
    pub path: String,
    /// Type in WGSL.
    #[serde(rename = "type")]
    pub ty: String,
    pub numbers: Vec<f64>,
    /// `time` in seconds, or `color`, where the name says so.
    pub role: Option<String>,
}

/// What can be changed in a picture, with the numbers that it has. Matrices follow from the scene.
#[wasm_bindgen(js_name = pictureControls)]
pub fn picture_controls(request: Ts<PictureRequest>) -> Answer<PictureControls> {
    let request = request.to_rust()?;
    let found = with_kept(|kept| {
        plan(kept, &request)
            .and_then(|plan| picture::picture_controls(&kept.programs, &plan, &shot(&request)?))
            .map_err(|problems| diagnostics(&kept.programs.texts(), &problems))
    });
    answer(&match found.and_then(|found| found) {
        Ok(controls) => page_controls(controls),
        Err(diagnostics) => PictureControls { diagnostics, ..PictureControls::default() },
    })
}

/// A uniform for the page.
pub fn uniform_info(uniform: picture::Uniform) -> UniformInfo {
    let role = uniform_role(&uniform.path, &uniform.ty).map(|role| match role {
        UniformRole::Time => "time".to_owned(),
        UniformRole::Color => "color".to_owned(),
    });
    UniformInfo {
        role,
        program: uniform.program,
        path: uniform.path,
        ty: uniform.ty,
        numbers: uniform.numbers,
    }
}

fn page_controls(controls: picture::Controls) -> PictureControls {
    let matrix = controls.clip_from_world;
    let lamp = |lamp: &picture::LampControl| LampInfo {
        index: lamp.index as u32,
        kind: match lamp.kind {
            LampKind::Directional => "directional",
            LampKind::Point => "point",
            LampKind::Spot => "spot",
        }
        .to_owned(),
        position: lamp.position.to_array().to_vec(),
    };
    PictureControls {
        clip_from_world: matrix.to_cols_array().to_vec(),
        world_from_clip: matrix.inverse().to_cols_array().to_vec(),
        lamps: controls.lamps.iter().map(lamp).collect(),
        uniforms: controls.uniforms.into_iter().map(uniform_info).collect(),
        diagnostics: Vec::new(),
    }
}
