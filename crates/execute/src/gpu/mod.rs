//! What the executors on GPUs share: runs kernels through wgpu, without a window.

mod compute;
mod draw;
mod fixtures;
mod heaps;
mod open;
mod opengl;
mod passthrough;
mod pipeline;

pub use super::emitted;
pub use open::{AdapterName, DeviceRequest, Shaders, open_gpu};
pub use opengl::{OpenGl, OpenGlApi};

use std::collections::HashMap;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::dispatch::{Dispatch, DispatchResult};
use super::frame::{Drawing, Frame};
use super::kernel::{ECHO, INPUT_WIDTH, Kernel, SENTINEL, TARGET_WIDTH};
use super::shipped::ColorFormat;
use super::written::{self, WrittenLanguage};
use super::{Session, ShippedPair, draws_none, executor_failed};
use fixtures::{TEXEL, color_attachment, copy_to_buffer, create_texture, write_level};
use heaps::HeapGroups;
use lamplight_bundle::{Stage, Target};
use lamplight_diagnostic::Diagnostic;
use lamplight_emit::Emitted;
use passthrough::SpirvBinary;
use pipeline::GroupLayouts;
use pipeline::PreparedKernel;

/// The longest wait for one draw: a hundred thousand times what one usually takes.
const PATIENCE: Duration = Duration::from_secs(60);
const TARGET_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;

/// An open device.
pub struct WgpuDevice {
    adapter: String,
    shaders: Shaders,
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// Errors that no error scope caught, and the loss of the device.
    faults: Arc<Mutex<Vec<String>>>,
    vertex: wgpu::ShaderModule,
    prepared: HashMap<u64, PreparedKernel>,
    /// Shipped stages as SPIR-V, by their bytes and the bind group of their heaps.
    binaries: Mutex<HashMap<(Vec<u8>, u32), SpirvBinary>>,
    heaps: HeapGroups,
    layouts: GroupLayouts,
}

impl Session for WgpuDevice {
    fn adapter(&self) -> String {
        self.adapter.clone()
    }

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        run_batches(kernel, inputs, |texels, rows| {
            self.prepare(kernel)?;
            let buffer = self.guarded(|gpu| gpu.submit(kernel, texels, rows))??;
            self.read(&buffer)
        })
    }

    fn dispatch(&mut self, dispatches: &[Dispatch<'_>]) -> Vec<DispatchResult> {
        dispatches.iter().map(|dispatch| self.compute(dispatch)).collect()
    }

    fn draw_frames(&self, drawing: &Drawing<'_>) -> Result<Vec<Frame>, Diagnostic> {
        match self.shaders {
            Shaders::Translated => self.frames(drawing),
            Shaders::Emitted(_) | Shaders::Written => Err(draws_none()),
        }
    }

    fn draw_shipped(
        &self,
        pair: ShippedPair<'_>,
        drawing: &Drawing<'_>,
    ) -> Result<Vec<Frame>, Diagnostic> {
        self.shipped_frames(pair, drawing)
    }
}

/// Runs as many draws as the inputs need. `draw` is given the words of the input texture and the
/// rows of the target, and returns the words of the target.
pub fn run_batches(
    kernel: &Kernel,
    inputs: &[u32],
    mut draw: impl FnMut(&[u32], u32) -> Result<Vec<u32>, Diagnostic>,
) -> Result<Vec<u32>, Diagnostic> {
    // The number of the draw, which the target echoes. So the results of another draw are
    // recognised.
    static RUN: AtomicU32 = AtomicU32::new(1);
    let mut run = |batch: &[u32], count: u32| {
        let (rows, header) = kernel.draw_header(count, RUN.fetch_add(1, Ordering::Relaxed));
        let pixels = draw(&input_texels(kernel, batch, header), rows)?;
        unpack_results(kernel, &pixels, header)
    };
    if kernel.input_words() == 0 {
        return run(&[], 1);
    }
    let stride = kernel.input_words() as usize;
    let mut results = Vec::new();
    for batch in inputs.chunks(kernel.batch() as usize * stride) {
        results.extend(run(batch, (batch.len() / stride) as u32)?);
    }
    Ok(results)
}

impl WgpuDevice {
    fn prepare(&mut self, kernel: &Kernel) -> Result<(), Diagnostic> {
        if !self.prepared.contains_key(&kernel.code) {
            let emitted = match self.shaders {
                Shaders::Translated => None,
                Shaders::Emitted(target) => {
                    let Emitted { bytes, native } = emitted::emit_kernel(kernel, target)?;
                    let heaps = pipeline::HEAPS;
                    let binary = SpirvBinary::new(target, Stage::Fragment, &bytes, &native, heaps);
                    Some(binary.map_err(executor_failed)?)
                }
                Shaders::Written => {
                    let (text, native) = written::fragment_text(kernel, WrittenLanguage::Hlsl)?;
                    let (stage, heaps) = (Stage::Fragment, pipeline::HEAPS);
                    let binary =
                        SpirvBinary::new(Target::HLSL, stage, text.as_bytes(), &native, heaps);
                    Some(binary.map_err(executor_failed)?)
                }
            };
            let prepared =
                self.guarded(|gpu| PreparedKernel::new(gpu, kernel, emitted.as_ref()))?;
            self.prepared.insert(kernel.code, prepared.map_err(executor_failed)?);
        }
        Ok(())
    }

    fn submit(
        &self,
        kernel: &Kernel,
        texels: &[u32],
        rows: u32,
    ) -> Result<wgpu::Buffer, Diagnostic> {
        let prepared = self
            .prepared
            .get(&kernel.code)
            .ok_or_else(|| executor_failed("the kernel was not prepared"))?;
        let inputs = self.inputs(texels);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let size = [TARGET_WIDTH, rows, 1];
        let target = create_texture(&self.device, size, 1, TARGET_FORMAT, usage);
        let group = prepared.bind(&self.device, &inputs.create_view(&Default::default()));
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let view = target.create_view(&Default::default());
        let attachment = color_attachment(&view, ColorFormat::Uint);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment)],
            ..Default::default()
        });
        pass.set_pipeline(&prepared.pipeline);
        pass.set_bind_group(0, &group, &[]);
        if let Some(heaps) = &prepared.heaps {
            pass.set_bind_group(pipeline::HEAPS, heaps, &[]);
        }
        pass.draw(0..3, 0..1);
        drop(pass);
        let buffer =
            copy_to_buffer(&self.device, &mut encoder, &target, [TARGET_WIDTH, rows], TEXEL);
        self.queue.submit([encoder.finish()]);
        Ok(buffer)
    }

    fn inputs(&self, texels: &[u32]) -> wgpu::Texture {
        let rows = (texels.len() as u32 / 4).div_ceil(INPUT_WIDTH);
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let size = [INPUT_WIDTH, rows, 1];
        let texture = create_texture(&self.device, size, 1, TARGET_FORMAT, usage);
        let bytes: Vec<u8> = texels.iter().flat_map(|word| word.to_le_bytes()).collect();
        write_level(&self.queue, &texture, 0, size, &bytes);
        texture
    }

    fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u32>, Diagnostic> {
        let word = |bytes: &[u8; 4]| u32::from_le_bytes(*bytes);
        self.mapped(buffer, |bytes| bytes.as_chunks::<4>().0.iter().map(word).collect())
    }

    /// Waits until the device has written a buffer, and calls a function with its bytes.
    fn mapped<T>(
        &self,
        buffer: &wgpu::Buffer,
        run: impl FnOnce(&[u8]) -> T,
    ) -> Result<T, Diagnostic> {
        let outcome = Arc::new(Mutex::new(None));
        let sender = Arc::clone(&outcome);
        buffer
            .map_async(wgpu::MapMode::Read, .., move |result| *lock_mutex(&sender) = Some(result));
        let waited = self
            .device
            .poll(wgpu::PollType::Wait { submission_index: None, timeout: Some(PATIENCE) });
        waited.map_err(|error| {
            executor_failed(format!("no answer within {} s: {error}", PATIENCE.as_secs()))
        })?;
        self.check_faults()?;
        match lock_mutex(&outcome).take() {
            Some(Ok(())) => {}
            Some(Err(error)) => return Err(executor_failed(error.to_string())),
            None => return Err(executor_failed("the result was never handed over")),
        }
        let view =
            buffer.get_mapped_range(..).map_err(|error| executor_failed(format!("{error:?}")))?;
        let found = run(&view);
        drop(view);
        buffer.unmap();
        Ok(found)
    }

    /// Runs calls of wgpu with every error caught, panics below wgpu included.
    fn guarded<T>(&self, calls: impl FnOnce(&Self) -> T) -> Result<T, Diagnostic> {
        let filters = [
            wgpu::ErrorFilter::Validation,
            wgpu::ErrorFilter::Internal,
            wgpu::ErrorFilter::OutOfMemory,
        ];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| calls(self)));
        let caught: Vec<_> =
            scopes.into_iter().rev().filter_map(|scope| pollster::block_on(scope.pop())).collect();
        let value = outcome.map_err(|_| executor_failed("wgpu or naga panicked"))?;
        match caught.first() {
            Some(error) => Err(executor_failed(error.to_string())),
            None => self.check_faults().map(|()| value),
        }
    }

    fn check_faults(&self) -> Result<(), Diagnostic> {
        match lock_mutex(&self.faults).first() {
            Some(fault) => Err(executor_failed(fault.clone())),
            None => Ok(()),
        }
    }
}

/// The words of the input texture, in whole rows, with the header first.
fn input_texels(kernel: &Kernel, inputs: &[u32], header: [u32; 4]) -> Vec<u32> {
    let stride = kernel.input_words().max(1) as usize;
    let padding = (kernel.input_texels() * 4 - kernel.input_words()) as usize;
    let mut texels = header.to_vec();
    if kernel.input_words() > 0 {
        for invocation in inputs.chunks(stride) {
            texels.extend_from_slice(invocation);
            texels.extend(std::iter::repeat_n(0, padding));
        }
    }
    let row = INPUT_WIDTH as usize * 4;
    texels.resize(texels.len().next_multiple_of(row), 0);
    texels
}

/// The result words, once the echo and the padding show that the target was written as intended.
fn unpack_results(
    kernel: &Kernel,
    pixels: &[u32],
    header: [u32; 4],
) -> Result<Vec<u32>, Diagnostic> {
    let pixel = |index: usize| &pixels[index * 4..index * 4 + 4];
    let last = header[1] as usize - 1;
    for index in [0, last] {
        if pixel(index) != [header[0], header[1], header[2], ECHO ^ index as u32] {
            let found = pixel(index);
            return Err(executor_failed(format!(
                "pixel {index} of {last} echoes {found:08x?}: the target was not written as laid out"
            )));
        }
    }
    let texels = kernel.result_texels() as usize;
    let end = 1 + header[0] as usize * texels;
    if (1..end).any(|index| pixel(index) == [SENTINEL; 4]) {
        return Err(executor_failed("a pixel was never written"));
    }
    if (end..last).any(|index| pixel(index) != pixel(end - texels + (index - end) % texels)) {
        return Err(executor_failed("the padding does not repeat the last invocation"));
    }
    let words = kernel.result_words() as usize;
    Ok((0..header[0] as usize)
        .flat_map(|index| pixels[(1 + index * texels) * 4..].iter().take(words).copied())
        .collect())
}

fn lock_mutex<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
