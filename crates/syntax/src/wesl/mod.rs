//! Parses WESL text into a [`Module`], by one pass over the characters and two over the tokens.
//!
//! There is no syntax tree: composing needs items, scopes and conditions, and naga parses the
//! composed text anyway.

pub mod blank;
mod body;
mod condition;
mod item;
mod module;
mod token;

pub use module::{
    ComparisonOperand, ComparisonOperator, Condition, ConditionId, Directive, Event, Expression,
    ExpressionId, Guard, Import, Item, ItemKind, LocalUse, Module, Origin, Path, PathParts,
    PlacedModule, UsedName,
};
pub use token::{Name, Names, is_keyword, is_path_name, keywords};

use std::sync::Arc;

use lamplight_diagnostic::source::SourceId;

/// The most errors of one file that are reported.
const ERRORS: usize = 50;

/// Parses a file. Its errors are in [`Module::errors`]. Some of the text after an error may not be
/// parsed.
pub fn parse(source: SourceId, text: Arc<str>, names: &mut Names) -> Module {
    parse_with(source, text, names, false)
}

/// As [`parse`], with [`Module::local_uses`]: editors ask for those, composing does not.
pub fn parse_for_editor(source: SourceId, text: Arc<str>, names: &mut Names) -> Module {
    parse_with(source, text, names, true)
}

fn parse_with(source: SourceId, text: Arc<str>, names: &mut Names, locals: bool) -> Module {
    let mut module = Module {
        source,
        text: Arc::clone(&text),
        directives: Vec::new(),
        imports: Vec::new(),
        items: Vec::new(),
        conditions: Vec::new(),
        expressions: Vec::new(),
        references: Vec::new(),
        guards: Vec::new(),
        local_uses: Vec::new(),
        errors: Vec::new(),
        warnings: Vec::new(),
    };
    match token::tokenize(&text, source, names) {
        Ok(tokens) => {
            let found = item::split_items(&mut module, &tokens, names);
            body::scan_body(&mut module, &tokens, names, found, locals);
        }
        Err(error) => module.errors.push(error),
    }
    module.errors.truncate(ERRORS);
    module.warnings.truncate(ERRORS);
    module
}
