//! External programs that validate outputs or make them ready to run: validators, compilers, clang
//! with headers of ours for Metal ([`metal`]), and Chromium ([`browser`]).

#[cfg(not(target_family = "wasm"))]
pub mod browser;
pub mod metal;

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A program and the Debian package that brings it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Tool {
    pub program: &'static str,
    pub package: &'static str,
}

pub const GLSLANG: Tool = Tool { program: "glslangValidator", package: "glslang-tools" };
pub const GLSLC: Tool = Tool { program: "glslc", package: "glslc" };
pub const SPIRV_VAL: Tool = Tool { program: "spirv-val", package: "spirv-tools" };
pub const SPIRV_OPT: Tool = Tool { program: "spirv-opt", package: "spirv-tools" };
pub const CLANG: Tool = Tool { program: "clang++", package: "clang" };
pub const NODE: Tool = Tool { program: "node", package: "nodejs" };

impl Tool {
    /// Where it is, if it is installed.
    pub fn path(self) -> Option<PathBuf> {
        let folders = std::env::var_os("PATH")?;
        let files = std::env::split_paths(&folders).map(|folder| folder.join(self.program));
        files.into_iter().find(|file| file.is_file())
    }

    /// The message for someone on whose machine it is missing.
    pub fn missing(self) -> String {
        let Self { program, package } = self;
        format!("`{program}` is not installed\ninstall it with: apt-get install {package}")
    }

    /// The version that it reports, in one line. Another version may accept other outputs. Each
    /// program is asked once.
    pub fn version(self) -> String {
        static VERSIONS: Mutex<BTreeMap<&str, Arc<OnceLock<String>>>> = Mutex::new(BTreeMap::new());
        let slot = {
            let mut slot = VERSIONS.lock().unwrap_or_else(PoisonError::into_inner);
            slot.entry(self.program).or_default().clone()
        };
        let ask = || {
            let output = Command::new(self.program).arg("--version").stdin(Stdio::null()).output();
            // spirv-opt writes it to standard error.
            let words = |Output { stdout, stderr, .. }: Output| {
                let text = if stdout.is_empty() { stderr } else { stdout };
                String::from_utf8_lossy(&text).replace('\n', " ")
            };
            output.map_or(String::new(), words)
        };
        slot.get_or_init(ask).clone()
    }

    /// Its name and the number of its version, for people.
    pub fn described(self) -> String {
        let version = self.version();
        let mut words = version.split([' ', ',']).map(|word| word.trim_start_matches('v'));
        let number = words
            .find(|word| word.contains('.') && word.starts_with(|one: char| one.is_ascii_digit()));
        number.map_or(self.program.to_owned(), |number| format!("{} {number}", self.program))
    }

    /// Runs it on bytes; returns what it wrote.
    ///
    /// # Errors
    /// Its message if it refuses the bytes, or why it could not be run.
    pub fn pipe(self, arguments: &[&str], input: &[u8]) -> Result<Vec<u8>, String> {
        let failed = |error: io::Error| format!("`{}` could not be run: {error}", self.program);
        if self.path().is_none() {
            return Err(self.missing());
        }
        let mut child = Command::new(self.program)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        let stdin = child.stdin.take();
        let output = std::thread::scope(|scope| {
            // The program may write before it has read everything, or may stop reading.
            scope.spawn(|| stdin.map(|mut stdin| stdin.write_all(input)));
            child.wait_with_output()
        });
        let output = output.map_err(failed)?;
        if output.status.success() { Ok(output.stdout) } else { Err(output_text(&output)) }
    }

    /// Runs it on files.
    pub fn run(
        self,
        arguments: &[impl AsRef<OsStr>],
        files: impl IntoIterator<Item = impl AsRef<Path>>,
    ) -> io::Result<Output> {
        self.run_in(Path::new("."), arguments, files)
    }

    /// Runs it on files, in a folder to which it writes.
    pub fn run_in(
        self,
        folder: &Path,
        arguments: &[impl AsRef<OsStr>],
        files: impl IntoIterator<Item = impl AsRef<Path>>,
    ) -> io::Result<Output> {
        let files = files.into_iter().map(|file| file.as_ref().as_os_str().to_owned());
        let mut command = Command::new(self.program);
        command.args(arguments).args(files).current_dir(folder).stdin(Stdio::null()).output()
    }
}

/// Everything that a program printed.
pub fn output_text(output: &Output) -> String {
    let all = [output.stdout.as_slice(), output.stderr.as_slice()].concat();
    String::from_utf8_lossy(&all).trim().to_owned()
}

/// Runs a program on a batch, and returns what was found, or `None` if the program refuses the
/// batch.
pub type RunBatch<'r, T, F, E> = dyn Fn(&[T]) -> Result<Option<Vec<F>>, E> + 'r;

/// Runs a program on a batch. If it refuses the batch, it runs on each half, until those at fault
/// are found.
///
/// Parameter: `alone` returns what was found for a single one.
///
/// # Errors
/// The first error of a run.
pub fn halve_refused<T, F, E>(
    batch: &[T],
    together: &RunBatch<'_, T, F, E>,
    alone: &dyn Fn(&T) -> Result<Vec<F>, E>,
) -> Result<Vec<F>, E> {
    match batch {
        [] => Ok(Vec::new()),
        [one] => alone(one),
        _ => match together(batch)? {
            Some(found) => Ok(found),
            None => {
                let (first, second) = batch.split_at(batch.len() / 2);
                let mut found = halve_refused(first, together, alone)?;
                found.extend(halve_refused(second, together, alone)?);
                Ok(found)
            }
        },
    }
}
