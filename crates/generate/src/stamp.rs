//! Whether a bundle is still as a run left it.

use std::fs::{self, Metadata};
use std::path::Path;

use lamplight_bundle::Bundle;
use lamplight_bundle::contents::{shortened_hash, to_hex};
use lamplight_files::input;

/// A larger output is not compared with an earlier one.
const MOST_BYTES: u64 = 4 << 30;

/// How closely a bundle is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// Blobs whose size, times and identity are those of the last run are not read.
    Cheap,
    /// Every byte is read.
    Whole,
}

/// What a bundle was when a run ended: its content, and what the file system says of its blobs.
/// The latter differs from machine to machine, so it is never in a bundle.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct BundleStamp {
    /// The hash of its file, or of its manifest, its index and the names of its blobs.
    content: String,
    /// The hash of the size, the times and the identity of each blob; empty for a single file,
    /// whose content is read in any case.
    blobs: String,
}

impl BundleStamp {
    /// The hash of what is in the bundle.
    pub fn content(&self) -> &str {
        &self.content
    }

    /// The present stamp of a bundle; `None` where there is none.
    pub fn of(out: &Path) -> Option<Self> {
        if !out.is_dir() {
            let content = blake3::hash(&input::read_file(out, MOST_BYTES).ok()?);
            return Some(Self { content: hex(&content), blobs: String::new() });
        }
        let mut content = blake3::Hasher::new();
        for name in ["manifest.json", "index.bin"] {
            content.update(&input::read_file(&out.join(name), MOST_BYTES).ok()?);
        }
        let entries = fs::read_dir(out.join("blobs")).ok()?;
        let files = entries.map(|entry| {
            let entry = entry.ok()?;
            Some((entry.file_name().into_string().ok()?, entry.metadata().ok()?))
        });
        let mut files = files.collect::<Option<Vec<_>>>()?;
        files.sort_unstable_by(|left, right| left.0.cmp(&right.0));
        let mut blobs = blake3::Hasher::new();
        for (name, found) in &files {
            for hasher in [&mut content, &mut blobs] {
                hasher.update(&(name.len() as u64).to_le_bytes()).update(name.as_bytes());
            }
            for number in numbers(found) {
                blobs.update(&number.to_le_bytes());
            }
        }
        Some(Self { content: hex(&content.finalize()), blobs: hex(&blobs.finalize()) })
    }

    /// The present stamp of the bundle, if the bundle is the one that this stamp is of. What the
    /// look does not vouch for is read.
    pub fn renewed(&self, out: &Path, look: Look) -> Option<Self> {
        let now = Self::of(out).filter(|now| now.content == self.content)?;
        let is_seen = !out.is_dir() || (look == Look::Cheap && now.blobs == self.blobs);
        let is_whole = || Bundle::open(out).and_then(|bundle| bundle.verify()).is_ok();
        (is_seen || is_whole()).then_some(now)
    }
}

/// What the file system says of a file. The time of the last change of its entry, which no program
/// can set, tells of most changes that leave the size and the other time as they were.
#[cfg(unix)]
fn numbers(found: &Metadata) -> [u64; 8] {
    use std::os::unix::fs::MetadataExt;
    [
        found.size(),
        found.mtime() as u64,
        found.mtime_nsec() as u64,
        found.ctime() as u64,
        found.ctime_nsec() as u64,
        found.dev(),
        found.ino(),
        u64::from(found.mode()),
    ]
}

#[cfg(not(unix))]
fn numbers(found: &Metadata) -> [u64; 3] {
    let modified = found.modified().ok();
    let since = modified.and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok());
    let since = since.unwrap_or_default();
    [found.len(), since.as_secs(), u64::from(since.subsec_nanos())]
}

fn hex(hash: &blake3::Hash) -> String {
    to_hex(&shortened_hash(hash))
}
