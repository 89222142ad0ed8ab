//! `lamplight init [DIR]`: a package to start from.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::Failure;
use crate::cli::terminal::stdout;
use crate::output::{self, Replace};

/// Write a package with a shader, a manifest and a numeric case.
#[derive(Args)]
pub struct Arguments {
    /// The folder of the package; it is made if it is not there.
    #[arg(default_value = ".")]
    folder: PathBuf,
}

/// Files of the package; `NAME` in them is its name.
const FILES: &[(&str, &str)] = &[
    ("wesl.toml", include_str!("package/wesl.toml.in")),
    ("lamplight.toml", include_str!("package/lamplight.toml.in")),
    ("shaders/lamp.wesl", include_str!("package/lamp.wesl.in")),
    ("shaders/falloff.wesl", include_str!("package/falloff.wesl.in")),
    ("shaders/falloff.toml", include_str!("package/falloff.toml.in")),
];

pub fn run_init(arguments: Arguments) -> Result<(), Failure> {
    let folder = &arguments.folder;
    // All or nothing: nothing is written if a file of the package is there already.
    if let Some((path, _)) =
        FILES.iter().find(|(path, _)| folder.join(path).symlink_metadata().is_ok())
    {
        return Err(Failure::input(format!(
            "`{}` is there already\nhelp: name another folder, such as `lamplight init lamps`",
            folder.join(path).display()
        )));
    }
    let name = package_name(folder);
    for (path, text) in FILES {
        let path = folder.join(path);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|error| {
                Failure::environment(format!("cannot write `{}`: {error}", folder.display()))
            })?;
        }
        let text = text.replace("NAME", &name);
        output::write_file(&path, text.as_bytes(), |_| false, Replace::Ours)?;
        writeln!(stdout(), "{}", path.display())?;
    }
    let enter = if folder == Path::new(".") {
        String::new()
    } else {
        format!("cd {} && ", folder.display())
    };
    Ok(writeln!(stdout(), "next: {enter}lamplight lint && lamplight check && lamplight gen")?)
}

/// The folder's name in the form of a package's name.
fn package_name(folder: &Path) -> String {
    let real = folder.canonicalize().or_else(|_| std::path::absolute(folder));
    let last = real.ok().and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
    let fits = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
    let name: String = last.unwrap_or_default().to_lowercase().chars().map(fits).collect();
    let name = name.trim_matches('_');
    match name.chars().next() {
        Some(first) if first.is_ascii_alphabetic() && name != "lamplight" => name.to_owned(),
        _ => "shaders".to_owned(),
    }
}
