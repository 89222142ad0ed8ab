//! A folder with files, and the command run in it.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use libtest_mimic::Failed;
use tempfile::TempDir;

use super::Outcome;

/// Files in a folder of their own.
pub struct Package(TempDir);

/// What a command did.
pub struct Run {
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
    /// It ended with that exit code.
    pub fn ends(self, code: i32) -> Result<Self, Failed> {
        if self.code == code {
            return Ok(self);
        }
        Err(format!("exit code {}, expected {code}:\n{}{}", self.code, self.out, self.err).into())
    }

    /// It said all of these words, on either stream.
    pub fn says(self, words: &[&str]) -> Result<Self, Failed> {
        let all = format!("{}{}", self.out, self.err);
        match words.iter().find(|word| !all.contains(**word)) {
            Some(word) => Err(format!("`{word}` is not said:\n{all}").into()),
            None => Ok(self),
        }
    }

    /// It said none of these words.
    pub fn is_silent_of(self, words: &[&str]) -> Result<Self, Failed> {
        let all = format!("{}{}", self.out, self.err);
        match words.iter().find(|word| all.contains(**word)) {
            Some(word) => Err(format!("`{word}` is said:\n{all}").into()),
            None => Ok(self),
        }
    }
}

pub fn equal<T: PartialEq + std::fmt::Debug>(found: T, expected: T) -> Outcome {
    if found == expected {
        return Ok(());
    }
    Err(format!("found {found:?}, expected {expected:?}").into())
}
