//! Finds an adapter and opens a device on it.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use glow::HasContext as _;

use super::{Gpu, lock};
use crate::bundle::Target;

/// The full-screen triangle.
const VERTEX: &str = "
@vertex fn triangle(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2u((index << 1u) & 2u, index & 2u);
    return vec4f(vec2f(corner) * 2.0 - 1.0, 0.0, 1.0);
}";

/// Which device to open, and what it is given.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    pub backend: wgpu::Backends,
    /// Part of the adapter's name that it must have, or must not have.
    pub named: Named,
    pub shaders: Shaders,
}

/// A condition on an adapter's name.
#[derive(Debug, Clone, Copy)]
pub enum Named {
    With(&'static str),
    Without(&'static str),
}

/// Where a kernel's shader comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shaders {
    /// wgpu translates naga's module.
    Translated,
    /// What the crate emits, as it is.
    Emitted(Target),
}

impl Named {
    fn allows(self, name: &str) -> bool {
        match self {
            Self::With(part) => name.contains(part),
            Self::Without(part) => !name.contains(part),
        }
    }
}

/// Opens the preferred adapter of a backend: a software one where there is one, since its
/// numbers are the same on every machine. The error is in words.
pub fn open(wanted: Wanted) -> Result<Gpu, String> {
    let descriptor = wgpu::InstanceDescriptor { backends: wanted.backend, ..wgpu::InstanceDescriptor::new_without_display_handle() };
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wanted.backend));
    adapters.retain(|adapter| wanted.named.allows(&adapter.get_info().name));
    adapters.sort_by_key(|adapter| adapter.get_info().device_type != wgpu::DeviceType::Cpu);
    let adapter = adapters.into_iter().next().ok_or("no adapter was found")?;
    let mut features = wgpu::Features::FLOAT32_FILTERABLE & adapter.features();
    if wanted.shaders != Shaders::Translated {
        features |= wgpu::Features::PASSTHROUGH_SHADERS;
    }
    let descriptor = wgpu::DeviceDescriptor { required_features: features, required_limits: adapter.limits(), ..Default::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| error.to_string())?;
    let faults = watch(&device);
    filter_seams(&device);
    let source = wgpu::ShaderSource::Wgsl(VERTEX.into());
    let vertex = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let adapter = describe(&adapter.get_info());
    Ok(Gpu { adapter, shaders: wanted.shaders, device, queue, faults, vertex, prepared: HashMap::new(), runs: 0 })
}

/// OpenGL filters across the edges of a cube's faces only where it is told to, as WebGPU means it;
/// wgpu does not tell it.
fn filter_seams(device: &wgpu::Device) {
    // SAFETY: the device has just been made, and is not destroyed here.
    let Some(device) = (unsafe { device.as_hal::<wgpu::hal::api::Gles>() }) else { return };
    let context = device.context().lock();
    // OpenGL ES 3 knows no other way.
    if !context.version().is_embedded {
        // SAFETY: the lock makes the context current.
        unsafe { context.enable(glow::TEXTURE_CUBE_MAP_SEAMLESS) };
    }
}

/// Collects what would otherwise be a panic.
fn watch(device: &wgpu::Device) -> Arc<Mutex<Vec<String>>> {
    let faults = Arc::new(Mutex::new(Vec::new()));
    let sink = Arc::clone(&faults);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| lock(&sink).push(error.to_string())));
    let sink = Arc::clone(&faults);
    device.set_device_lost_callback(move |reason, message| {
        if !matches!(reason, wgpu::DeviceLostReason::Destroyed) {
            lock(&sink).push(format!("the device was lost: {message}"));
        }
    });
    faults
}

fn describe(info: &wgpu::AdapterInfo) -> String {
    let parts = [info.name.as_str(), info.driver.as_str(), info.driver_info.as_str()];
    parts.iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join(", ")
}
