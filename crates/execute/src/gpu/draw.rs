//! Draws meshes into targets of words, a depth buffer, or both.

mod bindings;
mod shipped;
mod target;

use std::borrow::Cow;
use std::collections::BTreeSet;

use naga::{AddressSpace, StorageAccess};
use wgpu::util::DeviceExt;

use super::{WgpuDevice, executor_failed};
use crate::frame::{
    BindingPlace, Drawing, EntryPoint, Face, Frame, Mesh, PipelineState, VertexAttribute,
    VertexFormat,
};
use crate::module_info;
use crate::shipped::ColorFormat;
use bindings::Bindings;
use lamplight_diagnostic::Diagnostic;
use target::{DEPTH_FORMAT, Targets};

/// The most uniform blocks that a stage may have on lavapipe.
///
/// Mesa 22.3 looks for uniforms that a branch reads, to inline their values. Its table has rows of
/// four offsets, but it writes to it as if rows had 32 (`lvp_inline_uniforms.c`, `uni_offsets[ubo *
/// PIPE_MAX_CONSTANT_BUFFERS + i]`). So the offsets of the fourth block overwrite the table of
/// counts that follows. The next draw then reads a push constant that does not exist, and the
/// process crashes. `forward` with a shadow has a branch on its fourth block. Storage blocks have
/// the same layout and are not looked at. But at the edge of a triangle they read as 0 in the
/// helper invocations of a quad, so that derivatives of anything computed from them are wrong.
const LAVAPIPE_BLOCKS: usize = 3;
const LAVAPIPE_DETOUR: &str = "uniform blocks were bound as storage blocks: lavapipe crashes where a branch reads the fourth of a stage";

impl WgpuDevice {
    /// Draws the frame of each view and reads it back.
    pub(super) fn frames(&self, drawing: &Drawing<'_>) -> Result<Vec<Frame>, Diagnostic> {
        let used: Vec<_> = std::iter::once(drawing.vertex)
            .chain(drawing.fragment)
            .map(used_bindings)
            .collect::<Result<_, _>>()?;
        let as_storage =
            if self.is_lavapipe() { spared_blocks(drawing, &used) } else { BTreeSet::new() };
        let all: BTreeSet<BindingPlace> = used.into_iter().flatten().collect();
        let frames = self.guarded(|gpu| gpu.submit_frames(drawing, all, &as_storage))??;
        let detour = (!as_storage.is_empty()).then_some(LAVAPIPE_DETOUR);
        frames.into_iter().map(|frame| frame.read(self, detour)).collect()
    }

    fn is_lavapipe(&self) -> bool {
        let info = self.device.adapter_info();
        info.backend == wgpu::Backend::Vulkan && info.name.starts_with("llvmpipe")
    }

    fn submit_frames(
        &self,
        drawing: &Drawing<'_>,
        used: BTreeSet<BindingPlace>,
        as_storage: &BTreeSet<BindingPlace>,
    ) -> Result<Vec<target::Pending>, Diagnostic> {
        let vertex = (self.shader(drawing.vertex, as_storage), drawing.vertex.entry);
        let fragment = drawing.fragment.map(|stage| (self.shader(stage, as_storage), stage.entry));
        let stages = StageModules {
            vertex: (&vertex.0, vertex.1),
            fragment: fragment.as_ref().map(|(module, entry)| (module, *entry)),
        };
        let formats = vec![ColorFormat::Uint; drawing.targets as usize];
        let pipeline = self.mesh_pipeline(drawing, stages, None, &formats);
        let bindings = Bindings::new(self, drawing, used)?;
        let meshes = Meshes::new(self, drawing);
        let layout = |index| Some(pipeline.get_bind_group_layout(index));
        // All views are drawn into the same targets, one after another, and copied from there.
        let targets = Targets::new(&self.device, drawing, &formats);
        let mut frames = Vec::new();
        for view in drawing.views {
            let items = drawing.items.iter();
            let groups: Vec<_> = items
                .map(|item| bindings.groups(self, drawing, view, item, &layout))
                .collect::<Result<_, _>>()?;
            frames.push(meshes.pass(self, &targets, &pipeline, &groups));
        }
        Ok(frames)
    }

    fn shader(
        &self,
        stage: EntryPoint<'_>,
        as_storage: &BTreeSet<BindingPlace>,
    ) -> wgpu::ShaderModule {
        let source = wgpu::ShaderSource::Naga(Cow::Owned(storage_blocks(stage.module, as_storage)));
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
    }

    /// Makes the pipeline. Without `layout`, wgpu derives the layout from what the stages use.
    fn mesh_pipeline(
        &self,
        drawing: &Drawing<'_>,
        stages: StageModules<'_>,
        layout: Option<&wgpu::PipelineLayout>,
        formats: &[ColorFormat],
    ) -> wgpu::RenderPipeline {
        let mesh = drawing.items.first().map(|item| item.mesh);
        let attributes = mesh.map(vertex_layout).unwrap_or_default();
        let vertices = wgpu::VertexBufferLayout {
            array_stride: mesh.map_or(0, Mesh::stride),
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        };
        let buffers = if attributes.is_empty() { Vec::new() } else { vec![Some(vertices)] };
        let targets: Vec<_> = formats
            .iter()
            .map(|format| Some(wgpu::ColorTargetState::from(target::texture_format(*format))))
            .collect();
        let compilation_options = wgpu::PipelineCompilationOptions::default();
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout,
            vertex: wgpu::VertexState {
                module: stages.vertex.0,
                entry_point: Some(stages.vertex.1),
                compilation_options: compilation_options.clone(),
                buffers: &buffers,
            },
            primitive: primitive_state(drawing.state),
            depth_stencil: drawing.state.depth_test.then(|| depth_state(drawing.state)),
            multisample: Default::default(),
            fragment: stages.fragment.map(|(module, entry)| wgpu::FragmentState {
                module,
                entry_point: Some(entry),
                compilation_options,
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn buffer(&self, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage,
        })
    }
}

fn primitive_state(state: PipelineState) -> wgpu::PrimitiveState {
    wgpu::PrimitiveState {
        front_face: if state.mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
        cull_mode: state.cull.map(|side| match side {
            Face::Front => wgpu::Face::Front,
            Face::Back => wgpu::Face::Back,
        }),
        ..Default::default()
    }
}

fn depth_state(state: PipelineState) -> wgpu::DepthStencilState {
    let [slope_scale, constant] = state.offset;
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::Less),
        stencil: Default::default(),
        bias: wgpu::DepthBiasState { constant: constant as i32, slope_scale, clamp: 0.0 },
    }
}

/// The stages as shaders of the device, with their entry points.
#[derive(Clone, Copy)]
struct StageModules<'a> {
    vertex: (&'a wgpu::ShaderModule, &'a str),
    fragment: Option<(&'a wgpu::ShaderModule, &'a str)>,
}

/// The meshes that are drawn into every frame, on the device.
struct Meshes(Vec<Uploaded>);

/// The bind groups of an item, with their index.
type Groups = Vec<(u32, wgpu::BindGroup)>;

impl Meshes {
    fn new(gpu: &WgpuDevice, drawing: &Drawing<'_>) -> Self {
        Self(drawing.items.iter().map(|item| Uploaded::new(gpu, item.mesh)).collect())
    }

    /// Draws one frame into the targets, each item with its bind groups, and copies it into buffers
    /// that can be mapped.
    fn pass(
        &self,
        gpu: &WgpuDevice,
        targets: &Targets,
        pipeline: &wgpu::RenderPipeline,
        groups: &[Groups],
    ) -> target::Pending {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        targets.pass(&mut encoder, |pass| {
            pass.set_pipeline(pipeline);
            for (mesh, groups) in self.0.iter().zip(groups) {
                groups.iter().for_each(|(index, group)| pass.set_bind_group(*index, group, &[]));
                mesh.draw(pass);
            }
        });
        let pending = targets.download(gpu, &mut encoder);
        gpu.queue.submit([encoder.finish()]);
        pending
    }
}

/// A mesh on the device.
struct Uploaded {
    vertices: Option<wgpu::Buffer>,
    indices: Option<wgpu::Buffer>,
    count: u32,
}

impl Uploaded {
    fn new(gpu: &WgpuDevice, mesh: &Mesh) -> Self {
        let buffer = |numbers: &[u32], usage| {
            (!numbers.is_empty()).then(|| gpu.buffer(&bytes_of_words(numbers), usage))
        };
        let count =
            if mesh.indices.is_empty() { mesh.vertices() } else { mesh.indices.len() as u32 };
        Self {
            vertices: buffer(&mesh.words, wgpu::BufferUsages::VERTEX),
            indices: buffer(&mesh.indices, wgpu::BufferUsages::INDEX),
            count,
        }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(vertices) = &self.vertices {
            pass.set_vertex_buffer(0, vertices.slice(..));
        }
        match &self.indices {
            Some(indices) => {
                pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(0..self.count, 0, 0..1);
            }
            None => pass.draw(0..self.count, 0..1),
        }
    }
}

/// The uniform blocks to bind as storage blocks, so that no stage has too many: as few of the plain
/// ones as are enough, or all blocks.
fn spared_blocks(
    drawing: &Drawing<'_>,
    stages: &[BTreeSet<BindingPlace>],
) -> BTreeSet<BindingPlace> {
    let blocks: Vec<BTreeSet<BindingPlace>> = stages
        .iter()
        .map(|used| used.iter().copied().filter(|place| drawing.is_buffer(*place)).collect())
        .collect();
    let fits = |spared: &BTreeSet<BindingPlace>| {
        blocks.iter().all(|blocks| blocks.difference(spared).count() <= LAVAPIPE_BLOCKS)
    };
    let mut spared = BTreeSet::new();
    for place in drawing.plain {
        if fits(&spared) {
            break;
        }
        spared.insert(*place);
    }
    if fits(&spared) { spared } else { blocks.into_iter().flatten().collect() }
}

/// The module with some uniform blocks declared as read-only storage blocks.
fn storage_blocks(module: &naga::Module, places: &BTreeSet<BindingPlace>) -> naga::Module {
    let mut module = module.clone();
    for (_, variable) in module.global_variables.iter_mut() {
        let is_spared =
            variable.binding.is_some_and(|place| places.contains(&(place.group, place.binding)));
        if variable.space == AddressSpace::Uniform && is_spared {
            variable.space = AddressSpace::Storage { access: StorageAccess::LOAD };
        }
    }
    module
}

fn bytes_of_words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// The bindings that the entry point uses, which are those of the derived layout.
fn used_bindings(stage: EntryPoint<'_>) -> Result<BTreeSet<BindingPlace>, Diagnostic> {
    let info = module_info("program", stage.module)?;
    let index = stage.module.entry_points.iter().position(|point| point.name == stage.entry);
    let index = index.ok_or_else(|| {
        executor_failed(format!("the program has no entry point `{}`", stage.entry))
    })?;
    let variables = stage
        .module
        .global_variables
        .iter()
        .filter(|(handle, _)| !info.get_entry_point(index)[*handle].is_empty());
    Ok(variables
        .filter_map(|(_, variable)| variable.binding.map(|place| (place.group, place.binding)))
        .collect())
}

/// The attributes of a mesh as wgpu takes them.
fn vertex_layout(mesh: &Mesh) -> Vec<wgpu::VertexAttribute> {
    let attribute = |(attribute, offset): (VertexAttribute, u64)| wgpu::VertexAttribute {
        format: match attribute.format {
            VertexFormat::Uint32 => wgpu::VertexFormat::Uint32,
            VertexFormat::Float32 => wgpu::VertexFormat::Float32,
            VertexFormat::Float32x2 => wgpu::VertexFormat::Float32x2,
            VertexFormat::Float32x3 => wgpu::VertexFormat::Float32x3,
            VertexFormat::Float32x4 => wgpu::VertexFormat::Float32x4,
        },
        offset,
        shader_location: attribute.location,
    };
    mesh.layout().into_iter().map(attribute).collect()
}
