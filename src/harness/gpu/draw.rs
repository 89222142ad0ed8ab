//! Draws a mesh with a program into a target of words.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use wgpu::util::DeviceExt;

use super::{Gpu, TARGET_FORMAT, failed, fixtures};
use crate::diagnostic::Diagnostic;
use crate::harness::fixture::Fixture;
use crate::harness::kernel::{SENTINEL, TARGET_WIDTH};

/// A triangle list, its attributes interleaved.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    pub attributes: Vec<Attribute>,
    /// Words of every corner, attribute after attribute.
    pub words: Vec<u32>,
}

/// One attribute of a corner.
#[derive(Debug, Clone, Copy)]
pub struct Attribute {
    pub location: u32,
    pub format: wgpu::VertexFormat,
}

/// What one frame is drawn with.
#[derive(Debug)]
pub struct Drawing<'a> {
    /// Holds both entry points; the fragment one returns four words at location 0.
    pub module: &'a naga::Module,
    pub vertex: &'a str,
    pub fragment: &'a str,
    pub mesh: &'a Mesh,
    /// Uniform buffers by group and binding; those that the entry points do not use are skipped.
    pub buffers: &'a BTreeMap<(u32, u32), Vec<u8>>,
    /// Textures and samplers likewise.
    pub fixtures: &'a BTreeMap<(u32, u32), Arc<Fixture>>,
    /// Pixels from top to bottom.
    pub height: u32,
}

/// What a binding keeps alive.
enum Kept {
    Buffer(wgpu::Buffer),
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

impl Mesh {
    fn stride(&self) -> u64 {
        self.attributes.iter().map(|attribute| attribute.format.size()).sum()
    }

    fn corners(&self) -> u32 {
        (self.words.len() as u64 * 4 / self.stride().max(4)) as u32
    }

    fn layout(&self) -> Vec<wgpu::VertexAttribute> {
        let offsets =
            self.attributes.iter().scan(0, |offset, attribute| Some(std::mem::replace(offset, *offset + attribute.format.size())));
        let attribute = |(attribute, offset): (&Attribute, u64)| wgpu::VertexAttribute {
            format: attribute.format,
            offset,
            shader_location: attribute.location,
        };
        self.attributes.iter().zip(offsets).map(attribute).collect()
    }
}

impl Gpu {
    /// The words of the target, four a pixel.
    pub fn draw_mesh(&self, drawing: &Drawing<'_>) -> Result<Vec<u32>, Diagnostic> {
        let buffer = self.guarded(|gpu| gpu.submit_mesh(drawing))??;
        self.read(&buffer)
    }

    fn submit_mesh(&self, drawing: &Drawing<'_>) -> Result<wgpu::Buffer, Diagnostic> {
        let used = used(drawing)?;
        let pipeline = self.mesh_pipeline(drawing);
        let groups = self.groups(drawing, &used, &pipeline)?;
        let vertices = self.buffer(&words(&drawing.mesh.words), wgpu::BufferUsages::VERTEX);
        let target = self.texture(TARGET_WIDTH, drawing.height, wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC);
        let view = target.create_view(&Default::default());
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let cleared = f64::from(SENTINEL);
        let load = wgpu::LoadOp::Clear(wgpu::Color { r: cleared, g: cleared, b: cleared, a: cleared });
        let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
        let attachment = wgpu::RenderPassColorAttachment { view: &view, depth_slice: None, resolve_target: None, ops };
        let mut pass =
            encoder.begin_render_pass(&wgpu::RenderPassDescriptor { color_attachments: &[Some(attachment)], ..Default::default() });
        pass.set_pipeline(&pipeline);
        groups.iter().for_each(|(index, group)| pass.set_bind_group(*index, group, &[]));
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.draw(0..drawing.mesh.corners(), 0..1);
        drop(pass);
        let buffer = self.download(&mut encoder, &target, drawing.height);
        self.queue.submit([encoder.finish()]);
        Ok(buffer)
    }

    fn mesh_pipeline(&self, drawing: &Drawing<'_>) -> wgpu::RenderPipeline {
        let source = wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(drawing.module.clone()));
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let attributes = drawing.mesh.layout();
        let layout = wgpu::VertexBufferLayout {
            array_stride: drawing.mesh.stride(),
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        };
        let compilation_options = wgpu::PipelineCompilationOptions::default();
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(drawing.vertex),
                compilation_options: compilation_options.clone(),
                buffers: &[Some(layout)],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(drawing.fragment),
                compilation_options,
                targets: &[Some(wgpu::ColorTargetState::from(TARGET_FORMAT))],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn groups(
        &self,
        drawing: &Drawing<'_>,
        used: &BTreeSet<(u32, u32)>,
        pipeline: &wgpu::RenderPipeline,
    ) -> Result<Vec<(u32, wgpu::BindGroup)>, Diagnostic> {
        let kept = used.iter().map(|place| Ok((*place, self.kept(drawing, *place)?))).collect::<Result<Vec<_>, Diagnostic>>()?;
        let indices: BTreeSet<u32> = used.iter().map(|(group, _)| *group).collect();
        let group = |index: u32| {
            let own = kept.iter().filter(|((group, _), _)| *group == index);
            let entries: Vec<_> =
                own.map(|((_, binding), kept)| wgpu::BindGroupEntry { binding: *binding, resource: kept.resource() }).collect();
            let layout = &pipeline.get_bind_group_layout(index);
            (index, self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries }))
        };
        Ok(indices.into_iter().map(group).collect())
    }

    fn kept(&self, drawing: &Drawing<'_>, place: (u32, u32)) -> Result<Kept, Diagnostic> {
        if let Some(bytes) = drawing.buffers.get(&place) {
            return Ok(Kept::Buffer(self.buffer(bytes, wgpu::BufferUsages::UNIFORM)));
        }
        match drawing.fixtures.get(&place).map(|fixture| &**fixture) {
            Some(Fixture::Texture(texture)) => Ok(Kept::View(fixtures::upload(&self.device, &self.queue, texture))),
            Some(Fixture::Sampler(sampler)) => Ok(Kept::Sampler(fixtures::sampler(&self.device, *sampler))),
            None => Err(failed(format!("nothing is given for group {}, binding {}", place.0, place.1))),
        }
    }

    fn buffer(&self, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    }
}

impl Kept {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        match self {
            Self::Buffer(buffer) => buffer.as_entire_binding(),
            Self::View(view) => wgpu::BindingResource::TextureView(view),
            Self::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
        }
    }
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Bindings that one of the two entry points uses: those of the derived layout.
fn used(drawing: &Drawing<'_>) -> Result<BTreeSet<(u32, u32)>, Diagnostic> {
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(drawing.module);
    let info = info.map_err(|error| failed(format!("the program is not valid: {error}")))?;
    let mut used = BTreeSet::new();
    for (index, point) in drawing.module.entry_points.iter().enumerate() {
        if ![drawing.vertex, drawing.fragment].contains(&point.name.as_str()) {
            continue;
        }
        let variables = drawing.module.global_variables.iter().filter(|(handle, _)| !info.get_entry_point(index)[*handle].is_empty());
        used.extend(variables.filter_map(|(_, variable)| variable.binding.map(|place| (place.group, place.binding))));
    }
    Ok(used)
}
