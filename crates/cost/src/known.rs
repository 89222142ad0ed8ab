//! Figures that were measured before.

use std::hash::{Hash as _, Hasher};

use super::StageFigures;
use super::device::Device;
use super::pipeline::Pipeline;
use lamplight_bundle::Hash;
use lamplight_bundle::contents::shortened_hash;
use lamplight_generate::cache::Cache;

/// The first word of the names of records.
const KIND: &str = "costs";

/// The figures of a pipeline's stages, measured unless the cache has them.
///
/// # Errors
/// What the driver says where it refuses the pipeline.
pub fn known_figures(
    device: &Device,
    pipeline: &Pipeline,
    cache: Option<&Cache>,
) -> Result<StageFigures, String> {
    let Some(cache) = cache else { return device.measure(pipeline) };
    let key = figures_key(cache.build(), device, pipeline);
    let known = cache.get(KIND, key).and_then(|bytes| serde_json::from_slice(&bytes).ok());
    if let Some(known) = known {
        return Ok(known);
    }
    let figures = device.measure(pipeline)?;
    cache.put(KIND, key, serde_json::to_vec(&figures).ok());
    Ok(figures)
}

/// A hash of all that figures depend on: the pipeline, the GPU, the driver, and how this crate
/// asks.
fn figures_key(build: &str, device: &Device, pipeline: &Pipeline) -> Hash {
    let mut hasher = DigestHasher(blake3::Hasher::new());
    (build, &device.driver, device.gpu.name, pipeline).hash(&mut hasher);
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
