//! Draws frames while a bundle is rebuilt, and swaps its pipeline when a shader of the pipeline has
//! changed. The example opens no window. It prints the colour that it drew whenever the colour
//! changes.
//!
//! The shaders are those of the guide's page "Hot reload":
//!
//! ```text
//! lamplight watch --out live.lamplight &
//! cargo run --example hot_reload -- live.lamplight
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, SystemTime};

use lamplight::bundle::{Bundle, Target};

type Outcome<T> = Result<T, Box<dyn Error>>;

/// The program, the entry point and the key of the permutation that is drawn.
const PROGRAM: &str = "surface";
const ENTRY: &str = "fs_main";
const KEY: &str = "shadowed";

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const FRAME: Duration = Duration::from_millis(16);

/// The vertex shader, which is the engine's own: a triangle over the whole picture, fully lit.
const VERTEX: &str = "
struct Corner { @builtin(position) position: vec4f, @location(0) light: f32 }

@vertex
fn vs_main(@builtin(vertex_index) index: u32) -> Corner {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return Corner(vec4f(corner, 0.0, 1.0), 1.0);
}";

pub fn main() -> Outcome<()> {
    let path = std::env::args().nth(1).ok_or("usage: hot_reload BUNDLE [SWAPS]")?;
    let swaps = std::env::args().nth(2).map_or(Ok(1), |text| text.parse())?;
    draw(Path::new(&path), swaps, &mut |line| println!("{line}"))
}

/// Draws frames until the pipeline was swapped `swaps` times. Each event is reported to `report`.
pub fn draw(path: &Path, swaps: usize, report: &mut dyn FnMut(String)) -> Outcome<()> {
    let gpu = Gpu::open()?;
    // The time of the file is read before its contents. A change between the two is then noticed
    // after the next frame.
    let mut written = modified(path)?;
    let mut bundle = Bundle::open(path)?;
    let mut pipeline = gpu.pipeline(&bundle)?;
    let (mut shown, mut swapped) = (None, 0);
    for frame in 0u64.. {
        let color = gpu.frame(&pipeline)?;
        if shown.replace(color) != Some(color) {
            report(format!("frame {frame}: {color:?}"));
        }
        if swapped == swaps {
            break;
        }
        thread::sleep(FRAME);
        let now = modified(path)?;
        if std::mem::replace(&mut written, now) == now || !is_changed(&mut bundle, report) {
            continue;
        }
        match gpu.pipeline(&bundle) {
            Ok(next) => (pipeline, swapped) = (next, swapped + 1),
            Err(error) => report(format!("the older pipeline stays: {error}")),
        }
    }
    Ok(())
}

fn modified(path: &Path) -> std::io::Result<SystemTime> {
    std::fs::metadata(path)?.modified()
}

/// Reads the bundle again. Returns whether the permutation that is drawn has changed.
fn is_changed(bundle: &mut Bundle, report: &mut dyn FnMut(String)) -> bool {
    let difference = match bundle.reload() {
        Ok(difference) => difference,
        Err(error) => {
            report(format!("the older bundle stays: {error}"));
            return false;
        }
    };
    for change in &difference.permutations {
        let (entry, key, kind) = (&change.entry, &change.key, change.kind);
        report(format!("{} {entry} {key}: {kind} {}", change.program, change.parts.join(", ")));
    }
    difference.permutations.iter().any(|change| {
        (&*change.program, &*change.entry, &*change.key) == (PROGRAM, ENTRY, KEY)
            && change.kind != "removed"
    })
}

struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// The picture that is drawn into, of one pixel.
    picture: wgpu::Texture,
}

impl Gpu {
    /// Opens a device, on a software adapter if there is one.
    fn open() -> Outcome<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
        adapters.sort_by_key(|adapter| adapter.get_info().device_type != wgpu::DeviceType::Cpu);
        let adapter = adapters.first().ok_or("no adapter: install mesa-vulkan-drivers")?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        let picture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        Ok(Self { device, queue, picture })
    }

    /// The pipeline of the permutation that is drawn. If the driver refuses the shader, this is an
    /// error, and the caller goes on with the pipeline that it had.
    fn pipeline(&self, bundle: &Bundle) -> Outcome<wgpu::RenderPipeline> {
        let found = bundle.program(PROGRAM)?.shader(ENTRY)?.get(KEY, Target::WGSL)?;
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = |text: &str| {
            let source = wgpu::ShaderSource::Wgsl(text.to_owned().into());
            self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
        };
        let pipeline = self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(KEY),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module(VERTEX),
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module(std::str::from_utf8(&found.bytes)?),
                entry_point: Some(&found.native.entry_name),
                compilation_options: Default::default(),
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        match pollster::block_on(scope.pop()) {
            None => Ok(pipeline),
            Some(error) => Err(error.into()),
        }
    }

    /// Draws a frame and returns its colour.
    fn frame(&self, pipeline: &wgpu::RenderPipeline) -> Outcome<[u8; 4]> {
        let view = self.picture.create_view(&Default::default());
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let attachment = wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations::default(),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment)],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.draw(0..3, 0..1);
        drop(pass);
        self.read(encoder)
    }

    fn read(&self, mut encoder: wgpu::CommandEncoder) -> Outcome<[u8; 4]> {
        let staging = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 4,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            self.picture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &staging, layout: Default::default() },
            self.picture.size(),
        );
        self.queue.submit([encoder.finish()]);
        let (sender, receiver) = mpsc::channel();
        staging.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        receiver.recv()??;
        let view = staging.get_mapped_range(..)?;
        Ok(<[u8; 4]>::try_from(&view[..])?)
    }
}
