//! Emitted files as SPIR-V that a Vulkan driver takes as it is.

use super::hlsl;
use crate::bundle::{Native, SamplerHeap, Stage, Target};
use crate::emit::spirv::words;

/// One stage, ready for the driver.
#[derive(Debug, Clone)]
pub struct Binary {
    words: Vec<u32>,
    entry: String,
    /// Heaps that the stage takes its samplers from, if its target has such.
    pub heaps: Vec<SamplerHeap>,
}

impl Binary {
    /// The bytes of a target that SPIR-V can be had of. Sampler heaps go into the bind group
    /// `heaps`.
    ///
    /// # Errors
    /// In words: those of the translator.
    pub fn new(
        target: Target,
        stage: Stage,
        bytes: &[u8],
        native: &Native,
        heaps: u32,
    ) -> Result<Self, String> {
        let words = match target {
            Target::SPIRV => words(bytes),
            Target::HLSL => hlsl::spirv(bytes, stage, native, heaps)?,
            _ => return Err(format!("there is no SPIR-V of target `{target}`")),
        };
        let (entry, heaps) = (native.entry_name.clone(), native.sampler_heaps.clone());
        Ok(Self { words, entry, heaps })
    }

    /// Its entry point.
    pub fn entry(&self) -> &str {
        &self.entry
    }

    /// As a shader of the device.
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
        // SAFETY: the words were written from a validated module; indices into arrays are not
        // clamped in it, and the harness draws with indices that are within its own arrays.
        unsafe { device.create_shader_module_passthrough(descriptor) }
    }
}
