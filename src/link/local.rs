//! Names within functions: marked before naga writes them, plain again in what it wrote.
//!
//! naga numbers names over the whole module, so that a function's text depends on those before
//! it. A mark that is the function's own keeps its names apart from all others; afterwards each
//! becomes what naga would have called it in a module by itself.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use naga::{ArraySize, Function, Module, Type, TypeInner};

use super::words::{Word, words};
use crate::emit::type_name;

/// Between a local name and the number of its function; no text with it is taken apart.
pub const MARK: &str = "_zq";
const MARK_END: char = 'q';

/// The module with marked names in its functions, and with arrays named by what they hold: a
/// language without arrays by value needs a name for each.
pub fn marked(module: &Module) -> Module {
    let mut module = module.clone();
    for (number, (_, function)) in module.functions.iter_mut().enumerate() {
        mark(function, number);
        for argument in &mut function.arguments {
            argument.name = Some(marked_name(argument.name.as_deref().unwrap_or("param"), number));
        }
    }
    // Arguments of an entry point have other names outside of its function.
    for (number, point) in module.entry_points.iter_mut().enumerate() {
        mark(&mut point.function, module.functions.len() + number);
    }
    let arrays: Vec<_> =
        module.types.iter().filter_map(|(handle, found)| Some((handle, array_name(&module, found)?, found.inner.clone()))).collect();
    for (handle, name, inner) in arrays {
        module.types.replace(handle, Type { name: Some(name), inner });
    }
    module
}

fn mark(function: &mut Function, number: usize) {
    for (_, local) in function.local_variables.iter_mut() {
        local.name = Some(marked_name(local.name.as_deref().unwrap_or("local"), number));
    }
    for name in function.named_expressions.values_mut() {
        *name = marked_name(name, number);
    }
}

fn marked_name(name: &str, function: usize) -> String {
    format!("{}{MARK}{function}{MARK_END}", name.trim_end_matches('_'))
}

fn array_name(module: &Module, found: &Type) -> Option<String> {
    let Type { name: None, inner: TypeInner::Array { base, size: ArraySize::Constant(size), .. } } = found else { return None };
    let base = array_name(module, &module.types[*base]).unwrap_or_else(|| type_name(module, *base));
    let base: String = base.chars().map(|character| if character.is_ascii_alphanumeric() { character } else { '_' }).collect();
    Some(format!("array_{size}_{}", base.trim_matches('_')))
}

/// Names that the writers themselves give to variables of a function; they number them too.
const OWN: &[&str] = &["loop_init", "loop_bound", "dummy", "oob", "unnamed", "_tmp", "should_continue"];

/// What naga calls a declaration of some name in a target, where it is the first of its name.
pub type FirstNames = BTreeMap<String, String>;

/// The names of a function's text: which are its own, and what is left of them without marks and
/// numbers.
pub struct Locals<'a> {
    text: &'a str,
    words: Vec<Word<'a>>,
    /// For each name, its base; `None` for those that are not the function's own.
    bases: HashMap<&'a str, Option<&'a str>>,
}

impl<'a> Locals<'a> {
    /// Reads the text of a function; `modules` are the names of the module's declarations.
    pub fn read(text: &'a str, modules: &BTreeSet<&str>) -> Self {
        let words: Vec<Word<'a>> = words(text).filter(|word| word.before != b'.').collect();
        let mut bases: HashMap<&str, Option<&str>> = words.iter().map(|word| (word.text, None)).collect();
        let results = results(text, &words, modules);
        for (name, found) in &mut bases {
            *found = base(name).or_else(|| (OWN.contains(name) || results.contains(name)).then_some(*name));
            *found = found.filter(|_| !modules.contains(name));
        }
        Self { text, words, bases }
    }

    /// Bases that [`Locals::plain`] must know the first name of.
    pub fn bases(&self) -> impl Iterator<Item = &'a str> {
        self.bases.values().flatten().copied()
    }

    /// The text with the names that it has in a module by itself.
    ///
    /// # Errors
    /// Where a base has no first name.
    pub fn plain(&self, first: &FirstNames) -> Result<String, String> {
        let mut taken: BTreeSet<String> =
            self.bases.iter().filter(|(_, base)| base.is_none()).map(|(name, _)| (*name).to_owned()).collect();
        let mut names: HashMap<&str, String> = HashMap::new();
        let mut plain = String::with_capacity(self.text.len());
        let mut copied = 0;
        for word in &self.words {
            let Some(base) = self.bases.get(word.text).copied().flatten() else { continue };
            if !names.contains_key(word.text) {
                let name = free(first.get(base).ok_or_else(|| format!("`{base}` has no name"))?, base, &taken);
                taken.insert(name.clone());
                names.insert(word.text, name);
            }
            plain.push_str(&self.text[copied..word.start]);
            plain.push_str(&names[word.text]);
            copied = word.start + word.text.len();
        }
        plain.push_str(&self.text[copied..]);
        Ok(plain)
    }
}

/// The first name, or the first number that is free.
fn free(first: &str, base: &str, taken: &BTreeSet<String>) -> String {
    let mut numbered = (1..).map(|number: usize| format!("{base}_{number}"));
    if taken.contains(first) { numbered.find(|name| !taken.contains(name)).unwrap_or_default() } else { first.to_owned() }
}

/// Variables that HLSL's writer calls after their type, in small letters.
fn results<'a>(text: &str, words: &[Word<'a>], modules: &BTreeSet<&str>) -> BTreeSet<&'a str> {
    let is_one = |(ty, name): &(&Word<'a>, &Word<'a>)| {
        let gap = &text[ty.start + ty.text.len()..name.start];
        modules.contains(ty.text) && gap.trim().is_empty() && ty.text.to_lowercase() == name.text
    };
    words.iter().zip(words.iter().skip(1)).filter(is_one).map(|(_, name)| name.text).collect()
}

/// A name without its mark or its number, where it has one.
fn base(name: &str) -> Option<&str> {
    let (base, end) = name.rsplit_once('_')?;
    let number = |end: &str| !end.is_empty() && end.bytes().all(|byte| byte.is_ascii_digit());
    if let Some((base, _)) = name.split_once(MARK) {
        return Some(base);
    }
    (!base.is_empty() && number(end)).then_some(base)
}
