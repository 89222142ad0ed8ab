//! The declarations of a lean text, in the order in which its functions can be translated.

use std::collections::BTreeSet;

use rustc_hash::{FxHashMap, FxHashSet};

use naga::ShaderStage;

use super::mark;
use super::reason::Reason;
use lamplight_bundle::Stage;
use lamplight_compose::{Composed, Part, PartKind};
use lamplight_syntax::words::words;

/// 128 bits of a hash, which identify content.
pub type ContentKey = [u8; 16];

/// A text with more declarations is compiled as a whole.
const DECLARATIONS: usize = 2048;

/// A text whose calls nest deeper is compiled as a whole.
const DEPTH: usize = 64;

/// One declaration.
#[derive(Debug)]
pub struct Declaration<'a> {
    pub kind: PartKind,
    pub names: &'a [String],
    pub text: &'a str,
    /// The text before a function's body; the whole text of any other declaration.
    pub head: &'a str,
    /// The declarations that it names.
    pub uses: Vec<usize>,
    /// Those that a function's head names.
    pub head_uses: Vec<usize>,
    pub hash: ContentKey,
}

impl Declaration<'_> {
    /// Its name, or the first of several.
    pub fn name(&self) -> &str {
        self.names.first().map_or("", String::as_str)
    }
}

/// A text that can be put together from functions.
#[derive(Debug)]
pub struct Outline<'a> {
    pub stage: ShaderStage,
    /// Directives.
    pub header: String,
    pub declarations: Vec<Declaration<'a>>,
    /// Indices of the functions, each after those that it calls. The last one is the entry point.
    pub functions: Vec<usize>,
    /// The structure that the entry point returns, if it returns one.
    pub interface: Option<usize>,
    /// All declarations but functions, by name.
    named: FxHashMap<&'a str, usize>,
}

impl<'a> Outline<'a> {
    /// Reads a lean text whose one entry point is `entry`.
    ///
    /// # Errors
    /// The reason why the text has to be compiled as a whole. It depends on the text alone.
    pub fn read(lean: &'a Composed, entry: &str) -> Result<Self, Reason> {
        if lean.parts.is_empty() {
            return Err(Reason::NoParts);
        }
        if lean.parts.len() > DECLARATIONS {
            return Err(Reason::Large);
        }
        if mark::occurs_in(&lean.text) {
            return Err(Reason::MarkedName);
        }
        let stage = entry_stage(lean, entry)?;
        let text = |part: &Part| &lean.text[part.range.clone()];
        let directives = lean.parts.iter().filter(|part| part.kind == PartKind::Directive);
        let header = directives.map(text).collect::<Vec<_>>().concat();
        let declarations = read_declarations(lean)?;
        let mut outline = Outline {
            stage,
            header,
            named: first_of_name(&declarations),
            declarations,
            functions: Vec::new(),
            interface: None,
        };
        outline.functions = call_order(&outline.declarations, entry)?;
        outline.interface = outline.returned();
        Ok(outline)
    }

    pub fn entry(&self) -> usize {
        self.functions.last().copied().unwrap_or_default()
    }

    /// All functions but the entry point.
    pub fn functions_before_entry(&self) -> &[usize] {
        self.functions.split_last().map_or(&[], |(_, before)| before)
    }

    /// The functions that a function calls or may call, in the order of the text.
    pub fn callees(&self, function: usize) -> impl Iterator<Item = usize> {
        let declaration = &self.declarations[function];
        declaration.uses.iter().copied().filter(move |used| {
            *used != function && self.declarations[*used].kind == PartKind::Function
        })
    }

    /// The declaration of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.named.get(name).copied()
    }

    /// The structure that a WGSL entry point returns.
    fn returned(&self) -> Option<usize> {
        let entry = &self.declarations[self.entry()];
        let (_, result) = entry.head.split_once("->")?;
        let named = words(result).filter(|word| word.before != b'@').last()?.text;
        self.find(named).filter(|found| self.declarations[*found].kind == PartKind::Struct)
    }
}

/// The first declaration of each name, functions left out.
fn first_of_name<'a>(declared: &[Declaration<'a>]) -> FxHashMap<&'a str, usize> {
    let mut named = FxHashMap::default();
    for (index, declaration) in declared.iter().enumerate() {
        if declaration.kind != PartKind::Function {
            for name in declaration.names {
                named.entry(name.as_str()).or_insert(index);
            }
        }
    }
    named
}

/// The stage of the one entry point.
fn entry_stage(lean: &Composed, entry: &str) -> Result<ShaderStage, Reason> {
    let stages = lean.parts.iter().filter_map(|part| {
        let text = &lean.text[part.range.clone()];
        let head = text.split('{').next().unwrap_or_default();
        (part.kind == PartKind::Function).then(|| stage_attribute(head)).flatten()
    });
    let found: Vec<Stage> = stages.collect();
    let is_known = lean
        .parts
        .iter()
        .any(|part| part.kind == PartKind::Function && part.names.iter().any(|name| name == entry));
    match found.first().copied().filter(|_| found.len() == 1 && is_known) {
        Some(Stage::Vertex) => Ok(ShaderStage::Vertex),
        Some(Stage::Fragment) => Ok(ShaderStage::Fragment),
        _ => Err(Reason::EntryPoint),
    }
}

/// The stage that an attribute before a function names.
fn stage_attribute(head: &str) -> Option<Stage> {
    words(head).filter(|word| word.before == b'@').find_map(|word| match word.text {
        "vertex" => Some(Stage::Vertex),
        "fragment" => Some(Stage::Fragment),
        "compute" => Some(Stage::Compute),
        _ => None,
    })
}

fn read_declarations(lean: &Composed) -> Result<Vec<Declaration<'_>>, Reason> {
    let mut numbers = vec![usize::MAX; lean.parts.len()];
    let kept: Vec<(usize, &Part)> = lean
        .parts
        .iter()
        .enumerate()
        .filter(|(_, part)| part.kind != PartKind::Directive && !part.range.is_empty())
        .collect();
    for (number, (index, _)) in kept.iter().enumerate() {
        numbers[*index] = number;
    }
    refuse_any(lean, &kept)?;
    let number = |used: &u32| match numbers[*used as usize] {
        usize::MAX => all_of(lean, *used, &numbers),
        number => vec![number],
    };
    let declared = kept.into_iter().map(|(_, part)| {
        let text = &lean.text[part.range.clone()];
        let is_function = part.kind == PartKind::Function;
        let head = if is_function { text.split('{').next().unwrap_or(text) } else { text };
        let mut uses: Vec<usize> = part.uses.iter().flat_map(number).collect();
        uses.sort_unstable();
        uses.dedup();
        Declaration {
            kind: part.kind,
            names: &part.names,
            text,
            head,
            uses,
            head_uses: Vec::new(),
            hash: hash_parts([text.as_bytes()]),
        }
    });
    let mut declared: Vec<Declaration<'_>> = declared.collect();
    find_head_uses(&mut declared);
    Ok(declared)
}

/// Finds what each function's head names, by comparing words. A parameter with the name of a
/// declaration counts as a use of it too: that only adds something to the function's key.
fn find_head_uses(declared: &mut [Declaration<'_>]) {
    for index in 0..declared.len() {
        if declared[index].kind == PartKind::Function {
            let head: Vec<&str> = words(declared[index].head).map(|word| word.text).collect();
            let named =
                |used: &usize| declared[*used].names.iter().any(|name| head.contains(&&**name));
            declared[index].head_uses =
                declared[index].uses.iter().copied().filter(named).collect();
        }
    }
}

/// The declarations that an expanded alias named, directly or through other aliases.
fn all_of(lean: &Composed, alias: u32, numbers: &[usize]) -> Vec<usize> {
    let (mut open, mut seen, mut found) = (vec![alias], BTreeSet::new(), Vec::new());
    while let Some(part) = open.pop() {
        match numbers[part as usize] {
            usize::MAX if seen.insert(part) => open.extend(&lean.parts[part as usize].uses),
            usize::MAX => {}
            number => found.push(number),
        }
    }
    found
}

/// Refuses a text with a declaration that cannot be separated from the others.
fn refuse_any(lean: &Composed, kept: &[(usize, &Part)]) -> Result<(), Reason> {
    let mut functions: FxHashSet<&String> = FxHashSet::default();
    for (_, part) in kept {
        let text = &lean.text[part.range.clone()];
        refuse_part(part, text)?;
        if part.kind == PartKind::Function && !part.names.iter().all(|name| functions.insert(name))
        {
            return Err(Reason::Overload);
        }
    }
    Ok(())
}

/// Refuses the kinds of declaration that cannot be separated. The kinds are listed in
/// `crates/compose/src/part.rs`.
fn refuse_part(part: &Part, text: &str) -> Result<(), Reason> {
    let is_storage = |text: &str| {
        let space = text.split_once('<').filter(|(before, _)| before.trim_end().ends_with("var"));
        let is_it = |space: &str| words(space).next().is_some_and(|word| word.text == "storage");
        space.is_some_and(|(_, space)| is_it(space))
    };
    match part.kind {
        PartKind::Override => Err(Reason::Override),
        PartKind::Prototype => Err(Reason::Overload),
        PartKind::Other => Err(Reason::Declaration),
        // Aliases were expanded already: this one could not be.
        PartKind::Alias => Err(Reason::Declaration),
        PartKind::Variable if is_storage(text) => Err(Reason::StorageBuffer),
        PartKind::Variable if text.contains("binding_array") => Err(Reason::BindingArray),
        _ => Ok(()),
    }
}

/// The functions that the entry point reaches, callees first.
fn call_order(declared: &[Declaration<'_>], entry: &str) -> Result<Vec<usize>, Reason> {
    let is_function = |index: usize| declared[index].kind == PartKind::Function;
    let mut functions = (0..declared.len()).filter(|index| is_function(*index));
    let root = functions.rfind(|index| declared[*index].name() == entry);
    let root = root.ok_or(Reason::EntryPoint)?;
    let mut walk = DeclarationWalk {
        declared,
        state: vec![VisitState::New; declared.len()],
        order: Vec::new(),
    };
    walk.visit(root, 0)?;
    Ok(walk.order)
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum VisitState {
    New,
    Open,
    Done,
}

struct DeclarationWalk<'w, 'a> {
    declared: &'w [Declaration<'a>],
    state: Vec<VisitState>,
    order: Vec<usize>,
}

impl DeclarationWalk<'_, '_> {
    fn visit(&mut self, function: usize, depth: usize) -> Result<(), Reason> {
        match self.state[function] {
            VisitState::Done => return Ok(()),
            VisitState::Open => return Err(Reason::Recursion),
            VisitState::New if depth == DEPTH => return Err(Reason::Recursion),
            VisitState::New => self.state[function] = VisitState::Open,
        }
        for used in &self.declared[function].uses {
            if *used != function && self.declared[*used].kind == PartKind::Function {
                self.visit(*used, depth + 1)?;
            }
        }
        self.state[function] = VisitState::Done;
        self.order.push(function);
        Ok(())
    }
}

/// 128 bits of a hash. Each part is hashed with its length, so parts cannot run into each other.
pub fn hash_parts<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> ContentKey {
    let mut bytes = Vec::with_capacity(512);
    for part in parts {
        bytes.extend_from_slice(&(part.len() as u64).to_le_bytes());
        bytes.extend_from_slice(part);
    }
    let mut key = [0; 16];
    key.copy_from_slice(&blake3::hash(&bytes).as_bytes()[..16]);
    key
}
