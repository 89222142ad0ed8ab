//! An output of a canonical text, divided: what is the unit's own, and what it shares.

use std::collections::{BTreeSet, HashMap};
use std::hash::{Hash, Hasher};

use rustc_hash::FxHashMap;

use super::mark::{self, Mark, SCRATCH};
use super::reason::Reason;
use super::text::{self, Declared};
use super::words::words;

/// What to keep of an output.
pub struct Wanted<'a> {
    /// The author's name of the function; `None` for the entry point.
    pub function: Option<&'a str>,
    /// What the output calls its entry point.
    pub entry: &'a str,
    /// The author's names by the number of their mark.
    pub names: &'a [String],
}

/// An output of one unit.
#[derive(Debug, Default)]
pub struct Cut {
    /// The lines before all declarations.
    pub header: String,
    /// Types, constants and functions of the writer's own, each after what it names.
    pub shared: Vec<Shared>,
    /// What is bound, and what enters and leaves the stage: the entry point has all of it.
    pub globals: Vec<Fragment>,
    pub body: Fragment,
}

/// A declaration that functions may share.
#[derive(Debug)]
pub struct Shared {
    pub fragment: Fragment,
    pub kind: text::Kind,
    /// What it is called: another of the same name and head would be declared twice.
    pub declares: Fragment,
    /// Places in the list of what it names.
    pub uses: Vec<usize>,
}

/// A part of an output. References to the author's declarations are apart from all other text.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Fragment {
    /// The text, with nothing in the places of the references.
    pub text: String,
    /// In the order of their places.
    pub references: Vec<Reference>,
    /// Identifiers that are no references, and that the function declares.
    pub locals: Vec<String>,
}

/// Nearly all that differ do so in their text.
impl Hash for Fragment {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.text.hash(state);
    }
}

/// A name of the author's.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reference {
    /// Where it stands in the text.
    pub at: usize,
    pub name: String,
    /// A variable that the writer calls after the declaration, in small letters.
    pub small: bool,
}

/// Divides an output.
///
/// # Errors
/// `shape` where something is not as naga 30 writes it.
pub fn cut(text: &str, wanted: &Wanted<'_>) -> Result<Cut, Reason> {
    let (header, declared) = text::split(text).map_err(|_| Reason::Shape)?;
    let mut cut = Cut { header: header.to_owned(), ..Cut::default() };
    let (mut bodies, mut roots) = (0, Vec::new());
    let mut shared: Vec<usize> = Vec::new();
    let mut bound: BTreeSet<&str> = BTreeSet::new();
    for (index, declaration) in declared.iter().enumerate() {
        match role(declaration, wanted)? {
            Role::Body => {
                roots.push(declaration.text);
                cut.body = Fragment::read(declaration.text, wanted.names)?;
                bodies += 1;
            }
            Role::Global if wanted.function.is_none() => {
                roots.push(declaration.text);
                cut.globals.push(Fragment::read(declaration.text, wanted.names)?);
            }
            Role::Global => {
                bound.insert(declaration.name);
            }
            Role::Shared => shared.push(index),
            Role::Dropped => {}
        }
    }
    cut.shared = share(&declared, &shared, &roots, &bound, wanted.names)?;
    if bodies == 1 { Ok(cut) } else { Err(Reason::Shape) }
}

/// The shared declarations that the roots name, each after what it names itself.
fn share(
    declared: &[Declared<'_>],
    shared: &[usize],
    roots: &[&str],
    bound: &BTreeSet<&str>,
    names: &[String],
) -> Result<Vec<Shared>, Reason> {
    let mut by_name: FxHashMap<&str, Vec<usize>> = FxHashMap::default();
    for index in shared {
        by_name.entry(declared[*index].name).or_default().push(*index);
    }
    let named = |text: &str| -> BTreeSet<usize> {
        let words = words(text).filter(|word| word.before != b'.');
        words.filter_map(|word| by_name.get(word.text)).flatten().copied().collect()
    };
    let mut reached: BTreeSet<usize> = roots.iter().flat_map(|root| named(root)).collect();
    let mut open: Vec<usize> = reached.iter().copied().collect();
    while let Some(index) = open.pop() {
        open.extend(named(declared[index].text).into_iter().filter(|used| reached.insert(*used)));
    }
    let places: HashMap<usize, usize> =
        reached.iter().enumerate().map(|(place, index)| (*index, place)).collect();
    let one = |index: &usize| {
        let Declared { kind, name, text } = declared[*index];
        // Without its entry point, what is bound is not there.
        if !bound.is_empty() && words(text).any(|word| bound.contains(word.text)) {
            return Err(Reason::Shape);
        }
        // A declaration names others that come before it. Functions of one name are apart.
        let uses = named(text).into_iter().filter(|used| used < index);
        let uses = uses.filter(|used| declared[*used].name != name).map(|used| places[&used]);
        Ok(Shared {
            fragment: Fragment::read(text, names)?,
            kind,
            declares: Fragment::read(name, names)?,
            uses: uses.collect(),
        })
    };
    reached.iter().map(one).collect()
}

enum Role {
    Body,
    Global,
    Shared,
    Dropped,
}

fn role(declaration: &Declared<'_>, wanted: &Wanted<'_>) -> Result<Role, Reason> {
    let name = declaration.name;
    let found = mark::find(name, 0);
    let is_whole = |mark: &Mark| mark.start == 0 && mark.end == name.len();
    let is_function = declaration.kind == text::Kind::Function;
    Ok(match found {
        Some(mark) if mark.number == SCRATCH => Role::Dropped,
        Some(mark) if is_function && is_whole(&mark) => {
            let author = wanted.names.get(mark.number as usize).ok_or(Reason::Shape)?;
            if wanted.function == Some(author) { Role::Body } else { Role::Dropped }
        }
        _ if is_function && name == wanted.entry => {
            if wanted.function.is_none() {
                Role::Body
            } else {
                Role::Dropped
            }
        }
        _ if declaration.kind == text::Kind::Global => Role::Global,
        _ => Role::Shared,
    })
}

impl Fragment {
    /// Takes the marks out of a text.
    pub fn read(text: &str, names: &[String]) -> Result<Self, Reason> {
        let mut fragment = Self { text: String::with_capacity(text.len()), ..Self::default() };
        let mut at = 0;
        while let Some(mark) = mark::find(text, at) {
            let name = names.get(mark.number as usize).filter(|name| !name.is_empty());
            let name = name.ok_or(Reason::Shape)?.clone();
            fragment.text.push_str(&text[at..mark.start]);
            let at_text = fragment.text.len();
            fragment.references.push(Reference { at: at_text, name, small: mark.small });
            at = mark.end;
        }
        fragment.text.push_str(&text[at..]);
        Ok(fragment)
    }

    /// Identifiers that have nothing of a reference, but for members.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        let mut references = self.references.iter().map(|reference| reference.at).peekable();
        let mut last = 0;
        words(&self.text).filter_map(move |word| {
            let end = word.at + word.text.len();
            while let Some(at) = references.next_if(|at| *at < word.at) {
                last = at;
            }
            let is_plain = references.peek().is_none_or(|at| *at > end);
            // A member follows its dot, with no reference in between.
            let after_dot = || self.text[..word.at].trim_end().len();
            let is_member = word.before == b'.' && last < after_dot();
            (is_plain && !is_member).then_some(word.text)
        })
    }
}

impl Fragment {
    /// Writes a name in the place of all references in small letters to a declaration.
    pub fn settle(&mut self, declaration: &str, name: &str) {
        let (mut text, mut at) = (String::with_capacity(self.text.len() + name.len()), 0);
        let mut kept = Vec::with_capacity(self.references.len());
        for reference in std::mem::take(&mut self.references) {
            text.push_str(&self.text[at..reference.at]);
            at = reference.at;
            if reference.small && reference.name == declaration {
                text.push_str(name);
            } else {
                kept.push(Reference { at: text.len(), ..reference });
            }
        }
        text.push_str(&self.text[at..]);
        (self.text, self.references) = (text, kept);
        self.locals.push(name.to_owned());
    }
}

impl Cut {
    /// Tells the identifiers apart that the unit's function declares: `bases` are the author's
    /// names, which naga writes with an underscore or a number behind them. The entry point is no
    /// local, even where one is called like it.
    pub fn add_locals(&mut self, bases: &BTreeSet<&str>, entry: &str) {
        let is_local = |word: &&str| {
            if *word == entry {
                return false;
            }
            let stem = word.trim_end_matches(|end: char| end.is_ascii_digit());
            let stem = if stem.ends_with('_') { stem.trim_end_matches('_') } else { *word };
            bases.contains(stem) || bases.contains(word.trim_end_matches('_'))
        };
        let words: BTreeSet<&str> = self.body.words().collect();
        let locals = words.into_iter().filter(|word| is_local(word)).map(str::to_owned);
        self.body.locals = locals.collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_plain_where_no_reference_touches_them() {
        let names = ["".to_owned(), "author".to_owned()];
        let mark = mark::mark(1);
        let text = format!("a.b Make{mark} {mark}_1 c+{mark} d .{mark} e . f {mark}(g)h1{mark}x");
        let fragment = Fragment::read(&text, &names).unwrap();
        assert_eq!(fragment.words().collect::<Vec<_>>(), ["a", "c", "d", "e", "g"]);
    }
}
