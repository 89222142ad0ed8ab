//! Snapshots, kept by insta under `snapshots/` in the folders of what they show.
//!
//! Review changes with `cargo insta review`, or accept them with `INSTA_UPDATE=always`.

use std::path::Path;

/// Compares with `snapshots/FOLDER/NAME.snap`; a difference fails with insta's own words.
pub fn check(folder: &str, name: &str, text: &str) -> Result<(), libtest_mimic::Failed> {
    let mut settings = insta::Settings::new();
    settings.set_snapshot_path(Path::new(env!("CARGO_MANIFEST_DIR")).join("snapshots").join(folder));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings
        .bind(|| std::panic::catch_unwind(|| insta::assert_snapshot!(name, text)))
        .map_err(|_| format!("snapshots/{folder}/{name}.snap differs").into())
}
