//! Chooses what the author's names are called in the outputs of one target.
//!
//! The *usual* form of a name is what naga makes of it in a module with nothing else; a keyword,
//! for example, gets an underscore at its end. Where the text has that identifier with another
//! meaning, the name gets a number instead.

use std::collections::{BTreeMap, BTreeSet};

use naga::{Constant, Expression, Literal, Module, Scalar, Span, Type, TypeInner};
use rustc_hash::FxHashMap;

use super::cut::DeclarationReference;
use super::ready::{Bits, Identifier, ReadyTemplate};
use super::reason::Reason;
use super::text;
use lamplight_bundle::Target;

use lamplight_emit::emit;
use lamplight_validate::{Validated, info_unchecked};

/// The names and identifiers of a target, each with a number.
#[derive(Default)]
pub struct OutputNames {
    target: Option<Target>,
    numbers: FxHashMap<String, u32>,
    /// For each name: the author's form, its usual form, and the number of the usual form as a
    /// word.
    usual: Vec<(String, String, u32)>,
    words: FxHashMap<String, u32>,
}

/// The forms that the names of one text get.
pub struct ChosenNames {
    pub renames: Renames,
    /// The names that do not have their usual form.
    pub renamed: Bits,
    /// For each identifier, by number: whether a name has it as its usual form.
    taken: Bits,
}

/// The names that a text cannot have in their usual form, with what they are called instead.
pub type Renames = BTreeMap<u32, String>;

impl OutputNames {
    pub fn new(target: Target) -> Self {
        Self { target: Some(target), ..Self::default() }
    }

    /// The number of an author's name; a new name gets the next one.
    pub fn number(&mut self, name: &str) -> Result<u32, Reason> {
        if let Some(number) = self.numbers.get(name) {
            return Ok(*number);
        }
        let usual = self.target.and_then(|target| plain_name(name, target)).ok_or(Reason::Shape)?;
        let word = self.word(&usual);
        let number = self.usual.len() as u32;
        self.usual.push((name.to_owned(), usual, word));
        self.numbers.insert(name.to_owned(), number);
        Ok(number)
    }

    /// The number of an identifier; a new identifier gets the next one.
    pub fn word(&mut self, word: &str) -> u32 {
        if let Some(number) = self.words.get(word) {
            return *number;
        }
        let number = self.words.len() as u32;
        self.words.insert(word.to_owned(), number);
        number
    }

    /// The usual form of a name.
    pub fn usual(&self, number: u32) -> &str {
        self.usual.get(number as usize).map_or("", |(_, usual, _)| usual)
    }

    /// The number, as a word, of a name's usual form.
    pub fn usual_word(&self, number: u32) -> u32 {
        self.usual.get(number as usize).map_or(u32::MAX, |(_, _, word)| *word)
    }

    /// The usual form of a reference.
    pub fn usual_of(&self, reference: &DeclarationReference) -> &str {
        let small = reference.small.then(|| reference.name.to_lowercase());
        let name = small.as_ref().unwrap_or(&reference.name);
        self.numbers.get(name).map_or("", |number| self.usual(*number))
    }

    /// Finds the names that cannot have their usual form in a text, and numbers those.
    pub fn choose(&self, fragments: &[&ReadyTemplate]) -> Result<ChosenNames, Reason> {
        let mut words = Bits::new(self.words.len());
        let mut names = Bits::new(self.usual.len());
        let mut captured = Bits::new(self.usual.len());
        for ready in fragments {
            ready.words.add_to(&mut words);
            ready.names.add_to(&mut names);
            ready.captured.iter().for_each(|name| _ = captured.insert(*name as usize));
        }
        let mut taken = Bits::new(self.words.len());
        let (mut open, mut wanted_twice) = (Vec::new(), Vec::new());
        for name in names.numbers() {
            let word = self.usual[name].2 as usize;
            if words.has(word) || captured.has(name) {
                open.push(name);
            } else if taken.insert(word) {
                wanted_twice.push(word);
            }
        }
        // Sorted by name: numbers depend on the order in which names were met, names do not.
        let author = |name: &usize| &self.usual[*name].0;
        wanted_twice.sort_unstable();
        wanted_twice.dedup();
        for word in wanted_twice {
            let wants = |name: &usize| self.usual[*name].2 as usize == word && !captured.has(*name);
            let first = names.numbers().filter(wants).min_by_key(author);
            open.extend(names.numbers().filter(wants).filter(|name| Some(*name) != first));
        }
        open.sort_by_key(author);
        let renames = self.numbered(&open, fragments, |word| words.has(word) || taken.has(word))?;
        let mut renamed = Bits::new(self.usual.len());
        open.iter().for_each(|name| _ = renamed.insert(*name));
        Ok(ChosenNames { renames, renamed, taken })
    }

    /// Appends a number to each of some names, so that each is new in the text.
    fn numbered(
        &self,
        open: &[usize],
        fragments: &[&ReadyTemplate],
        is_used: impl Fn(usize) -> bool,
    ) -> Result<Renames, Reason> {
        let mut renames = Renames::new();
        let mut chosen: BTreeSet<String> = BTreeSet::new();
        for name in open {
            let base = self.usual[*name].1.trim_end_matches('_');
            let is_local =
                |word: &u32| fragments.iter().any(|ready| ready.locals.binary_search(word).is_ok());
            let is_free = |candidate: &String| {
                let word = self.words.get(candidate);
                !word.is_some_and(|word| is_used(*word as usize) || is_local(word))
                    && !chosen.contains(candidate)
            };
            let mut numbered = (1..u32::MAX).map(|number| format!("{base}_{number}"));
            let free = numbered.find(is_free).ok_or(Reason::Clash)?;
            chosen.insert(free.clone());
            renames.insert(*name as u32, free);
        }
        Ok(renames)
    }

    /// Whether an identifier is the form that some name of the author's has in the text.
    pub fn is_name(&self, identifier: &Identifier, chosen: &ChosenNames) -> bool {
        let (text, word) = match identifier {
            Identifier::Usual(word) => (None, Some(*word)),
            Identifier::Text(text) => (Some(text), self.words.get(text).copied()),
        };
        word.is_some_and(|word| chosen.taken.has(word as usize))
            || chosen.renames.values().any(|renamed| match text {
                Some(text) => text == renamed,
                None => self.words.get(renamed).copied() == word,
            })
    }
}

/// What naga calls a declaration of that name in a module with nothing else.
fn plain_name(name: &str, target: Target) -> Option<String> {
    let text = usual_name(&trivial_module(name)?, target)?;
    let (_, declared) = text::split_declarations(&text).ok()?;
    let mut constants =
        declared.iter().filter(|declared| declared.kind == text::OutputKind::Constant);
    let found = constants.next()?.name.to_owned();
    constants.next().is_none().then_some(found)
}

fn usual_name(module: &Validated, target: Target) -> Option<String> {
    String::from_utf8(emit(module, ENTRY, target).ok()?.bytes).ok()
}

const ENTRY: &str = "lamplight_entry";

/// A module with an entry point that does nothing, and a constant of the given name.
fn trivial_module(name: &str) -> Option<Validated> {
    let text = format!("@fragment fn {ENTRY}() {{}}");
    let mut module: Module = naga::front::wgsl::parse_str(&text).ok()?;
    let number = Type { name: None, inner: TypeInner::Scalar(Scalar::U32) };
    let ty = module.types.insert(number, Span::UNDEFINED);
    let one = Expression::Literal(Literal::U32(0));
    let init = module.global_expressions.append(one, Span::UNDEFINED);
    module.constants.append(Constant { name: Some(name.to_owned()), ty, init }, Span::UNDEFINED);
    let info = info_unchecked(&module).ok()?;
    Some(Validated { module, info, portable: true })
}
