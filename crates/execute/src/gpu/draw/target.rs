//! The attachments of a frame, and how they are read back.

use super::super::textures::{TEXEL, color_attachment, copy_to_buffer, create_texture, padded_row};
use super::super::{TARGET_FORMAT, WgpuDevice, pipeline};
use crate::frame::{Drawing, Frame};
use crate::shipped::ColorFormat;
use lamplight_diagnostic::Diagnostic;

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
pub fn texture_format(of: ColorFormat) -> wgpu::TextureFormat {
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
