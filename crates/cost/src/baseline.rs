//! Recorded costs, and which figures rose since; and the cache of figures that were measured
//! before.

use crate::device::Device;
use crate::pipeline::Pipeline;
use crate::statistics::{FIGURES, Statistics};
use crate::{Cost, StageFigures};
use lamplight_bundle::Hash;
use lamplight_bundle::contents::shortened_hash;
use lamplight_generate::cache::Cache;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::hash::{Hash as _, Hasher};

/// Identifies a file of recorded costs.
const FORMAT: &str = "lamplight-costs-2";

/// Figures of one version of the driver, by name, GPU and stage.
#[derive(Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// [`FORMAT`].
    format: String,
    /// The driver's version. Figures of other versions are not comparable.
    pub driver: String,
    pub costs: BTreeMap<String, Statistics>,
}

/// A figure that is worse than recorded.
#[derive(Debug, PartialEq, Eq)]
pub struct Rise {
    /// Name, GPU and stage.
    pub key: String,
    pub figure: &'static str,
    pub before: i64,
    pub after: i64,
}

/// The key under which a cost is recorded.
pub fn baseline_key(cost: &Cost) -> String {
    format!("{} {} {:?}", cost.name, cost.gpu.name, cost.stage).to_lowercase()
}

impl Baseline {
    /// Records costs.
    pub fn of(driver: &str, costs: &[Cost]) -> Self {
        let costs = costs.iter().map(|cost| (baseline_key(cost), *cost.figures())).collect();
        Self { format: FORMAT.to_owned(), driver: driver.to_owned(), costs }
    }

    /// Reads a file's bytes.
    ///
    /// # Errors
    /// Why they are not recorded costs.
    pub fn parse(bytes: &[u8]) -> Result<Self, String> {
        let read: Self = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
        match read.format == FORMAT {
            true => Ok(read),
            false => Err(format!("the format is `{}`, not `{FORMAT}`", read.format)),
        }
    }

    /// The text of a file, with one line for each cost, so that a diff is readable.
    pub fn text(&self) -> String {
        let written = |value: &str| serde_json::Value::from(value).to_string();
        let line = |(key, figures): (&String, &Statistics)| {
            let figures = serde_json::to_string(figures).unwrap_or_default();
            format!("    {}: {figures}", written(key))
        };
        let costs: Vec<String> = self.costs.iter().map(line).collect();
        format!(
            "{{\n  \"format\": {},\n  \"driver\": {},\n  \"costs\": {{\n{}\n  }}\n}}\n",
            written(&self.format),
            written(&self.driver),
            costs.join(",\n")
        )
    }

    /// Whether a file that begins like this holds recorded costs.
    pub fn is_at(head: &[u8]) -> bool {
        String::from_utf8_lossy(head).contains(FORMAT)
    }

    /// Figures that are worse than recorded by more than a share of the recorded figure, such as
    /// 0.02. Figures that are not recorded are not compared.
    pub fn rises(&self, costs: &[Cost], share: f64) -> Vec<Rise> {
        let mut rises = Vec::new();
        for cost in costs {
            let key = baseline_key(cost);
            let Some(recorded) = self.costs.get(&key) else { continue };
            for figure in FIGURES {
                let (before, after) = (figure.of(recorded), figure.of(cost.figures()));
                let worse = if figure.more_is_worse { after - before } else { before - after };
                if worse as f64 > share * before.abs() as f64 {
                    rises.push(Rise { key: key.clone(), figure: figure.key, before, after });
                }
            }
        }
        rises
    }
}

/// The first word of the names of records.
const KIND: &str = "costs";

/// The figures of a pipeline's stages, measured unless the cache has them.
///
/// # Errors
/// What the driver says where it refuses the pipeline.
pub fn known_figures(
    device: &Device,
    pipeline: &Pipeline,
    iterations: &[u32],
    cache: Option<&Cache>,
) -> Result<StageFigures, String> {
    let Some(cache) = cache else { return device.measure(pipeline, iterations) };
    let key = figures_key(cache.build(), device, pipeline, iterations);
    let known = cache.get(KIND, key).and_then(|bytes| serde_json::from_slice(&bytes).ok());
    if let Some(known) = known {
        return Ok(known);
    }
    let figures = device.measure(pipeline, iterations)?;
    cache.put(KIND, key, serde_json::to_vec(&figures).ok());
    Ok(figures)
}

/// A hash of all that figures depend on: the pipeline, the GPU, the driver, and how this crate
/// asks.
fn figures_key(build: &str, device: &Device, pipeline: &Pipeline, iterations: &[u32]) -> Hash {
    let mut hasher = DigestHasher(blake3::Hasher::new());
    (build, &device.driver, device.gpu.name, pipeline, iterations).hash(&mut hasher);
    shortened_hash(&hasher.0.finalize())
}

/// Hashes what implements [`std::hash::Hash`] with BLAKE3. Parts cannot run into each other: a list
/// begins with its length, and a string ends with a byte that no string has.
struct DigestHasher(blake3::Hasher);

impl Hasher for DigestHasher {
    fn write(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    fn finish(&self) -> u64 {
        let bytes = self.0.finalize();
        bytes.as_bytes().first_chunk().map_or(0, |first| u64::from_le_bytes(*first))
    }
}
