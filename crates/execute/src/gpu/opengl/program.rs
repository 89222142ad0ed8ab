//! Compiles and links programs from two texts.

use glow::HasContext as _;

use super::context::OpenGlApi;

/// The full-screen triangle, without the `#version` line.
const TRIANGLE: &str = "
void main() {
    vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
";

/// A vertex stage that draws one triangle over everything.
pub fn triangle_stage(api: OpenGlApi) -> String {
    let version = match api {
        OpenGlApi::Core(major, minor) => format!("{major}{minor}0 core"),
        OpenGlApi::Embedded(major, minor) => format!("{major}{minor}0 es"),
    };
    format!("#version {version}\n{TRIANGLE}")
}

/// The first extension that a text requires and that the driver lacks.
pub fn missing_extension(gl: &glow::Context, text: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(text);
    let required = text.lines().filter_map(|line| {
        line.strip_prefix("#extension ")?.strip_suffix(": require").map(str::trim)
    });
    let known = gl.supported_extensions();
    required.into_iter().find(|name| !known.contains(*name)).map(str::to_owned)
}

/// Compiles and links both stages.
pub fn link_program(
    gl: &glow::Context,
    vertex: &str,
    fragment: &str,
) -> Result<glow::Program, String> {
    // SAFETY: the context is current; every name is of this context.
    unsafe {
        let program = gl.create_program()?;
        for (stage, text) in [(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)] {
            let shader = gl.create_shader(stage)?;
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
pub fn set_unit(gl: &glow::Context, program: glow::Program, name: &str, unit: u32) {
    // SAFETY: the context is current and the program is of it.
    unsafe {
        gl.use_program(Some(program));
        if let Some(location) = gl.get_uniform_location(program, name) {
            gl.uniform_1_i32(Some(&location), unit as i32);
        }
    }
}

/// Assigns a uniform block to a binding, unless the driver removed it.
pub fn set_block(gl: &glow::Context, program: glow::Program, name: &str, binding: u32) {
    // SAFETY: the context is current and the program is of it.
    unsafe {
        if let Some(index) = gl.get_uniform_block_index(program, name) {
            gl.uniform_block_binding(program, index, binding);
        }
    }
}

/// Returns the first OpenGL error since the last check, as a message.
pub fn check_error(gl: &glow::Context) -> Result<(), String> {
    // SAFETY: the context is current.
    match unsafe { gl.get_error() } {
        glow::NO_ERROR => Ok(()),
        error => Err(format!("OpenGL reports error 0x{error:04x}")),
    }
}
