//! Finds several mistakes of one text. naga stops at the first one, so the text is validated again
//! without the declaration that has it. Where that is not known, each declaration is validated
//! alone, with only the declarations that it needs.

use std::cell::RefCell;
use std::collections::VecDeque;

use super::{Validated, is_small, read_text, validate_for_some};
use lamplight_bundle::Language;
use lamplight_compose::{Composed, PartKind};
use lamplight_diagnostic::{Code, Diagnostic, Diagnostics, codes};

/// A text with more declarations than this is searched only for its first mistake.
const PARTS: usize = 500;

/// After so many mistakes no more are looked for.
const MOST: usize = 20;

/// Errors that concern a text as a whole.
const STOPPING: [&Code; 4] =
    [codes::NAGA_INTERNAL, codes::NAGA_EXHAUSTED, codes::LIMIT_EXCEEDED, codes::NO_ENTRY_POINT];

/// As [`validate_for_some`], but continues after the first mistake. This is for a text that is probably
/// wrong, since naga runs again for each mistake.
///
/// # Errors
/// Each mistake once, in the order of the composed text's places.
pub fn validate_every(composed: &Composed) -> Result<Validated, Diagnostics> {
    // The checker of GLSL goes on after a mistake.
    if composed.language == Language::Glsl {
        return validate_for_some(composed);
    }
    // A large text is tried in another process, and so would be each of its parts.
    let is_small = is_small(composed).unwrap_or(false);
    let first = match if is_small { read_text(composed) } else { validate_for_some(composed) } {
        Ok(validated) => return Ok(validated),
        Err(errors) => errors,
    };
    let stops = |error: &Diagnostic| STOPPING.contains(&error.code);
    if !is_small || composed.parts.len() > PARTS || first.iter().any(stops) {
        return Err(first);
    }
    let mut search =
        MistakeSearch { composed, wrong: vec![false; composed.parts.len()], found: first };
    if !search.without_wrong() {
        search.one_by_one();
    }
    search.found.sort_by_key(|error| error.labels.first().map(|label| label.span));
    Err(search.found)
}

/// The mistakes that were found so far, and the parts that have them.
struct MistakeSearch<'c> {
    composed: &'c Composed,
    wrong: Vec<bool>,
    found: Diagnostics,
}

impl MistakeSearch<'_> {
    /// Reads the text again and again, each time without the parts whose mistakes are known and
    /// those that need them, until nothing is wrong. Returns false if it cannot go on: a mistake is
    /// not in a single part, or no new mistake is found.
    fn without_wrong(&mut self) -> bool {
        let mut errors = self.found.clone();
        while self.found.len() < MOST {
            let parts: Vec<_> = errors.iter().map(|error| self.part_of(error)).collect();
            let is_new = |part: &Option<usize>| part.is_some_and(|part| !self.wrong[part]);
            if parts.is_empty() || !parts.iter().all(is_new) {
                return false;
            }
            parts.into_iter().flatten().for_each(|part| self.wrong[part] = true);
            let needed = self.without_dependents();
            let rest = joined_parts(self.composed, &needed);
            if was_accepted(&rest) {
                return true;
            }
            match validate_for_some(&only_needed(self.composed, &needed)) {
                Ok(_) => {
                    keep_accepted(rest);
                    return true;
                }
                Err(new) => errors = self.take_new(new),
            }
        }
        true
    }

    /// The part that a mistake is in, if it is in one.
    fn part_of(&self, error: &Diagnostic) -> Option<usize> {
        let span = error.labels.first()?.span;
        let parts = &self.composed.parts;
        let segments = self.composed.map.segments().iter();
        let here = segments.filter(|segment| {
            let known = segment.span.filter(|known| known.source == span.source);
            known.is_some_and(|known| known.start <= span.start && span.start < known.end)
        });
        let mut found = None;
        for segment in here {
            let start = segment.start as usize;
            let part = parts.iter().position(|part| part.range.contains(&start))?;
            let is_whole = matches!(parts[part].kind, PartKind::Directive | PartKind::Other);
            if is_whole || found.is_some_and(|found| found != part) {
                return None;
            }
            found = Some(part);
        }
        found
    }

    /// Whether each part neither is wrong nor needs one that is.
    fn without_dependents(&self) -> Vec<bool> {
        let parts = &self.composed.parts;
        let mut users: Vec<Vec<usize>> = vec![Vec::new(); parts.len()];
        for (user, part) in parts.iter().enumerate() {
            part.uses.iter().for_each(|used| users[*used as usize].push(user));
        }
        let mut needed = vec![true; parts.len()];
        let mut open: Vec<usize> = (0..parts.len()).filter(|part| self.wrong[*part]).collect();
        while let Some(part) = open.pop() {
            if std::mem::replace(&mut needed[part], false) {
                open.extend(&users[part]);
            }
        }
        needed
    }

    /// Reads each part alone, with what it needs.
    fn one_by_one(&mut self) {
        for index in 0..self.composed.parts.len() {
            if self.found.len() >= MOST {
                break;
            }
            let needed = needed_parts(self.composed, index);
            // A mistake in a part is reported for that part, and not again for every part that
            // needs it.
            if needed.iter().zip(&self.wrong).any(|(needed, wrong)| *needed && *wrong) {
                continue;
            }
            let Err(errors) = validate_for_some(&only_needed(self.composed, &needed)) else {
                continue;
            };
            self.wrong[index] = true;
            self.take_new(errors);
        }
    }

    /// Adds mistakes that are not known yet, and returns those.
    fn take_new(&mut self, errors: Diagnostics) -> Diagnostics {
        let is_new = |error: &Diagnostic| {
            !STOPPING.contains(&error.code)
                && !error.labels.is_empty()
                && !self.found.iter().any(|known| same_mistake(known, error))
        };
        let new: Diagnostics = errors.into_iter().filter(is_new).collect();
        self.found.extend(new.iter().cloned());
        new
    }
}

thread_local! {
    /// The texts that naga accepted last after the parts with mistakes were left out, as
    /// [`joined_parts`] gives them. While an author edits one function, that rest stays the same.
    static ACCEPTED: RefCell<VecDeque<String>> = const { RefCell::new(VecDeque::new()) };
}

/// How many accepted texts are kept.
const KEPT: usize = 4;

fn was_accepted(rest: &String) -> bool {
    ACCEPTED.with_borrow(|accepted| accepted.contains(rest))
}

fn keep_accepted(rest: String) {
    ACCEPTED.with_borrow_mut(|accepted| {
        accepted.push_front(rest);
        accepted.truncate(KEPT);
    });
}

/// A key for what naga reads if only some parts are needed: the text without the other parts.
fn joined_parts(composed: &Composed, needed: &[bool]) -> String {
    let mut text = String::new();
    let mut at = 0;
    for (part, _) in composed.parts.iter().zip(needed).filter(|(_, needed)| !**needed) {
        let range = part.range.start.max(at)..part.range.end.max(at).min(composed.text.len());
        text += composed.text.get(at..range.start).unwrap_or_default();
        text.push('\n');
        at = range.end;
    }
    text + composed.text.get(at..).unwrap_or_default()
}

/// Whether two errors are the same mistake at the same place.
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
    let left_out = composed.parts.iter().zip(needed).filter(|(_, needed)| !**needed);
    for (part, _) in left_out {
        let range = part.range.start.min(bytes.len())..part.range.end.min(bytes.len());
        bytes[range].iter_mut().filter(|byte| **byte != b'\n').for_each(|byte| *byte = b' ');
    }
    let text = String::from_utf8(bytes).unwrap_or_default();
    Composed { text, ..composed.clone() }
}
