//! Snapshots, which insta keeps in the folders of `snapshots/`.
//!
//! Review changes with `cargo insta review`, or accept them with `INSTA_UPDATE=always`.

use std::path::{Path, PathBuf};

/// The workspace's root.
pub fn root() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// Compares a text with `snapshots/FOLDER/NAME.snap`. insta prints the difference.
pub fn check(folder: &str, name: &str, text: &str) -> Result<(), libtest_mimic::Failed> {
    let mut settings = insta::Settings::new();
    settings.set_snapshot_path(root().join("snapshots").join(folder));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings
        .bind(|| std::panic::catch_unwind(|| insta::assert_snapshot!(name, text)))
        .map_err(|_| format!("snapshots/{folder}/{name}.snap differs, as printed above").into())
}

/// The cases of `tests/FOLDER`, which are its folders, sorted by name.
pub fn cases(folder: &str) -> Vec<(String, PathBuf)> {
    let mut found: Vec<(String, PathBuf)> = std::fs::read_dir(root().join("tests").join(folder))
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| (entry.file_name().to_string_lossy().into_owned(), entry.path()))
        .filter(|(_, path): &(String, PathBuf)| Path::is_dir(path))
        .collect();
    found.sort();
    found
}
