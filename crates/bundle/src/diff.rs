//! What differs between two bundles.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::{Contents, EntryContents, Language, Unit};

/// Everything that differs, sorted.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// Programs whose axes changed.
    pub axes: Vec<String>,
    /// Permutations that changed, were added or removed.
    pub permutations: Vec<Change>,
}

/// One permutation of one entry point that differs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Change {
    /// Name of the program.
    pub program: String,
    /// Language of the source.
    pub language: Language,
    /// Name of the entry point.
    pub entry: String,
    /// Key of the permutation.
    pub key: String,
    /// `added`, `removed`, or `changed`.
    pub kind: &'static str,
    /// For `changed`: `reflection` if it changed, and the targets whose bytes or names changed.
    pub parts: Vec<String>,
}

impl Difference {
    /// Whether the bundles have equal contents.
    pub fn is_empty(&self) -> bool {
        self.axes.is_empty() && self.permutations.is_empty()
    }
}

/// Compares `new` with `old`.
pub fn diff(old: &Contents, new: &Contents) -> Difference {
    let mut difference = Difference::default();
    let programs: BTreeSet<&String> = old.programs.keys().chain(new.programs.keys()).collect();
    for program in programs {
        let [before, after] = [old, new].map(|contents| {
            contents.programs.get(program).map_or(&[][..], |program| program.axes.as_slice())
        });
        if before != after {
            difference.axes.push(program.clone());
        }
        let (before, after) = (entries_by_place(old, program), entries_by_place(new, program));
        let places: BTreeSet<_> = before.keys().chain(after.keys()).copied().collect();
        for place in places {
            compare_entries(
                program,
                place,
                before.get(&place).copied(),
                after.get(&place).copied(),
                &mut difference.permutations,
            );
        }
    }
    difference
}

type EntryPlace<'a> = (Language, &'a str);

fn entries_by_place<'a>(
    contents: &'a Contents,
    program: &str,
) -> BTreeMap<EntryPlace<'a>, &'a EntryContents> {
    let languages =
        contents.programs.get(program).into_iter().flat_map(|program| &program.languages);
    languages
        .flat_map(|(language, entries)| {
            entries.iter().map(|(name, entry)| ((*language, name.as_str()), entry))
        })
        .collect()
}

fn compare_entries(
    program: &str,
    place: EntryPlace<'_>,
    old: Option<&EntryContents>,
    new: Option<&EntryContents>,
    changes: &mut Vec<Change>,
) {
    let none = BTreeMap::new();
    let [before, after] = [old, new].map(|entry| entry.map_or(&none, |entry| &entry.keys));
    let all: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
    for key in all {
        let (kind, parts) = match (before.get(key), after.get(key)) {
            (Some(one), Some(other)) if one == other => continue,
            (None, _) => ("added", Vec::new()),
            (_, None) => ("removed", Vec::new()),
            (Some(one), Some(other)) => (
                "changed",
                changed_parts(
                    old.and_then(|entry| entry.units.get(one)),
                    new.and_then(|entry| entry.units.get(other)),
                ),
            ),
        };
        changes.push(Change {
            program: program.to_owned(),
            language: place.0,
            entry: place.1.to_owned(),
            key: key.clone(),
            kind,
            parts,
        });
    }
}

fn changed_parts(old: Option<&Unit>, new: Option<&Unit>) -> Vec<String> {
    let (Some(old), Some(new)) = (old, new) else { return Vec::new() };
    let reflection = (old.reflection != new.reflection).then(|| "reflection".to_owned());
    let targets: BTreeSet<&String> = old.targets.keys().chain(new.targets.keys()).collect();
    let targets = targets
        .into_iter()
        .filter(|target| old.targets.get(*target) != new.targets.get(*target))
        .cloned();
    reflection.into_iter().chain(targets).collect()
}
