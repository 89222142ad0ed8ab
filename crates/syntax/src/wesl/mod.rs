//! Parses WESL text into a [`Module`], by one pass over the characters and two over the tokens.
//!
//! There is no syntax tree: composing needs items, scopes and conditions, and naga parses the
//! composed text anyway.

mod advice;
pub use advice::unclosed_by_indentation;
mod balance;
pub mod blank;
mod body;
mod condition;
mod item;
mod module;
mod template;
mod token;

pub use condition::{Attributes, Chain, read_attributes};
pub use item::{ItemPlace, after_template, read_origin};
pub use module::{
    ComparisonOperand, ComparisonOperator, Condition, ConditionId, Directive, Event, Expression,
    ExpressionId, Guard, Import, Item, ItemKind, LocalUse, Module, Origin, Path, PathParts,
    PlacedModule, UsedName, Visibility, Wildcard,
};
pub use template::{Piece, template_lists};
pub use token::{Name, Names, Token, TokenKind, Tokens, is_keyword, is_path_name, keywords};

use std::sync::Arc;

use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::SourceId;

/// The most errors of one file that are reported.
const ERRORS: usize = 50;

/// Parses a file. Its errors are in [`Module::errors`]. After an error, parsing goes on with the next
/// statement or declaration. An error of brackets, comments or characters is the only one of its
/// file.
pub fn parse(source: SourceId, text: Arc<str>, names: &mut Names) -> Module {
    parse_with(source, text, names, false)
}

/// As [`parse`], with [`Module::local_uses`]: editors ask for those, composing does not.
pub fn parse_for_editor(source: SourceId, text: Arc<str>, names: &mut Names) -> Module {
    parse_with(source, text, names, true)
}

/// A file as tokens, for readers that go into the bodies of items.
#[derive(Debug)]
pub struct SplitModule {
    /// Its imports, items and the conditions of both. Bodies are not read: there are no events.
    pub module: Module,
    pub tokens: Vec<Token>,
    /// Where each item is among the tokens.
    pub places: Vec<ItemPlace>,
}

/// Reads a file's imports and the heads of its items.
pub fn split_module(
    source: SourceId,
    text: Arc<str>,
    names: &mut Names,
) -> Result<SplitModule, Diagnostics> {
    let tokens = token::tokenize(&text, source, names).map_err(|error| vec![error])?;
    let mut module = empty_module(source, text);
    let places = item::split_items(&mut module, &tokens, names);
    match module.errors.is_empty() {
        true => Ok(SplitModule { module, tokens, places }),
        false => Err(module.errors),
    }
}

fn empty_module(source: SourceId, text: Arc<str>) -> Module {
    Module {
        source,
        text,
        directives: Vec::new(),
        imports: Vec::new(),
        wildcards: Vec::new(),
        is_wildcardable: false,
        says_visibility: false,
        items: Vec::new(),
        conditions: Vec::new(),
        expressions: Vec::new(),
        references: Vec::new(),
        guards: Vec::new(),
        local_uses: Vec::new(),
        errors: Vec::new(),
        warnings: Vec::new(),
    }
}

fn says_visibility(module: &Module) -> bool {
    module.items.iter().any(|item| item.visibility != Visibility::Package)
        || module.imports.iter().any(|import| import.is_public)
        || module.is_wildcardable
}

fn parse_with(source: SourceId, text: Arc<str>, names: &mut Names, locals: bool) -> Module {
    let mut module = empty_module(source, Arc::clone(&text));
    match token::tokenize_damaged(&text, source, names) {
        Ok(token::DamagedTokens { tokens, error }) => {
            let found = item::split_items(&mut module, &tokens, names);
            module.says_visibility = says_visibility(&module);
            body::scan_body(&mut module, &tokens, names, found, locals);
            if let Some(error) = error {
                // What else is found may follow from it.
                module.errors = vec![error];
                module.warnings.clear();
            }
        }
        Err(error) => module.errors.push(error),
    }
    module.errors.truncate(ERRORS);
    module.warnings.truncate(ERRORS);
    module
}
