//! A directory that a killed run left between its two renames: the index is the next bundle's, the
//! manifest still the older one's. Whatever later runs do there, the blobs of both stay until an
//! index and a manifest of one bundle are in place.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use lamplight_bundle::{Bundle, DirectoryWriter, write_directory};

use super::{Outcome, check, fewer, small};

/// The scratch folder that the killed run left, with the mark that says whose it is.
const SCRATCH: &str = ".lamplight-0123456789abcdef";
const MARK: &str = "Lamplight: files of a run that is not over. Delete this folder if none is.\n";

pub fn between_the_renames() -> Outcome {
    let folder = tempfile::tempdir()?;
    let bundle = folder.path().join("bundle");
    write_directory(&fewer(), &bundle)?;
    stop_between_the_renames(&bundle)?;
    Bundle::open(&bundle)?.verify()?;
    let both = blobs(&bundle)?;
    // Runs that end before they write anything.
    for _ in 0..2 {
        drop(DirectoryWriter::create(&bundle)?);
        check(!bundle.join(SCRATCH).exists(), "the folder is not taken for one of a killed run")?;
        Bundle::open(&bundle)?.verify()?;
        check(blobs(&bundle)? == both, "a run that wrote nothing removed blobs")?;
    }
    // A run that ends well names one bundle, and the run after it removes what is left of the other.
    for _ in 0..2 {
        write_directory(&fewer(), &bundle)?;
        Bundle::open(&bundle)?.verify()?;
    }
    let fresh = folder.path().join("fresh");
    write_directory(&fewer(), &fresh)?;
    check(blobs(&bundle)? == blobs(&fresh)?, "blobs that no bundle names were left")
}

/// Leaves what a run that writes `small` leaves if it is killed after it has renamed the index.
fn stop_between_the_renames(bundle: &Path) -> Outcome {
    let finished = tempfile::tempdir()?;
    write_directory(&small(), finished.path())?;
    for name in blobs(finished.path())? {
        let name = Path::new("blobs").join(name);
        fs::copy(finished.path().join(&name), bundle.join(&name))?;
    }
    fs::copy(finished.path().join("index.bin"), bundle.join("index.bin"))?;
    fs::create_dir(bundle.join(SCRATCH))?;
    fs::write(bundle.join(SCRATCH).join("mark"), MARK)?;
    let manifest = bundle.join(SCRATCH).join("manifest.json");
    fs::copy(finished.path().join("manifest.json"), manifest)?;
    Ok(())
}

fn blobs(bundle: &Path) -> std::io::Result<BTreeSet<std::ffi::OsString>> {
    fs::read_dir(bundle.join("blobs"))?.map(|entry| Ok(entry?.file_name())).collect()
}
