//! Compares our composer with the `wesl` crate: from the same modules, both must give texts of the
//! same meaning.
//!
//! The texts differ in names, order and comments, so naga parses both, and they are compared in a
//! canonical form. The known disagreements are listed in [`ACCEPTED`].

mod library;
mod normal;
mod peer;
mod tree;

use lamplight::compose::Mangle;
use libtest_mimic::{Failed, Trial};

use normal::normal;
use peer::{Files, Flags, Peer};

/// The number of generated module trees.
const TREES: u64 = 240;
/// The number of tests that share them, so that they run in parallel.
const TESTS: u64 = 8;

/// Differences that are accepted: a part of the message that shows one, and why our side is right.
const ACCEPTED: &[(&str, &str)] = &[(
    "only lamplight refuses: error[name-conflict]",
    "an override keeps its name, since an engine sets it by that; wesl renames it, as it does all that is imported",
)];

/// How many texts were compared, and for how many of them both composers gave a text.
#[derive(Default)]
struct Tally {
    all: usize,
    composed: usize,
}

pub fn tests() -> Vec<Trial> {
    let part = |part: u64| {
        Trial::test(format!("differential::trees_{part}"), move || {
            trees((part..TREES).step_by(TESTS as usize))
        })
    };
    (0..TESTS).map(part).chain(library::tests()).collect()
}

fn trees(seeds: impl Iterator<Item = u64>) -> Result<(), Failed> {
    let (mut failures, mut tally) = (Vec::new(), Tally::default());
    for seed in seeds {
        let tree = tree::tree(seed);
        let mut peer = Peer::new(&tree.files);
        for flags in &tree.flags {
            for mangle in [Mangle::Collisions, Mangle::Underscore] {
                if let Some(difference) =
                    difference(&tree.files, tree.root, flags, mangle, &mut peer, &mut tally)
                {
                    failures.push(format!(
                        "tree {seed}, {mangle:?}, {}\n{difference}\n{}",
                        shown(flags),
                        texts(&tree.files)
                    ));
                }
            }
        }
    }
    match failures.first() {
        // If both composers refuse a tree, nothing is compared. That must be rare.
        None if tally.composed * 10 < tally.all * 9 => {
            let (composed, all) = (tally.composed, tally.all);
            Err(format!("both composers accept only {composed} of {all}, expected 90 %").into())
        }
        None => Ok(()),
        Some(first) => Err(format!("{} differences; the first: {first}", failures.len()).into()),
    }
}

fn difference(
    files: &Files,
    root: &str,
    flags: &Flags,
    mangle: Mangle,
    peer: &mut Peer,
    tally: &mut Tally,
) -> Option<String> {
    let ours = peer::lamplight(files, root, flags, mangle);
    let theirs = peer.compose(root, flags);
    tally.all += 1;
    tally.composed += usize::from(ours.is_ok() && theirs.is_ok());
    match (ours, theirs) {
        (Ok(ours), Ok(theirs)) => compare(&ours, &theirs),
        (Err(_), Err(_)) => None,
        (Err(error), Ok(_)) => unless_accepted(format!("only lamplight refuses: {error}")),
        (Ok(_), Err(error)) => unless_accepted(format!("only wesl refuses: {error}")),
    }
}

fn compare(ours: &str, theirs: &str) -> Option<String> {
    let (our_meaning, their_meaning) = (normal(ours), normal(theirs));
    if our_meaning == their_meaning && our_meaning.is_ok() {
        return None;
    }
    let meaning = |meaning: Result<String, String>| meaning.unwrap_or_else(|error| error);
    let words = format!(
        "--- lamplight\n{ours}\n--- wesl\n{theirs}\n--- meaning, lamplight\n{}\n--- meaning, wesl\n{}",
        meaning(our_meaning),
        meaning(their_meaning)
    );
    unless_accepted(words)
}

fn unless_accepted(difference: String) -> Option<String> {
    let accepted = ACCEPTED.iter().any(|(words, _)| difference.contains(words));
    (!accepted).then_some(difference)
}

fn shown(flags: &Flags) -> String {
    flags.iter().filter(|(_, on)| **on).map(|(name, _)| format!("{name} ")).collect()
}

fn texts(files: &Files) -> String {
    files.iter().map(|((package, path), text)| format!("=== {package}/{path}\n{text}\n")).collect()
}
