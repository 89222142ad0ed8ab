//! Modules reduced to what others see of them, so that each module of a large package can be
//! checked without everything that it reaches.
//!
//! A reduced module keeps its declarations and the imports that they need. The body of a function
//! becomes `{ return T(); }`, with its type of result. So a chain of modules that import each
//! other is read only as far as types and constants lead.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rustc_hash::FxHashSet;

use lamplight_diagnostic::source::{SourceId, SourceSet};
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_files::limits::count_steps;
use lamplight_syntax::wesl::{
    self, Event, Import, Item, ItemKind, Module, Name, Names, Origin, UsedName,
};

/// The most modules that are read whole for one root module.
const NEAR_MODULES: usize = 12;

/// The most imports that these may have in total, besides those of the root module.
const NEAR_IMPORTS: usize = 64;

/// Reduces what is far from a root module, over many readings of one package.
#[derive(Debug, Default)]
pub struct Reductions {
    /// By the whole text: the reduced one and the number of imports. `None` if the module cannot be
    /// reduced.
    known: BTreeMap<Arc<str>, (Option<Arc<str>>, usize)>,
    /// The sources whose texts are reduced. Places in them mean nothing to the author.
    reduced: BTreeSet<SourceId>,
    /// Whether modules are reduced now.
    is_on: bool,
    modules: usize,
    imports: usize,
    /// Files that were read, counted at each reading.
    read: u64,
}

impl Reductions {
    /// Begins to read for a root module; with `reduces`, what is far from it is reduced.
    pub fn begin(&mut self, reduces: bool) {
        (self.is_on, self.modules, self.imports) = (reduces, 0, 0);
    }

    /// Files that were read so far, counted at each reading.
    pub fn files_read(&self) -> u64 {
        self.read
    }

    /// The diagnostics at places of the author's text. What is wrong in a reduced module is found
    /// when that module is the root.
    pub fn visible(&self, found: Diagnostics) -> Diagnostics {
        let is_reduced = |source: SourceId| self.reduced.contains(&source);
        let kept = found.into_iter().filter_map(|mut diagnostic: Diagnostic| {
            if diagnostic.labels.first().is_some_and(|label| is_reduced(label.span.source)) {
                return None;
            }
            diagnostic.labels.retain(|label| !is_reduced(label.span.source));
            Some(diagnostic)
        });
        kept.collect()
    }

    /// The source to use instead of one that was just read: itself if it is near.
    pub(super) fn source(&mut self, sources: &mut SourceSet, source: SourceId) -> SourceId {
        self.read += 1;
        count_steps(1);
        self.modules += 1;
        if !self.is_on || self.modules == 1 {
            return source;
        }
        let text = sources.get(source).text.clone();
        let entry = self.known.entry(text);
        let (reduced, imports) =
            entry.or_insert_with_key(|text| reduced_text(source, Arc::clone(text)));
        let all = self.imports + *imports;
        if self.modules <= NEAR_MODULES && all <= NEAR_IMPORTS {
            self.imports = all;
            return source;
        }
        let Some(reduced) = reduced else { return source };
        let path = sources.get(source).path.clone();
        let source = sources.add(path, Arc::clone(reduced));
        self.reduced.insert(source);
        source
    }
}

/// The reduced text of a module, and how many imports the whole one has. There is none for a module
/// with errors, which everything that imports it has too, and for one whose imports or directives
/// have conditions, which cannot be written apart from each other.
fn reduced_text(source: SourceId, text: Arc<str>) -> (Option<Arc<str>>, usize) {
    let mut names = Names::default();
    let module = wesl::parse(source, Arc::clone(&text), &mut names);
    let imports = module.imports.len();
    let is_conditional = module.imports.iter().any(|import| import.condition.is_some())
        || module.directives.iter().any(|directive| directive.condition.is_some());
    if is_conditional || module.has_errors() || !module.wildcards.is_empty() {
        return (None, imports);
    }
    let mut items = String::new();
    let mut used = FxHashSet::default();
    for item in &module.items {
        // An assertion stands for itself, and is checked with its own module.
        if item.kind == ItemKind::ConstAssert && item.condition.is_none() {
            continue;
        }
        let end = write_item(&mut items, &module, item);
        used.extend(names_before(&module, item, end));
    }
    let mut reduced = String::new();
    for directive in &module.directives {
        reduced += &module.text[directive.range.start as usize..directive.range.end as usize];
        reduced.push('\n');
    }
    needed_imports(&module, used).for_each(|import| reduced += &written_import(import, &names));
    (Some((reduced + &items).into()), imports)
}

/// Writes an item, a function without its body. Returns where the text ends that was kept.
fn write_item(items: &mut String, module: &Module, item: &Item) -> u32 {
    let whole = &module.text[item.range.start as usize..item.range.end as usize];
    let name = (item.name_range.end - item.range.start) as usize;
    let body = whole[name..].find('{').filter(|_| item.kind == ItemKind::Function);
    let kept = body.map_or(whole.len(), |body| name + body);
    *items += &whole[..kept];
    if body.is_some() {
        let result = whole[name..kept].rsplit_once("->").map(|(_, result)| bare_type(result));
        match result {
            Some(result) => *items += &format!("{{ return {result}(); }}"),
            None => *items += "{ }",
        }
    }
    items.push('\n');
    item.range.start + kept as u32
}

/// The type of a function's result, without its attributes, which only entry points have.
fn bare_type(result: &str) -> &str {
    let mut rest = result.trim();
    while let Some(attribute) = rest.strip_prefix('@') {
        let word = attribute.find(|next: char| !next.is_alphanumeric() && next != '_');
        let after = attribute[word.unwrap_or(attribute.len())..].trim_start();
        let closed = after.strip_prefix('(').and_then(|inside| inside.split_once(')'));
        rest = closed.map_or(after, |(_, after)| after).trim_start();
    }
    rest
}

/// The first names of what an item uses before a place.
fn names_before<'m>(module: &'m Module, item: &'m Item, end: u32) -> impl Iterator<Item = Name> {
    let uses = item.events.iter().filter_map(move |event| match event {
        Event::Use { reference, start, .. } if *start < end => {
            module.references.get(*reference as usize)
        }
        _ => None,
    });
    uses.filter_map(|used| match used {
        UsedName::Name(name) => Some(*name),
        UsedName::Path(path) if path.origin == Origin::Scope => path.segments.first().copied(),
        UsedName::Path(_) => None,
    })
}

/// The imports that bring names which are used, and those that these go through.
fn needed_imports(module: &Module, used: FxHashSet<Name>) -> impl Iterator<Item = &Import> {
    let mut aliases: BTreeMap<Name, Vec<usize>> = BTreeMap::new();
    for (index, import) in module.imports.iter().enumerate() {
        aliases.entry(import.alias).or_default().push(index);
    }
    let mut needed: Vec<bool> = module.imports.iter().map(|import| import.is_public).collect();
    let passed = module.imports.iter().filter(|import| import.is_public);
    let starts = passed.filter_map(|import| import.path.segments.first().copied());
    let mut open: Vec<Name> = used.into_iter().chain(starts).collect();
    while let Some(name) = open.pop() {
        for index in aliases.get(&name).into_iter().flatten() {
            if !std::mem::replace(&mut needed[*index], true) {
                let path = &module.imports[*index].path;
                let first = path.segments.first().filter(|_| path.origin == Origin::Scope);
                open.extend(first);
            }
        }
    }
    module.imports.iter().zip(needed).filter(|(_, needed)| *needed).map(|(import, _)| import)
}

fn written_import(import: &Import, names: &Names) -> String {
    let first = match import.path.origin {
        Origin::Package => "package::".to_owned(),
        Origin::Super(ups) => "super::".repeat(ups as usize),
        Origin::Scope => String::new(),
    };
    let segments: Vec<&str> = import.path.segments.iter().map(|name| names.text(*name)).collect();
    let alias = names.text(import.alias);
    let renamed = segments.last().is_some_and(|last| *last != alias);
    let renamed = if renamed { format!(" as {alias}") } else { String::new() };
    let public = if import.is_public { "public " } else { "" };
    format!("{public}import {first}{}{renamed};\n", segments.join("::"))
}
