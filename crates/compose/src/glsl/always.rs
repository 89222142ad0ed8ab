//! Warns of `#ifdef`, `#ifndef` and `defined` of a setting. Such a condition has one result only,
//! since every setting is defined: as 0 if it is off. There is no warning if the setting is on, or
//! if `#ifndef X` gives `X` a default.

use super::expand::Expander;
use super::table::MacroMeaning;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_syntax::glsl::{Directive, FilePart, Module, Symbol, known};

/// The warning about the branch at `index`, if it asks whether a setting is defined.
pub fn always_warning(
    expander: &Expander<'_, '_>,
    module: &Module,
    index: usize,
) -> Option<Diagnostic> {
    let FilePart::Directive(directive, span) = module.parts.get(index)? else { return None };
    let (name, negated) = tested_macro(module, directive)?;
    // If the setting is on, `defined` gives the same answer as its value, so nothing is odd.
    match expander.table.get(name)? {
        MacroMeaning::Setting(setting) if !expander.reads.is_on(setting) => {}
        _ => return None,
    }
    // `#ifndef` around a `#define` gives a default, for compilers that know no settings.
    let gives_default = |part: &FilePart| matches!(part, FilePart::Directive(Directive::Define(given), _) if given.name == name);
    if negated && module.parts.get(index + 1).is_some_and(gives_default) {
        return None;
    }
    let macro_name = expander.table.spellings.text(name);
    let sign = if negated { "!" } else { "" };
    let message = format!("the setting `{macro_name}` is always defined, as 0 where it is off");
    let label = if negated { "never holds" } else { "always holds" };
    Some(
        Diagnostic::warning(codes::ALWAYS_DEFINED, message)
            .at(*span, label)
            .note(format!("help: ask for its value: `#if {sign}{macro_name}`")),
    )
}

/// The macro that a directive tests for being defined, and whether the test is negated. `None` if
/// the directive tests anything else.
fn tested_macro(module: &Module, directive: &Directive) -> Option<(Symbol, bool)> {
    match directive {
        Directive::Ifdef { name: Ok(name), negated, .. } => Some((*name, *negated)),
        Directive::If { condition, .. } | Directive::Elif { condition, .. } => {
            let tokens = &module.tokens[condition.start as usize..condition.end as usize];
            let symbols: Vec<Symbol> = tokens.iter().map(|token| token.symbol).collect();
            let (negated, rest) = match symbols.split_first()? {
                (first, rest) if *first == known::NOT => (true, rest),
                _ => (false, &symbols[..]),
            };
            match rest {
                [word, name] if *word == known::DEFINED => Some((*name, negated)),
                [word, open, name, _] if *word == known::DEFINED && *open == known::OPEN => {
                    Some((*name, negated))
                }
                _ => None,
            }
        }
        _ => None,
    }
}
