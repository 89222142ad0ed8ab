//! Runs the files and commands of a page as one shell session.

use std::ffi::OsString;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use libtest_mimic::Failed;
use serde_json::json;

use crate::snapshot;

/// The longest time that the commands of one page may take together, on a busy machine.
const PATIENCE: Duration = Duration::from_secs(600);

/// The start of the line that the session prints after each command's output.
const MARK: &str = "guide-command-ended-with";

/// One step of the session.
pub enum Step<'a> {
    /// Writes a file.
    File { path: &'a str, text: String },
    /// Runs a command.
    Command(&'a str),
}

/// The result of one command.
pub struct Outcome {
    /// The lines of both streams in their order, without blanks at the ends of lines.
    pub lines: Vec<String>,
    pub code: i32,
}

/// A session that has ended.
pub struct Session {
    stage: tempfile::TempDir,
    /// The result of each command.
    pub outcomes: Vec<Outcome>,
}

impl Session {
    /// Runs the steps in an empty folder.
    pub fn run(steps: &[Step<'_>]) -> Result<Self, Failed> {
        let stage = tempfile::tempdir()?;
        let script = script(stage.path(), steps)?;
        let printed = execute(stage.path(), &script)?;
        let outcomes = outcomes(&printed)?;
        let commands = steps.iter().filter(|step| matches!(step, Step::Command(_))).count();
        if outcomes.len() != commands {
            let ran = outcomes.len();
            return Err(format!("the shell ended after {ran} of {commands}:\n{printed}").into());
        }
        Ok(Self { stage, outcomes })
    }

    /// A file that the commands wrote.
    pub fn made(&self, path: &str) -> Result<String, Failed> {
        let path = work(self.stage.path()).join(path);
        fs::read_to_string(&path).map_err(|error| format!("`{}`: {error}", path.display()).into())
    }
}

/// The folder that the commands run in.
fn work(stage: &Path) -> PathBuf {
    stage.join("work")
}

/// Writes the files of the steps to folders of their own. The script copies them to the session's
/// folder, in order, and runs the commands.
fn script(stage: &Path, steps: &[Step<'_>]) -> Result<String, Failed> {
    fs::create_dir_all(work(stage))?;
    let mut script = String::from("exec 2>&1\n");
    for (index, step) in steps.iter().enumerate() {
        match step {
            Step::File { path, text } => {
                let folder = stage.join(format!("step-{index}"));
                let file = folder.join(path);
                fs::create_dir_all(file.parent().unwrap_or(&folder))?;
                fs::write(file, text)?;
                writeln!(script, "cp -R \"$STAGE/step-{index}/.\" \"$STAGE/work\"")?;
            }
            Step::Command(text) => {
                fs::write(stage.join(format!("step-{index}.sh")), format!("{text}\n"))?;
                writeln!(script, ". \"$STAGE/step-{index}.sh\"")?;
                writeln!(script, "printf '\\n{MARK} %s\\n' $?")?;
            }
        }
    }
    Ok(script)
}

/// Runs the script and gives what it printed. The output goes to a file, because a command that is
/// left in the background would hold a pipe open.
fn execute(stage: &Path, script: &str) -> Result<String, Failed> {
    let (path, printed) = (stage.join("script.sh"), stage.join("printed"));
    fs::write(&path, script)?;
    cargo_config(stage)?;
    let mut command = Command::new("sh");
    command.arg(&path).current_dir(work(stage));
    command.stdin(Stdio::null()).stdout(File::create(&printed)?);
    environment(&mut command, stage);
    wait(command.spawn()?)?;
    Ok(String::from_utf8_lossy(&fs::read(&printed)?).into_owned())
}

/// Sets an environment that is the same on every machine: no colours, a narrow terminal, no cache of
/// the user's.
fn environment(command: &mut Command, stage: &Path) {
    let binaries = Path::new(env!("CARGO_BIN_EXE_lamplight")).parent().map(Path::to_path_buf);
    let known = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(binaries.into_iter().chain(std::env::split_paths(&known)));
    command.env("PATH", path.unwrap_or_else(|_| OsString::from(&known)));
    command.env("STAGE", stage).env("XDG_CACHE_HOME", stage.join("cache"));
    command.env("COLUMNS", "80").env("NO_COLOR", "1").env("LC_ALL", "C.UTF-8");
}

/// Makes cargo use this repository in place of the registry, so that pages need no network. It builds
/// in the folder of the tests, and as they do, so that dependencies are not built twice.
fn cargo_config(stage: &Path) -> Result<(), Failed> {
    let root = snapshot::root();
    let binaries = Path::new(env!("CARGO_BIN_EXE_lamplight")).parent();
    let target = binaries.and_then(Path::parent).ok_or("the tests have no target folder")?;
    let manifest: toml::Table = toml::from_str(&fs::read_to_string(root.join("Cargo.toml"))?)?;
    let config = json!({
        "patch": { "crates-io": { "lamplight": { "path": root } } },
        "net": { "offline": true },
        "build": { "target-dir": target, "incremental": false },
        "profile": { "dev": manifest["profile"]["dev"] },
    });
    fs::create_dir_all(stage.join(".cargo"))?;
    fs::write(stage.join(".cargo/config.toml"), toml::to_string(&config)?)?;
    fs::copy(root.join("Cargo.lock"), work(stage).join("Cargo.lock"))?;
    Ok(())
}

fn wait(mut child: Child) -> Result<(), Failed> {
    let start = Instant::now();
    while child.try_wait()?.is_none() {
        if start.elapsed() > PATIENCE {
            child.kill()?;
            child.wait()?;
            return Err(format!("the commands of the page take more than {PATIENCE:?}").into());
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    Ok(())
}

/// Divides what the shell printed into the results of the commands.
fn outcomes(printed: &str) -> Result<Vec<Outcome>, Failed> {
    let (mut outcomes, mut lines) = (Vec::new(), Vec::new());
    for line in printed.lines() {
        let Some(code) = line.strip_prefix(MARK) else {
            lines.push(line.trim_end().to_owned());
            continue;
        };
        while lines.last().is_some_and(String::is_empty) {
            lines.pop();
        }
        outcomes.push(Outcome { lines: std::mem::take(&mut lines), code: code.trim().parse()? });
    }
    Ok(outcomes)
}
