//! Computes the identity of the build, which the caches of results depend on.

#![allow(clippy::print_stdout)]

use std::path::PathBuf;
use std::{env, fs, io};

use lamplight_build::identity::{build_identity, source_folders};

fn main() -> io::Result<()> {
    let folder = |name| env::var_os(name).map(PathBuf::from).ok_or(io::ErrorKind::NotFound);
    let (root, out) = (folder("CARGO_MANIFEST_DIR")?, folder("OUT_DIR")?);
    // The lock file of the workspace that is built, which need not be this crate's.
    let mut folders = out.ancestors().chain([root.as_path()]);
    let lock = folders.find_map(|folder| fs::read(folder.join("Cargo.lock")).ok());
    let mut settings = vec![lock.unwrap_or_default()];
    for variable in ["CARGO_PKG_VERSION", "TARGET"] {
        settings.push(env::var(variable).unwrap_or_default().into_bytes());
    }
    // Machines of several kinds may share the work for one bundle.
    let version = env::var("CARGO_PKG_VERSION").unwrap_or_default();
    let tool = build_identity(&root, &settings[..2])?;
    println!("cargo::rustc-env=LAMPLIGHT_TOOL={version} {tool}");
    for folder in source_folders(&root)? {
        println!("cargo::rerun-if-changed={}", folder.display());
    }
    println!("cargo::rerun-if-changed={}", root.join("Cargo.lock").display());
    println!("cargo::rustc-env=LAMPLIGHT_BUILD={}", build_identity(&root, &settings)?);
    Ok(())
}
