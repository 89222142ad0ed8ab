//! Outlines, which are spaces and manifests without their lists, answer like the whole.

use std::fs;
use std::path::Path;

use lamplight_diagnostic::source::SourceSet;
use lamplight_permute::{Assignment, Space, manifest};
use libtest_mimic::Failed;

use super::laws::{ensure, random_spaces};

/// An outline has the valid points, keys and settings of the space, before anybody asks for them and
/// after; and all its valid points are wanted, since it has no lists.
pub fn of_spaces() -> Result<(), Failed> {
    for (index, space) in random_spaces(200).enumerate() {
        let outline = Space::outline(space.axes().to_vec(), space.constraints().to_vec());
        // Without constraints, every point of the product is valid.
        let product = Space::outline(space.axes().to_vec(), Vec::new()).enumerate();
        for point in product {
            same_point(&space, &outline, &point)
                .map_err(|what| format!("space {index}: {what}"))?;
        }
        let counts = [space.valid_count(), outline.valid_count(), outline.count()];
        ensure(counts.iter().all(|count| *count == counts[0]), format!("{index}: {counts:?}"))?;
    }
    Ok(())
}

fn same_point(space: &Space, outline: &Space, point: &Assignment) -> Result<(), String> {
    let what = space.key(point).to_string();
    let settings = [space, outline].map(|one| format!("{:?}", one.settings(point)));
    let broken = [space, outline].map(|one| one.broken(point).count());
    let valid = [space, outline].map(|one| one.is_valid(point));
    let is_same = settings[0] == settings[1]
        && broken[0] == broken[1]
        && valid[0] == valid[1]
        && what == outline.key(point).to_string();
    if is_same { Ok(()) } else { Err(format!("`{what}`: {settings:?} {broken:?} {valid:?}")) }
}

/// The outline of each manifest that can be read has its programs, with the same files, targets,
/// conventions and settings.
pub fn of_manifests() -> Result<(), Failed> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/permute");
    let mut read = 0;
    for entry in fs::read_dir(folder)? {
        let path = entry?.path().join("manifest.toml");
        let Ok(text) = fs::read_to_string(&path) else { continue };
        let mut sources = SourceSet::default();
        let id = sources.add("lamplight.toml", text);
        let Ok(whole) = manifest::parse(&sources, id) else { continue };
        let outline = manifest::parse_outline(&sources, id)
            .map_err(|_| format!("{}: no outline", path.display()))?;
        ensure(whole.programs.len() == outline.programs.len(), path.display().to_string())?;
        for (program, other) in whole.programs.iter().zip(&outline.programs) {
            let facts = [program, other].map(|one| {
                let files: Vec<&str> = one.files().map(|file| file.path.as_str()).collect();
                let default = one.space.default_assignment();
                let settings = one.space.settings(&default);
                format!(
                    "{} {files:?} {:?} {:?} {settings:?}",
                    one.name, one.targets, one.conventions
                )
            });
            ensure(facts[0] == facts[1], format!("{facts:?}"))?;
            for point in program.space.enumerate().iter().take(100) {
                same_point(&program.space, &other.space, point)?;
            }
        }
        read += 1;
    }
    ensure(read > 10, format!("{read} manifests were read"))
}
