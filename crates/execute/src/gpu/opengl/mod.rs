//! Runs emitted GLSL unchanged, directly on OpenGL and OpenGL ES.
//!
//! Why not through wgpu? Its GL backend accepts a shader's text unchanged. But it learns only from
//! its own translation which sampler belongs to which texture, so shadow lookups would not work. It
//! also opens only one kind of context.
//!
//! Programs are compiled and linked from two texts; fixtures and words become textures and samplers.

mod compute;
mod context;
mod frame;

use crate::dispatch::{Dispatch, DispatchResult};
use crate::fixture::{Address, Compare, Fixture, FixtureSampler, FixtureTexture};
use crate::frame::{Drawing, Frame};
use crate::gpu::{emitted, executor_failed};
use crate::kernel::{INPUT_WIDTH, Kernel, SENTINEL, TARGET_WIDTH};
use crate::source;
use crate::{Session, ShippedPair};
pub use context::OpenGlApi;
use context::OpenGlContext;
use glow::HasContext as _;
use lamplight_bundle::{Combined, Target};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_emit::Emitted;
use std::collections::HashMap;

/// Group and binding of a kernel's input texture.
const INPUTS: [u32; 2] = [0, 0];

/// A context that runs the texts of one target.
pub struct OpenGl {
    context: OpenGlContext,
    target: Target,
    /// Whether the driver compiles the author's own text in the place of the emitted one.
    is_source: bool,
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
        let context = OpenGlContext::open(api)?;
        Ok(Self { context, target, is_source: false, kept: HashMap::new() })
    }

    /// The same for the author's own texts in GLSL.
    pub fn open_source(api: OpenGlApi, target: Target) -> Result<Self, String> {
        Ok(Self { is_source: true, ..Self::open(api, target)? })
    }

    fn has_extensions(&self, text: &[u8]) -> Result<(), Diagnostic> {
        let missing = self.context.with(|gl| Ok(missing_extension(gl, text)));
        match missing.map_err(executor_failed)? {
            None => Ok(()),
            Some(name) => {
                let message = format!("the driver has no {name}, which the emitted text requires");
                Err(Diagnostic::error(codes::EXECUTOR_LACKS, message))
            }
        }
    }

    fn prepare(&mut self, kernel: &Kernel) -> Result<(), Diagnostic> {
        if self.kept.contains_key(&kernel.code) {
            return Ok(());
        }
        if self.is_source {
            let api = self.context.api();
            let text = source::fragment_text(kernel, source_head(api))?;
            let vertex = triangle_stage(api);
            let kept = self.context.with(|gl| keep_source(gl, kernel, &vertex, &text));
            self.kept.insert(kernel.code, kept.map_err(executor_failed)?);
        } else {
            let emitted = emitted::emit_kernel(kernel, self.target)?;
            self.has_extensions(&emitted.bytes)?;
            let vertex = triangle_stage(self.context.api());
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
        crate::gpu::run_batches(kernel, inputs, |texels, rows| self.draw(kernel, texels, rows))
    }

    fn dispatch(&mut self, dispatches: &[Dispatch<'_>]) -> Vec<DispatchResult> {
        dispatches.iter().map(|dispatch| self.compute(dispatch)).collect()
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
    let program = link_program(gl, vertex, text)?;
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
        let sampler = settings.map(|settings| create_sampler(gl, settings)).transpose()?;
        let (target, texture) = upload_fixture(gl, fixture)?;
        units.push(TextureUnit { index, target, texture, sampler });
    }
    check_error(gl)?;
    Ok(OpenGlKernel { program, inputs, units })
}

/// What comes before the author's text.
fn source_head(api: OpenGlApi) -> &'static str {
    match api {
        OpenGlApi::Core(..) => "#version 450 core\n",
        // Shadow samplers have no precision of their own in ES.
        OpenGlApi::Embedded(..) => {
            "#version 300 es\nprecision highp float;\nprecision highp int;\n\
             precision highp sampler2D;\nprecision highp sampler2DShadow;\n\
             precision highp samplerCubeShadow;\n"
        }
    }
}

/// The same for the author's own text, whose textures are combined with the samplers behind them.
fn keep_source(
    gl: &glow::Context,
    kernel: &Kernel,
    vertex: &str,
    text: &str,
) -> Result<OpenGlKernel, String> {
    let program = link_program(gl, vertex, text)?;
    set_unit(gl, program, source::INPUTS, 0);
    let mut units = Vec::new();
    let resources: Vec<_> = kernel.resources().collect();
    for (order, resource) in resources.iter().enumerate() {
        let Fixture::Texture(fixture) = &*resource.fixture else { continue };
        let index = units.len() as u32 + 1;
        set_unit(gl, program, &source::texture_name(resource.binding), index);
        let settings = resources.get(order + 1).and_then(|next| next.fixture.sampler());
        let sampler = settings.map(|settings| create_sampler(gl, settings)).transpose()?;
        let (target, texture) = upload_fixture(gl, fixture)?;
        units.push(TextureUnit { index, target, texture, sampler });
    }
    check_error(gl)?;
    Ok(OpenGlKernel { program, inputs: 0, units })
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
        set_unit(gl, program, &combined.name, order);
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
        let target = words_texture(gl, [TARGET_WIDTH, rows], None)?;
        let height_of_inputs = texels.len() as u32 / 4 / INPUT_WIDTH;
        let inputs = words_texture(gl, [INPUT_WIDTH, height_of_inputs], Some(&bytes))?;
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
    check_error(gl)?;
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

/// The full-screen triangle, without the `#version` line.
const TRIANGLE: &str = "
void main() {
    vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
";

/// A vertex stage that draws one triangle over everything.
fn triangle_stage(api: OpenGlApi) -> String {
    let version = match api {
        OpenGlApi::Core(major, minor) => format!("{major}{minor}0 core"),
        OpenGlApi::Embedded(major, minor) => format!("{major}{minor}0 es"),
    };
    format!("#version {version}\n{TRIANGLE}")
}

/// The first extension that a text requires and that the driver lacks.
fn missing_extension(gl: &glow::Context, text: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(text);
    let required = text.lines().filter_map(|line| {
        line.strip_prefix("#extension ")?.strip_suffix(": require").map(str::trim)
    });
    let known = gl.supported_extensions();
    required.into_iter().find(|name| !known.contains(*name)).map(str::to_owned)
}

/// Compiles and links both stages.
fn link_program(gl: &glow::Context, vertex: &str, fragment: &str) -> Result<glow::Program, String> {
    link_stages(gl, &[(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)])
}

fn link_stages(gl: &glow::Context, stages: &[(u32, &str)]) -> Result<glow::Program, String> {
    // SAFETY: the context is current; every name is of this context.
    unsafe {
        let program = gl.create_program()?;
        for (stage, text) in stages {
            let shader = gl.create_shader(*stage)?;
            gl.shader_source(shader, text);
            gl.compile_shader(shader);
            if !gl.get_shader_compile_status(shader) {
                let words = gl.get_shader_info_log(shader);
                return Err(format!("the driver rejects the emitted text: {words}"));
            }
            gl.attach_shader(program, shader);
            gl.delete_shader(shader);
        }
        gl.link_program(program);
        if gl.get_program_link_status(program) {
            Ok(program)
        } else {
            let words = gl.get_program_info_log(program);
            Err(format!("the driver does not link the emitted texts: {words}"))
        }
    }
}

/// Assigns a combined sampler to a texture unit, unless the driver removed it.
fn set_unit(gl: &glow::Context, program: glow::Program, name: &str, unit: u32) {
    // SAFETY: the context is current and the program is of it.
    unsafe {
        gl.use_program(Some(program));
        if let Some(location) = gl.get_uniform_location(program, name) {
            gl.uniform_1_i32(Some(&location), unit as i32);
        }
    }
}

/// Assigns a uniform block to a binding, unless the driver removed it.
fn set_block(gl: &glow::Context, program: glow::Program, name: &str, binding: u32) {
    // SAFETY: the context is current and the program is of it.
    unsafe {
        if let Some(index) = gl.get_uniform_block_index(program, name) {
            gl.uniform_block_binding(program, index, binding);
        }
    }
}

/// Returns the first OpenGL error since the last check, as a message.
fn check_error(gl: &glow::Context) -> Result<(), String> {
    // SAFETY: the context is current.
    match unsafe { gl.get_error() } {
        glow::NO_ERROR => Ok(()),
        error => Err(format!("OpenGL reports error 0x{error:04x}")),
    }
}

/// Uploads the fixture as a texture; also returns its target.
fn upload_fixture(
    gl: &glow::Context,
    texture: &FixtureTexture,
) -> Result<(u32, glow::Texture), String> {
    let (internal, format) = if texture.kind.is_depth() {
        (glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT)
    } else {
        (glow::RGBA32F, glow::RGBA)
    };
    let cube = texture.kind.layers() == 6;
    let target = if cube { glow::TEXTURE_CUBE_MAP } else { glow::TEXTURE_2D };
    let layer = texture.texels.len() / texture.kind.layers() as usize;
    let bytes: Vec<u8> = texture.texels.iter().flat_map(|value| value.to_ne_bytes()).collect();
    // SAFETY: the context is current. Each slice has the texels of one layer, with four bytes for
    // each component.
    unsafe {
        let made = gl.create_texture()?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(target, Some(made));
        for (face, texels) in bytes.chunks(layer * 4).enumerate() {
            let target =
                if cube { glow::TEXTURE_CUBE_MAP_POSITIVE_X + face as u32 } else { target };
            gl.tex_image_2d(
                target,
                0,
                internal as i32,
                texture.width as i32,
                texture.height as i32,
                0,
                format,
                glow::FLOAT,
                glow::PixelUnpackData::Slice(Some(texels)),
            );
        }
        set_nearest(gl, target);
        Ok((target, made))
    }
}

/// A texture of words, bound to unit 0.
fn words_texture(
    gl: &glow::Context,
    size: [u32; 2],
    texels: Option<&[u8]>,
) -> Result<glow::Texture, String> {
    make_texture(gl, size, (glow::RGBA32UI, glow::RGBA_INTEGER, glow::UNSIGNED_INT), texels)
}

/// A texture to draw into, with four floats or four words for each texel.
fn target_texture(
    gl: &glow::Context,
    size: [u32; 2],
    is_float: bool,
) -> Result<glow::Texture, String> {
    match is_float {
        true => make_texture(gl, size, (glow::RGBA32F, glow::RGBA, glow::FLOAT), None),
        false => words_texture(gl, size, None),
    }
}

fn make_texture(
    gl: &glow::Context,
    [width, height]: [u32; 2],
    (internal, format, ty): (u32, u32, u32),
    texels: Option<&[u8]>,
) -> Result<glow::Texture, String> {
    // SAFETY: the context is current, and the slice has 16 bytes for each texel.
    unsafe {
        let made = gl.create_texture()?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_2D, Some(made));
        gl.tex_image_2d(
            glow::TEXTURE_2D,
            0,
            internal as i32,
            width as i32,
            height as i32,
            0,
            format,
            ty,
            glow::PixelUnpackData::Slice(texels),
        );
        set_nearest(gl, glow::TEXTURE_2D);
        Ok(made)
    }
}

/// Sets what a texture with one level needs to be complete, where no sampler object is bound.
///
/// # Safety
///
/// The context is current, and a texture is bound to the target.
unsafe fn set_nearest(gl: &glow::Context, target: u32) {
    // SAFETY: a texture is bound to the target.
    unsafe {
        gl.tex_parameter_i32(target, glow::TEXTURE_MIN_FILTER, glow::NEAREST as i32);
        gl.tex_parameter_i32(target, glow::TEXTURE_MAG_FILTER, glow::NEAREST as i32);
        gl.tex_parameter_i32(target, glow::TEXTURE_MAX_LEVEL, 0);
    }
}

/// A sampler object with these settings.
fn create_sampler(gl: &glow::Context, settings: FixtureSampler) -> Result<glow::Sampler, String> {
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
        Compare::Equal => glow::EQUAL,
        Compare::NotEqual => glow::NOTEQUAL,
    });
    // SAFETY: the context is current.
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
