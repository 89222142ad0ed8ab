//! Root modules that are not files: `-`, and pipes such as `/dev/stdin` or `<(...)`.

use std::fs::{self, File};
use std::io::{Read, stdin};
use std::path::Path;

use super::failure::Failure;
use crate::bundle::{Language, Stage};
use crate::source::{Files, LIMITS, ReadError};

/// Stands for standard input.
pub const STANDARD_INPUT: &str = "-";

/// Whether the path is a stream: its text can be read once, and has no folder.
pub fn is_stream(path: &Path) -> bool {
    path.as_os_str() == STANDARD_INPUT
        || fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// Whether a path names what this process has open: `/dev/stdin`, or what a shell makes of `<(...)`.
fn is_open_already(path: &Path) -> bool {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    ["/dev/stdin", "/dev/fd", "/proc"].iter().any(|known| path.starts_with(known))
}

/// Reads the text of a stream. It may be as long as a file may be.
pub fn read_stream(path: &Path) -> Result<String, Failure> {
    String::from_utf8(read_stream_bytes(path)?).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Failure::input(format!("`{}` is not UTF-8: byte {at} is wrong", path.display()))
    })
}

/// Reads the bytes of a stream.
pub fn read_stream_bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    let most = LIMITS.file_bytes as u64;
    let mut bytes = Vec::new();
    if path.as_os_str() == STANDARD_INPUT {
        stdin().lock().take(most + 1).read_to_end(&mut bytes)?;
    } else {
        if !is_open_already(path) {
            return Err(Failure::input(format!(
                "`{}` is a pipe or a device, and reading it may wait for ever\nhelp: give it as \
                 standard input: `- < {}`",
                path.display(),
                path.display()
            )));
        }
        let unreadable =
            |error| Failure::input(format!("cannot read `{}`: {error}", path.display()));
        let file = File::open(path).map_err(unreadable)?;
        file.take(most + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    }
    if bytes.len() as u64 > most {
        let message =
            format!("`{}` has more than the {most} bytes that are allowed", path.display());
        return Err(Failure::input(message));
    }
    Ok(bytes)
}

/// The name of a stream's module in its package, from which the composer takes the stage of GLSL.
pub fn stream_name(language: Language, stage: Option<Stage>) -> String {
    let stage = match stage {
        Some(Stage::Vertex) => ".vert",
        Some(Stage::Fragment) => ".frag",
        Some(Stage::Compute) => ".comp",
        None => "",
    };
    match language {
        Language::Wesl => "stdin.wesl".to_owned(),
        Language::Glsl => format!("stdin{stage}.glsl"),
    }
}

/// The files of a package, with `text` in the place of the file `name`.
pub struct StreamOverlay {
    pub below: Box<dyn Files>,
    pub name: String,
    pub text: String,
}

impl Files for StreamOverlay {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        if path == self.name { Ok(Some(self.text.clone())) } else { self.below.read(path) }
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        self.below.list(extensions)
    }

    fn display(&self, path: &str) -> String {
        if path == self.name { "<standard input>".to_owned() } else { self.below.display(path) }
    }

    fn on_disk(&self, path: &str) -> bool {
        path != self.name && self.below.on_disk(path)
    }
}
