//! What is done in one place only.

use std::path::Path;

use libtest_mimic::Failed;

use crate::{ROOT, rust_files};

/// Commands print through `src/cli/terminal.rs`, which escapes control characters.
pub fn to_the_terminal() -> Result<(), Failed> {
    let mut files = Vec::new();
    rust_files(&Path::new(ROOT).join("src/cli"), &mut files)?;
    let names_a_stream = |line: &str| {
        let imports = line.starts_with("use std::io")
            && ["stdout", "stderr"].iter().any(|stream| line.contains(stream));
        imports || line.contains("io::stdout(") || line.contains("io::stderr(")
    };
    let mut found = Vec::new();
    for file in files.iter().filter(|file| !file.ends_with("terminal.rs")) {
        let text = std::fs::read_to_string(file)?;
        if let Some(line) = text.lines().find(|line| names_a_stream(line)) {
            found.push(format!("{}: {line}", file.display()));
        }
    }
    match found.is_empty() {
        true => Ok(()),
        false => Err(format!("use `cli::terminal` instead:\n{}", found.join("\n")).into()),
    }
}

/// Finished files are renamed by `output::rename_finished` alone.
pub fn to_rename() -> Result<(), Failed> {
    let mut files = Vec::new();
    for folder in ["src", "crates"] {
        rust_files(&Path::new(ROOT).join(folder), &mut files)?;
    }
    files.retain(|file| !file.components().any(|part| part.as_os_str() == "tests"));
    let mut found = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(&file)?;
        let calls = text.lines().filter(|line| line.contains("fs::rename(")).count();
        found.extend((calls > 0).then(|| (file.strip_prefix(ROOT).map(Path::to_owned), calls)));
    }
    match &found[..] {
        [(Ok(file), 1)] if file == Path::new("crates/files/src/output/mod.rs") => Ok(()),
        _ => Err(format!(
            "expected one call of `fs::rename`, in crates/files/src/output, found {found:?}"
        )
        .into()),
    }
}
