//! Command lines of cases, run in a folder.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use libtest_mimic::Failed;

/// The command lines of a case, with what they print on standard error and their exit codes; with
/// `all`, also what they print on standard output. `program` is the path of `lamplight`.
pub fn transcript(program: &str, case: &Path, all: bool) -> Result<String, Failed> {
    // The case runs in a copy: its outputs must not land in the repository, and the repository's
    // own configuration files must not be found.
    let folder = tempfile::tempdir()?;
    copy_folder(case, folder.path())?;
    let mut text = String::new();
    for line in
        fs::read_to_string(case.join("command"))?.lines().filter(|line| !line.trim().is_empty())
    {
        writeln!(text, "{line}")?;
        if !line.starts_with('#') {
            let output = run_line(program, folder.path(), line)?;
            if all {
                text += &String::from_utf8(output.stdout)?;
            }
            text += &String::from_utf8(output.stderr)?.replace("lamplight.exe", "lamplight");
            writeln!(text, "=> {}\n", output.status.code().ok_or("killed")?)?;
        }
    }
    let lines = text.lines().map(|line| line.trim_end().to_owned() + "\n");
    Ok(lines.collect::<String>().trim_end().to_owned())
}

/// Runs a program in a folder with the words of a line.
pub fn run_line(program: &str, folder: &Path, line: &str) -> Result<Output, Failed> {
    let mut command = Command::new(program);
    command.current_dir(folder).env("COLUMNS", "100").args(line.split_whitespace());
    Ok(command.output()?)
}

/// What a program printed on standard error.
pub fn stderr_text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn copy_folder(from: &Path, to: &Path) -> Result<(), Failed> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (path, name) = (entry.path(), entry.file_name());
        if path.is_dir() {
            copy_folder(&path, &to.join(name))?;
        } else {
            fs::copy(&path, to.join(name))?;
        }
    }
    Ok(())
}
