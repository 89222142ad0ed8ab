//! A shadow from beginning to end: a box on a floor under a spot lamp. The program `depth` draws the
//! shadow map as the lamp sees the scene, and `forward` draws the picture with it. The matrices are
//! those of the package `lamplight-scene`, and the pipelines are made with `lamplight-wgpu`. The example
//! opens no window. It writes a PNG.
//!
//! ```text
//! cargo run -- gen --manifest shaderlib/lamplight.toml --target wgsl --program depth --out depth.lamplight
//! cargo run -- gen --manifest shaderlib/lamplight.toml --target wgsl --program forward \
//!     --only lights=spot,max_lights=1,shadow=pcf_3x3 --out forward.lamplight
//! cargo run --example shadow_pass -- depth.lamplight forward.lamplight shadow.png
//! ```

#![allow(clippy::print_stdout)]

use std::collections::BTreeMap;
use std::error::Error;

use glam::{DMat4, DVec3};
use lamplight::bundle::{Binding, Bundle, Target};
use lamplight_scene::{Clip, Depth, look_at, perspective, shadow_matrix};
use lamplight_wgpu::{Block, Stage};
use wgpu::util::DeviceExt as _;

/// The permutation of `forward` that draws the picture.
pub const KEY: &str = "lights=spot,max_lights=1,shadow=pcf_3x3";

/// The picture and the shadow map, in pixels. wgpu copies textures into buffers only in rows of a
/// multiple of 256 bytes.
pub const SIZE: [u32; 2] = [256, 192];
const MAP_SIZE: u32 = 512;

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The lamp, which shines at the origin in a cone of 60 degrees, and its near and far planes: the
/// closer they are to the scene, the finer are the depths.
pub const LAMP: DVec3 = DVec3::new(2.5, 4.0, 1.5);
const CONE: f64 = std::f64::consts::FRAC_PI_3;
const PLANES: [f64; 2] = [1.0, 12.0];

/// The box on the floor, by two of its corners.
pub const BOX: [DVec3; 2] = [DVec3::new(-0.5, 0.0, -0.5), DVec3::new(0.5, 1.0, 0.5)];
const FLOOR: f64 = 4.0;

pub fn main() -> Result<(), Box<dyn Error>> {
    let usage = "usage: shadow_pass DEPTH_BUNDLE FORWARD_BUNDLE PICTURE";
    let paths: Vec<String> = std::env::args().skip(1).collect();
    let [depth, forward, picture] = paths.as_slice() else { return Err(usage.into()) };
    let pixels = draw(&Bundle::open(depth)?, &Bundle::open(forward)?)?;
    let [width, height] = SIZE;
    image::save_buffer(picture, &pixels, width, height, image::ExtendedColorType::Rgba8)?;
    let place = shadow_from_world().project_point3(DVec3::new(-1.0, 0.0, -0.6));
    println!("(-1, 0, -0.6) is at {:.3}, {:.3} in the map, {:.3} deep", place.x, place.y, place.z);
    Ok(())
}

/// What the viewer sees, from world to clip space.
pub fn clip_from_world() -> DMat4 {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    perspective(0.8, aspect, 0.1, 50.0, Clip::Wgpu, Depth::Normal) * camera_view()
}

fn camera_view() -> DMat4 {
    look_at(DVec3::new(-2.0, 4.5, 5.0), DVec3::ZERO, DVec3::Y)
}

/// What the lamp sees: a square around its cone.
fn lamp_projection() -> DMat4 {
    let [near, far] = PLANES;
    perspective(CONE, 1.0, near, far, Clip::Wgpu, Depth::Normal)
}

fn lamp_view() -> DMat4 {
    look_at(LAMP, DVec3::ZERO, DVec3::Y)
}

/// From the world to texture coordinates and depth of the shadow map, with the scale and the bias of
/// OpenGL's books. `forward` takes the matrix without them, and does this itself.
pub fn shadow_from_world() -> DMat4 {
    shadow_matrix(lamp_projection(), lamp_view(), Clip::Wgpu)
}

/// Draws the picture: four bytes for each pixel, coded as sRGB.
pub fn draw(depth: &Bundle, forward: &Bundle) -> Result<Vec<u8>, Box<dyn Error>> {
    let (device, queue) = open()?;
    let gpu = Gpu { device, queue };
    let corners = corners();
    let vertices = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("corners"),
        contents: &corners
            .iter()
            .flatten()
            .flat_map(|number| number.to_le_bytes())
            .collect::<Vec<_>>(),
        usage: wgpu::BufferUsages::VERTEX,
    });
    let count = corners.len() as u32;
    let map = gpu.target([MAP_SIZE; 2], DEPTH, wgpu::TextureUsages::TEXTURE_BINDING);
    let map_view = map.create_view(&Default::default());
    let shadows = Pass::new(&gpu, depth, "depth", "default")?;
    let view = Pass::new(&gpu, forward, "forward", KEY)?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());

    let groups = shadows.groups(&gpu, &map_view, lamp_projection() * lamp_view(), lamp_view())?;
    {
        // Where nothing is drawn, the map is at the far plane.
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(cleared_depth(&map_view)),
            ..Default::default()
        });
        shadows.record(&mut pass, &groups, &vertices, count);
    }

    let picture = gpu.target(SIZE, COLOR, wgpu::TextureUsages::COPY_SRC);
    let depths = gpu.target(SIZE, DEPTH, wgpu::TextureUsages::empty());
    let depths = depths.create_view(&Default::default());
    let groups = view.groups(&gpu, &map_view, clip_from_world(), camera_view())?;
    {
        let color = picture.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(cleared_color(&color))],
            depth_stencil_attachment: Some(cleared_depth(&depths)),
            ..Default::default()
        });
        view.record(&mut pass, &groups, &vertices, count);
    }
    gpu.read(encoder, &picture)
}

/// A program with its pipeline.
struct Pass {
    pipeline: wgpu::RenderPipeline,
    /// What its stages bind, each once.
    bindings: Vec<Binding>,
}

type Groups = Vec<(u32, wgpu::BindGroup)>;

impl Pass {
    /// The pipeline of a permutation. `depth` writes depths alone: its fragment stage is for WebGL 2.
    fn new(gpu: &Gpu, bundle: &Bundle, name: &str, key: &str) -> Result<Self, Box<dyn Error>> {
        let program = bundle.program(name)?;
        let vertex = program.shader("vs_main")?.get(key, Target::WGSL)?;
        let is_map = name == "depth";
        let fragment = match is_map {
            true => None,
            false => Some(program.shader("fs_main")?.get(key, Target::WGSL)?),
        };
        let mut bindings: BTreeMap<(u32, u32), Binding> = BTreeMap::new();
        for stage in [Some(&vertex), fragment.as_ref()].into_iter().flatten() {
            let own = stage.reflection.bindings.iter();
            bindings.extend(own.map(|one| ((one.group, one.binding), one.clone())));
        }
        let vertex = Stage::new(&gpu.device, &vertex)?;
        let fragment = fragment.map(|found| Stage::new(&gpu.device, &found)).transpose()?;
        let pipeline = gpu.pipeline(&vertex, fragment.as_ref(), is_map);
        Ok(Self { pipeline, bindings: bindings.into_values().collect() })
    }

    /// The bind groups: uniform blocks by the names of their members, the map, and its sampler.
    fn groups(
        &self,
        gpu: &Gpu,
        map: &wgpu::TextureView,
        clip_from_world: DMat4,
        view: DMat4,
    ) -> Result<Groups, Box<dyn Error>> {
        // The linear filter weighs four comparisons.
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        let mut buffers = BTreeMap::new();
        for binding in self.bindings.iter().filter(|binding| binding.size.is_some()) {
            let bytes = filled(binding, clip_from_world, view)?;
            let buffer = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(&binding.name),
                contents: &bytes,
                usage: wgpu::BufferUsages::UNIFORM,
            });
            buffers.insert(binding.name.as_str(), buffer);
        }
        let resource = |name: &str| match (name, buffers.get(name)) {
            (_, Some(buffer)) => buffer.as_entire_binding(),
            ("shadow_map", None) => wgpu::BindingResource::TextureView(map),
            (_, None) => wgpu::BindingResource::Sampler(&sampler),
        };
        let group = |index: u32| {
            let own = self.bindings.iter().filter(|binding| binding.group == index);
            let entries: Vec<_> = own
                .map(|found| wgpu::BindGroupEntry {
                    binding: found.binding,
                    resource: resource(&found.name),
                })
                .collect();
            let layout = &self.pipeline.get_bind_group_layout(index);
            let descriptor = wgpu::BindGroupDescriptor { label: None, layout, entries: &entries };
            (index, gpu.device.create_bind_group(&descriptor))
        };
        let used: std::collections::BTreeSet<u32> =
            self.bindings.iter().map(|binding| binding.group).collect();
        Ok(used.into_iter().map(group).collect())
    }

    fn record(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        groups: &Groups,
        vertices: &wgpu::Buffer,
        count: u32,
    ) {
        pass.set_pipeline(&self.pipeline);
        for (index, group) in groups {
            pass.set_bind_group(*index, group, &[]);
        }
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.draw(0..count, 0..1);
    }
}

/// The bytes of a uniform block. What is not set is 0.
fn filled(binding: &Binding, clip: DMat4, view: DMat4) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut block = Block::new(binding);
    let identity = DMat4::IDENTITY;
    // The blocks of `depth` are the beginning of those of `forward`.
    let has = |name: &str| binding.members.iter().any(|member| member.name == name);
    match binding.name.as_str() {
        "camera" => {
            block.set("clip_from_world", &numbers(clip))?;
            if has("world_from_view") {
                block.set("world_from_view", &numbers(view.inverse()))?;
            }
        }
        "object" => {
            block.set("world_from_object", &numbers(identity))?;
            if has("color") {
                block.set("normal_from_object", &numbers(identity))?;
                block.set("color", &[1.0_f32; 4])?;
            }
        }
        "lamps" => {
            block.set("count", &[1_u32])?;
            // LIGHT_SPOT of the library.
            block.set("lights[0].kind", &[3_u32])?;
            block.set("lights[0].color", &[1.0_f32; 3])?;
            block.set("lights[0].position", &LAMP.as_vec3().to_array())?;
            block.set("lights[0].axis", &(-LAMP.normalize()).as_vec3().to_array())?;
            block.set("lights[0].cutoff", &[(0.5 * CONE).cos() as f32])?;
            block.set("lights[0].attenuation", &[1.0_f32, 0.0, 0.0])?;
            block.set("lights[0].strength", &[1.0_f32])?;
            block.set("lights[0].shadow_strength", &[1.0_f32])?;
        }
        "caster" => {
            // The matrix that the map was drawn with. The pipeline has added the bias.
            block.set("clip_from_world", &numbers(lamp_projection() * lamp_view()))?;
        }
        "surroundings" => block.set("color", &[0.1_f32; 3])?,
        "materials" => {
            block.set("items[0].ambient", &[1.0_f32; 3])?;
            block.set("items[0].diffuse", &[1.0_f32; 3])?;
            block.set("items[0].specular", &[0.05_f32; 3])?;
            block.set("items[0].shininess", &[30.0_f32])?;
        }
        other => return Err(format!("the block `{other}` is not known").into()),
    }
    Ok(block.bytes().to_vec())
}

/// Column after column, as a uniform block has them.
fn numbers(matrix: DMat4) -> [f32; 16] {
    matrix.as_mat4().to_cols_array()
}

struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

/// Opens a device, on a software adapter if there is one.
fn open() -> Result<(wgpu::Device, wgpu::Queue), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
    adapters.sort_by_key(|adapter| adapter.get_info().device_type != wgpu::DeviceType::Cpu);
    let adapter = adapters.first().ok_or("no adapter: install mesa-vulkan-drivers")?;
    Ok(pollster::block_on(adapter.request_device(&Default::default()))?)
}

impl Gpu {
    fn pipeline(
        &self,
        vertex: &Stage,
        fragment: Option<&Stage>,
        is_map: bool,
    ) -> wgpu::RenderPipeline {
        // `depth` takes the position alone, from the same buffer.
        let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4];
        let options =
            |constants| wgpu::PipelineCompilationOptions { constants, ..Default::default() };
        let (of_vertex, of_fragment) =
            (vertex.constants(), fragment.map(Stage::constants).unwrap_or_default());
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &vertex.module,
                entry_point: Some(&vertex.entry),
                compilation_options: options(&of_vertex),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: 40,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: if is_map { &attributes[..1] } else { &attributes },
                })],
            },
            primitive: Default::default(),
            depth_stencil: Some(depth_state(is_map)),
            multisample: Default::default(),
            fragment: fragment.map(|stage| wgpu::FragmentState {
                module: &stage.module,
                entry_point: Some(&stage.entry),
                compilation_options: options(&of_fragment),
                targets: &[Some(wgpu::ColorTargetState {
                    format: COLOR,
                    blend: None,
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// A texture that is drawn into, and used otherwise too.
    fn target(
        &self,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        })
    }

    fn read(
        &self,
        mut encoder: wgpu::CommandEncoder,
        picture: &wgpu::Texture,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let [width, height] = SIZE;
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(4 * width * height),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * width),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            picture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
            picture.size(),
        );
        self.queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        receiver.recv()??;
        Ok(buffer.get_mapped_range(..)?.to_vec())
    }
}

/// The depth test, and for the map a bias that pushes depths away from the lamp: by twice the slope of a
/// triangle, and by four of the smallest steps, as in example 7.18 of the OpenGL Programming Guide.
fn depth_state(is_map: bool) -> wgpu::DepthStencilState {
    let bias = match is_map {
        true => wgpu::DepthBiasState { constant: 4, slope_scale: 2.0, clamp: 0.0 },
        false => wgpu::DepthBiasState::default(),
    };
    wgpu::DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::LessEqual),
        stencil: Default::default(),
        bias,
    }
}

fn cleared_color(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
            store: wgpu::StoreOp::Store,
        },
    }
}

fn cleared_depth(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(1.0),
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    }
}

/// Positions, normals and colours of the corners of all triangles.
fn corners() -> Vec<[f32; 10]> {
    let floor = [DVec3::new(-FLOOR, -0.1, -FLOOR), DVec3::new(FLOOR, 0.0, FLOOR)];
    let mut all = cuboid(floor, [0.75, 0.75, 0.7]);
    all.extend(cuboid(BOX, [0.8, 0.35, 0.2]));
    all
}

/// The six sides of a box, counter-clockwise seen from outside.
fn cuboid([low, high]: [DVec3; 2], color: [f32; 3]) -> Vec<[f32; 10]> {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let sides = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let side = |normal: DVec3| {
        let across = DVec3::new(normal.y.abs(), normal.z.abs(), normal.x.abs());
        let up = normal.cross(across);
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(
            |(x, y)| {
                let place = (middle + half * (normal + across * x + up * y)).as_vec3();
                let normal = normal.as_vec3();
                let [red, green, blue] = color;
                [place.x, place.y, place.z, normal.x, normal.y, normal.z, red, green, blue, 1.0]
            },
        )
    };
    sides.flat_map(side).collect()
}
