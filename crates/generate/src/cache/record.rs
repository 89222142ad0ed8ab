//! Results as bytes.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use snap::raw::{Decoder, Encoder, decompress_len};

use super::shortened_hash;
use lamplight_bundle::{Artifact, Hash, Native, Reflection, Unit};
use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, Label, Severity, codes};
use lamplight_files::limits::CACHE_BYTES;

pub const MAGIC: &[u8; 4] = b"LLC4";
const SUM_BYTES: usize = 16;

/// The most bytes of a record.
pub const MOST_RECORD_BYTES: u64 = CACHE_BYTES as u64;

/// The most bytes that a byte of Snappy can expand to. A record that claims more was not written by
/// this crate.
const MOST_RATIO: usize = 64;

/// Packs a payload, with a checksum over it and over its name; `None` where it is too large to be
/// kept.
pub fn seal_record(name: &str, payload: &[u8]) -> Option<Vec<u8>> {
    if payload.len() > CACHE_BYTES {
        return None;
    }
    let packed = Encoder::new().compress_vec(payload).ok()?;
    Some([MAGIC.as_slice(), &record_checksum(name, &packed), &packed].concat())
}

/// Unpacks the payload of a record that is undamaged and was written under that name.
pub fn open_record(name: &str, record: &[u8]) -> Option<Vec<u8>> {
    let (found, packed) = record.strip_prefix(MAGIC)?.split_first_chunk::<SUM_BYTES>()?;
    if record_checksum(name, packed) != *found {
        return None;
    }
    let most = CACHE_BYTES.min(packed.len().saturating_mul(MOST_RATIO));
    decompress_len(packed).ok().filter(|size| *size <= most)?;
    Decoder::new().decompress_vec(packed).ok()
}

/// The checksum of a record. It covers the name, so that a record that was moved to another name is
/// not taken for that result.
fn record_checksum(name: &str, packed: &[u8]) -> Hash {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&(name.len() as u64).to_le_bytes());
    hasher.update(name.as_bytes());
    hasher.update(packed);
    shortened_hash(&hasher.finalize())
}

/// What is written before the bytes of a unit's targets.
#[derive(Serialize, Deserialize)]
struct RecordHead<'a> {
    /// Whether there are warnings. They have a record of their own, since they have places, which
    /// the unit's key does not cover.
    has_warnings: bool,
    reflection: Cow<'a, Reflection>,
    targets: BTreeMap<Cow<'a, str>, TargetRecord<'a>>,
}

#[derive(Serialize, Deserialize)]
struct TargetRecord<'a> {
    extension: Cow<'a, str>,
    native: Cow<'a, Native>,
    bytes: usize,
}

/// A unit as bytes: the length of the head, the head, and the bytes of each target.
pub fn encode_unit(unit: &Unit, has_warnings: bool) -> Option<Vec<u8>> {
    let mut targets = BTreeMap::new();
    for (target, artifact) in &unit.targets {
        let extension = Cow::Borrowed(artifact.extension.as_str());
        let native = Cow::Borrowed(&*artifact.native);
        let part = TargetRecord { extension, native, bytes: artifact.bytes.len() };
        targets.insert(Cow::Borrowed(target.as_str()), part);
    }
    let head = RecordHead { has_warnings, reflection: Cow::Borrowed(&*unit.reflection), targets };
    let head = serde_json::to_vec(&head).ok()?;
    let mut payload = u32::try_from(head.len()).ok()?.to_le_bytes().to_vec();
    payload.extend_from_slice(&head);
    unit.targets.values().for_each(|artifact| payload.extend_from_slice(&artifact.bytes));
    Some(payload)
}

pub fn decode_unit(payload: &[u8]) -> Option<(Unit, bool)> {
    let (length, rest) = payload.split_first_chunk::<4>()?;
    let (head, mut rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
    let head: RecordHead = serde_json::from_slice(head).ok()?;
    let mut targets = BTreeMap::new();
    for (target, part) in head.targets {
        let (bytes, after) = rest.split_at_checked(part.bytes)?;
        rest = after;
        let native = Arc::new(part.native.into_owned());
        let extension = part.extension.into_owned();
        targets.insert(target.into_owned(), Artifact { bytes: bytes.into(), extension, native });
    }
    rest.is_empty().then_some((
        Unit { reflection: Arc::new(head.reflection.into_owned()), targets },
        head.has_warnings,
    ))
}

#[derive(Serialize, Deserialize)]
struct WarningRecord {
    is_warning: bool,
    code: String,
    message: String,
    labels: Vec<(u32, u32, u32, String)>,
    notes: Vec<String>,
}

pub fn encode_diagnostics(errors: &Diagnostics) -> Option<Vec<u8>> {
    let errors = errors.iter().map(|error| WarningRecord {
        is_warning: error.severity == Severity::Warning,
        code: error.code.name.to_owned(),
        message: error.message.clone(),
        labels: error
            .labels
            .iter()
            .map(|label| {
                (label.span.source.0, label.span.start, label.span.end, label.message.clone())
            })
            .collect(),
        notes: error.notes.clone(),
    });
    serde_json::to_vec(&errors.collect::<Vec<_>>()).ok()
}

/// Reads the diagnostics of a record, if all their places are in texts that `is_known`.
pub fn decode_diagnostics(
    payload: &[u8],
    is_known: impl Fn(SourceId) -> bool,
) -> Option<Diagnostics> {
    let errors: Vec<WarningRecord> = serde_json::from_slice(payload).ok()?;
    let is_placed = |diagnostic: &WarningRecord| {
        let mut labels = diagnostic.labels.iter();
        labels.all(|(source, start, end, _)| start <= end && is_known(SourceId(*source)))
    };
    if !errors.iter().all(is_placed) {
        return None;
    }
    errors.into_iter().map(decode_error).collect()
}

fn decode_error(error: WarningRecord) -> Option<Diagnostic> {
    let labels = error.labels.into_iter().map(|(source, start, end, message)| Label {
        span: Span { source: SourceId(source), start, end },
        message,
    });
    Some(Diagnostic {
        severity: if error.is_warning { Severity::Warning } else { Severity::Error },
        code: codes::find(&error.code)?,
        message: error.message,
        labels: labels.collect(),
        notes: error.notes,
        item: None,
    })
}
