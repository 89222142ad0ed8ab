//! Textures of a device, and what is copied to and from them.

use crate::kernel::SENTINEL;
use crate::shipped::ColorFormat;

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
