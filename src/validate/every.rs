//! Finds several mistakes of one text. naga stops at the first one, so each declaration is also
//! validated alone, with only the declarations that it needs.

use super::{Validated, is_calm, validate};
use crate::bundle::Language;
use crate::compose::{Composed, Part, PartKind};
use crate::diagnostic::{Code, Diagnostic, Diagnostics, codes};
use crate::source::SourceId;

/// A text with this many declarations is searched only for its first mistake.
const PARTS: usize = 500;

/// After so many mistakes no more are looked for.
const MOST: usize = 20;

/// Errors that concern a text as a whole.
const STOPPING: [&Code; 4] =
    [codes::NAGA_INTERNAL, codes::NAGA_EXHAUSTED, codes::LIMIT_EXCEEDED, codes::NO_ENTRY_POINT];

/// As [`validate`], but continues after the first mistake. This is for a text that is probably
/// wrong, since after a mistake naga runs once for each declaration.
///
/// # Errors
/// Each mistake once, in the order of the composed text's places.
pub fn every(composed: &Composed) -> Result<Validated, Diagnostics> {
    every_wanted(composed, |_| true)
}

/// As [`every`], for the mistakes in one file: after a mistake, naga runs only for its declarations.
///
/// # Errors
/// Those of [`every`] in that file. Others may be among them.
pub fn every_in(composed: &Composed, source: SourceId) -> Result<Validated, Diagnostics> {
    every_wanted(composed, |part| composed.map.is_from(part.range.clone(), source))
}

fn every_wanted(
    composed: &Composed,
    is_wanted: impl Fn(&Part) -> bool,
) -> Result<Validated, Diagnostics> {
    let first = match validate(composed) {
        Ok(validated) => return Ok(validated),
        Err(errors) => errors,
    };
    let stops = |error: &Diagnostic| STOPPING.contains(&error.code);
    // A large text is tried in another process, and so would be each of its parts.
    let is_calm = is_calm(composed).unwrap_or(false);
    if !is_calm || composed.parts.len() > PARTS || first.iter().any(stops) {
        return Err(first);
    }
    let mut found = first;
    let mut wrong = vec![false; composed.parts.len()];
    for (index, _) in composed.parts.iter().enumerate().filter(|(_, part)| is_wanted(part)) {
        if found.len() >= MOST {
            break;
        }
        let needed = needed_parts(composed, index);
        // A mistake in a part is reported for that part, and not again for every part that needs
        // it.
        if needed.iter().zip(&wrong).any(|(needed, wrong)| *needed && *wrong) {
            continue;
        }
        let Err(errors) = validate(&only_needed(composed, &needed)) else { continue };
        wrong[index] = true;
        let new = errors.into_iter().filter(|error| {
            !stops(error)
                && !error.labels.is_empty()
                && !found.iter().any(|known| same_mistake(known, error))
        });
        found.extend(new.collect::<Vec<_>>());
    }
    found.sort_by_key(|error| error.labels.first().map(|label| label.span));
    Err(found)
}

/// The same mistake at the same place.
fn same_mistake(one: &Diagnostic, other: &Diagnostic) -> bool {
    one.code == other.code
        && one.labels.first().map(|label| label.span)
            == other.labels.first().map(|label| label.span)
}

/// A part, everything that it names, and what concerns the text as a whole.
fn needed_parts(composed: &Composed, index: usize) -> Vec<bool> {
    let whole = |kind| matches!(kind, PartKind::Directive | PartKind::Other);
    let mut needed: Vec<bool> = composed.parts.iter().map(|part| whole(part.kind)).collect();
    let mut open = vec![index as u32];
    while let Some(next) = open.pop() {
        if !std::mem::replace(&mut needed[next as usize], true) {
            open.extend(&composed.parts[next as usize].uses);
        }
    }
    needed
}

/// The text with blanks instead of what is not needed, so that places do not change.
fn only_needed(composed: &Composed, needed: &[bool]) -> Composed {
    let mut bytes = composed.text.clone().into_bytes();
    let left_out = || composed.parts.iter().zip(needed).filter(|(_, needed)| !**needed);
    for (part, _) in left_out() {
        let range = part.range.start.min(bytes.len())..part.range.end.min(bytes.len());
        bytes[range].iter_mut().filter(|byte| **byte != b'\n').for_each(|byte| *byte = b' ');
    }
    let main = |names: &[String]| names.iter().any(|name| name == "main");
    if composed.language == Language::Glsl && left_out().any(|(part, _)| main(&part.names)) {
        bytes.extend_from_slice(b"\nvoid main() {}\n");
    }
    let text = String::from_utf8(bytes).unwrap_or_default();
    Composed { text, ..composed.clone() }
}
