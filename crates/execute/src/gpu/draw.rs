//! Draws meshes into targets of words, a depth buffer, or both: the resources that a drawing's stages
//! are bound to, and the attachments of a frame, with how they are read back.

mod shipped;

use crate::fixture::{Address, Fixture, FixtureSampler};
use crate::frame::{
    BindingPlace, Buffers, DrawItem, Drawing, EntryPoint, Face, Frame, Mesh, PipelineState,
    VertexAttribute, VertexFormat,
};
use crate::gpu::fixtures::{TEXEL, color_attachment, copy_to_buffer, create_texture, padded_row};
use crate::gpu::{TARGET_FORMAT, WgpuDevice, executor_failed, fixtures, pipeline};
use crate::module_info;
use crate::shipped::ColorFormat;
use lamplight_diagnostic::Diagnostic;
use naga::{AddressSpace, StorageAccess};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use wgpu::util::DeviceExt;

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
    ) -> Result<Vec<Pending>, Diagnostic> {
        let vertex = (self.shader(drawing.vertex, as_storage)?, drawing.vertex.entry);
        let fragment = match drawing.fragment {
            Some(stage) => Some((self.shader(stage, as_storage)?, stage.entry)),
            None => None,
        };
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
    ) -> Result<wgpu::ShaderModule, Diagnostic> {
        let module = storage_blocks(stage.module, as_storage);
        let masked = lamplight_emit::with_masked_shifts(&module).map_err(executor_failed)?;
        let source = wgpu::ShaderSource::Naga(Cow::Owned(masked.unwrap_or(module)));
        let descriptor = wgpu::ShaderModuleDescriptor { label: None, source };
        Ok(self.device.create_shader_module(descriptor))
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
            .map(|format| Some(wgpu::ColorTargetState::from(texture_format(*format))))
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
    ) -> Pending {
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
            VertexFormat::Uint32x2 => wgpu::VertexFormat::Uint32x2,
            VertexFormat::Uint32x3 => wgpu::VertexFormat::Uint32x3,
            VertexFormat::Uint32x4 => wgpu::VertexFormat::Uint32x4,
            VertexFormat::Sint32 => wgpu::VertexFormat::Sint32,
            VertexFormat::Sint32x2 => wgpu::VertexFormat::Sint32x2,
            VertexFormat::Sint32x3 => wgpu::VertexFormat::Sint32x3,
            VertexFormat::Sint32x4 => wgpu::VertexFormat::Sint32x4,
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

/// The bindings that the stages use, with their textures and samplers uploaded.
pub struct Bindings {
    used: BTreeSet<BindingPlace>,
    kept: BTreeMap<BindingPlace, KeptResource>,
}

/// What keeps a binding's resource alive.
enum KeptResource {
    Buffer(wgpu::Buffer),
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

impl Bindings {
    pub fn new(
        gpu: &WgpuDevice,
        drawing: &Drawing<'_>,
        used: BTreeSet<BindingPlace>,
    ) -> Result<Self, Diagnostic> {
        let mut kept = BTreeMap::new();
        for place in used.iter().filter(|place| !drawing.is_buffer(**place)) {
            kept.insert(*place, bound_fixture(gpu, drawing, *place)?);
        }
        Ok(Self { used, kept })
    }

    /// The bind groups of one item in one view.
    pub fn groups(
        &self,
        gpu: &WgpuDevice,
        drawing: &Drawing<'_>,
        view: &Buffers,
        item: &DrawItem<'_>,
        layout: &dyn Fn(u32) -> Option<wgpu::BindGroupLayout>,
    ) -> Result<Groups, Diagnostic> {
        let buffers = self.buffers(gpu, drawing, view, item)?;
        let indices: BTreeSet<u32> = self.used.iter().map(|(group, _)| *group).collect();
        let group = |index: u32| {
            let own = buffers.iter().chain(&self.kept).filter(|((group, _), _)| *group == index);
            let entries: Vec<_> = own
                .map(|((_, binding), kept)| wgpu::BindGroupEntry {
                    binding: *binding,
                    resource: kept.resource(),
                })
                .collect();
            let layout = layout(index)?;
            let descriptor =
                wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries };
            Some((index, gpu.device.create_bind_group(&descriptor)))
        };
        Ok(indices.into_iter().filter_map(group).collect())
    }

    /// Adds samplers that nothing reads at the unused bindings of its groups. wgpu numbers bindings
    /// without gaps, but a shipped stage has the author's numbers.
    pub fn without_gaps(mut self, gpu: &WgpuDevice) -> Self {
        let last: BTreeMap<u32, u32> = self.used.iter().copied().collect();
        for place in last.iter().flat_map(|(group, last)| (0..*last).map(|one| (*group, one))) {
            if !self.used.contains(&place) {
                let settings =
                    FixtureSampler { compare: None, linear: false, address: Address::Clamp };
                let sampler = fixtures::create_sampler(&gpu.device, settings);
                self.kept.insert(place, KeptResource::Sampler(sampler));
            }
        }
        self
    }

    pub fn layouts(
        &self,
        gpu: &WgpuDevice,
        drawing: &Drawing<'_>,
    ) -> BTreeMap<u32, wgpu::BindGroupLayout> {
        let places: BTreeSet<BindingPlace> =
            self.used.iter().chain(self.kept.keys()).copied().collect();
        let fixture = |place: &BindingPlace| drawing.fixtures.get(place).map(|fixture| &**fixture);
        // Not every device can filter f32 textures, so filtering is asked for only where a stage
        // filters.
        let is_filter = |fixture: &Fixture| matches!(fixture, Fixture::Sampler(one) if one.linear && one.compare.is_none());
        let filters = self.used.iter().filter_map(fixture).any(is_filter);
        let entry = |place: &BindingPlace| wgpu::BindGroupLayoutEntry {
            binding: place.1,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: match (self.used.contains(place), fixture(place)) {
                (true, Some(fixture)) => binding_type(fixture, filters),
                (true, None) => UNIFORM,
                (false, _) => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
            },
            count: None,
        };
        let groups: BTreeSet<u32> = places.iter().map(|(group, _)| *group).collect();
        let layout = |group: u32| {
            let own = places.iter().filter(|(other, _)| *other == group);
            (group, gpu.layouts.of(&gpu.device, own.map(entry).collect()))
        };
        groups.into_iter().map(layout).collect()
    }

    fn buffers(
        &self,
        gpu: &WgpuDevice,
        drawing: &Drawing<'_>,
        view: &Buffers,
        item: &DrawItem<'_>,
    ) -> Result<BTreeMap<BindingPlace, KeptResource>, Diagnostic> {
        let places = self.used.iter().filter(|place| !self.kept.contains_key(place));
        let buffer = |place: &BindingPlace| {
            let bytes =
                drawing.buffer(view, item, *place).ok_or_else(|| missing_binding(*place))?;
            Ok((
                *place,
                KeptResource::Buffer(
                    gpu.buffer(bytes, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::STORAGE),
                ),
            ))
        };
        places.map(buffer).collect()
    }
}

impl KeptResource {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        match self {
            Self::Buffer(buffer) => buffer.as_entire_binding(),
            Self::View(view) => wgpu::BindingResource::TextureView(view),
            Self::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
        }
    }
}

const UNIFORM: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: None,
};

fn binding_type(fixture: &Fixture, filterable: bool) -> wgpu::BindingType {
    match fixture {
        Fixture::Texture(texture) => {
            let is_cube = texture.kind.layers() == 6;
            let dimension = if is_cube {
                wgpu::TextureViewDimension::Cube
            } else {
                wgpu::TextureViewDimension::D2
            };
            let sample = match texture.kind.is_depth() {
                true => wgpu::TextureSampleType::Depth,
                false => wgpu::TextureSampleType::Float { filterable },
            };
            pipeline::texture_type(sample, dimension)
        }
        Fixture::Sampler(settings) => pipeline::sampler_type(*settings),
    }
}

fn bound_fixture(
    gpu: &WgpuDevice,
    drawing: &Drawing<'_>,
    place: BindingPlace,
) -> Result<KeptResource, Diagnostic> {
    match drawing.fixtures.get(&place).map(|fixture| &**fixture) {
        Some(Fixture::Texture(texture)) => {
            let levels = drawing.levels.get(&place).map_or(&[][..], Vec::as_slice);
            Ok(KeptResource::View(fixtures::upload_levels(
                &gpu.device,
                &gpu.queue,
                texture,
                levels,
            )))
        }
        Some(Fixture::Sampler(sampler)) => {
            Ok(KeptResource::Sampler(fixtures::create_sampler(&gpu.device, *sampler)))
        }
        None => Err(missing_binding(place)),
    }
}

fn missing_binding(place: BindingPlace) -> Diagnostic {
    executor_failed(format!("nothing is given for group {}, binding {}", place.0, place.1))
}

const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The format that depths are read in: their bits.
const READ_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// The shader that reads depth. Not every device can copy depth into a buffer, but all can read it.
const DEPTH: &str = "
@group(0) @binding(0) var drawn: texture_2d<f32>;
@vertex fn triangle(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2u((index << 1u) & 2u, index & 2u);
    return vec4f(vec2f(corner) * 2.0 - 1.0, 0.0, 1.0);
}
@fragment fn read(@builtin(position) position: vec4f) -> @location(0) vec4u {
    return vec4u(bitcast<u32>(textureLoad(drawn, vec2u(position.xy), 0).x), 0u, 0u, 0u);
}";

/// The attachments of one frame.
pub struct Targets {
    size: [u32; 2],
    color: Vec<(wgpu::Texture, ColorFormat)>,
    depth: Option<wgpu::Texture>,
    keep_depth: bool,
}

/// A frame that is being copied back.
pub struct Pending {
    size: [u32; 2],
    color: Vec<wgpu::Buffer>,
    depth: Option<wgpu::Buffer>,
}

impl Targets {
    pub fn new(device: &wgpu::Device, drawing: &Drawing<'_>, formats: &[ColorFormat]) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let depth_usage =
            wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let [width, height] = drawing.size;
        let create = |format, usage| create_texture(device, [width, height, 1], 1, format, usage);
        Self {
            size: drawing.size,
            color: formats.iter().map(|one| (create(texture_format(*one), usage), *one)).collect(),
            depth: drawing.state.depth_test.then(|| create(DEPTH_FORMAT, depth_usage)),
            keep_depth: drawing.state.keep_depth,
        }
    }

    /// A render pass over cleared attachments.
    pub fn pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        draws: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) {
        let views: Vec<_> = self
            .color
            .iter()
            .map(|(target, format)| (target.create_view(&Default::default()), *format))
            .collect();
        let attachments: Vec<_> =
            views.iter().map(|(view, format)| Some(color_attachment(view, *format))).collect();
        let depth = self.depth.as_ref().map(|depth| depth.create_view(&Default::default()));
        let depth_stencil_attachment =
            depth.as_ref().map(|view| wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            });
        let descriptor = wgpu::RenderPassDescriptor {
            color_attachments: &attachments,
            depth_stencil_attachment,
            ..Default::default()
        };
        draws(&mut encoder.begin_render_pass(&descriptor));
    }

    /// Copies the targets, and the depth if it is kept, into buffers that can be mapped.
    pub fn download(&self, gpu: &WgpuDevice, encoder: &mut wgpu::CommandEncoder) -> Pending {
        let color = self
            .color
            .iter()
            .map(|(target, _)| copy_to_buffer(&gpu.device, encoder, target, self.size, TEXEL))
            .collect();
        let kept = self.depth.as_ref().filter(|_| self.keep_depth);
        let depth = kept.map(|depth| {
            let target = as_words(gpu, encoder, depth, self.size);
            copy_to_buffer(&gpu.device, encoder, &target, self.size, DEPTH_TEXEL)
        });
        Pending { size: self.size, color, depth }
    }
}

impl Pending {
    pub fn read(
        &self,
        gpu: &WgpuDevice,
        detour: Option<&'static str>,
    ) -> Result<Frame, Diagnostic> {
        let color = |buffer: &wgpu::Buffer| {
            gpu.mapped(buffer, |bytes| self.texels(bytes, TEXEL, u32::from_le_bytes))
        };
        let targets = self.color.iter().map(color).collect::<Result<_, _>>()?;
        let depth = self.depth.as_ref().map(|buffer| {
            gpu.mapped(buffer, |bytes| self.texels(bytes, DEPTH_TEXEL, f32::from_le_bytes))
        });
        Ok(Frame { targets, depth: depth.transpose()?.unwrap_or_default(), detour })
    }

    /// The numbers in the rows of a mapped buffer, without the padding of the rows. All memory is
    /// allocated at the start, since shadow maps are large.
    fn texels<T>(&self, bytes: &[u8], texel: u32, number: impl Fn([u8; 4]) -> T) -> Vec<T> {
        let [width, height] = self.size;
        let row = (width * texel) as usize;
        let mut all = Vec::with_capacity(row / 4 * height as usize);
        for bytes in bytes.chunks(padded_row(width, texel) as usize) {
            all.extend(bytes[..row].as_chunks::<4>().0.iter().map(|bytes| number(*bytes)));
        }
        all
    }
}

/// The texture format of a target.
fn texture_format(of: ColorFormat) -> wgpu::TextureFormat {
    match of {
        ColorFormat::Float => wgpu::TextureFormat::Rgba32Float,
        ColorFormat::Uint => TARGET_FORMAT,
    }
}

/// Bytes of a texel of the depths that are read.
const DEPTH_TEXEL: u32 = 4;

/// A pipeline that reads the bits of a depth texture, and the layout of its bindings.
fn depth_reader(device: &wgpu::Device) -> (wgpu::BindGroupLayout, wgpu::RenderPipeline) {
    let taken = wgpu::TextureSampleType::Float { filterable: false };
    pipeline::texture_pipeline(device, (DEPTH, "read"), taken, Some(READ_FORMAT), None)
}

/// Draws the bits of a depth texture into a target of words.
fn as_words(
    gpu: &WgpuDevice,
    encoder: &mut wgpu::CommandEncoder,
    depth: &wgpu::Texture,
    [width, height]: [u32; 2],
) -> wgpu::Texture {
    let device = &gpu.device;
    let (layout, pipeline) = depth_reader(device);
    let view = depth.create_view(&Default::default());
    let entry =
        wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) };
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[entry],
    });
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
    let target = create_texture(device, [width, height, 1], 1, READ_FORMAT, usage);
    let view = target.create_view(&Default::default());
    let attachments = [Some(color_attachment(&view, ColorFormat::Uint))];
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &attachments,
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    target
}
