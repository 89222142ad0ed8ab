//! Asks Arm's Mali Offline Compiler, and reads its report in JSON.
//!
//! The form of the report is that of the schema `performance` of malioc 7 and 8. A shader that it
//! refuses has a report of the schema `error`.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::pipeline::SpirvStage;
use super::stages::settled_words;
use lamplight_emit::spirv;
use lamplight_tools::{Tool, output_text};

/// The compiler. No package of Debian has it.
pub const MALIOC: Tool = Tool { program: "malioc", package: "" };

/// How to get the compiler.
pub const MISSING: &str = "`malioc` is not installed\n\
     it is a part of Arm Performance Studio: https://developer.arm.com/Tools%20and%20Software/Arm%20Performance%20Studio\n\
     put its folder on PATH";

/// What the compiler says of one variant of a stage. A fragment stage has one variant; a vertex
/// stage has one for the position and one for everything else.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MaliVariant {
    pub core: String,
    pub name: String,
    /// The names of the units of the core, in the order of the cycles.
    pub pipelines: Vec<String>,
    /// If every instruction were executed once.
    pub total: Cycles,
    pub shortest: Cycles,
    /// Unknown if the number of iterations of a loop is.
    pub longest: Cycles,
    pub work_registers: Option<f64>,
    pub uniform_registers: Option<f64>,
    /// Threads that run at a time, in percent of the most that a core can run.
    pub occupancy: Option<f64>,
    pub spilled_bytes: Option<f64>,
}

/// Cycles of each unit, and which units have the most.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cycles {
    #[serde(rename(deserialize = "cycle_count"))]
    pub cycles: Vec<Option<f64>>,
    #[serde(rename(deserialize = "bound_pipelines"))]
    pub bound: Vec<Option<String>>,
}

impl Cycles {
    /// Cycles of the busiest unit.
    pub fn most(&self) -> Option<f64> {
        self.cycles.iter().flatten().copied().reduce(f64::max)
    }
}

#[derive(Deserialize)]
#[serde(rename = "Report")]
struct MaliReport {
    shaders: Vec<MaliShader>,
}

#[derive(Deserialize)]
#[serde(rename = "Shader")]
struct MaliShader {
    hardware: Option<Hardware>,
    #[serde(default)]
    errors: Vec<String>,
    #[serde(default)]
    variants: Vec<Reported>,
}

#[derive(Deserialize)]
struct Hardware {
    core: String,
}

#[derive(Deserialize)]
struct Reported {
    name: String,
    performance: Performance,
    properties: Vec<Property>,
}

#[derive(Deserialize)]
struct Performance {
    pipelines: Vec<String>,
    total_cycles: Cycles,
    shortest_path_cycles: Cycles,
    longest_path_cycles: Cycles,
}

#[derive(Deserialize)]
struct Property {
    name: String,
    value: Value,
}

/// Compiles a stage for a core. `file` has its SPIR-V. The compiler reads the stage from the name,
/// which ends in `.spv` after the stage's suffix.
///
/// # Errors
/// The compiler's message where it refuses the stage, or what is wrong with its report.
pub fn compile_stage(file: &Path, entry: &str, core: &str) -> Result<Vec<MaliVariant>, String> {
    let arguments = ["--vulkan", "--core", core, "--name", entry, "--format", "json"];
    let output = MALIOC.run(&arguments, [file]);
    let output = output.map_err(|error| format!("`malioc` could not be run: {error}"))?;
    let printed = output_text(&output);
    parse_report(&String::from_utf8_lossy(&output.stdout)).map_err(|reason| match reason {
        MaliRefusal::Shader(errors) => format!("`malioc` refuses the shader for {core}: {errors}"),
        MaliRefusal::Report(why) => {
            let printed: String = printed.chars().take(400).collect();
            format!("the report of `malioc` for {core} could not be read: {why}\n{printed}")
        }
    })
}

/// Why there are no figures.
#[derive(Debug, PartialEq)]
pub enum MaliRefusal {
    /// The compiler's errors about the shader.
    Shader(String),
    /// What is wrong with the report.
    Report(String),
}

/// Reads a report: the variants of its only shader.
///
/// # Errors
/// What the compiler says of the shader, or what is wrong with the report.
pub fn parse_report(text: &str) -> Result<Vec<MaliVariant>, MaliRefusal> {
    let wrong = |why: String| MaliRefusal::Report(why);
    let report: MaliReport =
        serde_json::from_str(text).map_err(|error| wrong(error.to_string()))?;
    let [shader] = &report.shaders[..] else {
        return Err(wrong(format!("it has {} shaders instead of one", report.shaders.len())));
    };
    if !shader.errors.is_empty() {
        return Err(MaliRefusal::Shader(shader.errors.join("\n")));
    }
    if shader.variants.is_empty() {
        return Err(wrong("the shader has no variants".to_owned()));
    }
    let core = shader.hardware.as_ref().map_or_else(String::new, |known| known.core.clone());
    shader.variants.iter().map(|variant| variant_of(&core, variant).map_err(wrong)).collect()
}

fn variant_of(core: &str, reported: &Reported) -> Result<MaliVariant, String> {
    let Performance { pipelines, total_cycles, shortest_path_cycles, longest_path_cycles } =
        &reported.performance;
    for cycles in [total_cycles, shortest_path_cycles, longest_path_cycles] {
        if cycles.cycles.len() != pipelines.len() {
            let (counts, units) = (cycles.cycles.len(), pipelines.len());
            return Err(format!("`{}` has {counts} counts for {units} units", reported.name));
        }
    }
    let property = |name: &str| {
        let found = reported.properties.iter().find(|property| property.name == name);
        found.and_then(|property| property.value.as_f64())
    };
    Ok(MaliVariant {
        core: core.to_owned(),
        name: reported.name.clone(),
        pipelines: pipelines.clone(),
        total: total_cycles.clone(),
        shortest: shortest_path_cycles.clone(),
        longest: longest_path_cycles.clone(),
        work_registers: property("work_registers_used"),
        uniform_registers: property("uniform_registers_used"),
        occupancy: property("thread_occupancy"),
        spilled_bytes: property("stack_spill_bytes"),
    })
}

/// The bytes of a stage's file.
pub fn file_bytes(stage: &SpirvStage) -> Vec<u8> {
    spirv::bytes(&settled_words(stage))
}
