//! The next generation of a bundle, for engines that draw while shaders are edited.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

use super::diff::{Change, Difference};
use super::loader::{self, Bundle};
use super::store::{Store, StoredUnit};
use super::{Error, Language};

impl Bundle {
    /// Reads the bundle again from where it was opened, and tells which permutations have changed:
    /// their pipelines must be made again.
    ///
    /// A bundle is replaced as a whole, so everything read before belongs to one generation, and
    /// everything read afterwards to the next. On an error, such as a file that is being copied,
    /// the bundle stays at its present generation. A bundle from memory never changes.
    ///
    /// # Errors
    /// Those of [`Bundle::open`].
    ///
    /// ```no_run
    /// # fn main() -> Result<(), lamplight_bundle::Error> {
    /// let mut bundle = lamplight_bundle::Bundle::open("live.lamplight")?;
    /// for change in bundle.reload()?.permutations {
    ///     println!("{} {} `{}`: {}", change.program, change.entry, change.key, change.kind);
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn reload(&mut self) -> Result<Difference, Error> {
        let Some(path) = self.path() else { return Ok(Difference::default()) };
        let next = loader::store_of(path)?;
        let difference = compare_stores(self.store(), &*next)?;
        self.replace_store(next);
        Ok(difference)
    }
}

/// An entry point of a program.
type EntryPointName = (String, Language, String);

fn compare_stores(old: &dyn Store, new: &dyn Store) -> Result<Difference, Error> {
    let mut difference = Difference::default();
    let names: BTreeSet<&String> = old.programs().keys().chain(new.programs().keys()).collect();
    for name in names {
        let (before, after) = (old.programs().get(name), new.programs().get(name));
        if before.map(|program| &program.axes) != after.map(|program| &program.axes) {
            difference.axes.push(name.clone());
        }
        let places =
            [before, after].into_iter().flatten().flat_map(|program| program.entries.keys());
        for (language, entry) in places.collect::<BTreeSet<_>>() {
            let place = (name.clone(), *language, entry.clone());
            let number = |program: Option<&super::store::StoredProgram>| {
                program
                    .and_then(|program| program.entries.get(&(*language, entry.clone())).copied())
            };
            let sides = (keys_of_entry(old, number(before))?, keys_of_entry(new, number(after))?);
            difference.permutations.extend(entry_changes(old, new, &place, &sides)?);
        }
    }
    Ok(difference)
}

fn keys_of_entry(store: &dyn Store, entry: Option<usize>) -> Result<BTreeMap<String, u32>, Error> {
    let mut keys = BTreeMap::new();
    if let Some(entry) = entry {
        store.each_key(entry, &mut |key, unit| {
            keys.insert(key.to_owned(), unit);
        })?;
    }
    Ok(keys)
}

/// What changed of one entry point. Many keys share a unit, which is compared once.
fn entry_changes(
    old: &dyn Store,
    new: &dyn Store,
    (program, language, entry): &EntryPointName,
    (before, after): &(BTreeMap<String, u32>, BTreeMap<String, u32>),
) -> Result<Vec<Change>, Error> {
    let mut known: BTreeMap<(u32, u32), Vec<String>> = BTreeMap::new();
    let mut found = Vec::new();
    for key in before.keys().chain(after.keys()).collect::<BTreeSet<_>>() {
        let (kind, parts) = match (before.get(key), after.get(key)) {
            (Some(one), Some(other)) => {
                let parts = match known.entry((*one, *other)) {
                    Entry::Occupied(known) => known.get().clone(),
                    Entry::Vacant(place) => {
                        let sides = ((old, &old.unit(*one)?), (new, &new.unit(*other)?));
                        place.insert(changed_parts(sides.0, sides.1)?).clone()
                    }
                };
                ("changed", parts)
            }
            (Some(_), None) => ("removed", Vec::new()),
            (None, _) => ("added", Vec::new()),
        };
        if kind != "changed" || !parts.is_empty() {
            let (program, entry, key) = (program.clone(), entry.clone(), key.clone());
            found.push(Change { program, language: *language, entry, key, kind, parts });
        }
    }
    Ok(found)
}

/// `reflection`, and the targets that differ. Bytes are compared by their hashes.
fn changed_parts(
    (old, before): (&dyn Store, &StoredUnit),
    (new, after): (&dyn Store, &StoredUnit),
) -> Result<Vec<String>, Error> {
    let mut found = Vec::new();
    if before.reflection != after.reflection {
        found.push("reflection".to_owned());
    }
    for target in before.targets.keys().chain(after.targets.keys()).collect::<BTreeSet<_>>() {
        let same = match (before.targets.get(target), after.targets.get(target)) {
            (Some(one), Some(other)) => {
                one.native == other.native && old.digest(one.blob)? == new.digest(other.blob)?
            }
            _ => false,
        };
        if !same {
            found.push(target.clone());
        }
    }
    Ok(found)
}
