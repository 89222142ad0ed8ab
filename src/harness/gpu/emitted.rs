//! Kernels as the files that the crate emits, given to the driver as they are.

use naga::valid::{ValidationFlags, Validator};

use super::failed;
use crate::bundle::Target;
use crate::compose::Language;
use crate::diagnostic::Diagnostic;
use crate::emit::{self, Emitted};
use crate::harness::kernel::{ENTRY, Kernel};
use crate::validate::{CAPABILITIES, Validated};

/// The kernel's entry point in a target's language.
pub fn emit(kernel: &Kernel, target: Target) -> Result<Emitted, Diagnostic> {
    let info = Validator::new(ValidationFlags::all(), CAPABILITIES).validate(&kernel.module);
    let info = info.map_err(|error| failed(format!("the kernel is not valid: {error}")))?;
    emit::emit(&Validated { language: Language::Wesl, module: kernel.module.clone(), info }, ENTRY, target)
}

/// Emitted SPIR-V as a shader of the device.
pub fn module(device: &wgpu::Device, kernel: &Kernel, emitted: &Emitted) -> wgpu::ShaderModule {
    let words: Vec<u32> = emitted.bytes.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect();
    let entry = wgpu::PassthroughShaderEntryPoint { name: emitted.native.entry_name.as_str().into(), workgroup_size: (0, 0, 0) };
    let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
        label: Some(kernel.name.as_str()),
        entry_points: vec![entry].into(),
        spirv: Some(words.into()),
        ..Default::default()
    };
    // SAFETY: the words were written by naga from a validated module; indices into arrays are not
    // clamped in it, and the kernel's own are within its textures.
    unsafe { device.create_shader_module_passthrough(descriptor) }
}
