//! Textures and samplers of a device: uploads fixtures, and copies texels to and from textures.

use crate::fixture::{Address, Compare, FixtureSampler, FixtureTexture};
use crate::gpu::pipeline;
use crate::kernel::SENTINEL;
use crate::shipped::ColorFormat;
use lamplight_eval::{half_from, half_to};

/// The shader that draws depth. Not every device can copy into a depth texture, but all can draw
/// into it.
const DEPTH: &str = "
@group(0) @binding(0) var stored: texture_2d<u32>;
@vertex fn triangle(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2u((index << 1u) & 2u, index & 2u);
    return vec4f(vec2f(corner) * 2.0 - 1.0, 0.0, 1.0);
}
@fragment fn depth(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    return bitcast<f32>(textureLoad(stored, vec2u(position.xy), 0).x);
}";

/// Uploads a texture; returns a view of it.
pub fn upload_texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &FixtureTexture,
) -> wgpu::TextureView {
    upload_levels(device, queue, texture, &[])
}

/// Uploads a texture with its smaller levels, which only colours may have.
pub fn upload_levels(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &FixtureTexture,
    smaller: &[FixtureTexture],
) -> wgpu::TextureView {
    let cube = texture.kind.layers() == 6;
    let dimension =
        if cube { wgpu::TextureViewDimension::Cube } else { wgpu::TextureViewDimension::D2 };
    let created = if texture.kind.is_depth() {
        depth_texture(device, queue, texture)
    } else {
        color_texture(device, queue, texture, smaller)
    };
    created.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(dimension),
        ..Default::default()
    })
}

pub fn create_sampler(device: &wgpu::Device, sampler: FixtureSampler) -> wgpu::Sampler {
    let address = match sampler.address {
        Address::Clamp => wgpu::AddressMode::ClampToEdge,
        Address::Repeat => wgpu::AddressMode::Repeat,
        Address::Mirror => wgpu::AddressMode::MirrorRepeat,
    };
    let filter = if sampler.linear { wgpu::FilterMode::Linear } else { wgpu::FilterMode::Nearest };
    let compare = sampler.compare.map(|compare| match compare {
        Compare::Less => wgpu::CompareFunction::Less,
        Compare::LessEqual => wgpu::CompareFunction::LessEqual,
        Compare::Greater => wgpu::CompareFunction::Greater,
        Compare::GreaterEqual => wgpu::CompareFunction::GreaterEqual,
        Compare::Equal => wgpu::CompareFunction::Equal,
        Compare::NotEqual => wgpu::CompareFunction::NotEqual,
    });
    device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: address,
        address_mode_v: address,
        address_mode_w: address,
        mag_filter: filter,
        min_filter: filter,
        // For textures with several levels, which are filtered linearly between these too.
        mipmap_filter: if sampler.linear && compare.is_none() {
            wgpu::MipmapFilterMode::Linear
        } else {
            wgpu::MipmapFilterMode::Nearest
        },
        compare,
        ..Default::default()
    })
}

/// A colour texture with all its levels. It has 32 bits a channel, or 16 where the device cannot
/// filter 32 and 16 bits represent every value exactly.
fn color_texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &FixtureTexture,
    smaller: &[FixtureTexture],
) -> wgpu::Texture {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let levels = || std::iter::once(texture).chain(smaller);
    let half = !device.features().contains(wgpu::Features::FLOAT32_FILTERABLE)
        && levels().all(|level| level.texels.iter().all(|texel| is_half(*texel)));
    let format =
        if half { wgpu::TextureFormat::Rgba16Float } else { wgpu::TextureFormat::Rgba32Float };
    let count = 1 + smaller.len() as u32;
    let created = create_texture(device, level_size(texture), count, format, usage);
    for (index, level) in levels().enumerate() {
        let bytes: Vec<u8> = match half {
            true => level
                .texels
                .iter()
                .flat_map(|texel| half_from(f64::from(*texel)).to_le_bytes())
                .collect(),
            false => level.texels.iter().flat_map(|texel| texel.to_le_bytes()).collect(),
        };
        write_level(queue, &created, index as u32, level_size(level), &bytes);
    }
    created
}

/// Width, height and layers.
fn level_size(level: &FixtureTexture) -> [u32; 3] {
    [level.width, level.height, level.kind.layers()]
}

fn is_half(texel: f32) -> bool {
    half_to(half_from(f64::from(texel))) == f64::from(texel)
}

fn depth_texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &FixtureTexture,
) -> wgpu::Texture {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT;
    let format = wgpu::TextureFormat::Depth32Float;
    let created = create_texture(device, level_size(texture), 1, format, usage);
    let (layout, drawing) = pipeline::texture_pipeline(
        device,
        (DEPTH, "depth"),
        wgpu::TextureSampleType::Uint,
        None,
        Some(format),
    );
    for layer in 0..texture.kind.layers() {
        draw_layer(device, queue, texture, layer, &created, &layout, &drawing);
    }
    created
}

/// The bits of a layer's depths, as a texture of words.
fn staged_depths(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &FixtureTexture,
    layer: u32,
) -> wgpu::Texture {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let size = [texture.width, texture.height, 1];
    let staged = create_texture(device, size, 1, wgpu::TextureFormat::R32Uint, usage);
    let count = (texture.width * texture.height) as usize;
    let texels = texture.texels.iter().skip(layer as usize * count).take(count);
    let bytes: Vec<u8> = texels.flat_map(|value| value.to_le_bytes()).collect();
    write_level(queue, &staged, 0, size, &bytes);
    staged
}

fn draw_layer(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &FixtureTexture,
    layer: u32,
    target: &wgpu::Texture,
    layout: &wgpu::BindGroupLayout,
    drawing: &wgpu::RenderPipeline,
) {
    let stored = staged_depths(device, queue, texture, layer).create_view(&Default::default());
    let entry =
        wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&stored) };
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &[entry],
    });
    let view = target.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let attachment = wgpu::RenderPassDepthStencilAttachment {
        view: &view,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(0.0),
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(attachment),
        ..Default::default()
    });
    pass.set_pipeline(drawing);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    queue.submit([encoder.finish()]);
}

/// Bytes of a texel of a target.
pub const TEXEL: u32 = 16;

/// A new texture of this width, height and number of layers, without content.
pub fn create_texture(
    device: &wgpu::Device,
    [width, height, layers]: [u32; 3],
    levels: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Copies bytes into one level of a texture. The size is that of the level: width, height and
/// layers.
pub fn write_level(
    queue: &wgpu::Queue,
    target: &wgpu::Texture,
    level: u32,
    [width, height, layers]: [u32; 3],
    bytes: &[u8],
) {
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(bytes.len() as u32 / (height * layers).max(1)),
        rows_per_image: Some(height),
    };
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: layers };
    let place = wgpu::TexelCopyTextureInfo { mip_level: level, ..target.as_image_copy() };
    queue.write_texture(place, bytes, layout, size);
}

/// A target of a pass, cleared to the bits of [`SENTINEL`].
pub fn color_attachment(
    view: &wgpu::TextureView,
    format: ColorFormat,
) -> wgpu::RenderPassColorAttachment<'_> {
    let cleared = match format {
        ColorFormat::Float => f64::from(f32::from_bits(SENTINEL)),
        ColorFormat::Uint => f64::from(SENTINEL),
    };
    let load = wgpu::LoadOp::Clear(wgpu::Color { r: cleared, g: cleared, b: cleared, a: cleared });
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
    }
}

/// Bytes of a row in a buffer, with its padding.
pub fn padded_row(width: u32, texel: u32) -> u32 {
    (width * texel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

/// Copies a texture with texels of `texel` bytes to a buffer that can be read.
pub fn copy_to_buffer(
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    target: &wgpu::Texture,
    [width, height]: [u32; 2],
    texel: u32,
) -> wgpu::Buffer {
    let row = padded_row(width, texel);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    encoder.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        size,
    );
    buffer
}
