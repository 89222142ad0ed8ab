//! One bundle of several, and one permutation into a bundle.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::Path;

use super::directory_writer::DirectoryWriter;
use super::{Bundle, Contents, EntryContents, Error, ProgramContents};

/// The contents of several bundles in one. Every byte of them is verified first.
///
/// # Errors
/// [`Error::Conflict`] if two bundles have different shaders for a key, or different axes for a
/// program, or if they are shards that were not made of the same.
pub fn merge(bundles: &[Bundle]) -> Result<Contents, Error> {
    bundles.iter().try_for_each(Bundle::verify)?;
    merge_contents(bundles.iter().map(Bundle::contents))
}

fn merge_contents(
    mut bundles: impl Iterator<Item = Result<Contents, Error>>,
) -> Result<Contents, Error> {
    let Some(first) = bundles.next() else { return Ok(Contents::default()) };
    let mut all = first?;
    bundles.try_for_each(|next| all.merge(next?))?;
    // The parts of a whole bundle leave no trace in it.
    all.shard = all.shard.filter(|origin| origin.missing().is_some());
    Ok(all)
}

/// [`merge`] into the directory form, unit by unit: memory holds keys and hashes only.
pub fn merge_into(bundles: &[Bundle], writer: DirectoryWriter) -> Result<(), Error> {
    bundles.iter().try_for_each(Bundle::verify)?;
    let all = merge_contents(bundles.iter().map(|bundle| copy_units(bundle, &writer)))?;
    writer.finish(&all)
}

/// Adds permutations to a bundle that is a directory, or replaces those with the same keys. All
/// other permutations stay. Units that no key refers to any more stay too, until the whole bundle
/// is written again.
pub fn patch_directory(contents: &Contents, path: impl AsRef<Path>) -> Result<(), Error> {
    let writer = DirectoryWriter::reopen(path)?;
    writer.add_all(contents)?;
    writer.patch(contents)
}

/// Writes the units of a bundle. Returns its programs and keys, without the units.
fn copy_units(bundle: &Bundle, writer: &DirectoryWriter) -> Result<Contents, Error> {
    let mut contents = Contents { shard: bundle.shard().cloned(), ..Contents::default() };
    let mut digests = BTreeMap::new();
    for name in bundle.programs() {
        let program = bundle.program(name)?;
        let mut copied =
            ProgramContents { axes: program.axes().to_vec(), ..ProgramContents::default() };
        for (language, entry) in program.entries() {
            let mut keys = BTreeMap::new();
            for (key, number) in program.entry(language, entry)?.numbered()? {
                if let Entry::Vacant(digest) = digests.entry(number) {
                    digest.insert(writer.add(&bundle.unit(number)?)?.unit);
                }
                keys.extend(digests.get(&number).map(|unit| (key, *unit)));
            }
            copied
                .languages
                .entry(language)
                .or_default()
                .insert(entry.to_owned(), EntryContents { units: BTreeMap::new(), keys });
        }
        contents.programs.insert(name.to_owned(), copied);
    }
    Ok(contents)
}
