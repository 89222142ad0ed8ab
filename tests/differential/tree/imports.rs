//! Chooses how a module imports and names the items of other modules.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::{Item, file, segments};
use crate::random::Random;

/// The imports of a module: its local names, and the statements that import them.
pub struct Imports {
    pub module: usize,
    locals: BTreeSet<String>,
    spelling: BTreeMap<usize, String>,
    statements: Vec<(Vec<String>, String)>,
    plain: Vec<String>,
}

impl Imports {
    pub fn new(module: usize, items: &[Item]) -> Self {
        let own =
            items.iter().filter(|item| item.module == module).map(|item| item.name.to_owned());
        Self {
            module,
            locals: own.collect(),
            spelling: BTreeMap::new(),
            statements: Vec::new(),
            plain: Vec::new(),
        }
    }

    /// A name for an item in this module. An import is added if the name needs one.
    pub fn reference(&mut self, item: &Item, hidden: &[String], random: &mut Random) -> String {
        if item.module == self.module {
            return item.name.to_owned();
        }
        if let Some(known) =
            self.spelling.get(&item.id).filter(|known| random.chance(80) && !hidden.contains(known))
        {
            return known.clone();
        }
        let path = path(self.module, item.module, random);
        let inline = format!("{}::{}", path.join("::"), item.name);
        let free = |name: &str, imports: &Self| {
            !imports.locals.contains(name) && !hidden.iter().any(|other| other == name)
        };
        match random.below(5) {
            0 => inline,
            1 if free(path.last().unwrap(), self)
                && path.len() > 1
                && path.last().is_none_or(|last| last != "super") =>
            {
                // The module is imported, and the item is named by a path from it.
                let last = path.last().unwrap().clone();
                self.locals.insert(last.clone());
                self.statements.push((path, String::new()));
                let found = format!("{last}::{}", item.name);
                self.spelling.insert(item.id, found.clone());
                found
            }
            2 | 3 if free(item.name, self) => self.named(item, path, item.name.to_owned()),
            _ => {
                let alias = format!("{}_{}", item.name, ["here", "there", "now"][random.below(3)]);
                if free(&alias, self) { self.named(item, path, alias) } else { inline }
            }
        }
    }

    fn named(&mut self, item: &Item, path: Vec<String>, local: String) -> String {
        self.locals.insert(local.clone());
        let renamed =
            if local == item.name { local.clone() } else { format!("{} as {local}", item.name) };
        let guard = item.guard.clone().filter(|_| item.id.is_multiple_of(2));
        match guard {
            Some(guard) => {
                self.plain.push(format!("@if({guard}) import {}::{renamed};\n", path.join("::")))
            }
            None => self.statements.push((path, renamed)),
        }
        self.spelling.insert(item.id, local.clone());
        local
    }

    /// The import statements. Each is on its own, or grouped in braces with those that have the same
    /// first segment.
    pub fn text(&self, random: &mut Random) -> String {
        let mut groups: BTreeMap<&str, Vec<String>> = BTreeMap::new();
        let mut text = self.plain.concat();
        for (path, item) in &self.statements {
            let below = |from: usize| {
                path[from..]
                    .iter()
                    .map(String::as_str)
                    .chain((!item.is_empty()).then_some(item.as_str()))
                    .collect::<Vec<_>>()
                    .join("::")
            };
            if random.chance(50) && path[0] != "super" && !below(1).is_empty() {
                groups.entry(&path[0]).or_default().push(below(1));
            } else {
                let _ = writeln!(text, "import {};", below(0));
            }
        }
        for (first, rest) in groups {
            let nested: Vec<String> = rest
                .into_iter()
                .map(|path| if random.chance(30) { nest(&path) } else { path })
                .collect();
            let _ = writeln!(text, "import {first}::{{ {}, }};", nested.join(", "));
        }
        text
    }
}

/// `a::b as c` as `a::{b as c}`.
fn nest(path: &str) -> String {
    path.split_once("::").map_or(path.to_owned(), |(first, rest)| format!("{first}::{{{rest}}}"))
}

/// A path from one module to another: from the package, or with `super`.
pub fn path(from: usize, to: usize, random: &mut Random) -> Vec<String> {
    let (start, end) = (segments(from), segments(to));
    let (own, other) = (file(from).0, file(to).0);
    if own != other {
        return [vec![other], end].concat();
    }
    let shared = start.iter().zip(&end).take_while(|(a, b)| a == b).count();
    // The first `super` leads to the module's folder, and each further one a folder up. There are
    // as many as lead to a folder that contains the other module.
    let common = shared.min(start.len() - 1).min(end.len() - 1);
    if random.chance(40) {
        let climbs = vec!["super".to_owned(); start.len() - common];
        return [climbs, end[common..].to_vec()].concat();
    }
    [vec!["package".to_owned()], end].concat()
}
