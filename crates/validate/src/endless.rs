//! Functions that end in a loop without an exit.
//!
//! Such a function needs no `return` at its end in WGSL, since nothing gets there. naga puts a `return`
//! without a value behind the loop, and its validator refuses that. It gets a value here, which other
//! languages need too.

use naga::{Block, Expression, Function, Module, Span, Statement};

/// Gives a value to each `return` that nothing gets to.
pub fn return_values(module: &mut Module) {
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    let points = module.entry_points.iter_mut().map(|point| &mut point.function);
    functions.chain(points).for_each(return_value);
}

fn return_value(function: &mut Function) {
    let Some(result) = &function.result else { return };
    let zero = Expression::ZeroValue(result.ty);
    let places = ends(&mut function.body);
    if places.is_empty() {
        return;
    }
    let value = function.expressions.append(zero, Span::UNDEFINED);
    places.into_iter().for_each(|place| *place = Some(value));
}

/// The values of the statements that naga added behind loops without an exit. Those that an author wrote
/// have a place in the text, and are wrong without a value.
fn ends(block: &mut Block) -> Vec<&mut Option<naga::Handle<Expression>>> {
    let statements: Vec<_> = block.span_iter().collect();
    let is_added = match statements.as_slice() {
        [
            ..,
            (Statement::Loop { body, continuing, break_if: None }, _),
            (Statement::Return { value: None }, span),
        ] => !span.is_defined() && !has_break(body) && !has_break(continuing),
        _ => false,
    };
    match block.last_mut() {
        Some(Statement::Return { value }) if is_added => vec![value],
        Some(Statement::Block(block)) => ends(block),
        Some(Statement::If { condition: _, accept, reject }) => {
            ends(accept).into_iter().chain(ends(reject)).collect()
        }
        Some(Statement::Switch { selector: _, cases }) => {
            cases.iter_mut().flat_map(|case| ends(&mut case.body)).collect()
        }
        _ => Vec::new(),
    }
}

/// Whether a block leaves the loop that it is in.
fn has_break(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Break => true,
        Statement::Block(block) => has_break(block),
        Statement::If { condition: _, accept, reject } => has_break(accept) || has_break(reject),
        // A `break` in a loop or a `switch` leaves that one.
        _ => false,
    })
}

#[cfg(test)]
mod tests {
    use crate::{info_for_some, parse_wgsl};

    fn is_valid(body: &str) -> bool {
        let text = format!("fn f(x: i32) -> i32 {{ var i = x; {body} }}");
        let mut module = parse_wgsl(&text).unwrap();
        super::return_values(&mut module);
        info_for_some(&module).is_ok()
    }

    #[test]
    fn loops_without_an_exit_need_no_return() {
        for body in [
            "loop { i += 1; if i > 4 { return i; } }",
            "loop { i += 1; if i > 4 { return i; } continuing { i *= 2; } }",
            "loop { loop { i += 1; if i > 4 { break; } } if i > 9 { return i; } }",
            "loop { switch i { case 3: { return 1; } default: { break; } } i += 1; }",
            "if x > 0 { return 1; } else { loop { i += 1; if i > 4 { return i; } } }",
            "switch x { case 1: { return 1; } default: { loop { if i > 4 { return i; } i += 1; } } }",
            "{ loop { i += 1; if i > 4 { return i; } } }",
        ] {
            assert!(is_valid(body), "{body}");
        }
    }

    #[test]
    fn others_do() {
        for body in [
            "loop { i += 1; if i > 4 { break; } }",
            "loop { i += 1; if i > 4 { return i; } continuing { break if i > 9; } }",
            "while i < 4 { i += 1; }",
            "for (; i < 4; i++) { return 1; }",
            "if x > 0 { loop { if i > 4 { return i; } i += 1; } }",
            "loop { if i > 4 { return i; } i += 1; } i = 3;",
            "loop { if i > 4 { return i; } i += 1; } return;",
        ] {
            assert!(!is_valid(body), "{body}");
        }
    }
}
