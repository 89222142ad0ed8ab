//! Runs emitted GLSL unchanged, directly on OpenGL and OpenGL ES.
//!
//! Why not through wgpu? Its GL backend accepts a shader's text unchanged. But it learns only from
//! its own translation which sampler belongs to which texture, so shadow lookups would not work. It
//! also opens only one kind of context.

mod context;
mod frame;
mod program;
mod texture;

pub use context::OpenGlApi;

use std::collections::HashMap;

use glow::HasContext as _;

use super::{emitted, executor_failed};
use crate::fixture::Fixture;
use crate::frame::{Drawing, Frame};
use crate::kernel::{INPUT_WIDTH, Kernel, SENTINEL, TARGET_WIDTH};
use crate::{Session, ShippedPair};
use context::OpenGlContext;
use lamplight_bundle::{Combined, Target};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_emit::Emitted;

/// Group and binding of a kernel's input texture.
const INPUTS: [u32; 2] = [0, 0];

/// A context that runs the texts of one target.
pub struct OpenGl {
    context: OpenGlContext,
    target: Target,
    kept: HashMap<u64, OpenGlKernel>,
}

/// What is kept for a kernel: the program, the unit of its inputs, and the fixtures on their units.
struct OpenGlKernel {
    program: glow::Program,
    inputs: u32,
    units: Vec<TextureUnit>,
}

/// A texture unit, and what is bound to it.
struct TextureUnit {
    index: u32,
    target: u32,
    texture: glow::Texture,
    sampler: Option<glow::Sampler>,
}

impl OpenGl {
    /// Opens a context for the texts of a target. The error is a message.
    pub fn open(api: OpenGlApi, target: Target) -> Result<Self, String> {
        Ok(Self { context: OpenGlContext::open(api)?, target, kept: HashMap::new() })
    }

    fn has_extensions(&self, text: &[u8]) -> Result<(), Diagnostic> {
        let missing = self.context.with(|gl| Ok(program::missing_extension(gl, text)));
        match missing.map_err(executor_failed)? {
            None => Ok(()),
            Some(name) => {
                let message = format!("the driver has no {name}, which the emitted text requires");
                Err(Diagnostic::error(codes::EXECUTOR_LACKS, message))
            }
        }
    }

    fn prepare(&mut self, kernel: &Kernel) -> Result<(), Diagnostic> {
        if !self.kept.contains_key(&kernel.code) {
            let emitted = emitted::emit_kernel(kernel, self.target)?;
            self.has_extensions(&emitted.bytes)?;
            let vertex = program::triangle_stage(self.context.api());
            let kept = self.context.with(|gl| keep_kernel(gl, kernel, &vertex, &emitted));
            self.kept.insert(kernel.code, kept.map_err(executor_failed)?);
        }
        Ok(())
    }

    fn draw(&mut self, kernel: &Kernel, texels: &[u32], rows: u32) -> Result<Vec<u32>, Diagnostic> {
        self.prepare(kernel)?;
        let kept = self
            .kept
            .get(&kernel.code)
            .ok_or_else(|| executor_failed("the kernel was not prepared"))?;
        let api = self.context.api();
        self.context.with(|gl| draw_kernel(gl, api, kept, texels, rows)).map_err(executor_failed)
    }
}

impl Session for OpenGl {
    fn adapter(&self) -> String {
        self.context.adapter()
    }

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        super::run_batches(kernel, inputs, |texels, rows| self.draw(kernel, texels, rows))
    }

    fn draw_shipped(
        &self,
        pair: ShippedPair<'_>,
        drawing: &Drawing<'_>,
    ) -> Result<Vec<Frame>, Diagnostic> {
        for stage in [pair.vertex, pair.fragment] {
            if stage.target != self.target {
                return Err(executor_failed(format!("this executor draws no {}", stage.target)));
            }
            self.has_extensions(&stage.bytes)?;
        }
        let api = self.context.api();
        self.context.with(|gl| frame::draw_frames(gl, api, pair, drawing)).map_err(executor_failed)
    }
}

fn keep_kernel(
    gl: &glow::Context,
    kernel: &Kernel,
    vertex: &str,
    emitted: &Emitted,
) -> Result<OpenGlKernel, String> {
    let text = str::from_utf8(&emitted.bytes).map_err(|error| error.to_string())?;
    let program = program::link_program(gl, vertex, text)?;
    let (mut inputs, mut units) = (0, Vec::new());
    for (order, combined) in emitted.native.combined.iter().enumerate() {
        let index = texture_unit(gl, program, emitted, combined, order as u32);
        if combined.texture == INPUTS {
            inputs = index;
            continue;
        }
        let Some(Fixture::Texture(fixture)) = kernel.fixture_at(combined.texture[1]) else {
            return Err(format!("`{}` has no fixture", combined.name));
        };
        let settings = combined.sampler.and_then(|place| kernel.fixture_at(place[1])?.sampler());
        let sampler = settings.map(|settings| texture::create_sampler(gl, settings)).transpose()?;
        let (target, texture) = texture::upload_fixture(gl, fixture)?;
        units.push(TextureUnit { index, target, texture, sampler });
    }
    program::check_error(gl)?;
    Ok(OpenGlKernel { program, inputs, units })
}

/// The unit that the text declares. Where the language has no such declaration, the next free one
/// is assigned by name.
fn texture_unit(
    gl: &glow::Context,
    program: glow::Program,
    emitted: &Emitted,
    combined: &Combined,
    order: u32,
) -> u32 {
    let slot =
        emitted.native.slots.iter().find(|slot| [slot.group, slot.binding] == combined.texture);
    slot.and_then(|slot| slot.index).unwrap_or_else(|| {
        program::set_unit(gl, program, &combined.name, order);
        order
    })
}

fn draw_kernel(
    gl: &glow::Context,
    api: OpenGlApi,
    kept: &OpenGlKernel,
    texels: &[u32],
    rows: u32,
) -> Result<Vec<u32>, String> {
    let bytes: Vec<u8> = texels.iter().flat_map(|word| word.to_ne_bytes()).collect();
    let mut pixels = vec![0u8; (rows * TARGET_WIDTH) as usize * 16];
    let (width, height) = (TARGET_WIDTH as i32, rows as i32);
    // SAFETY: the context is current, every name is of it, and `pixels` holds the whole target.
    unsafe {
        let target = texture::words_texture(gl, [TARGET_WIDTH, rows], None)?;
        let height_of_inputs = texels.len() as u32 / 4 / INPUT_WIDTH;
        let inputs = texture::words_texture(gl, [INPUT_WIDTH, height_of_inputs], Some(&bytes))?;
        let (frame, array) = (gl.create_framebuffer()?, gl.create_vertex_array()?);
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(frame));
        gl.framebuffer_texture_2d(
            glow::FRAMEBUFFER,
            glow::COLOR_ATTACHMENT0,
            glow::TEXTURE_2D,
            Some(target),
            0,
        );
        gl.draw_buffers(&[glow::COLOR_ATTACHMENT0]);
        gl.read_buffer(glow::COLOR_ATTACHMENT0);
        plain_state(gl, api);
        gl.viewport(0, 0, width, height);
        gl.clear_buffer_u32_slice(glow::COLOR, 0, &[SENTINEL; 4]);
        bind_inputs(gl, kept, inputs);
        gl.bind_vertex_array(Some(array));
        gl.use_program(Some(kept.program));
        gl.draw_arrays(glow::TRIANGLES, 0, 3);
        let target_bytes = glow::PixelPackData::Slice(Some(&mut pixels));
        gl.read_pixels(0, 0, width, height, glow::RGBA_INTEGER, glow::UNSIGNED_INT, target_bytes);
        gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        gl.delete_framebuffer(frame);
        gl.delete_vertex_array(array);
        gl.delete_texture(target);
        gl.delete_texture(inputs);
    }
    program::check_error(gl)?;
    Ok(pixels.as_chunks::<4>().0.iter().map(|bytes| u32::from_ne_bytes(*bytes)).collect())
}

/// Sets the state: every fragment is written, and cubes are filtered across their edges, as WebGPU
/// demands. OpenGL does that only if it is enabled; OpenGL ES 3 always does.
fn plain_state(gl: &glow::Context, api: OpenGlApi) {
    let off =
        [glow::SCISSOR_TEST, glow::DEPTH_TEST, glow::STENCIL_TEST, glow::CULL_FACE, glow::BLEND];
    // SAFETY: the context is current.
    unsafe {
        off.iter().for_each(|state| gl.disable(*state));
        gl.color_mask(true, true, true, true);
        if matches!(api, OpenGlApi::Core(..)) {
            gl.enable(glow::TEXTURE_CUBE_MAP_SEAMLESS);
        }
    }
}

/// Binds the inputs and the fixtures to their units.
fn bind_inputs(gl: &glow::Context, kept: &OpenGlKernel, inputs: glow::Texture) {
    // SAFETY: the context is current and every name is of it.
    unsafe {
        gl.active_texture(glow::TEXTURE0 + kept.inputs);
        gl.bind_texture(glow::TEXTURE_2D, Some(inputs));
        gl.bind_sampler(kept.inputs, None);
        for unit in &kept.units {
            gl.active_texture(glow::TEXTURE0 + unit.index);
            gl.bind_texture(unit.target, Some(unit.texture));
            gl.bind_sampler(unit.index, unit.sampler);
        }
    }
}
