//! Lists the library's files, so that an installed program carries them.

#![allow(clippy::print_stdout)]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Endings of the files that are text: modules, programs and what is said about them.
const TEXTS: [&str; 4] = ["wesl", "wgsl", "glsl", "toml"];

fn main() -> io::Result<()> {
    let folder = |name| env::var_os(name).map(PathBuf::from).ok_or(io::ErrorKind::NotFound);
    let (root, out) = (folder("CARGO_MANIFEST_DIR")?, folder("OUT_DIR")?);
    let mut files = Vec::new();
    collect_files(&root, &root, &mut files)?;
    files.sort();
    let is_text = |name: &str| TEXTS.iter().any(|ending| name.ends_with(&format!(".{ending}")));
    let is_table = |name: &str| name.ends_with(".bin");
    let mut table = String::new();
    let texts =
        "/// Path and text of every file that is text, by path.\npub const FILES: &[(&str, &str)]";
    let tables = "/// Path and bytes of every precomputed table, by path.\npub const TABLES: &[(&str, &[u8])]";
    write_list(&mut table, texts, "include_str", files.iter().filter(|(name, _)| is_text(name)));
    write_list(
        &mut table,
        tables,
        "include_bytes",
        files.iter().filter(|(name, _)| is_table(name)),
    );
    fs::write(out.join("files.rs"), table)
}

fn write_list<'a>(
    table: &mut String,
    head: &str,
    include: &str,
    files: impl Iterator<Item = &'a (String, PathBuf)>,
) {
    let _ = writeln!(table, "{head} = &[");
    for (name, path) in files {
        let _ = writeln!(table, "    ({name:?}, {include}!({path:?})),");
    }
    table.push_str("];\n");
}

/// The files below a folder, with their paths below the root. Those paths have `/` and are text:
/// lookups compare text, which sorts otherwise than a `Path` (`a/b` before `a.b`).
fn collect_files(root: &Path, folder: &Path, files: &mut Vec<(String, PathBuf)>) -> io::Result<()> {
    println!("cargo::rerun-if-changed={}", folder.display());
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let below = path.strip_prefix(root).unwrap_or(&path);
        let name = below.to_string_lossy().replace('\\', "/");
        if path.is_dir() {
            collect_files(root, &path, files)?;
        } else if name != "Cargo.toml" {
            files.push((name, path));
        }
    }
    Ok(())
}
