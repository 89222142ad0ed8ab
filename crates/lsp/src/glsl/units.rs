//! All GLSL files of a package, which of them are compiled together, and what each identifier in
//! them refers to.

use std::collections::BTreeSet;
use std::ops::Range;

use super::names::GlslNames;
use super::outline::{GlslDeclaration, SymbolKind};
use lamplight_catalogue::prefix;
use lamplight_compose::resolve::glsl::{Graph, IncludeTarget};
use lamplight_syntax::glsl::{Directive, FilePart, Module, Symbol, TokenKind, known};

/// The most tokens of a `layout` that are searched.
const LAYOUT: usize = 256;

/// Every GLSL file of a package, and those of others that they include.
pub struct Units {
    pub names: GlslNames,
    /// For each file that no other includes, this file with all that it includes: what a compiler
    /// sees at once.
    units: Vec<BTreeSet<usize>>,
}

/// The role of an identifier at its position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Use {
    /// A local or parameter, by the place of its declaration.
    Local(Range<u32>),
    /// After a dot, or declared in a struct or block.
    Member,
    /// A word of a `layout`, or a parameter of a macro.
    Bound,
    /// Within a directive, which the preprocessor reads.
    Directive,
    /// In global scope.
    Global,
}

/// The symbol that a request is about.
#[derive(Debug, Clone)]
pub enum Meant {
    /// The locals of one name in a function, of which conditions choose one: the file, their
    /// places, and the range of the function.
    Local(usize, Vec<Range<u32>>, Range<u32>),
    Member(Symbol),
    Global(Symbol),
}

/// A place of a file that writes a name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct NamePlace {
    pub file: usize,
    pub start: u32,
    pub end: u32,
}

impl Units {
    pub fn new(graph: Graph) -> Self {
        let reach: Vec<BTreeSet<usize>> =
            (0..graph.modules.len()).map(|file| reached_files(&graph, file)).collect();
        let is_within = |file: &usize| {
            let others = reach.iter().enumerate().filter(|(other, _)| other != file);
            // Of files that include one another, the first stands for all.
            others.into_iter().any(|(other, files)| {
                files.contains(file) && (other < *file || !reach[*file].contains(&other))
            })
        };
        let roots: Vec<usize> = (0..reach.len()).filter(|file| !is_within(file)).collect();
        let units = roots.into_iter().map(|file| reach[file].clone()).collect();
        Self { names: GlslNames::new(graph), units }
    }

    pub fn module(&self, file: usize) -> &Module {
        &self.names.graph.modules[file]
    }

    pub fn spelt(&self, name: Symbol) -> &str {
        self.names.graph.symbols.text(name)
    }

    /// Whether a file is of the package itself.
    pub fn is_own(&self, file: usize) -> bool {
        self.names.graph.packages[file] == 0
    }

    /// The role of an identifier token of a file.
    pub fn use_of(&self, file: usize, token: usize) -> Use {
        let module = self.module(file);
        let found = module.tokens[token];
        if module.text_part(token as u32).is_none() {
            return if is_parameter(module, token) { Use::Bound } else { Use::Directive };
        }
        let place = found.start..found.end;
        let declared = &self.names.outlines[file].declarations;
        let at = declared.partition_point(|known| known.place.start < place.start);
        let declared = declared.get(at).filter(|known| known.place == place);
        let is_behind_point = token > 0 && module.tokens[token - 1].symbol == known::DOT;
        match declared.map(|known| known.kind) {
            Some(SymbolKind::Member) => return Use::Member,
            Some(_) => return Use::Global,
            None if is_behind_point => return Use::Member,
            None => {}
        }
        if is_layout_word(module, token) {
            return Use::Bound;
        }
        match self.names.local(file, found.symbol, found.start) {
            Some(local) => Use::Local(local.place.clone()),
            None => Use::Global,
        }
    }

    /// The tokens of a file that spell a name.
    pub fn tokens_of(&self, file: usize, name: Symbol) -> impl Iterator<Item = usize> + '_ {
        let tokens = self.module(file).tokens.iter().enumerate();
        let named = tokens
            .filter(move |(_, token)| token.symbol == name && token.kind == TokenKind::Identifier);
        named.map(|(at, _)| at)
    }

    /// Whether a file only gives the library's names their prefix.
    pub fn is_prefixes(&self, file: usize) -> bool {
        !self.is_own(file) && self.names.graph.paths[file].ends_with(prefix::PATH)
    }

    /// The symbol at a byte of a file, with the range of its name there.
    pub fn meant(&self, file: usize, byte: u32) -> Option<(Meant, Range<u32>)> {
        let at = self.names.token_at(file, byte)?;
        let token = self.module(file).tokens[at];
        let meant = match self.use_of(file, at) {
            Use::Local(place) => {
                let function = self.function_at(file, place.start)?;
                let same = self.names.outlines[file].locals.iter().filter(|local| {
                    local.name == token.symbol && function.contains(&local.place.start)
                });
                let places: Vec<_> = same.map(|local| local.place.clone()).collect();
                Meant::Local(file, self.chosen_among(file, &places, &place), function)
            }
            Use::Member => Meant::Member(token.symbol),
            Use::Bound => return None,
            Use::Global | Use::Directive => Meant::Global(token.symbol),
        };
        Some((meant, token.start..token.end))
    }

    /// The function that a byte of a file is in.
    fn function_at(&self, file: usize, byte: u32) -> Option<Range<u32>> {
        let declared = self.names.outlines[file].declarations.iter();
        let mut functions = declared.filter(|found| found.kind == SymbolKind::Function);
        functions.find(|found| found.whole.contains(&byte)).map(|found| found.whole.clone())
    }

    /// A local alone, or with the others of its name in its function if a condition chooses.
    fn chosen_among(
        &self,
        file: usize,
        places: &[Range<u32>],
        place: &Range<u32>,
    ) -> Vec<Range<u32>> {
        let is_chosen = |place: &Range<u32>| self.is_conditional(file, place);
        if places.len() > 1 && places.iter().any(is_chosen) {
            return places.to_vec();
        }
        vec![place.clone()]
    }

    /// Whether some use of the local is outside of the conditions that its declaration is under.
    pub fn is_conditional(&self, file: usize, place: &Range<u32>) -> bool {
        let own = branches_at(self.module(file), place.start);
        !own.is_empty()
            && self.uses_of_local(file, place).any(|at| {
                let start = self.module(file).tokens[at].start;
                !branches_at(self.module(file), start).starts_with(&own)
            })
    }

    fn uses_of_local<'u>(
        &'u self,
        file: usize,
        place: &'u Range<u32>,
    ) -> impl Iterator<Item = usize> + 'u {
        let token = self.names.token_at(file, place.start);
        let name = token.map(|at| self.module(file).tokens[at].symbol);
        let tokens = name.into_iter().flat_map(move |name| self.tokens_of(file, name));
        tokens.filter(move |at| self.use_of(file, *at) == Use::Local(place.clone()))
    }

    /// The files that may share the symbol of a name: the file `from`, and repeatedly each file
    /// that uses the name and is compiled together with one of them and with a declaration of the
    /// name.
    pub fn sharing_files(&self, name: Symbol, wanted: &Use, from: usize) -> BTreeSet<usize> {
        let has = |file: &usize| {
            self.tokens_of(*file, name).any(|at| {
                let found = self.use_of(*file, at);
                found == *wanted || (found == Use::Directive && *wanted == Use::Global)
            })
        };
        let having: BTreeSet<usize> =
            (0..self.names.outlines.len()).filter(|file| has(file)).collect();
        let mut found = BTreeSet::from([from]);
        loop {
            let near = self.units.iter().filter(|unit| !unit.is_disjoint(&found));
            let more: BTreeSet<usize> = near
                .filter(|unit| unit.iter().any(|file| self.declares(*file, name, wanted)))
                .flat_map(|unit| unit.intersection(&having).copied())
                .filter(|file| !found.contains(file))
                .collect();
            if more.is_empty() {
                return found;
            }
            found.extend(more);
        }
    }

    /// All files that a compiler sees together with one of some files.
    pub fn seen_files(&self, files: &BTreeSet<usize>) -> BTreeSet<usize> {
        let near = self.units.iter().filter(|unit| !unit.is_disjoint(files));
        near.flatten().copied().collect()
    }

    fn declares(&self, file: usize, name: Symbol, wanted: &Use) -> bool {
        self.declarations_in(file, name, wanted).next().is_some()
    }

    /// Declarations of a name in a file: of members, or else in global scope.
    pub fn declarations_in(
        &self,
        file: usize,
        name: Symbol,
        wanted: &Use,
    ) -> impl Iterator<Item = &GlslDeclaration> {
        let is_member = *wanted == Use::Member;
        let is_hidden = self.is_prefixes(file);
        self.names.outlines[file].declarations.iter().filter(move |found| {
            found.name == name && (found.kind == SymbolKind::Member) == is_member && !is_hidden
        })
    }

    /// Every place that writes what is meant, and those of them that declare it. The places of a
    /// name that nothing declares are those of directives: it may be an axis.
    pub fn places(&self, meant: &Meant, from: usize) -> (Vec<NamePlace>, Vec<NamePlace>) {
        let place = |file: usize, range: &Range<u32>| NamePlace {
            file,
            start: range.start,
            end: range.end,
        };
        let of_token = |file: usize, at: usize| {
            let token = self.module(file).tokens[at];
            place(file, &(token.start..token.end))
        };
        let (name, wanted) = match meant {
            Meant::Local(file, declared, _) => {
                let uses = declared.iter().flat_map(|local| self.uses_of_local(*file, local));
                let mut all: Vec<NamePlace> = uses.map(|at| of_token(*file, at)).collect();
                all.sort();
                all.dedup();
                return (all, declared.iter().map(|range| place(*file, range)).collect());
            }
            Meant::Member(name) => (*name, Use::Member),
            Meant::Global(name) => (*name, Use::Global),
        };
        let files = self.sharing_files(name, &wanted, from);
        let declared: Vec<NamePlace> = files
            .iter()
            .flat_map(|file| self.declarations_in(*file, name, &wanted).map(|found| (*file, found)))
            .map(|(file, found)| place(file, &found.place))
            .collect();
        let is_axis = declared.is_empty();
        let own: BTreeSet<usize> =
            (0..self.names.outlines.len()).filter(|file| self.is_own(*file)).collect();
        let files = if is_axis { own } else { files };
        let mut all = Vec::new();
        for file in files.into_iter().filter(|file| !self.is_prefixes(*file)) {
            let fits = |at: &usize| match self.use_of(file, *at) {
                Use::Directive => wanted == Use::Global,
                found => found == wanted && !is_axis,
            };
            all.extend(self.tokens_of(file, name).filter(fits).map(|at| of_token(file, at)));
        }
        (all, declared)
    }

    /// The file whose `#include` is at a byte of a file.
    pub fn included_at(&self, file: usize, byte: u32) -> Option<usize> {
        let targets = &self.names.graph.targets[file];
        let mut includes = self.module(file).includes.iter().zip(targets);
        includes.find_map(|(include, target)| match target {
            IncludeTarget::Module(to) if include.span.start <= byte && byte <= include.span.end => {
                Some(*to)
            }
            _ => None,
        })
    }

    /// Where a file is included.
    pub fn includes_of(&self, file: usize) -> Vec<NamePlace> {
        let all = self.names.graph.modules.iter().zip(&self.names.graph.targets).enumerate();
        let found = all.flat_map(|(includer, (module, targets))| {
            let pairs = module.includes.iter().zip(targets);
            let here = pairs
                .filter(|(_, target)| matches!(target, IncludeTarget::Module(to) if *to == file));
            here.map(move |(include, _)| NamePlace {
                file: includer,
                start: include.span.start,
                end: include.span.end,
            })
        });
        found.collect()
    }
}

fn reached_files(graph: &Graph, from: usize) -> BTreeSet<usize> {
    let (mut found, mut open) = (BTreeSet::from([from]), vec![from]);
    while let Some(file) = open.pop() {
        for target in &graph.targets[file] {
            if let IncludeTarget::Module(next) = target
                && found.insert(*next)
            {
                open.push(*next);
            }
        }
    }
    found
}

/// The branches of conditionals around a byte, the outermost first.
fn branches_at(module: &Module, byte: u32) -> Vec<usize> {
    let mut open = Vec::new();
    for (index, part) in module.parts.iter().enumerate() {
        let FilePart::Directive(directive, span) = part else { continue };
        if span.start > byte {
            break;
        }
        match directive {
            Directive::If { .. } | Directive::Ifdef { .. } => open.push(index),
            Directive::Elif { .. } | Directive::Else { .. } => {
                open.pop();
                open.push(index);
            }
            Directive::Endif => drop(open.pop()),
            _ => {}
        }
    }
    open
}

/// Whether an identifier in a directive is a parameter of the macro that this defines.
fn is_parameter(module: &Module, token: usize) -> bool {
    let found = module.tokens[token];
    let after = module.parts.partition_point(|part| match part {
        FilePart::Text(text) => text.bytes.start <= found.start,
        FilePart::Directive(_, span) => span.start <= found.start,
    });
    let part = after.checked_sub(1).and_then(|index| module.parts.get(index));
    let Some(FilePart::Directive(Directive::Define(defined), _)) = part else { return false };
    if defined.parameters.is_none() || found.start < defined.name_span.end {
        return false;
    }
    let first = module.tokens.partition_point(|token| token.start < defined.name_span.end);
    let list = module.tokens[first..].iter().take_while(|token| token.symbol != known::CLOSE);
    list.into_iter().any(|parameter| parameter.symbol == found.symbol)
}

/// Whether an identifier is the name of a qualifier: `layout(location = 0)`.
fn is_layout_word(module: &Module, token: usize) -> bool {
    let symbol = |at: usize| module.tokens[at].symbol;
    let begins = [known::OPEN, known::COMMA];
    if !token.checked_sub(1).is_some_and(|before| begins.contains(&symbol(before))) {
        return false;
    }
    let mut closed = 0;
    for at in (token.saturating_sub(LAYOUT)..token).rev() {
        match symbol(at) {
            known::CLOSE => closed += 1,
            known::OPEN if closed > 0 => closed -= 1,
            known::OPEN => return at > 0 && symbol(at - 1) == known::LAYOUT,
            known::SEMICOLON | known::OPEN_BRACE | known::CLOSE_BRACE => return false,
            _ => {}
        }
    }
    false
}
