//! `-I DIR` and `-D NAME=VALUE`, as other compilers of GLSL have them.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::input::plain_name;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::resolve::Packages;
use crate::source::{Disk, Package};

/// The options, for every command that reads shaders.
#[derive(Args, Clone, Default)]
pub struct Arguments {
    /// A folder in which `#include` looks last; may be given several times.
    #[arg(short = 'I', long = "include", value_name = "DIR")]
    include: Vec<PathBuf>,
    /// Define a macro before every file in GLSL, as 1 if there is no value.
    #[arg(short = 'D', long = "define", value_name = "NAME[=VALUE]", value_parser = definition)]
    define: Vec<(String, String)>,
    /// Make a whole shader of what a site's visitors write.
    #[arg(long, value_name = "SITE", value_enum)]
    wrap: Option<Wrap>,
}

/// Whose shaders are wrapped.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Wrap {
    /// A fragment shader with `mainImage`, and uniforms such as `iResolution` and `iTime`.
    Shadertoy,
}

/// The uniforms of Shadertoy (the site's "Shader Inputs"), and the outputs. Those that nothing reads
/// are left out.
const SHADERTOY: &str = "uniform vec3 iResolution;
uniform float iTime;
uniform float iTimeDelta;
uniform float iFrameRate;
uniform int iFrame;
uniform float iChannelTime[4];
uniform vec3 iChannelResolution[4];
uniform vec4 iMouse;
uniform vec4 iDate;
uniform float iSampleRate;
uniform float iGlobalTime;
uniform sampler2D iChannel0;
uniform sampler2D iChannel1;
uniform sampler2D iChannel2;
uniform sampler2D iChannel3;
layout(location = 0) out vec4 lamplight_color;
";

/// The site counts pixels from the bottom, and outputs from the top.
const SHADERTOY_MAIN: &str = "
void main() {
    lamplight_color = vec4(0.0, 0.0, 0.0, 1.0);
    mainImage(lamplight_color, vec2(gl_FragCoord.x, iResolution.y - gl_FragCoord.y));
}
";

/// Parses `NAME` or `NAME=VALUE`.
fn definition(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').unwrap_or((text, "1"));
    if value.contains(['\n', '\r', '\\']) {
        return Err("a value is on one line".to_owned());
    }
    Ok((plain_name(name)?, value.to_owned()))
}

impl Arguments {
    /// Whether files are wrapped, so that they are fragment shaders in GLSL whatever their names say.
    pub fn wraps(&self) -> bool {
        self.wrap.is_some()
    }

    /// Adds the folders and definitions to what a package may use.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn apply(&self, packages: &mut Packages) -> Result<(), Diagnostics> {
        for folder in &self.include {
            let disk = Disk::new(folder).map_err(|error| {
                let message = format!("cannot read `{}`: {error}", folder.display());
                vec![Diagnostic::error(codes::UNREADABLE, message)]
            })?;
            let name = folder.display().to_string();
            packages.add_includes(Package { name, files: Box::new(disk) });
        }
        for (name, value) in &self.define {
            packages.definitions.push_str(&format!("#define {name} {value}\n"));
        }
        if self.wrap == Some(Wrap::Shadertoy) {
            packages.definitions.push_str(SHADERTOY);
            packages.ending.push_str(SHADERTOY_MAIN);
        }
        Ok(())
    }
}
