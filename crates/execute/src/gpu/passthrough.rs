//! Turns emitted files into SPIR-V that a Vulkan driver gets unchanged.

use super::hlsl;
use lamplight_bundle::{Native, SamplerHeap, Stage, Target};
use lamplight_emit::spirv::words;

/// One stage as SPIR-V.
#[derive(Debug, Clone)]
pub struct SpirvBinary {
    words: Vec<u32>,
    entry: String,
    /// The heaps that the stage takes its samplers from, if its target has heaps.
    pub heaps: Vec<SamplerHeap>,
}

impl SpirvBinary {
    /// The stage from the bytes of a target, if those can become SPIR-V. Sampler heaps go into the
    /// bind group `heaps`.
    ///
    /// # Errors
    /// The message of the translator.
    pub fn new(
        target: Target,
        stage: Stage,
        bytes: &[u8],
        native: &Native,
        heaps: u32,
    ) -> Result<Self, String> {
        let words = match target {
            Target::SPIRV => words(bytes),
            Target::HLSL => hlsl::compile_hlsl(bytes, stage, native, heaps)?,
            _ => return Err(format!("there is no SPIR-V of target `{target}`")),
        };
        let (entry, heaps) = (native.entry_name.clone(), native.sampler_heaps.clone());
        Ok(Self { words, entry, heaps })
    }

    /// The name of its entry point.
    pub fn entry(&self) -> &str {
        &self.entry
    }

    /// The stage as a shader module of the device.
    pub fn module(&self, device: &wgpu::Device, label: &str) -> wgpu::ShaderModule {
        let entry = wgpu::PassthroughShaderEntryPoint {
            name: self.entry.as_str().into(),
            workgroup_size: (0, 0, 0),
        };
        let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
            label: Some(label),
            entry_points: vec![entry].into(),
            spirv: Some(self.words.as_slice().into()),
            ..Default::default()
        };
        // SAFETY: the words were written from a validated module. Indices into arrays are not
        // clamped in it, and the harness only uses indices that are within its own arrays.
        unsafe { device.create_shader_module_passthrough(descriptor) }
    }
}
