//! `lamplight export DIR`: the library's text for other tools.

use std::io::{Write, stdout};
use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use crate::output;
use crate::project::LIBRARY;
use crate::source::{Embedded, Files};

/// Write the shader library to `DIR/lamplight`, for compilers with an include path.
#[derive(Args)]
pub struct Arguments {
    /// The folder to give to the compiler: `glslangValidator -IDIR`.
    folder: PathBuf,
}

pub fn run(arguments: Arguments) -> Result<(), Failure> {
    let folder = arguments.folder.join(LIBRARY);
    let paths = Embedded.list(&["wesl", "wgsl", "glsl"]);
    for path in paths.iter().map(String::as_str).chain(["wesl.toml"]) {
        let text = Embedded.read(path).ok().flatten().ok_or_else(|| Failure::environment(format!("the binary carries no `{path}`")))?;
        output::write(&folder.join(path), text.as_bytes())?;
    }
    Ok(writeln!(stdout(), "{}: {} files", folder.display(), paths.len() + 1)?)
}
