//! Emitted GLSL on OpenGL itself, in the context that wgpu opens.
//!
//! Why not through wgpu: its GL backend takes a shader's text as it is, but learns which sampler
//! belongs to which texture only from its own translation, so that shadow lookups cannot work.

use std::collections::HashMap;

use glow::HasContext as _;

use super::{Gpu, emitted, failed, input_texels, unpack};
use crate::bundle::Target;
use crate::diagnostic::Diagnostic;
use crate::emit::Emitted;
use crate::harness::Session;
use crate::harness::fixture::{Address, Compare, Fixture, Sampler, Texture};
use crate::harness::kernel::{INPUT_WIDTH, Kernel, SENTINEL, TARGET_WIDTH};

/// The full-screen triangle.
const VERTEX: &str = "#version 450 core
void main() {
    vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
";

/// Bindings of a group in the emitted text.
const BINDINGS: u32 = 16;

/// A GL device that runs texts.
pub struct Direct {
    gpu: Gpu,
    kept: HashMap<u64, Kept>,
    runs: u32,
}

/// What a kernel keeps: the program, and the texture and sampler of each unit.
struct Kept {
    program: glow::Program,
    units: Vec<Unit>,
}

/// A texture unit: its number, target, texture and sampler.
type Unit = (u32, u32, glow::Texture, Option<glow::Sampler>);

impl Direct {
    /// On the device of a GL adapter.
    pub fn new(gpu: Gpu) -> Self {
        Self { gpu, kept: HashMap::new(), runs: 0 }
    }

    /// Runs calls with the context current.
    fn with<T>(&self, calls: impl FnOnce(&glow::Context) -> Result<T, String>) -> Result<T, Diagnostic> {
        // SAFETY: the device is used by this session alone, and not destroyed by it.
        let device = unsafe { self.gpu.device.as_hal::<wgpu::hal::api::Gles>() };
        let device = device.ok_or_else(|| failed("the device is not one of OpenGL"))?;
        let context = device.context().lock();
        calls(&context).map_err(failed)
    }

    fn prepare(&mut self, kernel: &Kernel) -> Result<(), Diagnostic> {
        if !self.kept.contains_key(&kernel.id) {
            let emitted = emitted::emit(kernel, Target::GLSL450)?;
            let kept = self.with(|gl| keep(gl, kernel, &emitted))?;
            self.kept.insert(kernel.id, kept);
        }
        Ok(())
    }

    fn draw(&mut self, kernel: &Kernel, inputs: &[u32], count: u32) -> Result<Vec<u32>, Diagnostic> {
        self.runs = self.runs.wrapping_add(1);
        let rows = (count * kernel.result_texels() + 2).div_ceil(TARGET_WIDTH);
        let header = [count, rows * TARGET_WIDTH, self.runs, 0];
        self.prepare(kernel)?;
        let kept = self.kept.get(&kernel.id).ok_or_else(|| failed("the kernel was not prepared"))?;
        let pixels = self.with(|gl| draw(gl, kept, &input_texels(kernel, inputs, header), rows))?;
        unpack(kernel, &pixels, header)
    }
}

impl Session for Direct {
    fn adapter(&self) -> String {
        self.gpu.adapter.clone()
    }

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        super::batched(kernel, inputs, |batch, count| self.draw(kernel, batch, count))
    }
}

fn keep(gl: &glow::Context, kernel: &Kernel, emitted: &Emitted) -> Result<Kept, String> {
    let text = str::from_utf8(&emitted.bytes).map_err(|error| error.to_string())?;
    let program = program(gl, text)?;
    let mut units = Vec::new();
    for resource in kernel.resources() {
        let Fixture::Texture(texture) = &*resource.fixture else { continue };
        let combined = emitted.native.combined.iter().find(|combined| combined.texture == [0, resource.binding]);
        let place = combined.and_then(|combined| combined.sampler);
        let sampler = place.and_then(|place| kernel.resources().find(|other| other.binding == place[1]));
        let sampler = match sampler.map(|resource| &*resource.fixture) {
            Some(Fixture::Sampler(settings)) => Some(sampler_of(gl, *settings)?),
            _ => None,
        };
        let (target, made) = texture_of(gl, texture)?;
        units.push((resource.binding % BINDINGS, target, made, sampler));
    }
    Ok(Kept { program, units })
}

fn program(gl: &glow::Context, fragment: &str) -> Result<glow::Program, String> {
    // SAFETY: the context is current; every name is of this context.
    unsafe {
        let program = gl.create_program()?;
        for (stage, text) in [(glow::VERTEX_SHADER, VERTEX), (glow::FRAGMENT_SHADER, fragment)] {
            let shader = gl.create_shader(stage)?;
            gl.shader_source(shader, text);
            gl.compile_shader(shader);
            if !gl.get_shader_compile_status(shader) {
                return Err(format!("the driver rejects the emitted text: {}", gl.get_shader_info_log(shader)));
            }
            gl.attach_shader(program, shader);
            gl.delete_shader(shader);
        }
        gl.link_program(program);
        if gl.get_program_link_status(program) { Ok(program) } else { Err(gl.get_program_info_log(program)) }
    }
}

/// The fixture as a texture, with its target.
fn texture_of(gl: &glow::Context, texture: &Texture) -> Result<(u32, glow::Texture), String> {
    let (internal, format) =
        if texture.kind.is_depth() { (glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT) } else { (glow::RGBA32F, glow::RGBA) };
    let cube = texture.kind.layers() == 6;
    let target = if cube { glow::TEXTURE_CUBE_MAP } else { glow::TEXTURE_2D };
    let layer = texture.texels.len() / texture.kind.layers() as usize;
    let bytes: Vec<u8> = texture.texels.iter().flat_map(|value| value.to_ne_bytes()).collect();
    // SAFETY: as above; each slice has the texels of one layer, four bytes a component.
    unsafe {
        let made = gl.create_texture()?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(target, Some(made));
        for (face, texels) in bytes.chunks(layer * 4).enumerate() {
            let target = if cube { glow::TEXTURE_CUBE_MAP_POSITIVE_X + face as u32 } else { target };
            let size = (texture.width as i32, texture.height as i32);
            let pixels = glow::PixelUnpackData::Slice(Some(texels));
            gl.tex_image_2d(target, 0, internal as i32, size.0, size.1, 0, format, glow::FLOAT, pixels);
        }
        nearest(gl, target);
        Ok((target, made))
    }
}

/// What a texture needs to be complete with one level, where no sampler says otherwise.
unsafe fn nearest(gl: &glow::Context, target: u32) {
    // SAFETY: a texture is bound to the target.
    unsafe {
        gl.tex_parameter_i32(target, glow::TEXTURE_MIN_FILTER, glow::NEAREST as i32);
        gl.tex_parameter_i32(target, glow::TEXTURE_MAG_FILTER, glow::NEAREST as i32);
        gl.tex_parameter_i32(target, glow::TEXTURE_MAX_LEVEL, 0);
    }
}

fn sampler_of(gl: &glow::Context, settings: Sampler) -> Result<glow::Sampler, String> {
    let filter = if settings.linear { glow::LINEAR } else { glow::NEAREST };
    let wrap = match settings.address {
        Address::Clamp => glow::CLAMP_TO_EDGE,
        Address::Repeat => glow::REPEAT,
        Address::Mirror => glow::MIRRORED_REPEAT,
    };
    let compare = settings.compare.map(|compare| match compare {
        Compare::Less => glow::LESS,
        Compare::LessEqual => glow::LEQUAL,
        Compare::Greater => glow::GREATER,
        Compare::GreaterEqual => glow::GEQUAL,
    });
    // SAFETY: as above.
    unsafe {
        let sampler = gl.create_sampler()?;
        let set = |name: u32, value: u32| gl.sampler_parameter_i32(sampler, name, value as i32);
        set(glow::TEXTURE_MIN_FILTER, filter);
        set(glow::TEXTURE_MAG_FILTER, filter);
        for axis in [glow::TEXTURE_WRAP_S, glow::TEXTURE_WRAP_T, glow::TEXTURE_WRAP_R] {
            set(axis, wrap);
        }
        if let Some(compare) = compare {
            set(glow::TEXTURE_COMPARE_MODE, glow::COMPARE_REF_TO_TEXTURE);
            set(glow::TEXTURE_COMPARE_FUNC, compare);
        }
        Ok(sampler)
    }
}

/// A texture of words, bound to unit 0.
unsafe fn words(gl: &glow::Context, width: u32, height: u32, texels: Option<&[u8]>) -> Result<glow::Texture, String> {
    // SAFETY: the context is current, and the slice has 16 bytes a texel.
    unsafe {
        let made = gl.create_texture()?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_2D, Some(made));
        let (format, pixels) = (glow::RGBA_INTEGER, glow::PixelUnpackData::Slice(texels));
        let internal = glow::RGBA32UI as i32;
        gl.tex_image_2d(glow::TEXTURE_2D, 0, internal, width as i32, height as i32, 0, format, glow::UNSIGNED_INT, pixels);
        nearest(gl, glow::TEXTURE_2D);
        Ok(made)
    }
}

fn draw(gl: &glow::Context, kept: &Kept, texels: &[u32], rows: u32) -> Result<Vec<u32>, String> {
    let bytes: Vec<u8> = texels.iter().flat_map(|word| word.to_ne_bytes()).collect();
    let mut pixels = vec![0u8; (rows * TARGET_WIDTH) as usize * 16];
    let (width, height) = (TARGET_WIDTH as i32, rows as i32);
    // SAFETY: the context is current, every name is of it, and `pixels` holds the whole target.
    unsafe {
        let target = words(gl, TARGET_WIDTH, rows, None)?;
        let inputs = words(gl, INPUT_WIDTH, texels.len() as u32 / 4 / INPUT_WIDTH, Some(&bytes))?;
        let (frame, array) = (gl.create_framebuffer()?, gl.create_vertex_array()?);
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(frame));
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, glow::TEXTURE_2D, Some(target), 0);
        gl.draw_buffers(&[glow::COLOR_ATTACHMENT0]);
        gl.read_buffer(glow::COLOR_ATTACHMENT0);
        gl.viewport(0, 0, width, height);
        for state in [glow::SCISSOR_TEST, glow::DEPTH_TEST, glow::STENCIL_TEST, glow::CULL_FACE, glow::BLEND] {
            gl.disable(state);
        }
        gl.color_mask(true, true, true, true);
        gl.enable(glow::TEXTURE_CUBE_MAP_SEAMLESS);
        gl.clear_buffer_u32_slice(glow::COLOR, 0, &[SENTINEL; 4]);
        bind(gl, kept, inputs);
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
        match gl.get_error() {
            glow::NO_ERROR => {}
            error => return Err(format!("OpenGL reports error 0x{error:04x}")),
        }
    }
    Ok(pixels.as_chunks::<4>().0.iter().map(|bytes| u32::from_ne_bytes(*bytes)).collect())
}

/// Puts the inputs on unit 0 and the fixtures on theirs.
unsafe fn bind(gl: &glow::Context, kept: &Kept, inputs: glow::Texture) {
    // SAFETY: the context is current and every name is of it.
    unsafe {
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_2D, Some(inputs));
        gl.bind_sampler(0, None);
        for (unit, target, texture, sampler) in &kept.units {
            gl.active_texture(glow::TEXTURE0 + unit);
            gl.bind_texture(*target, Some(*texture));
            gl.bind_sampler(*unit, *sampler);
        }
    }
}
