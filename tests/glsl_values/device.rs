//! lavapipe, which runs SPIR-V of glslang and WGSL.

use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex};

/// Words of the buffer that programs write.
pub const WORDS: usize = 256;
/// Bytes of the uniform block that programs read.
const UNIFORM_BYTES: u64 = 1024;
/// Bytes of the buffer that programs read.
const STORAGE_BYTES: u64 = 4096;
/// Texels at each side of the depth texture that programs read.
const SIDE: u32 = 4;

/// An open device.
pub struct Device {
    device: wgpu::Device,
    queue: wgpu::Queue,
    faults: Arc<Mutex<Vec<String>>>,
    layout: wgpu::BindGroupLayout,
    depths: wgpu::TextureView,
    /// One that compares, and one that does not.
    samplers: [wgpu::Sampler; 2],
}

impl Device {
    /// Opens lavapipe.
    pub fn open() -> Result<Self, String> {
        let descriptor = wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        };
        let instance = wgpu::Instance::new(descriptor);
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
        let is_it = |adapter: &wgpu::Adapter| adapter.get_info().name.contains("llvmpipe");
        let adapter = adapters.into_iter().find(is_it).ok_or("lavapipe is not installed")?;
        let descriptor = wgpu::DeviceDescriptor {
            required_features: wgpu::Features::PASSTHROUGH_SHADERS,
            required_limits: adapter.limits(),
            // SAFETY: shaders that are passed through come from glslang.
            experimental_features: unsafe { wgpu::ExperimentalFeatures::enabled() },
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| error.to_string())?;
        let faults = Arc::new(Mutex::new(Vec::new()));
        let sink = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            sink.lock().unwrap().push(error.to_string());
        }));
        let layout = layout_of(&device);
        let depths = depth_texture(&device, &queue);
        let sampler = |compare| {
            device.create_sampler(&wgpu::SamplerDescriptor { compare, ..Default::default() })
        };
        let samplers = [Some(wgpu::CompareFunction::LessEqual), None].map(sampler);
        Ok(Self { device, queue, faults, layout, depths, samplers })
    }

    /// The words that the original text writes.
    pub fn run_original(&self, text: &str) -> Result<Vec<u32>, String> {
        let words = compile_spirv(text)?;
        let entry =
            wgpu::PassthroughShaderEntryPoint { name: "main".into(), workgroup_size: (1, 1, 1) };
        let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
            label: None,
            entry_points: vec![entry].into(),
            spirv: Some(words.as_slice().into()),
            ..Default::default()
        };
        // SAFETY: glslang wrote the words, and the programs index within bounds.
        let module = unsafe { self.device.create_shader_module_passthrough(descriptor) };
        self.run_module(&module)
    }

    /// The words that a text in WGSL writes.
    pub fn run_wgsl(&self, text: &str) -> Result<Vec<u32>, String> {
        let source = wgpu::ShaderSource::Wgsl(text.into());
        let descriptor = wgpu::ShaderModuleDescriptor { label: None, source };
        let module = self.device.create_shader_module(descriptor);
        self.check()?;
        self.run_module(&module)
    }

    fn check(&self) -> Result<(), String> {
        let faults = std::mem::take(&mut *self.faults.lock().unwrap());
        faults.into_iter().next().map_or(Ok(()), Err)
    }

    fn run_module(&self, module: &wgpu::ShaderModule) -> Result<Vec<u32>, String> {
        let device = &self.device;
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&self.layout)],
            ..Default::default()
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&layout),
            module,
            entry_point: Some("main"),
            compilation_options: Default::default(),
            cache: None,
        });
        self.check()?;
        let bytes = (WORDS * 4) as u64;
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let output = self.buffer(bytes, usage, |_| 0);
        let uniform = self.buffer(UNIFORM_BYTES, wgpu::BufferUsages::UNIFORM, input_word);
        let storage = self.buffer(STORAGE_BYTES, wgpu::BufferUsages::STORAGE, input_word);
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let back = self.buffer(bytes, usage, |_| 0);
        let group = self.group([&output, &uniform, &storage]);
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&output, 0, &back, 0, bytes);
        self.queue.submit([encoder.finish()]);
        back.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| error.to_string())?;
        self.check()?;
        let view = back.slice(..).get_mapped_range().map_err(|error| error.to_string())?;
        let word = |bytes: &[u8]| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        Ok(view.chunks_exact(4).map(word).collect())
    }

    fn group(&self, buffers: [&wgpu::Buffer; 3]) -> wgpu::BindGroup {
        let buffers = buffers.map(wgpu::Buffer::as_entire_binding);
        let depths = wgpu::BindingResource::TextureView(&self.depths);
        let samplers = self.samplers.each_ref().map(wgpu::BindingResource::Sampler);
        let resources = buffers.into_iter().chain([depths]).chain(samplers);
        let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.layout,
            entries: &entries,
        })
    }

    fn buffer(&self, size: u64, usage: wgpu::BufferUsages, word: fn(u32) -> u32) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bytes: Vec<u8> =
            (0..(size / 4) as u32).flat_map(|index| word(index).to_le_bytes()).collect();
        self.queue.write_buffer(&buffer, 0, &bytes);
        buffer
    }
}

/// What the inputs hold: small numbers that are exact as floats, and whose bits differ.
fn input_word(index: u32) -> u32 {
    (((index * 7) % 61) as f32 * 0.25 - 3.0).to_bits()
}

fn layout_of(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let buffers = [
        wgpu::BufferBindingType::Storage { read_only: false },
        wgpu::BufferBindingType::Uniform,
        wgpu::BufferBindingType::Storage { read_only: true },
    ];
    let buffers = buffers.map(|ty| wgpu::BindingType::Buffer {
        ty,
        has_dynamic_offset: false,
        min_binding_size: None,
    });
    let depths = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let samplers = [wgpu::SamplerBindingType::Comparison, wgpu::SamplerBindingType::NonFiltering];
    let samplers = samplers.map(wgpu::BindingType::Sampler);
    let entries: Vec<wgpu::BindGroupLayoutEntry> = (0..)
        .zip(buffers.into_iter().chain([depths]).chain(samplers))
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        })
        .collect();
    let descriptor = wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries };
    device.create_bind_group_layout(&descriptor)
}

/// A depth texture whose texels all differ.
fn depth_texture(device: &wgpu::Device, queue: &wgpu::Queue) -> wgpu::TextureView {
    let size = wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth16Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let depth = |index: u32| (index * 7 % (SIDE * SIDE) * 4096) as u16;
    let bytes: Vec<u8> = (0..SIDE * SIDE).flat_map(|index| depth(index).to_le_bytes()).collect();
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(SIDE * 2),
        rows_per_image: None,
    };
    queue.write_texture(texture.as_image_copy(), &bytes, layout, size);
    texture.create_view(&Default::default())
}

/// Compiles a compute shader by glslang.
pub fn compile_spirv(text: &str) -> Result<Vec<u32>, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let (source, output) = (folder.path().join("a.comp"), folder.path().join("a.spv"));
    std::fs::write(&source, text).map_err(|error| error.to_string())?;
    let run = Command::new("glslangValidator")
        .args(["-V", "--quiet", "-o"])
        .args([&output, &source])
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("glslangValidator: {error}"))?;
    if !run.status.success() {
        return Err(format!("glslang refuses: {}", String::from_utf8_lossy(&run.stdout)));
    }
    let bytes = std::fs::read(&output).map_err(|error| error.to_string())?;
    let word = |bytes: &[u8]| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    Ok(bytes.chunks_exact(4).map(word).collect())
}
