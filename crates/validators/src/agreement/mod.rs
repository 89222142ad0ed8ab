//! Reads an output again, and compares what is found with the reflection that is shipped with it.
//!
//! `output -> a reading, by the reader of the target -> differences from the reflection`
//!
//! | target | what reads it |
//! |---|---|
//! | `wgsl` | naga's front end, as the layouts that it computes |
//! | `spirv` | `spirv.rs`, by ids and decorations alone, so that names may be stripped |
//! | GLSL | glslc, as the layouts that it decorates its SPIR-V with |
//! | `hlsl` | `hlsl.rs`, with Microsoft's packing rules of constant buffers |
//! | `msl` | `msl.rs` for names and slots; clang for offsets, strides and sizes, by assertions |
//!
//! Layouts are read without the code that writes outputs and reflections. naga's front end for SPIR-V
//! is not used: it would check types as naga's writer does, and it needs a graph library, while a
//! reading needs the decorations alone. glslang is not asked about HLSL, since it lays constant
//! buffers out in another way than Direct3D: `hlsl_packing.rs` says how.
//!
//! What a language does not say is not compared: the size of a workgroup in MSL, a stage in HLSL and
//! GLSL, the padding behind a structure in SPIR-V and GLSL, and storage buffers in HLSL, whose
//! offsets are in functions.

mod compare;
mod described;
mod glsl;
mod hlsl;
mod hlsl_packing;
mod msl;
mod plan;
mod reading;
mod spirv;
mod spirv_types;
mod text;
mod wgsl;

pub use described::Described;
pub use plan::AGREEMENT;
pub(crate) use plan::{plan_agreement, sample_of_lines};
pub(crate) use wgsl::module_differences;

use lamplight_bundle::{Native, Reflection, Target};

/// What an output and its reflection disagree about, a line for each difference. For GLSL, and for
/// offsets in MSL, another program has to read the output.
pub fn output_differences(
    target: Target,
    bytes: &[u8],
    reflection: &Reflection,
    native: &Native,
) -> Vec<String> {
    let described = Described { reflection, native };
    let text = || std::str::from_utf8(bytes).map_err(|error| error.to_string());
    let found = match target {
        Target::SPIRV => spirv::spirv_differences(bytes, described),
        Target::WGSL => text().and_then(|text| wgsl::text_differences(text, described)),
        Target::HLSL => text().and_then(|text| hlsl::hlsl_differences(text, described)),
        Target::MSL => text().and_then(|text| msl::msl_differences(text, described)),
        _ => text().map(|text| glsl::text_differences(text, described)),
    };
    found.unwrap_or_else(|reason| vec![unread(&reason)])
}

/// The words for an output that its reader refuses.
fn unread(reason: &str) -> String {
    format!("it cannot be read again: {reason}")
}
