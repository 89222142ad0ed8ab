//! The options for a shader of the user's own.

use clap::builder::RangedI64ValueParser;
use clap::{Args, ValueEnum};

use crate::bundle::SourceClip;
use crate::cli::compile::parse_convention;
use crate::picture::own::{MOST_VERTICES, UniformValue, parse_value};
use crate::picture::terminal::TerminalForm;

/// What is drawn of a file, and with which values.
#[derive(Args, Clone)]
#[command(next_help_heading = "A shader of your own")]
pub struct OwnArguments {
    /// The entry point that is drawn, where a file has several of a stage; once for each stage.
    #[arg(long, value_name = "NAME")]
    pub entry: Vec<String>,
    /// The value of a uniform: numbers, or a colour such as `#ff8800`. `block.member` names a member,
    /// `array[2]` an element. May be given several times.
    #[arg(long, value_name = "NAME=VALUE", value_parser = parse_uniform)]
    pub uniform: Vec<(String, UniformValue)>,
    /// What a texture holds: a PNG file; `checker`, `noise`, `bricks`, `uv`, `gradient`, `white`,
    /// `grey`, `black` or `flat`; for a cube an environment or a Radiance file. May be given several
    /// times.
    #[arg(long, value_name = "NAME=FILE|...", value_parser = parse_texture)]
    pub texture: Vec<(String, String)>,
    /// The time that the shader sees [default: 1].
    #[arg(long, value_name = "SECONDS", value_parser = parse_time, allow_negative_numbers = true)]
    pub time: Option<f64>,
    /// What the shader returns: `linear` light, which is encoded as sRGB for the picture, or `srgb`,
    /// which is encoded already [default: `srgb` for GLSL for OpenGL and for `--wrap`, else `linear`].
    #[arg(long, value_name = "SPACE", value_enum)]
    pub colors: Option<Colors>,
    /// How many vertices a vertex stage makes that only reads their index [default: the length of its
    /// longest array of vectors, else 3].
    #[arg(long, value_name = "N", value_parser = vertex_range())]
    pub vertices: Option<u32>,
    /// The API that a shader in GLSL is written for: `opengl`, `vulkan`, `webgpu`, or `auto`, which is
    /// `opengl` for versions below 4.50 without features of Vulkan, else `webgpu`.
    #[arg(long, value_name = "SPACE", default_value = "auto")]
    #[arg(value_parser = parse_convention::<SourceClip>)]
    pub source_clip: SourceClip,
    /// Draw again whenever the file, or one that it imports, changes, until interrupted.
    #[arg(long)]
    pub watch: bool,
    /// Show the picture in the terminal: as the terminal can, or in this form. No file is written then,
    /// unless `--out` names one.
    #[arg(long, value_name = "FORM", num_args = 0..=1, require_equals = true)]
    #[arg(value_parser = parse_form)]
    pub terminal: Option<Option<TerminalForm>>,
    /// Print what was drawn and what the shader was given as JSON.
    #[arg(long)]
    pub json: bool,
}

/// What the colours are.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Colors {
    Linear,
    Srgb,
}

impl OwnArguments {
    /// An option that was given, for the error where there is no shader of the user's.
    pub fn given(&self) -> Option<&'static str> {
        let given = [
            (!self.entry.is_empty(), "--entry"),
            (!self.uniform.is_empty(), "--uniform"),
            (!self.texture.is_empty(), "--texture"),
            (self.time.is_some(), "--time"),
            (self.colors.is_some(), "--colors"),
            (self.vertices.is_some(), "--vertices"),
            (self.watch, "--watch"),
            (self.terminal.is_some(), "--terminal"),
            (self.json, "--json"),
        ];
        given.into_iter().find(|(is_given, _)| *is_given).map(|(_, name)| name)
    }
}

fn vertex_range() -> RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(3..=i64::from(MOST_VERTICES))
}

fn parse_uniform(text: &str) -> Result<(String, UniformValue), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
    Ok((named(name)?, parse_value(value)?))
}

fn parse_texture(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=FILE, or NAME=checker")?;
    Ok((named(name)?, value.to_owned()))
}

fn named(name: &str) -> Result<String, String> {
    let name = name.trim();
    if name.is_empty() {
        Err("there is no name before the `=`".to_owned())
    } else {
        Ok(name.to_owned())
    }
}

fn parse_time(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "expected a number of seconds".to_owned())
}

fn parse_form(text: &str) -> Result<TerminalForm, String> {
    let found = TerminalForm::NAMES.iter().find(|(name, _)| *name == text);
    let names = || TerminalForm::NAMES.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    found.map(|(_, form)| *form).ok_or_else(|| format!("expected one of: {}", names()))
}
