//! A folder with files in which the command is run.

use std::fs;
use std::io::Write;
use std::panic::Location;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use libtest_mimic::Failed;
use tempfile::TempDir;

use super::Outcome;

/// Files in a temporary folder.
pub struct Package(TempDir);

/// The result of a command.
pub struct Run {
    /// The exit code; -1 if a signal ended the command.
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Package {
    pub fn new(files: &[(&str, &str)]) -> Result<Self, Failed> {
        let package = Self(tempfile::tempdir()?);
        files.iter().try_for_each(|(path, text)| package.write(path, text))?;
        Ok(package)
    }

    pub fn path(&self, below: &str) -> PathBuf {
        self.0.path().join(below)
    }

    pub fn write(&self, path: &str, text: &str) -> Outcome {
        let path = self.path(path);
        fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))?;
        Ok(fs::write(path, text)?)
    }

    /// Runs the command in the folder; arguments are separated by blanks.
    pub fn run(&self, arguments: &str) -> Result<Run, Failed> {
        self.run_in("", arguments)
    }

    /// Runs the command in a folder below.
    pub fn run_in(&self, folder: &str, arguments: &str) -> Result<Run, Failed> {
        Ok(self.command(folder, arguments).output()?.into())
    }

    /// Runs the command with a text on its standard input.
    pub fn fed(&self, arguments: &str, text: &str) -> Result<Run, Failed> {
        let mut command = self.command("", arguments);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn()?;
        if let Some(mut input) = child.stdin.take() {
            input.write_all(text.as_bytes())?;
        }
        Ok(child.wait_with_output()?.into())
    }

    pub fn command(&self, folder: &str, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
        command
            .args(arguments.split_whitespace())
            .current_dir(self.path(folder))
            .env("RAYON_NUM_THREADS", "2")
            .env("XDG_CACHE_HOME", self.path(".cache"));
        command
    }
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let code = output.status.code().unwrap_or(-1);
        Self { code, out: text(&output.stdout), err: text(&output.stderr) }
    }
}

impl Run {
    /// Fails unless the command ended with this exit code.
    #[track_caller]
    pub fn ends(self, code: i32) -> Result<Self, Failed> {
        if self.code == code {
            return Ok(self);
        }
        let place = Location::caller();
        let found = format!("exit code {}, expected {code}", self.code);
        Err(format!("{place}: {found}:\n{}{}", self.out, self.err).into())
    }

    /// Fails unless the command printed all of these words, on either stream.
    #[track_caller]
    pub fn says(self, words: &[&str]) -> Result<Self, Failed> {
        let place = Location::caller();
        let all = format!("{}{}", self.out, self.err);
        match words.iter().find(|word| !all.contains(**word)) {
            Some(word) => Err(format!("{place}: expected `{word}` in the output:\n{all}").into()),
            None => Ok(self),
        }
    }

    /// Fails if the command printed any of these words, on either stream.
    #[track_caller]
    pub fn is_silent_of(self, words: &[&str]) -> Result<Self, Failed> {
        let place = Location::caller();
        let all = format!("{}{}", self.out, self.err);
        match words.iter().find(|word| all.contains(**word)) {
            Some(word) => {
                Err(format!("{place}: expected no `{word}` in the output:\n{all}").into())
            }
            None => Ok(self),
        }
    }
}

/// Fails, with the place of the call, unless two values are equal.
#[track_caller]
pub fn equal<T: PartialEq + std::fmt::Debug>(found: T, expected: T) -> Outcome {
    if found == expected {
        return Ok(());
    }
    Err(format!("{}: found {found:?}, expected {expected:?}", Location::caller()).into())
}
