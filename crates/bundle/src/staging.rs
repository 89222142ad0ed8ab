//! Blobs as files, before the bundle that they are for is there.

use std::collections::BTreeSet;

use super::directory::{BlobFile, blob_files_of_manifest};
use super::manifest::Manifest;
use super::{Contents, Digest, Digester, Error, Unit};
use lamplight_files::limits::GROUP_BYTES;
use lamplight_files::output::Scratch;

/// Writes the blobs of a bundle into a scratch folder: for tools that take files.
pub fn stage_blobs(contents: &Contents, scratch: &Scratch) -> Result<BTreeSet<BlobFile>, Error> {
    let (digester, mut manifest) = (Digester::default(), Manifest::default());
    let mut staged = BTreeSet::new();
    let mut stage = |name: String, bytes: &[u8]| {
        if staged.insert(name.clone()) {
            scratch.stage(&name, bytes)?;
        }
        Ok(())
    };
    for unit in contents.entries().flat_map(|entry| entry.units.values()) {
        manifest.absorb(add_unit(&digester, unit, &mut stage)?.1);
    }
    blob_files_of_manifest(&manifest, &|name| scratch.path(name))
}

/// Called with the name and the bytes of a blob.
type StageBlob<'s> = &'s mut dyn FnMut(String, &[u8]) -> Result<(), Error>;

/// Passes the name and the bytes of each blob of a unit to `stage`. Returns the unit's digest, and a
/// manifest with this unit alone.
pub(super) fn add_unit(
    digester: &Digester,
    unit: &Unit,
    stage: StageBlob<'_>,
) -> Result<(Digest, Manifest), Error> {
    let digest = digester.digest(unit)?;
    if let Some(found) = digest.targets.iter().find(|found| found.length as usize > GROUP_BYTES) {
        let bytes = found.length;
        return Err(Error::Io(format!("a blob of {bytes} bytes is larger than a bundle takes")));
    }
    let mut part = Manifest::default();
    part.add_unit(&digest, unit)?;
    for (target, named) in part.units.values().flat_map(|unit| &unit.targets) {
        if let Some(artifact) = unit.targets.get(target) {
            stage(named.file()?, &artifact.bytes)?;
        }
    }
    Ok((digest, part))
}
