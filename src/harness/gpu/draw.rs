//! Draws a mesh with a program into targets of words.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{AddressSpace, StorageAccess};
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

/// An entry point of a module.
#[derive(Debug, Clone, Copy)]
pub struct Stage<'a> {
    pub module: &'a naga::Module,
    pub entry: &'a str,
}

/// What one frame is drawn with.
#[derive(Debug)]
pub struct Drawing<'a> {
    pub vertex: Stage<'a>,
    /// Returns four words at each of the locations 0 to `targets - 1`.
    pub fragment: Stage<'a>,
    pub targets: u32,
    pub mesh: &'a Mesh,
    /// Uniform buffers by group and binding; those that the entry points do not use are skipped.
    pub buffers: &'a BTreeMap<(u32, u32), Vec<u8>>,
    /// Textures and samplers likewise.
    pub fixtures: &'a BTreeMap<(u32, u32), Arc<Fixture>>,
    /// Pixels from top to bottom.
    pub height: u32,
}

/// What was drawn.
#[derive(Debug)]
pub struct Frame {
    /// The words of each target, four a pixel, row by row from the top; pixels that nothing
    /// covers hold [`SENTINEL`](crate::harness::kernel::SENTINEL).
    pub targets: Vec<Vec<u32>>,
    /// What was done otherwise than asked for, since the driver would have failed.
    pub detour: Option<&'static str>,
}

/// Uniform blocks of one stage above which lavapipe must not see them.
///
/// Mesa 22.3 looks for uniforms that a branch reads, to compile them in. It notes their places in
/// rows of four and counts its way there in rows of 32 (`lvp_inline_uniforms.c`,
/// `uni_offsets[ubo * PIPE_MAX_CONSTANT_BUFFERS + i]`), so that those of the fourth block land on
/// the table of counts behind. The next draw then reads a push constant that there is not, and
/// the process dies: `forward` with a shadow branches on its fourth block. Storage blocks, laid
/// out the same, are not looked at.
const LAVAPIPE_BLOCKS: usize = 3;
const LAVAPIPE_DETOUR: &str = "uniform blocks were bound as storage blocks: lavapipe crashes where a branch reads the fourth of a stage";

/// What a binding keeps alive.
enum Kept {
    Buffer(wgpu::Buffer),
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

type Place = (u32, u32);

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
    /// Draws one frame and reads it back.
    pub fn draw_mesh(&self, drawing: &Drawing<'_>) -> Result<Frame, Diagnostic> {
        let used = [used(drawing.vertex)?, used(drawing.fragment)?];
        let blocks = |used: &BTreeSet<Place>| used.iter().filter(|place| drawing.buffers.contains_key(place)).count();
        let as_storage = self.is_lavapipe() && used.iter().any(|used| blocks(used) > LAVAPIPE_BLOCKS);
        let all: BTreeSet<Place> = used.into_iter().flatten().collect();
        let buffers = self.guarded(|gpu| gpu.submit_mesh(drawing, &all, as_storage))??;
        let targets = buffers.iter().map(|buffer| self.read(buffer)).collect::<Result<_, _>>()?;
        Ok(Frame { targets, detour: as_storage.then_some(LAVAPIPE_DETOUR) })
    }

    fn is_lavapipe(&self) -> bool {
        let info = self.device.adapter_info();
        info.backend == wgpu::Backend::Vulkan && info.name.starts_with("llvmpipe")
    }

    fn submit_mesh(&self, drawing: &Drawing<'_>, used: &BTreeSet<Place>, as_storage: bool) -> Result<Vec<wgpu::Buffer>, Diagnostic> {
        let pipeline = self.mesh_pipeline(drawing, as_storage);
        let groups = self.groups(drawing, used, &pipeline)?;
        let vertices = self.buffer(&words(&drawing.mesh.words), wgpu::BufferUsages::VERTEX);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let targets: Vec<_> = (0..drawing.targets).map(|_| self.texture(TARGET_WIDTH, drawing.height, usage)).collect();
        let views: Vec<_> = targets.iter().map(|target| target.create_view(&Default::default())).collect();
        let cleared = f64::from(SENTINEL);
        let load = wgpu::LoadOp::Clear(wgpu::Color { r: cleared, g: cleared, b: cleared, a: cleared });
        let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
        let attachment = |view| Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops });
        let attachments: Vec<_> = views.iter().map(attachment).collect();
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor { color_attachments: &attachments, ..Default::default() });
        pass.set_pipeline(&pipeline);
        groups.iter().for_each(|(index, group)| pass.set_bind_group(*index, group, &[]));
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.draw(0..drawing.mesh.corners(), 0..1);
        drop(pass);
        let buffers = targets.iter().map(|target| self.download(&mut encoder, target, drawing.height)).collect();
        self.queue.submit([encoder.finish()]);
        Ok(buffers)
    }

    fn shader(&self, stage: Stage<'_>, as_storage: bool) -> wgpu::ShaderModule {
        let module = if as_storage { storage_blocks(stage.module) } else { stage.module.clone() };
        let source = wgpu::ShaderSource::Naga(Cow::Owned(module));
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
    }

    fn mesh_pipeline(&self, drawing: &Drawing<'_>, as_storage: bool) -> wgpu::RenderPipeline {
        let attributes = drawing.mesh.layout();
        let layout = wgpu::VertexBufferLayout {
            array_stride: drawing.mesh.stride(),
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        };
        let targets = vec![Some(wgpu::ColorTargetState::from(TARGET_FORMAT)); drawing.targets as usize];
        let compilation_options = wgpu::PipelineCompilationOptions::default();
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &self.shader(drawing.vertex, as_storage),
                entry_point: Some(drawing.vertex.entry),
                compilation_options: compilation_options.clone(),
                buffers: &[Some(layout)],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.shader(drawing.fragment, as_storage),
                entry_point: Some(drawing.fragment.entry),
                compilation_options,
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn groups(
        &self,
        drawing: &Drawing<'_>,
        used: &BTreeSet<Place>,
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

    fn kept(&self, drawing: &Drawing<'_>, place: Place) -> Result<Kept, Diagnostic> {
        if let Some(bytes) = drawing.buffers.get(&place) {
            return Ok(Kept::Buffer(self.buffer(bytes, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::STORAGE)));
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

/// The module with uniform blocks declared as storage blocks that are read.
fn storage_blocks(module: &naga::Module) -> naga::Module {
    let mut module = module.clone();
    for (_, variable) in module.global_variables.iter_mut() {
        if variable.space == AddressSpace::Uniform {
            variable.space = AddressSpace::Storage { access: StorageAccess::LOAD };
        }
    }
    module
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Bindings that the entry point uses: those of the derived layout.
fn used(stage: Stage<'_>) -> Result<BTreeSet<Place>, Diagnostic> {
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(stage.module);
    let info = info.map_err(|error| failed(format!("the program is not valid: {error}")))?;
    let index = stage.module.entry_points.iter().position(|point| point.name == stage.entry);
    let index = index.ok_or_else(|| failed(format!("the program has no entry point `{}`", stage.entry)))?;
    let variables = stage.module.global_variables.iter().filter(|(handle, _)| !info.get_entry_point(index)[*handle].is_empty());
    Ok(variables.filter_map(|(_, variable)| variable.binding.map(|place| (place.group, place.binding))).collect())
}
