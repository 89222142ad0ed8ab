//! The attachments of a frame, and how they are read back.

use super::super::{Gpu, TARGET_FORMAT, pipeline};
use crate::diagnostic::Diagnostic;
use crate::execute::frame::{Drawing, Frame};
use crate::execute::kernel::SENTINEL;
use crate::execute::shipped::Format;

pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

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
    color: Vec<(wgpu::Texture, Format)>,
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
    pub fn new(device: &wgpu::Device, drawing: &Drawing<'_>, formats: &[Format]) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let depth_usage =
            wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let size = drawing.size;
        Self {
            size,
            color: formats
                .iter()
                .map(|one| (create_target(device, size, texture_format(*one), usage), *one))
                .collect(),
            depth: drawing
                .state
                .depth_test
                .then(|| create_target(device, size, DEPTH_FORMAT, depth_usage)),
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

    /// Copies everything to where it can be read.
    pub fn download(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder) -> Pending {
        let color = self
            .color
            .iter()
            .map(|(target, _)| copy_to_buffer(gpu, encoder, target, self.size, TEXEL))
            .collect();
        let kept = self.depth.as_ref().filter(|_| self.keep_depth);
        let depth = kept.map(|depth| {
            let target = as_words(gpu, encoder, depth, self.size);
            copy_to_buffer(gpu, encoder, &target, self.size, DEPTH_TEXEL)
        });
        Pending { size: self.size, color, depth }
    }
}

impl Pending {
    pub fn read(&self, gpu: &Gpu, detour: Option<&'static str>) -> Result<Frame, Diagnostic> {
        let color = |buffer: &wgpu::Buffer| {
            gpu.mapped(buffer, |bytes| self.texels(bytes, TEXEL, u32::from_le_bytes))
        };
        let targets = self.color.iter().map(color).collect::<Result<_, _>>()?;
        let depth = self.depth.as_ref().map(|buffer| {
            gpu.mapped(buffer, |bytes| self.texels(bytes, DEPTH_TEXEL, f32::from_le_bytes))
        });
        Ok(Frame { targets, depth: depth.transpose()?.unwrap_or_default(), detour })
    }

    /// What is in the rows of a buffer, without their padding. Large maps are read once, into
    /// memory that has their size.
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
pub fn texture_format(of: Format) -> wgpu::TextureFormat {
    match of {
        Format::Float => wgpu::TextureFormat::Rgba32Float,
        Format::Uint => TARGET_FORMAT,
    }
}

fn color_attachment(
    view: &wgpu::TextureView,
    format: Format,
) -> wgpu::RenderPassColorAttachment<'_> {
    let cleared = match format {
        Format::Float => f64::from(f32::from_bits(SENTINEL)),
        Format::Uint => f64::from(SENTINEL),
    };
    let load = wgpu::LoadOp::Clear(wgpu::Color { r: cleared, g: cleared, b: cleared, a: cleared });
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
    }
}

/// Bytes of a texel of a target, and of the depths that are read.
const TEXEL: u32 = 16;
const DEPTH_TEXEL: u32 = 4;

/// Bytes of a row in a buffer, with its padding.
fn padded_row(width: u32, texel: u32) -> u32 {
    (width * texel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

fn copy_to_buffer(
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    target: &wgpu::Texture,
    [width, height]: [u32; 2],
    texel: u32,
) -> wgpu::Buffer {
    let row = padded_row(width, texel);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
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

/// A pipeline that reads the bits of a depth texture, and the layout of its bindings.
fn depth_reader(device: &wgpu::Device) -> (wgpu::BindGroupLayout, wgpu::RenderPipeline) {
    let taken = wgpu::TextureSampleType::Float { filterable: false };
    pipeline::texture_pipeline(device, (DEPTH, "read"), taken, Some(READ_FORMAT), None)
}

/// Draws the bits of a depth texture into a target of words.
fn as_words(
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    depth: &wgpu::Texture,
    size: [u32; 2],
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
    let target = create_target(
        device,
        size,
        READ_FORMAT,
        wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
    );
    let view = target.create_view(&Default::default());
    let attachments = [Some(color_attachment(&view, Format::Uint))];
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

fn create_target(
    device: &wgpu::Device,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
