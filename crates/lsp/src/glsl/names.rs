//! What an identifier in a GLSL file refers to.

use std::ops::Range;

use super::outline::{GlslDeclaration, GlslOutline, Local, SymbolKind, outline_of};
use lamplight_catalogue::prefix;
use lamplight_compose::resolve::glsl::{Graph, IncludeTarget};
use lamplight_syntax::glsl::{Directive, FilePart, Symbol, TokenKind, known};

/// A file, all that it may include, and what each of these declares.
pub struct GlslNames {
    pub graph: Graph,
    pub outlines: Vec<GlslOutline>,
}

/// What a name stands for.
pub enum NameMeaning<'n> {
    /// A parameter or a local variable of the file itself.
    Local(&'n Local),
    /// Declarations by the number of their file: several if a function has several forms.
    Declared(Vec<(usize, &'n GlslDeclaration)>),
    /// A file that is included, by its number.
    File(usize),
    /// The name of a macro that no file defines. It may be an axis.
    Macro(&'n str),
}

impl GlslNames {
    pub fn new(graph: Graph) -> Self {
        let outline = |module| outline_of(module, &graph.symbols);
        let outlines = graph.modules.iter().map(outline).collect();
        Self { graph, outlines }
    }

    /// What the identifier or the path of an `#include` at a byte of the root file stands for, with
    /// its place.
    pub fn meaning(&self, byte: u32) -> Option<(NameMeaning<'_>, Range<u32>)> {
        let module = self.graph.modules.first()?;
        let has = |range: &Range<u32>| range.start <= byte && byte <= range.end;
        for (include, target) in module.includes.iter().zip(self.graph.targets.first()?) {
            let place = include.span.start..include.span.end;
            if let (true, IncludeTarget::Module(file)) = (has(&place), target) {
                return Some((NameMeaning::File(*file), place));
            }
        }
        let at = self.token_at(0, byte)?;
        let token = module.tokens[at];
        let place = token.start..token.end;
        let before = at.checked_sub(1).map(|index| module.tokens[index].symbol);
        if before == Some(known::DOT) {
            // A member, unless it is the swizzle of a vector.
            let members = self.declared(token.symbol, |kind| kind == SymbolKind::Member);
            return (!members.is_empty()).then_some((NameMeaning::Declared(members), place));
        }
        if let Some(local) = self.local(0, token.symbol, token.start) {
            return Some((NameMeaning::Local(local), place));
        }
        let found = self.global(token.symbol);
        if !found.is_empty() {
            return Some((NameMeaning::Declared(found), place));
        }
        let text = self.graph.symbols.text(token.symbol);
        self.is_in_directive(token.start).then_some((NameMeaning::Macro(text), place))
    }

    /// The local of that name that is known at a byte of a file and was declared last before it.
    pub fn local(&self, file: usize, name: Symbol, byte: u32) -> Option<&Local> {
        let locals = &self.outlines.get(file)?.locals;
        let before = locals.partition_point(|local| local.place.start <= byte);
        locals[..before].iter().rev().find(|local| local.name == name && local.is_known(byte))
    }

    /// The identifier at a byte of a file, as the number of its token.
    pub fn token_at(&self, file: usize, byte: u32) -> Option<usize> {
        let tokens = &self.graph.modules.get(file)?.tokens;
        let after = tokens.partition_point(|token| token.start <= byte);
        // On the border of two tokens, the one before counts if the one after is no identifier.
        let mut near = (after.saturating_sub(2)..after).rev();
        near.find(|at| tokens[*at].kind == TokenKind::Identifier && byte <= tokens[*at].end)
    }

    /// Locals that are known at a byte.
    pub fn locals_at(&self, byte: u32) -> impl Iterator<Item = &Local> {
        let locals = self.outlines.first().into_iter().flat_map(|outline| &outline.locals);
        locals.filter(move |local| local.start <= byte && byte < local.end)
    }

    /// Declarations of a name in global scope: those of the file itself, or else those of its
    /// includes, or else those of the library's name without its prefix.
    fn global(&self, name: Symbol) -> Vec<(usize, &GlslDeclaration)> {
        let found = self.declared(name, |kind| kind != SymbolKind::Member);
        if !found.is_empty() {
            return found;
        }
        let bare = self.graph.symbols.text(name).strip_prefix(prefix::PREFIX);
        let bare = bare.and_then(|bare| self.graph.symbols.find(bare));
        bare.map(|bare| self.declared(bare, |kind| kind != SymbolKind::Member)).unwrap_or_default()
    }

    fn declared(
        &self,
        name: Symbol,
        fits: impl Fn(SymbolKind) -> bool,
    ) -> Vec<(usize, &GlslDeclaration)> {
        let all = self.outlines.iter().enumerate().flat_map(|(file, outline)| {
            outline.declarations.iter().map(move |declaration| (file, declaration))
        });
        let mut found: Vec<_> = all
            .filter(|(_, declaration)| declaration.name == name && fits(declaration.kind))
            .collect();
        // The library's file of prefixes defines a macro for each of its names.
        if found.iter().any(|(_, declaration)| declaration.kind != SymbolKind::Macro) {
            found.retain(|(_, declaration)| declaration.kind != SymbolKind::Macro);
        }
        if found.iter().any(|(file, _)| *file == 0) {
            found.retain(|(file, _)| *file == 0);
        }
        found
    }

    fn is_in_directive(&self, byte: u32) -> bool {
        let parts = self.graph.modules.first().into_iter().flat_map(|module| &module.parts);
        parts.into_iter().any(|part| match part {
            FilePart::Directive(Directive::Include(_), _) | FilePart::Text(_) => false,
            FilePart::Directive(_, span) => span.start <= byte && byte < span.end,
        })
    }
}
