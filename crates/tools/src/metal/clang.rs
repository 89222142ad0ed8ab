//! clang, and the folder with the headers that it reads.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, io};

use crate::CLANG;

/// The headers, and the program around the shaders.
const SHIM: &[(&str, &str)] = &[
    ("compute.h", include_str!("shim/compute.h")),
    ("convert.h", include_str!("shim/convert.h")),
    ("glue.h", include_str!("shim/glue.h")),
    ("math.h", include_str!("shim/math.h")),
    ("matrix.h", include_str!("shim/matrix.h")),
    ("metal_stdlib", include_str!("shim/metal_stdlib")),
    ("runtime.cpp", include_str!("shim/runtime.cpp")),
    ("runtime.h", include_str!("shim/runtime.h")),
    ("simd/simd.h", include_str!("shim/simd/simd.h")),
    ("texture.h", include_str!("shim/texture.h")),
    ("types.h", include_str!("shim/types.h")),
];

/// How shaders are read: as strict C++17, with one vector type for each element type and size, and
/// with literals without a suffix of type `float`. Warnings about naga's text would help nobody, so
/// they are off.
const FLAGS: &[&str] = &[
    "-x",
    "c++",
    "-std=c++17",
    "-fdeclspec",
    "-flax-vector-conversions=none",
    "-Xclang",
    "-cl-single-precision-constant",
    "-w",
    "-fno-caret-diagnostics",
    "-fno-color-diagnostics",
    "-ferror-limit=5",
];

/// Why clang cannot be used, or failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ClangMissing {
    pub reason: String,
}

/// An installed clang, with the headers in a folder of its own for as long as this lives.
#[derive(Debug)]
pub struct Clang {
    folder: PathBuf,
}

/// A hash of the headers and of how they are read, since other headers judge differently.
pub fn shim_hash() -> String {
    let mut hasher = blake3::Hasher::new();
    let texts = SHIM.iter().flat_map(|(name, text)| [*name, *text]).chain(FLAGS.iter().copied());
    texts.for_each(|text| {
        hasher.update(&text.len().to_le_bytes());
        hasher.update(text.as_bytes());
    });
    hasher.finalize().to_hex().to_string()
}

/// The version that the installed clang reports.
///
/// # Errors
/// No clang can be run, or it does not tell its version.
pub fn clang_version() -> Result<String, ClangMissing> {
    let output = Command::new(CLANG.program).arg("--version").output().map_err(missing_reason)?;
    let text = String::from_utf8_lossy(&output.stdout);
    let version = text.lines().next().unwrap_or_default().trim().to_owned();
    if output.status.success() && version.contains("clang") {
        Ok(version)
    } else {
        Err(ClangMissing { reason: format!("{} does not tell its version", CLANG.program) })
    }
}

fn missing_reason(error: io::Error) -> ClangMissing {
    ClangMissing { reason: format!("{}: {error}", CLANG.program) }
}

impl Clang {
    /// Looks for clang, and writes the headers.
    pub fn open() -> Result<Self, ClangMissing> {
        clang_version()?;
        let clang = Self { folder: own_folder().map_err(missing_reason)? };
        for (name, text) in SHIM {
            clang.write(name, text.as_bytes()).map_err(missing_reason)?;
        }
        Ok(clang)
    }

    /// The path of a file in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Writes a file of the folder.
    fn write(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let path = self.path(name);
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        fs::write(path, bytes)
    }

    /// Compiles a source with the flags for shaders and more arguments.
    pub fn compile(&self, source: &str, arguments: &[&str]) -> Result<Output, ClangMissing> {
        let mut command = Command::new(CLANG.program);
        command.args(FLAGS).arg("-isystem").arg(&self.folder).args(arguments).arg("-");
        self.run(command, source.as_bytes())
    }

    /// Calls clang with any arguments, in the folder.
    pub fn call(&self, arguments: &[&str]) -> Result<Output, ClangMissing> {
        let mut command = Command::new(CLANG.program);
        command.args(arguments);
        self.run(command, &[])
    }

    fn run(&self, mut command: Command, input: &[u8]) -> Result<Output, ClangMissing> {
        command.current_dir(&self.folder).stdin(Stdio::piped());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(missing_reason)?;
        if let Some(mut stdin) = child.stdin.take() {
            // clang stops reading at a fatal error. Its message is read below.
            match stdin.write_all(input) {
                Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                    return Err(missing_reason(error));
                }
                _ => drop(stdin),
            }
        }
        child.wait_with_output().map_err(missing_reason)
    }
}

impl Drop for Clang {
    fn drop(&mut self) {
        // If this fails, the rest stays in the folder for temporary files.
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// A new folder for temporary files.
fn own_folder() -> io::Result<PathBuf> {
    static NEXT: AtomicUsize = AtomicUsize::new(0);
    loop {
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = format!("lamplight-metal-{}-{number}", std::process::id());
        let folder = Path::new(&env::temp_dir()).join(name);
        match fs::create_dir(&folder) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            outcome => return outcome.map(|()| folder),
        }
    }
}
