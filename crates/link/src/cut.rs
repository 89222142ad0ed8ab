//! Divides the output of a canonical text into what belongs to its unit and what units share.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{Hash, Hasher};

use rustc_hash::{FxHashMap, FxHashSet};

use super::mark::{self, Mark, SCRATCH};
use super::reason::Reason;
use super::text::{self, OutputDeclaration};
use lamplight_syntax::words::words;

/// What to keep of an output.
pub struct WantedParts<'a> {
    /// The author's name of the function; `None` for the entry point.
    pub function: Option<&'a str>,
    /// The name of the entry point in the output.
    pub entry: &'a str,
    /// The author's names, indexed by the number of their mark.
    pub names: &'a [String],
}

/// The output of one unit, divided.
#[derive(Debug, Default)]
pub struct Cut {
    /// The lines before all declarations.
    pub header: String,
    /// Types, constants and functions that the writer made. Each comes after those that it names.
    pub shared: Vec<Shared>,
    /// Bound variables, and those that enter and leave the stage. Only the entry point's cut has
    /// them, since its output declares all of them.
    pub globals: Vec<TextFragment>,
    pub body: TextFragment,
}

/// A declaration that functions may share.
#[derive(Debug)]
pub struct Shared {
    pub fragment: TextFragment,
    pub kind: text::OutputKind,
    /// Its name. Two declarations of one name and head cannot stand in one text.
    pub declares: TextFragment,
    /// Indices into [`Cut::shared`] of the declarations that it names.
    pub uses: Vec<usize>,
}

/// A part of an output, with the references to the author's declarations kept apart from all other
/// text.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct TextFragment {
    /// The text without the references.
    pub text: String,
    /// The references, in the order of their places.
    pub references: Vec<DeclarationReference>,
    /// Identifiers that the function declares itself; references are not among them.
    pub locals: Vec<String>,
}

/// The text alone is hashed: nearly all fragments that differ do so in their text.
impl Hash for TextFragment {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.text.hash(state);
    }
}

/// A reference to one of the author's declarations.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeclarationReference {
    /// The byte offset in the text at which the name is inserted.
    pub at: usize,
    pub name: String,
    /// Whether it is a variable that the writer named after a declaration, in lower case.
    pub small: bool,
}

/// Divides an output.
///
/// # Errors
/// [`Reason::Shape`] if the output has a form that naga 30 does not write.
pub fn cut_output(text: &str, wanted: &WantedParts<'_>) -> Result<Cut, Reason> {
    let (header, declared) = text::split_declarations(text).map_err(|_| Reason::Shape)?;
    let mut cut = Cut { header: header.to_owned(), ..Cut::default() };
    let (mut bodies, mut roots) = (0, Vec::new());
    let mut shared: Vec<usize> = Vec::new();
    let mut bound: BTreeSet<&str> = BTreeSet::new();
    for (index, declaration) in declared.iter().enumerate() {
        match declared_role(declaration, wanted)? {
            CutRole::Body => {
                roots.push(declaration.text);
                cut.body = TextFragment::read(declaration.text, wanted.names)?;
                bodies += 1;
            }
            CutRole::Global if wanted.function.is_none() => {
                roots.push(declaration.text);
                cut.globals.push(TextFragment::read(declaration.text, wanted.names)?);
            }
            CutRole::Global => {
                bound.insert(declaration.name);
            }
            CutRole::Shared => shared.push(index),
            CutRole::Dropped => {}
        }
    }
    cut.shared = shared_by_roots(&declared, &shared, &roots, &bound, wanted.names)?;
    if bodies == 1 { Ok(cut) } else { Err(Reason::Shape) }
}

/// The shared declarations that the roots name, themselves or through others. Each comes after
/// those that it names.
fn shared_by_roots(
    declared: &[OutputDeclaration<'_>],
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
    // What each declaration that is reached names.
    let mut reached: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    let mut open: Vec<usize> = roots.iter().flat_map(|root| named(root)).collect();
    while let Some(index) = open.pop() {
        if let Entry::Vacant(place) = reached.entry(index) {
            open.extend(place.insert(named(declared[index].text)).iter().copied());
        }
    }
    let places: HashMap<usize, usize> =
        reached.keys().enumerate().map(|(place, index)| (*index, place)).collect();
    let one = |(index, named): (&usize, &BTreeSet<usize>)| {
        let OutputDeclaration { kind, name, text } = declared[*index];
        // Only an entry point's output declares the bound variables. A shared declaration that uses
        // one could not stand anywhere else.
        if !bound.is_empty() && words(text).any(|word| bound.contains(word.text)) {
            return Err(Reason::Shape);
        }
        // A declaration can only name earlier ones. Functions of the same name are overloads, not
        // uses of each other.
        let uses = named.iter().filter(|used| *used < index);
        let uses = uses.filter(|used| declared[**used].name != name).map(|used| places[used]);
        Ok(Shared {
            fragment: TextFragment::read(text, names)?,
            kind,
            declares: TextFragment::read(name, names)?,
            uses: uses.collect(),
        })
    };
    reached.iter().map(one).collect()
}

enum CutRole {
    Body,
    Global,
    Shared,
    Dropped,
}

fn declared_role(
    declaration: &OutputDeclaration<'_>,
    wanted: &WantedParts<'_>,
) -> Result<CutRole, Reason> {
    let name = declaration.name;
    let found = mark::find_mark(name, 0);
    let is_whole = |mark: &Mark| mark.start == 0 && mark.end == name.len();
    let is_function = declaration.kind == text::OutputKind::Function;
    Ok(match found {
        Some(mark) if mark.number == SCRATCH => CutRole::Dropped,
        Some(mark) if is_function && is_whole(&mark) => {
            let author = wanted.names.get(mark.number as usize).ok_or(Reason::Shape)?;
            if wanted.function == Some(author) { CutRole::Body } else { CutRole::Dropped }
        }
        _ if is_function && name == wanted.entry => {
            if wanted.function.is_none() {
                CutRole::Body
            } else {
                CutRole::Dropped
            }
        }
        _ if declaration.kind == text::OutputKind::Global => CutRole::Global,
        _ => CutRole::Shared,
    })
}

impl TextFragment {
    /// Replaces the marks of a text by references.
    pub fn read(text: &str, names: &[String]) -> Result<Self, Reason> {
        let mut fragment = Self { text: String::with_capacity(text.len()), ..Self::default() };
        let mut at = 0;
        while let Some(mark) = mark::find_mark(text, at) {
            let name = names.get(mark.number as usize).filter(|name| !name.is_empty());
            let name = name.ok_or(Reason::Shape)?.clone();
            fragment.text.push_str(&text[at..mark.start]);
            let at_text = fragment.text.len();
            fragment.references.push(DeclarationReference { at: at_text, name, small: mark.small });
            at = mark.end;
        }
        fragment.text.push_str(&text[at..]);
        Ok(fragment)
    }

    /// Identifiers without any reference in them, members left out.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        let mut references = self.references.iter().map(|reference| reference.at).peekable();
        let mut last = 0;
        words(&self.text).filter_map(move |word| {
            let end = word.at + word.text.len();
            while let Some(at) = references.next_if(|at| *at < word.at) {
                last = at;
            }
            let is_plain = references.peek().is_none_or(|at| *at > end);
            // A member follows its dot directly; a reference in between would make it something
            // else.
            let after_dot = || self.text[..word.at].trim_end().len();
            let is_member = word.before == b'.' && last < after_dot();
            (is_plain && !is_member).then_some(word.text)
        })
    }
}

impl TextFragment {
    /// Replaces all lower-case references to a declaration by a name.
    pub fn settle(&mut self, declaration: &str, name: &str) {
        let (mut text, mut at) = (String::with_capacity(self.text.len() + name.len()), 0);
        let mut kept = Vec::with_capacity(self.references.len());
        for reference in std::mem::take(&mut self.references) {
            text.push_str(&self.text[at..reference.at]);
            at = reference.at;
            if reference.small && reference.name == declaration {
                text.push_str(name);
            } else {
                kept.push(DeclarationReference { at: text.len(), ..reference });
            }
        }
        text.push_str(&self.text[at..]);
        (self.text, self.references) = (text, kept);
        self.locals.push(name.to_owned());
    }
}

impl Cut {
    /// Collects the unit's local identifiers. `bases` are the names of its parameters and variables
    /// in the source; naga may append underscores or digits to them. The entry point's own name is
    /// left out, even if a local has the same name.
    pub fn add_locals(&mut self, bases: &FxHashSet<&str>, entry: &str) {
        let is_local = |word: &&str| {
            if *word == entry {
                return false;
            }
            let stem = word.trim_end_matches(|end: char| end.is_ascii_digit());
            let stem = if stem.ends_with('_') { stem.trim_end_matches('_') } else { *word };
            bases.contains(stem) || bases.contains(word.trim_end_matches('_'))
        };
        let words: FxHashSet<&str> = self.body.words().collect();
        let locals = words.into_iter().filter(is_local);
        let mut locals: Vec<String> = locals.map(str::to_owned).collect();
        locals.sort_unstable();
        self.body.locals = locals;
    }
}
