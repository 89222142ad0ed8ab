//! What values of axes cost, as `cargo xtask docs --costs` recorded it.

use lamplight::LIBRARY_FILES;
use lamplight::source::SourceSet;
use lamplight_catalogue::cost::{self, SHOWN};
use serde::Serialize;
use tsify::Tsify;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::{Answer, answer};

/// Figures on one GPU.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct CostInfo {
    /// The driver that compiled.
    pub driver: String,
    /// The GPU and its architecture.
    pub gpu: String,
    pub generation: String,
    pub axes: Vec<AxisCost>,
}

/// What a value changes in a stage, against the default of its axis.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct AxisCost {
    pub axis: String,
    pub value: String,
    /// `vertex`, `fragment` or `compute`.
    pub stage: String,
    /// Pairs of permutations that differ only in the axis.
    pub pairs: u32,
    /// The change of the cycles of vector instructions: the smallest, the median, and the largest.
    pub cycles: Vec<i32>,
    /// The median change.
    pub vgprs: i32,
    /// Waves on a SIMD with the default and with the value, of the median pair.
    pub waves: Vec<i32>,
    /// The median change of the reads of textures.
    pub texture: i32,
}

/// What the axes of one of the library's programs cost.
#[wasm_bindgen(js_name = costs)]
pub fn axis_costs(program: &str) -> Answer<CostInfo> {
    // The library's own files have no errors.
    let record = cost::library_costs(LIBRARY_FILES, &mut SourceSet::default()).unwrap_or_default();
    let shown = record.gpus.iter().find(|gpu| gpu.name == SHOWN);
    let axis = |cost: &cost::AxisCost| AxisCost {
        axis: cost.axis.clone(),
        value: cost.value.clone(),
        stage: cost.stage.name().to_owned(),
        pairs: cost.pairs as u32,
        cycles: cost.cycles.map(|change| change as i32).to_vec(),
        vgprs: cost.vgprs as i32,
        waves: cost.waves.map(|waves| waves as i32).to_vec(),
        texture: cost.texture as i32,
    };
    answer(&CostInfo {
        driver: record.driver.clone(),
        gpu: SHOWN.to_owned(),
        generation: shown.map(|gpu| gpu.generation.clone()).unwrap_or_default(),
        axes: record.axes.iter().filter(|cost| cost.program == program).map(axis).collect(),
    })
}
