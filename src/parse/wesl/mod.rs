//! WESL text to a [`Module`]: one pass over the characters, one over the tokens.
//!
//! There is no syntax tree: composing needs items, scopes and conditions, and naga parses the
//! composed text anyway.

pub(crate) mod blank;
mod body;
mod condition;
mod cursor;
mod import;
mod item;
mod module;
mod name;
mod scope;
mod statement;
mod token;
mod trivia;

pub use module::{
    Comparison, Condition, ConditionId, Directive, Event, Expression, ExpressionId, Guard, Import,
    Item, ItemKind, Module, Operand, Origin, Parts, Path, Reference,
};
pub use name::{Name, Names, is_keyword};

use std::sync::Arc;

use crate::source::SourceId;

/// The most errors of one file that are reported.
const ERRORS: usize = 50;

/// Parses a file. Its errors are in [`Module::errors`]. What follows an error may be missing from
/// the rest.
pub fn parse(source: SourceId, text: Arc<str>, names: &mut Names) -> Module {
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
        errors: Vec::new(),
    };
    match token::tokenise(&text, source, names) {
        Ok(tokens) => {
            let found = item::split(&mut module, &tokens, names);
            body::scan(&mut module, &tokens, names, found);
        }
        Err(error) => module.errors.push(error),
    }
    module.errors.truncate(ERRORS);
    module
}
