//! Finds an adapter and opens a device on it.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use glow::HasContext as _;
use wgpu::hal::Instance as _;

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

impl Shaders {
    /// What a device must be able to do.
    fn features(self) -> wgpu::Features {
        match self {
            Self::Translated => wgpu::Features::empty(),
            // Samplers are in arrays, and a number in a buffer says which.
            Self::Emitted(Target::HLSL) => {
                wgpu::Features::PASSTHROUGH_SHADERS | wgpu::Features::TEXTURE_BINDING_ARRAY
            }
            Self::Emitted(_) => wgpu::Features::PASSTHROUGH_SHADERS,
        }
    }
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
    let descriptor = wgpu::InstanceDescriptor {
        backends: wanted.backend,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    };
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = adapters(&instance, wanted.backend);
    adapters.retain(|adapter| wanted.named.allows(&adapter.get_info().name));
    adapters.sort_by_key(|adapter| adapter.get_info().device_type != wgpu::DeviceType::Cpu);
    let adapter = adapters.into_iter().next().ok_or("no adapter was found")?;
    let mut features = wgpu::Features::FLOAT32_FILTERABLE & adapter.features();
    features |= wanted.shaders.features();
    if !adapter.features().contains(features) {
        let lacks = features - adapter.features();
        return Err(format!("{} has no {lacks}", describe(&adapter.get_info())));
    }
    let descriptor = wgpu::DeviceDescriptor {
        required_features: features,
        required_limits: adapter.limits(),
        ..Default::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
        .map_err(|error| error.to_string())?;
    let faults = watch(&device);
    filter_seams(&device);
    let source = wgpu::ShaderSource::Wgsl(VERTEX.into());
    let vertex = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let adapter = describe(&adapter.get_info());
    Ok(Gpu {
        adapter,
        shaders: wanted.shaders,
        device,
        queue,
        faults,
        vertex,
        prepared: HashMap::new(),
        binaries: Mutex::new(HashMap::new()),
        runs: 0,
    })
}

/// The adapters of a backend.
fn adapters(instance: &wgpu::Instance, backend: wgpu::Backends) -> Vec<wgpu::Adapter> {
    let of_opengl = if backend == wgpu::Backends::GL { filtering(instance) } else { Vec::new() };
    if of_opengl.is_empty() {
        pollster::block_on(instance.enumerate_adapters(backend))
    } else {
        of_opengl
    }
}

/// Adapters of OpenGL, said to filter 32-bit floats as all from 3.0 on do: wgpu looks for
/// extensions that a core profile need not name.
fn filtering(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    // SAFETY: the instance is borrowed all the while.
    let Some(hal) = (unsafe { instance.as_hal::<wgpu::hal::api::Gles>() }) else {
        return Vec::new();
    };
    // SAFETY: no surface is asked for.
    let exposed = unsafe { hal.enumerate_adapters(None) };
    let adapter = |mut exposed: wgpu::hal::ExposedAdapter<wgpu::hal::api::Gles>| {
        if !exposed.adapter.adapter_context().lock().version().is_embedded {
            exposed.features |= wgpu::Features::FLOAT32_FILTERABLE;
        }
        // SAFETY: the adapter comes from this instance.
        unsafe { instance.create_adapter_from_hal(exposed) }
    };
    exposed.into_iter().map(adapter).collect()
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
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        lock(&sink).push(error.to_string())
    }));
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
