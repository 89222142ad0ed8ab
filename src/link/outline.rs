//! The declarations of a lean WGSL text, and keys that say which functions are alike.
//!
//! A function's key covers its own text, all that its types, constants and variables are, and of
//! each function that it calls what a caller can notice: the signature, the variables that are
//! reached, and every function on the way that does more than compute. Functions of one key are
//! written alike in every target, whatever module they are in.

use std::collections::HashMap;
use std::sync::{Arc, PoisonError, RwLock};

use super::scan::{Name, Scan, scan};
use super::words::words;

/// Of a declaration and all that it depends on.
pub type Key = [u8; 16];

/// Declarations after which a text is left to be compiled as a whole.
const DECLARATIONS: usize = 1024;

/// Calls within each other after which a text is left to be compiled as a whole.
const DEPTH: usize = 64;

/// How types begin that stand for something that is elsewhere.
pub const HANDLES: [&str; 3] = ["texture", "sampler", "ptr"];

/// What a declaration declares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Function,
    Entry,
    Variable,
    /// A structure, an alias or a constant.
    Other,
}

/// One declaration.
#[derive(Debug)]
pub struct Declaration<'a> {
    pub kind: Kind,
    pub name: &'a str,
    pub text: &'a str,
    /// Of functions and entry points.
    pub key: Key,
}

/// A text that can be put together from functions.
#[derive(Debug)]
pub struct Outline<'a> {
    pub declarations: Vec<Declaration<'a>>,
    /// Indices of the functions, each after those that it calls; the entry point last.
    pub functions: Vec<usize>,
}

/// What was found out about declarations by their text: most texts share most of theirs.
#[derive(Debug, Default)]
pub struct Scans(RwLock<HashMap<Box<str>, Option<Arc<Known>>>>);

/// A declaration that was seen before.
#[derive(Debug)]
struct Known {
    kind: Kind,
    name: Box<str>,
    /// Of the text alone, and of the signature alone.
    text: Key,
    head: Key,
    scan: Scan,
}

impl Scans {
    pub fn clear(&self) {
        self.0.write().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// `None` for what no text may have that is taken apart.
    fn find(&self, text: &str) -> Option<Arc<Known>> {
        if let Some(known) = self.0.read().unwrap_or_else(PoisonError::into_inner).get(text) {
            return known.clone();
        }
        let read = || {
            let Part { kind, name } = part(text)?;
            let scan = is_plain(name).then(|| scan(text, kind, name))??;
            let head = hash(&text.as_bytes()[..scan.head], std::iter::empty());
            Some(Arc::new(Known { kind, name: name.into(), text: hash(text.as_bytes(), std::iter::empty()), head, scan }))
        };
        let known = read();
        self.0.write().unwrap_or_else(PoisonError::into_inner).insert(text.into(), known.clone());
        known
    }
}

impl<'a> Outline<'a> {
    /// Reads a text whose one entry point is `entry`. `None` where the parts of the text may not be
    /// independent: the decision is the text's alone, so that the same text is always treated alike.
    pub fn read(text: &'a str, entry: &str, scans: &Scans) -> Option<Self> {
        let texts = split(text)?;
        let known = texts.iter().map(|text| scans.find(text)).collect::<Option<Vec<Arc<Known>>>>()?;
        let names: HashMap<&str, usize> = known.iter().enumerate().map(|(index, known)| (&*known.name, index)).collect();
        let mut entries = (0..known.len()).filter(|index| known[*index].kind == Kind::Entry);
        let (root, other) = (entries.next()?, entries.next());
        if other.is_some() || &*known[root].name != entry || names.len() != known.len() || is_ambiguous(&known, root, &names) {
            return None;
        }
        let stage = hash(if texts[root].contains("@vertex") { b"vertex" } else { b"fragment" }, std::iter::empty());
        let facts = known.iter().map(|_| Facts::default()).collect();
        let mut keys = Keys { stage, texts: &texts, known: &known, names: &names, facts, order: Vec::new() };
        keys.visit(root, 0)?;
        let Keys { facts, order, .. } = keys;
        // What the entry point does not reach has no key, and no business to be here.
        let whole = facts.iter().all(|facts| facts.state == State::Known);
        let name = |text: &'a str, name: &str| text.find(name).map_or("", |start| &text[start..start + name.len()]);
        let declared = texts.iter().zip(&known).zip(&facts).map(|((text, known), facts)| Declaration {
            kind: known.kind,
            name: name(text, &known.name),
            text,
            key: facts.key,
        });
        whole.then(|| Self { declarations: declared.collect(), functions: order })
    }

    /// The same declarations, variables first and in an order of their own, functions last: naga
    /// numbers variables and their types in the order in which it comes to them, and passes them to
    /// functions in that order.
    pub fn sorted(&self) -> String {
        let is_function = |declaration: &&Declaration<'_>| matches!(declaration.kind, Kind::Function | Kind::Entry);
        let of = |kind: Kind| self.declarations.iter().filter(move |declaration| declaration.kind == kind);
        let mut variables: Vec<&Declaration<'_>> = of(Kind::Variable).collect();
        variables.sort_by_key(|variable| variable.text);
        let functions = self.declarations.iter().filter(is_function);
        variables.into_iter().chain(of(Kind::Other)).chain(functions).flat_map(|declaration| [declaration.text, "\n"]).collect()
    }

    /// The functions, each after those that it calls; the entry point last.
    pub fn functions(&self) -> impl Iterator<Item = &Declaration<'a>> {
        self.functions.iter().map(|index| &self.declarations[*index])
    }
}

struct Part<'a> {
    kind: Kind,
    name: &'a str,
}

/// The texts of the declarations.
fn split(text: &str) -> Option<Vec<&str>> {
    if !text.is_ascii() || text.contains(super::local::MARK) {
        return None;
    }
    let (mut depth, mut start, mut parts) = (0_usize, 0, Vec::new());
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.checked_sub(1)?,
            _ => {}
        }
        if depth == 0 && matches!(byte, b';' | b'}') {
            let declaration = text[start..=at].trim();
            start = at + 1;
            if declaration != ";" {
                parts.push(declaration);
            }
        }
    }
    (text[start..].trim().is_empty() && parts.len() <= DECLARATIONS).then_some(parts)
}

/// What a text declares; `None` where it is of a kind that concerns the module as a whole.
fn part(text: &str) -> Option<Part<'_>> {
    let mut attributes = Vec::new();
    let mut rest = text;
    while let Some(after) = rest.strip_prefix('@') {
        let name = words(after).next().filter(|word| word.start == 0)?.text;
        attributes.push(name);
        rest = after[name.len()..].trim_start();
        if rest.starts_with('(') {
            rest = rest.split_once(')')?.1.trim_start();
        }
    }
    let mut words = words(rest);
    let (keyword, mut name) = (words.next()?.text, words.next()?.text);
    let is_entry = attributes.iter().any(|attribute| matches!(*attribute, "vertex" | "fragment"));
    let kind = match keyword {
        "fn" if attributes.contains(&"compute") => return None,
        "fn" if is_entry => Kind::Entry,
        "fn" => Kind::Function,
        // An alias may hide what is passed on.
        "alias" if HANDLES.iter().any(|handle| rest.contains(handle)) => return None,
        "struct" | "const" | "alias" => Kind::Other,
        "var" => {
            let (_, after) = rest.split_once("var")?;
            let space = after.trim_start().strip_prefix('<');
            // Lengths of buffers are passed along by the number of the buffer.
            if space.and_then(|space| self::words(space).next()).is_some_and(|space| space.text == "storage") {
                return None;
            }
            let after = if space.is_some() { after.split_once('>')?.1 } else { after };
            name = self::words(after).next()?.text;
            Kind::Variable
        }
        _ => return None,
    };
    Some(Part { kind, name })
}

/// How names begin that naga gives to what it adds to a module.
const ADDED: &[&str] = &[
    "_",
    "array_",
    "gen_",
    "naga",
    "Naga",
    "gl_",
    "Construct",
    "ZeroValue",
    "GetMat",
    "SetMat",
    "ret_",
    "VertexInput",
    "VertexOutput",
    "FragmentInput",
    "FragmentOutput",
];

/// Whether naga writes the name as it is, but for an underscore where a language has taken it.
fn is_plain(name: &str) -> bool {
    let is_added = name == "member" || ADDED.iter().any(|prefix| name.starts_with(prefix));
    !is_added && !name.ends_with('_') && !name.contains("__")
}

/// Whether a name means two things where they could be taken for each other: one of the entry
/// point's arguments, or a member of their types, is called as a declaration; a member of any
/// structure as a type or a constant; a declaration as what naga adds for the entry point.
fn is_ambiguous(known: &[Arc<Known>], root: usize, names: &HashMap<&str, usize>) -> bool {
    let scan = &known[root].scan;
    let types = scan.names[..scan.signature].iter().filter_map(|name| names.get(&*name.text));
    let border = types.flat_map(|index| &known[*index].scan.members).chain(&scan.members);
    let is_shared = |name: &str| names.get(name).is_some_and(|index| known[*index].kind == Kind::Other);
    let members = known.iter().filter(|known| known.kind == Kind::Other).flat_map(|known| &known.scan.members);
    let is_added = |end: &str| names.contains_key(format!("{}{end}", known[root].name).as_str());
    border.into_iter().any(|name| names.contains_key(&**name))
        || members.into_iter().any(|name| is_shared(name))
        || ["Input", "Output"].into_iter().any(is_added)
}

#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum State {
    #[default]
    New,
    Open,
    Known,
}

#[derive(Default)]
struct Facts {
    state: State,
    key: Key,
    /// Of what others can notice: of a function, from outside; of everything else, all of it.
    face: Key,
    /// Of the variables, and of the acts of functions, that are reached; sorted.
    reached: Vec<Key>,
    /// Of the function's text and of the acts below it, if it acts.
    act: Option<Key>,
    /// Whether derivatives are taken, here or below.
    derives: bool,
}

struct Keys<'a> {
    /// The stages of one program are written differently.
    stage: Key,
    texts: &'a [&'a str],
    known: &'a [Arc<Known>],
    names: &'a HashMap<&'a str, usize>,
    facts: Vec<Facts>,
    order: Vec<usize>,
}

impl Keys<'_> {
    /// Finds the facts of a declaration after those of all that it refers to.
    fn visit(&mut self, index: usize, depth: usize) -> Option<()> {
        match self.facts[index].state {
            State::Known => return Some(()),
            State::Open => return None,
            State::New => {}
        }
        self.facts[index].state = State::Open;
        let known = self.known[index].clone();
        let found = known.scan.names.iter().map(|name| (name, self.names.get(&*name.text).copied()));
        let names: Vec<(&Name, Option<usize>)> = found.collect();
        for reference in names.iter().filter_map(|(_, index)| *index) {
            (depth < DEPTH).then(|| self.visit(reference, depth + 1))??;
        }
        let facts = match known.kind {
            Kind::Function | Kind::Entry => self.function(&known, &names)?,
            Kind::Variable | Kind::Other => self.other(&known, &names)?,
        };
        self.facts[index] = Facts { state: State::Known, ..facts };
        if matches!(known.kind, Kind::Function | Kind::Entry) {
            self.order.push(index);
        }
        Some(())
    }

    fn other(&self, known: &Known, names: &[(&Name, Option<usize>)]) -> Option<Facts> {
        let references = || names.iter().filter_map(|(_, index)| *index);
        let calls = references().any(|index| matches!(self.known[index].kind, Kind::Function | Kind::Entry));
        let face = hash(&known.text, references().map(|index| &self.facts[index].face));
        let reached = if known.kind == Kind::Variable { vec![face] } else { Vec::new() };
        (!calls).then(|| Facts { face, reached, ..Facts::default() })
    }

    fn function(&self, known: &Known, names: &[(&Name, Option<usize>)]) -> Option<Facts> {
        let below = || names.iter().filter_map(|(_, index)| Some(&self.facts[(*index)?]));
        let derives = |(name, index): &(&Name, Option<usize>)| index.map_or(name.derives, |index| self.facts[index].derives);
        // Where neighbouring fragments may have parted, a derivative has to be looked at in full.
        if names.iter().any(|named| named.0.loud && derives(named)) {
            return None;
        }
        // What is acted on depends on no value, and so on no function that only computes one.
        let acts = known.scan.acts || names.iter().any(|(name, index)| index.map_or(name.acts, |index| self.is_shared(index)));
        let act = acts.then(|| hash(&known.text, below().filter_map(|facts| facts.act.as_ref())));
        let mut reached: Vec<Key> = below().flat_map(|facts| facts.reached.iter().copied()).chain(act).collect();
        reached.sort_unstable();
        reached.dedup();
        let signature = names[..known.scan.signature].iter().filter_map(|(_, index)| Some(&self.facts[(*index)?].face));
        let face = hash(&known.head, signature.chain(&reached));
        let key = hash(&known.text, below().map(|facts| &facts.face).chain([&self.stage]));
        let derives = names.iter().any(derives);
        Some(Facts { face, key, reached, act, derives, ..Facts::default() })
    }

    /// Whether others can notice that a variable was used: it is no uniform block.
    fn is_shared(&self, index: usize) -> bool {
        self.known[index].kind == Kind::Variable && !self.texts[index].contains("<uniform")
    }
}

fn hash<'a>(text: &[u8], keys: impl Iterator<Item = &'a Key>) -> Key {
    let mut bytes = Vec::with_capacity(text.len() + 256);
    bytes.extend_from_slice(&(text.len() as u64).to_le_bytes());
    bytes.extend_from_slice(text);
    keys.for_each(|key| bytes.extend_from_slice(key));
    let mut key = [0; 16];
    key.copy_from_slice(&blake3::hash(&bytes).as_bytes()[..16]);
    key
}
