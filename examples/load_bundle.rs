//! Loads one permutation from a bundle and draws a triangle with it. The example opens no window.
//! It prints the colour of one pixel.
//!
//! ```text
//! cargo run -- gen --manifest shaderlib/lamplight.toml --program forward --out shaders.lamplight
//! cargo run --example load_bundle -- shaders.lamplight
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::sync::mpsc;

use lamplight::bundle::{Bundle, Found, Target};

/// Width and height of the picture. A row of 64 RGBA pixels has 256 bytes, and wgpu copies textures
/// into buffers only in rows of a multiple of 256 bytes.
const SIZE: u32 = 64;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The permutation that draws a surface in its own colour, without light.
const KEY: &str = "ambient=none,lights=none";

/// The attributes of a vertex at the locations where `forward` reads them: position, normal,
/// colour.
const CORNER: [wgpu::VertexAttribute; 3] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4];

pub fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: load_bundle BUNDLE")?;
    println!("{:?}", draw(&path)?);
    Ok(())
}

/// Draws an orange triangle and returns the pixel in the middle of the picture.
pub fn draw(path: &str) -> Result<[u8; 4], Box<dyn Error>> {
    let bundle = Bundle::open(path)?;
    let program = bundle.program("forward")?;
    let vertex = program.shader("vs_main")?.get(KEY, Target::WGSL)?;
    let fragment = program.shader("fs_main")?.get(KEY, Target::WGSL)?;

    let (device, queue) = open()?;
    let pipeline = pipeline(&device, &vertex, &fragment)?;

    let filled = |numbers: &[f32], usage| filled(&device, &queue, numbers, usage);
    let camera = filled(&[identity(), identity()].concat(), wgpu::BufferUsages::UNIFORM);
    let object =
        filled(&[&identity()[..], &identity(), &[1.0; 4]].concat(), wgpu::BufferUsages::UNIFORM);
    let corners = filled(&corners(), wgpu::BufferUsages::VERTEX);
    let bound = |group: u32, buffer: &wgpu::Buffer| {
        let entries = [wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }];
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(group),
            entries: &entries,
        })
    };

    let picture = picture(&device);
    let view = picture.create_view(&Default::default());
    let mut encoder = device.create_command_encoder(&Default::default());
    {
        let mut pass = cleared(&mut encoder, &view);
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bound(0, &camera), &[]);
        pass.set_bind_group(2, &bound(2, &object), &[]);
        pass.set_vertex_buffer(0, corners.slice(..));
        pass.draw(0..3, 0..1);
    }
    let pixels = read(&device, &queue, encoder, &picture)?;
    let middle = ((SIZE / 2 * SIZE + SIZE / 2) * 4) as usize;
    Ok([pixels[middle], pixels[middle + 1], pixels[middle + 2], pixels[middle + 3]])
}

/// Opens a device, on a software adapter if there is one.
fn open() -> Result<(wgpu::Device, wgpu::Queue), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
    adapters.sort_by_key(|adapter| adapter.get_info().device_type != wgpu::DeviceType::Cpu);
    let adapter = adapters.first().ok_or("no adapter: install mesa-vulkan-drivers")?;
    Ok(pollster::block_on(adapter.request_device(&Default::default()))?)
}

/// The pipeline of a vertex shader and a fragment shader of the bundle.
fn pipeline(
    device: &wgpu::Device,
    vertex: &Found,
    fragment: &Found,
) -> Result<wgpu::RenderPipeline, Box<dyn Error>> {
    let module = |bytes: &[u8]| -> Result<wgpu::ShaderModule, std::str::Utf8Error> {
        let source = wgpu::ShaderSource::Wgsl(std::str::from_utf8(bytes)?.into());
        Ok(device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source }))
    };
    Ok(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(KEY),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module(&vertex.bytes)?,
            entry_point: Some(&vertex.native.entry_name),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 40,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &CORNER,
            })],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module(&fragment.bytes)?,
            entry_point: Some(&fragment.native.entry_name),
            compilation_options: Default::default(),
            targets: &[Some(FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    }))
}

/// A buffer that is filled with the numbers.
fn filled(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    numbers: &[f32],
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bytes.len() as u64,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&buffer, 0, &bytes);
    buffer
}

/// The picture that is drawn into.
fn picture(device: &wgpu::Device) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// A render pass that clears the picture to black first.
fn cleared<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
) -> wgpu::RenderPass<'e> {
    let attachment = wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
            store: wgpu::StoreOp::Store,
        },
    };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(attachment)],
        ..Default::default()
    })
}

fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    picture: &wgpu::Texture,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let staging = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(SIZE * SIZE * 4),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(SIZE * 4),
        rows_per_image: None,
    };
    encoder.copy_texture_to_buffer(
        picture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &staging, layout },
        picture.size(),
    );
    queue.submit([encoder.finish()]);
    let (sender, receiver) = mpsc::channel();
    staging.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
    device.poll(wgpu::PollType::wait_indefinitely())?;
    receiver.recv()??;
    let view = staging.get_mapped_range(..)?;
    Ok(view.to_vec())
}

fn identity() -> [f32; 16] {
    std::array::from_fn(|index| if index % 5 == 0 { 1.0 } else { 0.0 })
}

/// The vertices of an orange triangle around the middle of the picture.
fn corners() -> Vec<f32> {
    let corner = |[x, y]: [f32; 2]| [x, y, 0.5, 0.0, 0.0, 1.0, 1.0, 0.5, 0.0, 1.0];
    [[-0.8, -0.8], [0.8, -0.8], [0.0, 0.8]].into_iter().flat_map(corner).collect()
}
