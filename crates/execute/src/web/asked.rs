//! Writes kernels, textures and samplers as the JSON that the scripts take.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Value, json};

use super::executor_failed;
use crate::fixture::{Fixture, FixtureSampler, FixtureTexture};
use crate::kernel::Kernel;
use lamplight_bundle::Combined;
use lamplight_diagnostic::Diagnostic;
use lamplight_emit::Emitted;

/// The stages that may read a binding, as WebGPU's bits.
const VERTEX_AND_FRAGMENT: u32 = 3;

/// Bytes as base64.
pub fn base64_of_bytes(bytes: &[u8]) -> String {
    BASE64_STANDARD.encode(bytes)
}

/// Words as base64.
pub fn base64_of_words(words: &[u32]) -> String {
    let all: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    base64_of_bytes(&all)
}

/// The words of an answer.
pub fn words_of_answer(value: &Value) -> Result<Vec<u32>, String> {
    let text = value.as_str().ok_or_else(|| format!("no words: {value}"))?;
    let bytes = BASE64_STANDARD.decode(text).map_err(|error| error.to_string())?;
    Ok(bytes.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect())
}

/// A kernel with everything that it is bound to.
pub fn kernel_json(kernel: &Kernel, emitted: &Emitted) -> Result<Value, Diagnostic> {
    let code =
        str::from_utf8(&emitted.bytes).map_err(|error| executor_failed(error.to_string()))?;
    let fixtures: Vec<((u32, u32), &Fixture)> =
        kernel.resources().map(|resource| ((0, resource.binding), &*resource.fixture)).collect();
    let filters = are_filtered(fixtures.iter().map(|(_, fixture)| *fixture));
    let inputs = json!({
        "binding": 0,
        "visibility": VERTEX_AND_FRAGMENT,
        "texture": { "sampleType": "uint", "viewDimension": "2d" },
    });
    let layout =
        fixtures.iter().map(|(place, fixture)| layout_entry(*place, Some(fixture), filters));
    let units: Vec<Value> = emitted.native.combined.iter().map(unit_json).collect();
    Ok(json!({
        "id": kernel.code,
        "code": code,
        "entry": emitted.native.entry_name,
        "layout": std::iter::once(inputs).chain(layout).collect::<Vec<_>>(),
        "fixtures": fixtures.iter().map(|(place, one)| fixture_json(*place, one)).collect::<Vec<_>>(),
        "units": units,
    }))
}

/// The key of a binding in the JSON for the scripts.
pub fn binding_key((group, binding): (u32, u32)) -> String {
    format!("{group}/{binding}")
}

/// A combined sampler of GLSL.
pub fn unit_json(combined: &Combined) -> Value {
    let key_of = |place: [u32; 2]| binding_key((place[0], place[1]));
    json!({
        "name": combined.name,
        "texture": key_of(combined.texture),
        "sampler": combined.sampler.map(key_of),
    })
}

/// Whether a sampler filters colour textures. Not every device can filter f32 textures.
pub fn are_filtered<'a>(mut fixtures: impl Iterator<Item = &'a Fixture>) -> bool {
    fixtures.any(|one| matches!(one, Fixture::Sampler(one) if one.linear && one.compare.is_none()))
}

/// The layout of a binding in WebGPU. Without a fixture it is a uniform buffer.
pub fn layout_entry((_, binding): (u32, u32), fixture: Option<&Fixture>, filters: bool) -> Value {
    let mut entry = json!({ "binding": binding, "visibility": VERTEX_AND_FRAGMENT });
    match fixture {
        Some(Fixture::Texture(texture)) => {
            let sample = match (texture.kind.is_depth(), filters) {
                (true, _) => "depth",
                (false, true) => "float",
                (false, false) => "unfilterable-float",
            };
            let dimension = if texture.kind.layers() == 6 { "cube" } else { "2d" };
            entry["texture"] = json!({ "sampleType": sample, "viewDimension": dimension });
        }
        Some(Fixture::Sampler(sampler)) => {
            let kind = match sampler {
                FixtureSampler { compare: Some(_), .. } => "comparison",
                FixtureSampler { linear: true, .. } => "filtering",
                _ => "non-filtering",
            };
            entry["sampler"] = json!({ "type": kind });
        }
        None => entry["buffer"] = json!({ "type": "uniform" }),
    }
    entry
}

/// A texture or a sampler with its binding.
pub fn fixture_json(place: (u32, u32), fixture: &Fixture) -> Value {
    match fixture {
        Fixture::Texture(texture) => {
            json!({ "place": binding_key(place), "texture": image_json(texture) })
        }
        Fixture::Sampler(one) => {
            json!({ "place": binding_key(place), "sampler": sampler_json(*one) })
        }
    }
}

fn image_json(texture: &FixtureTexture) -> Value {
    let texels: Vec<u32> = texture.texels.iter().map(|texel| texel.to_bits()).collect();
    json!({
        "width": texture.width,
        "height": texture.height,
        "layers": texture.kind.layers(),
        "depth": texture.kind.is_depth(),
        "texels": base64_of_words(&texels),
    })
}

/// The sampler in WebGPU's terms.
fn sampler_json(sampler: FixtureSampler) -> Value {
    let (address, compare) = sampler.web_words();
    let filter = if sampler.linear { "linear" } else { "nearest" };
    json!({ "address": address, "filter": filter, "compare": compare })
}
