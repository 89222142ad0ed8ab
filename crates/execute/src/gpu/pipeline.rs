//! A kernel's pipeline, and the bindings that are the same for all its draws.

use crate::fixture::{Fixture, FixtureSampler};
use crate::gpu::passthrough::SpirvBinary;
use crate::gpu::{TARGET_FORMAT, WgpuDevice, fixtures, lock_mutex};
use crate::kernel::{ENTRY, Kernel, ResourceClass};
use std::collections::HashMap;
use std::sync::Mutex;

/// What a device keeps for a kernel.
pub struct PreparedKernel {
    pub pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    resources: Vec<(u32, BoundResource)>,
    /// The bind group [`HEAPS`], if the shader takes its samplers from heaps.
    pub heaps: Option<wgpu::BindGroup>,
}

/// The index of the bind group with sampler heaps. The kernel's own group comes first.
pub const HEAPS: u32 = 1;

enum BoundResource {
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

impl PreparedKernel {
    /// Compiles the kernel and uploads its fixtures. If `emitted` is given, the driver gets it
    /// unchanged as the kernel's shader. Errors of the device go to its error scopes.
    pub fn new(
        gpu: &WgpuDevice,
        kernel: &Kernel,
        emitted: Option<&SpirvBinary>,
    ) -> Result<Self, String> {
        let WgpuDevice { device, queue, vertex, .. } = gpu;
        let layout = gpu.layouts.of(device, layout_entries(kernel));
        let fragment = match emitted {
            Some(emitted) => emitted.module(device, &kernel.name),
            None => {
                let masked = lamplight_emit::with_masked_shifts(&kernel.module)?;
                let module = masked.unwrap_or_else(|| kernel.module.clone());
                let source = wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(module));
                device.create_shader_module(wgpu::ShaderModuleDescriptor {
                    label: Some(&kernel.name),
                    source,
                })
            }
        };
        let heaps = match emitted {
            Some(emitted) if !emitted.heaps.is_empty() => {
                let sampler = |[_, binding]: [u32; 2]| kernel.fixture_at(binding)?.sampler();
                Some(gpu.heaps.bind(device, &emitted.heaps, &sampler)?)
            }
            _ => None,
        };
        let layouts: Vec<_> =
            std::iter::once(&layout).chain(heaps.as_ref().map(|bound| &bound.layout)).collect();
        let entry = emitted.map_or(ENTRY, SpirvBinary::entry);
        let pipeline =
            draw_pipeline(device, &layouts, vertex, (&fragment, entry), Some(TARGET_FORMAT), None);
        let resources = kernel
            .resources()
            .map(|resource| (resource.binding, bound_fixture(device, queue, &resource.fixture)))
            .collect();
        Ok(Self { pipeline, layout, resources, heaps: heaps.map(|bound| bound.group) })
    }

    /// The bind group of one draw.
    pub fn bind(&self, device: &wgpu::Device, inputs: &wgpu::TextureView) -> wgpu::BindGroup {
        let first = wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(inputs),
        };
        let rest = self.resources.iter().map(|(binding, bound)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: match bound {
                BoundResource::View(view) => wgpu::BindingResource::TextureView(view),
                BoundResource::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
            },
        });
        let entries: Vec<_> = std::iter::once(first).chain(rest).collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.layout,
            entries: &entries,
        })
    }
}

/// A pipeline that draws one full-screen triangle from a texture at binding 0, and the layout of
/// that binding. The WGSL `source` has both stages; `entry` is its fragment stage.
pub fn texture_pipeline(
    device: &wgpu::Device,
    (source, entry): (&'static str, &str),
    sample_type: wgpu::TextureSampleType,
    color: Option<wgpu::TextureFormat>,
    depth: Option<wgpu::TextureFormat>,
) -> (wgpu::BindGroupLayout, wgpu::RenderPipeline) {
    let source = wgpu::ShaderSource::Wgsl(source.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let ty = wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let binding = wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[binding],
    });
    let drawing = draw_pipeline(device, &[&layout], &module, (&module, entry), color, depth);
    (layout, drawing)
}

/// A pipeline that draws one full-screen triangle.
pub fn draw_pipeline(
    device: &wgpu::Device,
    layouts: &[&wgpu::BindGroupLayout],
    vertex: &wgpu::ShaderModule,
    fragment: (&wgpu::ShaderModule, &str),
    color: Option<wgpu::TextureFormat>,
    depth: Option<wgpu::TextureFormat>,
) -> wgpu::RenderPipeline {
    let layouts: Vec<_> = layouts.iter().copied().map(Some).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    let targets: Vec<_> =
        color.map(|format| Some(wgpu::ColorTargetState::from(format))).into_iter().collect();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: vertex,
            entry_point: Some("triangle"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: depth.map(|format| wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: fragment.0,
            entry_point: Some(fragment.1),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The layout of the kernel's bindings. It also has the samplers that the shader does not use: wgpu
/// numbers bindings without gaps, but an emitted shader keeps its own numbers.
fn layout_entries(kernel: &Kernel) -> Vec<wgpu::BindGroupLayoutEntry> {
    let inputs = texture_type(wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2);
    // Not every device can filter f32 textures, so filtering is asked for only where a kernel
    // filters colours.
    let filterable = kernel
        .resources()
        .any(|resource| matches!(&*resource.fixture, Fixture::Sampler(sampler) if sampler.linear && sampler.compare.is_none()));
    let rest = kernel.resources().map(|resource| {
        (resource.binding, binding_type(resource.class, &resource.fixture, filterable))
    });
    std::iter::once((0, inputs))
        .chain(rest)
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        })
        .collect()
}

fn binding_type(class: ResourceClass, fixture: &Fixture, filterable: bool) -> wgpu::BindingType {
    match class {
        ResourceClass::Sampler { comparison: true } => {
            wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison)
        }
        ResourceClass::Sampler { comparison: false } => match fixture {
            Fixture::Sampler(sampler) => sampler_type(FixtureSampler { compare: None, ..*sampler }),
            _ => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
        },
        ResourceClass::Texture { dim, class, .. } => {
            let dimension = match dim {
                naga::ImageDimension::Cube => wgpu::TextureViewDimension::Cube,
                _ => wgpu::TextureViewDimension::D2,
            };
            let sample = match class {
                naga::ImageClass::Depth { .. } => wgpu::TextureSampleType::Depth,
                _ => wgpu::TextureSampleType::Float { filterable },
            };
            texture_type(sample, dimension)
        }
    }
}

/// The type of a sampler's binding.
pub fn sampler_type(settings: FixtureSampler) -> wgpu::BindingType {
    wgpu::BindingType::Sampler(match settings {
        FixtureSampler { compare: Some(_), .. } => wgpu::SamplerBindingType::Comparison,
        FixtureSampler { linear: true, .. } => wgpu::SamplerBindingType::Filtering,
        _ => wgpu::SamplerBindingType::NonFiltering,
    })
}

/// The type of a texture's binding.
pub fn texture_type(
    sample_type: wgpu::TextureSampleType,
    view_dimension: wgpu::TextureViewDimension,
) -> wgpu::BindingType {
    wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false }
}

fn bound_fixture(device: &wgpu::Device, queue: &wgpu::Queue, fixture: &Fixture) -> BoundResource {
    match fixture {
        Fixture::Texture(texture) => {
            BoundResource::View(fixtures::upload_texture(device, queue, texture))
        }
        Fixture::Sampler(sampler) => {
            BoundResource::Sampler(fixtures::create_sampler(device, *sampler))
        }
    }
}

/// Layouts by their entries.
#[derive(Default)]
pub struct GroupLayouts {
    known: Mutex<HashMap<Vec<wgpu::BindGroupLayoutEntry>, wgpu::BindGroupLayout>>,
}

impl GroupLayouts {
    /// The layout with these entries.
    pub fn of(
        &self,
        device: &wgpu::Device,
        entries: Vec<wgpu::BindGroupLayoutEntry>,
    ) -> wgpu::BindGroupLayout {
        let mut known = lock_mutex(&self.known);
        let layout = known.entry(entries).or_insert_with_key(|entries| {
            device
                .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries })
        });
        layout.clone()
    }
}
