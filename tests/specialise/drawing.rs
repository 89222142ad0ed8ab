//! Draws one pixel, whose colour shows the value that a shader has.

use lamplight::bundle::Found;
use libtest_mimic::Failed;
use pollster::block_on;

use super::{choice_id, run};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// A device that draws one pixel.
pub struct Drawing {
    pub device: wgpu::Device,
    queue: wgpu::Queue,
    vertex: wgpu::ShaderModule,
}

const VERTEX: &str = "
struct Out { @builtin(position) position: vec4f, @location(0) x: f32 }
@vertex fn triangle(@builtin(vertex_index) index: u32) -> Out {
    let corner = vec2u((index << 1u) & 2u, index & 2u);
    return Out(vec4f(vec2f(corner) * 2.0 - 1.0, 0.0, 1.0), 1.0);
}";

impl Drawing {
    pub fn open() -> Result<Self, Failed> {
        let backends = wgpu::Backends::VULKAN;
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let mut adapters = block_on(instance.enumerate_adapters(backends));
        adapters.sort_by_key(|adapter| adapter.get_info().device_type != wgpu::DeviceType::Cpu);
        let adapter =
            adapters.into_iter().next().ok_or("no Vulkan driver: cargo xtask test installs one")?;
        let descriptor = wgpu::DeviceDescriptor {
            required_features: wgpu::Features::PASSTHROUGH_SHADERS,
            required_limits: adapter.limits(),
            // SAFETY: the shaders that pass through were validated.
            experimental_features: unsafe { wgpu::ExperimentalFeatures::enabled() },
            ..Default::default()
        };
        let (device, queue) = block_on(adapter.request_device(&descriptor))?;
        let source = wgpu::ShaderSource::Wgsl(VERTEX.into());
        let vertex =
            device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        Ok(Self { device, queue, vertex })
    }

    /// SPIR-V with its constants set by spirv-opt. A driver does so when it makes a
    /// pipeline, but wgpu cannot pass constants to a shader that it does not translate.
    pub fn chosen(&self, found: &Found) -> Result<wgpu::ShaderModule, Failed> {
        let folder = tempfile::tempdir()?;
        let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
        std::fs::write(path("a.spv"), &found.bytes)?;
        let id = |name: &str| choice_id(found, name);
        let values = found
            .constants
            .iter()
            .filter_map(|constant| Some(format!("{}:{}", id(&constant.name)?, constant.value)));
        let values: Vec<String> = values.collect();
        run(
            "spirv-opt",
            &[
                "--set-spec-const-default-value",
                &values.join(" "),
                &path("a.spv"),
                "-o",
                &path("b.spv"),
            ],
        )?;
        let bytes = std::fs::read(path("b.spv"))?;
        let words: Vec<u32> =
            bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
        let entry = wgpu::PassthroughShaderEntryPoint {
            name: found.native.entry_name.as_str().into(),
            workgroup_size: (0, 0, 0),
        };
        let entry_points = std::slice::from_ref(&entry).into();
        let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
            entry_points,
            spirv: Some(words.into()),
            ..Default::default()
        };
        // SAFETY: `spirv-val` accepts the words.
        Ok(unsafe { self.device.create_shader_module_passthrough(descriptor) })
    }

    /// Draws the pixel and gives its numbers.
    pub fn draw(
        &self,
        fragment: &wgpu::ShaderModule,
        constants: &[(&str, f64)],
    ) -> Result<Vec<f32>, Failed> {
        let pipeline = self.pipeline(fragment, constants);
        let target = self.target();
        let view = target.create_view(&Default::default());
        let ops = wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            store: wgpu::StoreOp::Store,
        };
        let attachment = wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops,
        };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment)],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.draw(0..3, 0..1);
        drop(pass);
        self.read(encoder, &target)
    }

    fn pipeline(
        &self,
        fragment: &wgpu::ShaderModule,
        constants: &[(&str, f64)],
    ) -> wgpu::RenderPipeline {
        let layout = wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[],
            immediate_size: 0,
        };
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&self.device.create_pipeline_layout(&layout)),
            vertex: wgpu::VertexState {
                module: &self.vertex,
                entry_point: Some("triangle"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: fragment,
                entry_point: Some("fs_main"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants,
                    ..Default::default()
                },
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// A texture of one pixel.
    fn target(&self) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }

    /// Runs the commands and reads the pixel.
    fn read(
        &self,
        mut encoder: wgpu::CommandEncoder,
        target: &wgpu::Texture,
    ) -> Result<Vec<f32>, Failed> {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 256,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(256),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            target.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
            target.size(),
        );
        self.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |_| ());
        self.device.poll(wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(std::time::Duration::from_secs(30)),
        })?;
        let bytes = buffer.get_mapped_range(..).map_err(|error| format!("{error:?}"))?;
        Ok(bytes[..16].as_chunks::<4>().0.iter().map(|word| f32::from_le_bytes(*word)).collect())
    }
}
