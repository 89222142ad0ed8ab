//! Metal's language without a Mac: clang, with headers of our own in the place of Apple's,
//! validates the MSL that the crate emits. `execute::compiled` runs it on the CPU.
//!
//! `texts -> attributes (by a table), then clang -> refusals`
//!
//! The headers are in `shim/`. [`Clang`] is the compiler, with the folder that it reads them from.
//! What C++ cannot express is rewritten by [`adapt`]. [`attributes`] checks what clang ignores.

pub mod adapt;
pub mod attributes;
pub mod token;

use crate::{CLANG, halve_refused};
use adapt::adapt_text;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, io};
use token::msl_tokens;

/// A text that is not well formed.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct MslRefusal {
    /// Index of the text.
    pub index: usize,
    /// What is wrong with it, as `line:column: error: ...`, a line for each.
    pub errors: String,
}

type Refusals = Result<Vec<MslRefusal>, ClangMissing>;

/// Validates some texts. Each has a number, by which refusals name it.
///
/// # Errors
/// clang cannot be run.
pub fn validate_batch(clang: &Clang, batch: &[IndexedText<'_>]) -> Refusals {
    let (mut refusals, mut sound) = (Vec::new(), Vec::new());
    for (index, text) in batch {
        match before_clang(text) {
            Some(errors) => refusals.push(MslRefusal { index: *index, errors }),
            None => sound.push((*index, *text)),
        }
    }
    refusals.extend(validate_declarations(clang, &sound)?);
    Ok(refusals)
}

/// What is wrong with a text that clang would not report in a batch: the header is not included (a
/// batch includes it itself), there is no entry point, or an attribute is wrong.
fn before_clang(text: &str) -> Option<String> {
    if !text.lines().any(|line| line.trim() == "#include <metal_stdlib>") {
        return Some("1:1: error: `metal_stdlib` is not included".to_owned());
    }
    let is_stage = |word: &str| ["vertex", "fragment", "kernel"].contains(&word);
    if !msl_tokens(text).iter().any(|token| is_stage(token.text)) {
        return Some("1:1: error: there is no entry point".to_owned());
    }
    attributes::first_mistake(text)
}

/// A text and its number.
pub type IndexedText<'t> = (usize, &'t str);

/// Validates texts that may be declarations alone, without an entry point.
///
/// # Errors
/// clang cannot be run.
pub fn validate_declarations(clang: &Clang, batch: &[IndexedText<'_>]) -> Refusals {
    // Its halves are validated if it is refused, since a mistake in one text may make others look
    // wrong.
    let compiled = |batch: &[IndexedText<'_>]| clang.compile(&unit_text(batch), &["-fsyntax-only"]);
    let together = |batch: &[IndexedText<'_>]| Ok(compiled(batch)?.status.success().then(Vec::new));
    let alone = |one: &IndexedText<'_>| {
        let output = compiled(&[*one])?;
        let refusal = || MslRefusal { index: one.0, errors: clang_errors(&output.stderr) };
        Ok((!output.status.success()).then(refusal).into_iter().collect())
    };
    halve_refused(batch, &together, &alone)
}

/// Texts side by side, each in a namespace of its own.
fn unit_text(texts: &[IndexedText<'_>]) -> String {
    let mut unit = "#include <metal_stdlib>\n".to_owned();
    for (number, (_, text)) in texts.iter().enumerate() {
        let _ =
            write!(unit, "namespace text{number} {{\n#line 1 \"text\"\n{}\n}}\n", adapt_text(text));
    }
    unit
}

/// clang's errors about a text, a line for each, with Metal's names of types.
fn clang_errors(stderr: &[u8]) -> String {
    let text = String::from_utf8_lossy(stderr);
    let lines: Vec<&str> = text.lines().collect();
    let errors: Vec<String> =
        (0..lines.len()).filter_map(|at| placed_error(&lines[at..])).collect();
    let errors = if errors.is_empty() { text.trim().to_owned() } else { errors.join("\n") };
    TYPES.iter().fold(errors, |errors, (clang, metal)| errors.replace(clang, metal))
}

/// An error with its place. If that is in the headers, a note tells which place of the text led
/// there.
fn placed_error(lines: &[&str]) -> Option<String> {
    let (place, message) = lines.first()?.split_once(": error: ")?;
    let here = |line: &str| line.strip_prefix("text:").map(str::to_owned);
    let notes = lines[1..].iter().take_while(|line| !line.contains(": error: "));
    let noted = || {
        let mut places = notes.filter_map(|line| here(line.split_once(": note: ")?.0));
        places.next()
    };
    let place = here(place).or_else(noted).unwrap_or_else(|| place.to_owned());
    Some(format!("{place}: error: {message}"))
}

/// What the headers call types, and what Metal calls them.
const TYPES: &[(&str, &str)] = &[
    // Only a comparison of vectors gives clang's own vector of `int`.
    ("'int' values", "'bool' values"),
    ("int __attribute__((ext_vector_type(2)))", "metal::bool2"),
    ("int __attribute__((ext_vector_type(3)))", "metal::bool3"),
    ("int __attribute__((ext_vector_type(4)))", "metal::bool4"),
    ("'wchar_t' values", "'int' values"),
    ("wchar_t", "int"),
    ("__lamplight_", ""),
    ("__lamplight::", "metal::"),
];

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
    "-Xclang",
    "-fnative-half-type",
    "-Xclang",
    "-fallow-half-arguments-and-returns",
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

/// A hash of the headers and of how they are read, since other headers accept other texts.
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
/// No clang can be run, or it does not print its version.
pub fn clang_version() -> Result<String, ClangMissing> {
    let output = Command::new(CLANG.program).arg("--version").output().map_err(missing_reason)?;
    let text = String::from_utf8_lossy(&output.stdout);
    let version = text.lines().next().unwrap_or_default().trim().to_owned();
    if output.status.success() && version.contains("clang") {
        Ok(version)
    } else {
        Err(ClangMissing { reason: format!("{} does not print its version", CLANG.program) })
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
