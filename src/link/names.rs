//! What the author's names become in one target.
//!
//! A name becomes what naga makes of it in a module by itself: a keyword gets an underscore behind
//! it. Where the text has the same identifier with another meaning, the name is numbered.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use naga::valid::{ValidationFlags, Validator};
use naga::{Constant, Expression, Literal, Module, Scalar, Span, Type, TypeInner};

use super::cut::Reference;
use super::reason::Reason;
use super::text;
use crate::bundle::Target;

use crate::bundle::Language;
use crate::emit::emit;
use crate::validate::{CAPABILITIES, Validated};

/// Names and identifiers of a target, by number.
#[derive(Default)]
pub struct Names {
    target: Option<Target>,
    numbers: HashMap<String, u32>,
    /// What naga calls each name, and the number of that as a word.
    usual: Vec<(String, String, u32)>,
    words: HashMap<String, u32>,
}

/// The identifiers of one fragment of a text.
pub struct Used<'u> {
    pub names: &'u [u32],
    pub captured: &'u [u32],
    pub words: &'u [u32],
    pub locals: &'u [String],
}

/// Names that a text cannot have as usual, with what they are instead.
pub type Renames = BTreeMap<u32, String>;

impl Names {
    pub fn new(target: Target) -> Self {
        Self { target: Some(target), ..Self::default() }
    }

    /// The number of an author's name, new or known.
    pub fn number(&mut self, name: &str) -> Result<u32, Reason> {
        if let Some(number) = self.numbers.get(name) {
            return Ok(*number);
        }
        let usual = self.target.and_then(|target| plain_name(name, target)).ok_or(Reason::Shape)?;
        let word = self.word(usual.clone());
        let number = self.usual.len() as u32;
        self.usual.push((name.to_owned(), usual, word));
        self.numbers.insert(name.to_owned(), number);
        Ok(number)
    }

    /// The number of an identifier, new or known.
    pub fn word(&mut self, word: String) -> u32 {
        let next = self.words.len() as u32;
        *self.words.entry(word).or_insert(next)
    }

    /// What naga calls a name.
    pub fn usual(&self, number: u32) -> &str {
        self.usual.get(number as usize).map_or("", |(_, usual, _)| usual)
    }

    /// What a reference nearly always is.
    pub fn usual_of(&self, reference: &Reference) -> &str {
        let small = reference.small.then(|| reference.name.to_lowercase());
        let name = small.as_ref().unwrap_or(&reference.name);
        self.numbers.get(name).map_or("", |number| self.usual(*number))
    }

    /// What a reference is in a text with some other names.
    pub fn renamed(&self, reference: &Reference, renames: &Renames) -> String {
        let number = self.numbers.get(&reference.name).filter(|_| !reference.small);
        let renamed = number.and_then(|number| renames.get(number));
        renamed.cloned().unwrap_or_else(|| self.usual_of(reference).to_owned())
    }

    /// The names of a text that cannot be as usual.
    pub fn choose(&self, fragments: &[Used<'_>]) -> Result<Renames, Reason> {
        let mut words = vec![false; self.words.len()];
        let mut names = vec![false; self.usual.len()];
        let mut captured = vec![false; self.usual.len()];
        for used in fragments {
            used.words.iter().for_each(|word| words[*word as usize] = true);
            used.names.iter().for_each(|name| names[*name as usize] = true);
            used.captured.iter().for_each(|name| captured[*name as usize] = true);
        }
        let mut renames = Renames::new();
        let mut taken = vec![false; self.words.len()];
        let mut open = Vec::new();
        let named = (0..self.usual.len()).filter(|name| names[*name]);
        let mut named: Vec<usize> = named.collect();
        // Numbers depend on what was met before; names do not.
        named.sort_by(|one, other| self.usual[*one].0.cmp(&self.usual[*other].0));
        for name in named {
            let word = self.usual[name].2 as usize;
            if words[word] || captured[name] || std::mem::replace(&mut taken[word], true) {
                open.push(name);
            }
        }
        let mut chosen: BTreeSet<String> = BTreeSet::new();
        for name in open {
            let base = self.usual[name].1.trim_end_matches('_');
            let is_free = |candidate: &String| {
                let word = self.words.get(candidate).map(|word| *word as usize);
                !word.is_some_and(|word| words[word] || taken[word])
                    && !chosen.contains(candidate)
                    && !fragments.iter().any(|used| used.locals.contains(candidate))
            };
            let mut numbered = (1..u32::MAX).map(|number| format!("{base}_{number}"));
            let free = numbered.find(is_free).ok_or(Reason::Clash)?;
            chosen.insert(free.clone());
            renames.insert(name as u32, free);
        }
        Ok(renames)
    }
}

/// What naga calls a declaration of that name in a module by itself.
fn plain_name(name: &str, target: Target) -> Option<String> {
    let text = written(&trivial(name)?, target)?;
    let (_, declared) = text::split(&text).ok()?;
    let mut constants = declared.iter().filter(|declared| declared.kind == text::Kind::Constant);
    let found = constants.next()?.name.to_owned();
    constants.next().is_none().then_some(found)
}

fn written(module: &Validated, target: Target) -> Option<String> {
    String::from_utf8(emit(module, ENTRY, target).ok()?.bytes).ok()
}

const ENTRY: &str = "lamplight_entry";

/// A stage that does nothing, beside a constant of the given name.
fn trivial(name: &str) -> Option<Validated> {
    let text = format!("@fragment fn {ENTRY}() {{}}");
    let mut module: Module = naga::front::wgsl::parse_str(&text).ok()?;
    let number = Type { name: None, inner: TypeInner::Scalar(Scalar::U32) };
    let ty = module.types.insert(number, Span::UNDEFINED);
    let one = Expression::Literal(Literal::U32(0));
    let init = module.global_expressions.append(one, Span::UNDEFINED);
    module.constants.append(Constant { name: Some(name.to_owned()), ty, init }, Span::UNDEFINED);
    let info = Validator::new(ValidationFlags::empty(), CAPABILITIES).validate(&module).ok()?;
    Some(Validated { language: Language::Wesl, module, info })
}
