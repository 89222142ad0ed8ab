//! Finds an adapter and opens a device on it.

use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex};

use glow::HasContext as _;
use wgpu::hal::Instance as _;

use super::{WgpuDevice, lock_mutex};
use lamplight_bundle::Target;

/// The full-screen triangle.
const VERTEX: &str = "
@vertex fn triangle(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2u((index << 1u) & 2u, index & 2u);
    return vec4f(vec2f(corner) * 2.0 - 1.0, 0.0, 1.0);
}";

/// Which device to open, and what shaders it gets.
#[derive(Debug, Clone, Copy)]
pub struct DeviceRequest {
    pub backend: wgpu::Backends,
    /// What the adapter's name must contain, or must not.
    pub named: AdapterName,
    pub shaders: Shaders,
}

/// A condition on an adapter's name.
#[derive(Debug, Clone, Copy)]
pub enum AdapterName {
    /// The name has this part. An empty part allows every name.
    With(&'static str),
    /// The name does not have this part.
    Without(&'static str),
}

/// Where a kernel's shader comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shaders {
    /// wgpu translates naga's module.
    Translated,
    /// The crate emits it, and the driver gets it unchanged.
    Emitted(Target),
    /// The kernel's source is HLSL, which glslangValidator compiles.
    Written,
}

impl Shaders {
    /// The features that the device must have.
    fn features(self) -> wgpu::Features {
        match self {
            Self::Translated => wgpu::Features::empty(),
            // Samplers are in arrays, which are indexed with a number from a buffer.
            Self::Emitted(Target::HLSL) => {
                wgpu::Features::PASSTHROUGH_SHADERS | wgpu::Features::TEXTURE_BINDING_ARRAY
            }
            Self::Emitted(_) | Self::Written => wgpu::Features::PASSTHROUGH_SHADERS,
        }
    }
}

impl AdapterName {
    fn allows(self, name: &str) -> bool {
        match self {
            Self::With(part) => name.contains(part),
            Self::Without(part) => !name.contains(part),
        }
    }
}

impl fmt::Display for AdapterName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::With(part) => write!(f, "whose name has `{part}`"),
            Self::Without(part) => write!(f, "other than those whose name has `{part}`"),
        }
    }
}

/// Opens the preferred adapter of a backend. A software adapter is preferred, since its numbers are
/// the same on every machine. The error is a message.
pub fn open_gpu(wanted: DeviceRequest) -> Result<WgpuDevice, String> {
    let descriptor = wgpu::InstanceDescriptor {
        backends: wanted.backend,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    };
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = adapters_of(&instance, wanted.backend);
    adapters.retain(|adapter| wanted.named.allows(&adapter.get_info().name));
    adapters.sort_by_key(|adapter| adapter.get_info().device_type != wgpu::DeviceType::Cpu);
    let none = || format!("wgpu found no adapter {}", wanted.named);
    let adapter = adapters.into_iter().next().ok_or_else(none)?;
    let wished = wgpu::Features::FLOAT32_FILTERABLE | wgpu::Features::IMMEDIATES;
    let mut features = wished & adapter.features();
    features |= wanted.shaders.features();
    if !adapter.features().contains(features) {
        let lacks = features - adapter.features();
        return Err(format!("{} has no {lacks}", describe_adapter(&adapter.get_info())));
    }
    let descriptor = wgpu::DeviceDescriptor {
        required_features: features,
        required_limits: adapter.limits(),
        ..Default::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
        .map_err(|error| error.to_string())?;
    let faults = watch_errors(&device);
    filter_seams(&device);
    let source = wgpu::ShaderSource::Wgsl(VERTEX.into());
    let vertex = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let adapter = describe_adapter(&adapter.get_info());
    Ok(WgpuDevice {
        adapter,
        shaders: wanted.shaders,
        device,
        queue,
        faults,
        vertex,
        prepared: HashMap::new(),
        binaries: Mutex::new(HashMap::new()),
        heaps: Default::default(),
        layouts: Default::default(),
    })
}

fn adapters_of(instance: &wgpu::Instance, backend: wgpu::Backends) -> Vec<wgpu::Adapter> {
    let of_opengl =
        if backend == wgpu::Backends::GL { filtering_adapters(instance) } else { Vec::new() };
    if of_opengl.is_empty() {
        pollster::block_on(instance.enumerate_adapters(backend))
    } else {
        of_opengl
    }
}

/// The adapters of OpenGL, marked as able to filter 32-bit floats. From version 3.0 on all can, but
/// wgpu looks for extensions that a core profile need not list.
fn filtering_adapters(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    // SAFETY: the instance is borrowed for as long as the handle is used.
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

/// Makes OpenGL filter across the edges of cube faces, as WebGPU demands. OpenGL does so only if it
/// is enabled, and wgpu does not enable it.
fn filter_seams(device: &wgpu::Device) {
    // SAFETY: the device has just been made, and is not destroyed here.
    let Some(device) = (unsafe { device.as_hal::<wgpu::hal::api::Gles>() }) else { return };
    let context = device.context().lock();
    // OpenGL ES 3 always filters that way.
    if !context.version().is_embedded {
        // SAFETY: the lock makes the context current.
        unsafe { context.enable(glow::TEXTURE_CUBE_MAP_SEAMLESS) };
    }
}

/// Collects errors that would otherwise be panics.
fn watch_errors(device: &wgpu::Device) -> Arc<Mutex<Vec<String>>> {
    let faults = Arc::new(Mutex::new(Vec::new()));
    let sink = Arc::clone(&faults);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        lock_mutex(&sink).push(error.to_string())
    }));
    let sink = Arc::clone(&faults);
    device.set_device_lost_callback(move |reason, message| {
        if !matches!(reason, wgpu::DeviceLostReason::Destroyed) {
            lock_mutex(&sink).push(format!("the device was lost: {message}"));
        }
    });
    faults
}

fn describe_adapter(info: &wgpu::AdapterInfo) -> String {
    let parts = [info.name.as_str(), info.driver.as_str(), info.driver_info.as_str()];
    parts.iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join(", ")
}
