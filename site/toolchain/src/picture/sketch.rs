//! Fragment stages of the user, drawn on a model.

use std::collections::BTreeMap;

use lamplight::compose;
use lamplight::diagnostic::Diagnostics;
use lamplight::source::SourceSet;
use lamplight_picture::sketch::{MODELS, SOURCES, Sketch, SketchOptions};
use lamplight_picture::{PreparedPass, Shot, Surroundings};
use lamplight_scenes::environment;
use serde::{Deserialize, Serialize};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::wasm_bindgen;

use super::author;
use super::controls::{UniformInfo, uniform_info};
use super::exchange::Step;
use super::{Ready, Work, begun, refused};
use crate::diagnostic::{Diagnostic, diagnostics};
use crate::shader::{ShaderRequest, composed_text};
use crate::{Answer, answer};

/// A fragment stage, and how it is drawn.
#[derive(Clone, PartialEq, Deserialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct SketchRequest {
    /// Its file and settings. `entry` names the entry point, if there are several.
    pub shader: ShaderRequest,
    /// One of `models`.
    #[serde(default)]
    #[tsify(optional)]
    pub model: String,
    /// How far the viewer has walked around the model, and how high, in radians.
    #[serde(default)]
    #[tsify(optional)]
    pub turn: [f64; 2],
    /// The place of the light, in world space. The model is at the origin.
    #[serde(default)]
    #[tsify(optional)]
    pub lamp: Option<[f64; 3]>,
    /// One of `sources` for an input. The others have the one that their name suggests.
    #[serde(default)]
    #[tsify(optional, type = "Record<string, string>")]
    pub inputs: BTreeMap<String, String>,
    /// Numbers of uniforms by path.
    #[serde(default)]
    #[tsify(optional, type = "Record<string, number[]>")]
    pub uniforms: BTreeMap<String, Vec<f64>>,
    /// Whether the text is an author's, as `lamplight render FILE` takes it: it may have a vertex stage,
    /// and names say what uniforms, inputs and textures hold. `model` may be a scene then, and without
    /// one the text chooses.
    #[serde(default)]
    #[tsify(optional)]
    pub own: bool,
    /// Seconds.
    #[serde(default)]
    #[tsify(optional)]
    pub time: f64,
    /// What textures of an author's text hold, by their names: one of the choices, or `file:NAME` for an
    /// image that `keepImage` took.
    #[serde(default)]
    #[tsify(optional, type = "Record<string, string>")]
    pub textures: BTreeMap<String, String>,
    /// Pixels along an edge.
    pub size: u32,
    /// How many places of each pixel are averaged.
    pub samples: u32,
    /// Factor on all light, in powers of two.
    #[serde(default)]
    #[tsify(optional)]
    pub exposure: f64,
    /// As in `PictureRequest`.
    pub target: String,
}

/// What can be changed in a sketch.
#[derive(Default, Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct SketchControls {
    pub inputs: Vec<InputInfo>,
    pub uniforms: Vec<UniformInfo>,
    /// The textures of an author's text.
    pub textures: Vec<TextureChoice>,
    /// Whether it is drawn over the whole picture, and not on a model.
    pub is_flat: bool,
    /// Whether numbers of colours are linear light.
    pub is_linear: bool,
    pub models: Vec<String>,
    /// What inputs can be given.
    pub sources: Vec<String>,
    pub diagnostics: Vec<Diagnostic>,
}

/// A texture, with what it holds and what it could hold.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct TextureChoice {
    pub name: String,
    /// Type in WGSL.
    #[serde(rename = "type")]
    pub ty: String,
    pub value: String,
    pub choices: Vec<String>,
}

/// An input of the stage.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct InputInfo {
    pub name: String,
    #[serde(rename = "type")]
    pub ty: String,
    /// One of `sources`.
    pub source: String,
}

/// Where the light is if nobody moved it.
pub const LAMP: [f64; 3] = [1.6, 2.0, 2.4];

/// Begins a picture of a fragment stage, and forgets the picture before it. `pictureFrames`
/// continues.
#[wasm_bindgen(js_name = sketchStart)]
pub fn sketch_start(request: Ts<SketchRequest>) -> Answer<Step> {
    let request = request.to_rust()?;
    let mut sources = SourceSet::default();
    answer(&match prepared_sketch(&request, &mut sources) {
        Ok(PreparedSketch { prepared, shot, is_upside_down }) => {
            let prepared = Box::new(prepared);
            let ready = Ready { prepared, shot, is_upside_down, before: 0 };
            begun(Work::Sketch(request.target), Some(ready))
        }
        Err(problems) => {
            Step { drawing: None, picture: None, diagnostics: diagnostics(&sources, &problems) }
        }
    })
}

/// What can be changed in the picture of a fragment stage.
#[wasm_bindgen(js_name = sketchControls)]
pub fn sketch_controls(request: Ts<SketchRequest>) -> Answer<SketchControls> {
    let request = request.to_rust()?;
    let mut sources = SourceSet::default();
    if request.own {
        let found = author::author_controls(&request, &mut sources);
        return answer(&found.unwrap_or_else(|problems| SketchControls {
            diagnostics: diagnostics(&sources, &problems),
            ..SketchControls::default()
        }));
    }
    let mut controls = SketchControls {
        is_linear: true,
        models: MODELS.iter().map(|(name, _)| (*name).to_owned()).collect(),
        sources: SOURCES.iter().map(|(name, _)| (*name).to_owned()).collect(),
        ..SketchControls::default()
    };
    match sketched(&request, &mut sources) {
        Ok((sketch, setting)) => {
            let input = |(name, ty, source): (String, String, &str)| InputInfo {
                name,
                ty,
                source: source.to_owned(),
            };
            controls.inputs = sketch.inputs(&setting).into_iter().map(input).collect();
            controls.uniforms = sketch.uniforms(&setting).into_iter().map(uniform_info).collect();
        }
        Err(problems) => controls.diagnostics = diagnostics(&sources, &problems),
    }
    answer(&controls)
}

/// A sketch on its model, with its camera.
pub struct PreparedSketch {
    pub prepared: PreparedPass,
    pub shot: Shot,
    /// Whether the rows of the picture come in the other order.
    pub is_upside_down: bool,
}

/// Makes a sketch ready to be drawn.
pub fn prepared_sketch(
    request: &SketchRequest,
    sources: &mut SourceSet,
) -> Result<PreparedSketch, Diagnostics> {
    let shot = shot(request)?;
    if request.own {
        let (prepared, is_upside_down) =
            author::author_picture(request, &shot, sources)?.into_pass();
        return Ok(PreparedSketch { prepared, shot, is_upside_down });
    }
    let (sketch, setting) = sketched(request, sources)?;
    let prepared = sketch.prepare(&setting, &shot)?;
    Ok(PreparedSketch { prepared, shot, is_upside_down: false })
}

fn sketched(
    request: &SketchRequest,
    sources: &mut SourceSet,
) -> Result<(Sketch, SketchOptions), Diagnostics> {
    let composed: compose::Composed = composed_text(&request.shader, sources)?;
    let sketch = Sketch::of_text(&composed, request.shader.entry.as_deref())?;
    let setting = SketchOptions {
        model: request.model.clone(),
        turn: request.turn,
        lamp: request.lamp.unwrap_or(LAMP).into(),
        inputs: request.inputs.clone(),
        uniforms: request.uniforms.clone(),
    };
    Ok((sketch, setting))
}

pub fn shot(request: &SketchRequest) -> Result<Shot, Diagnostics> {
    const LARGEST: u32 = 1024;
    let sky = environment("studio").ok_or_else(|| vec![refused("there is no environment")])?;
    Ok(Shot {
        size: [request.size.clamp(1, LARGEST); 2],
        samples: request.samples.clamp(1, 16),
        exposure: request.exposure.clamp(-32.0, 32.0),
        cascades: 1,
        language: lamplight::bundle::Language::Wesl,
        surroundings: Surroundings::Formula(sky),
    })
}
