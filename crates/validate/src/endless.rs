//! Functions whose ends nothing gets to, such as those that end in a loop without an exit.
//!
//! Such a function needs no `return` at its end in WGSL. naga puts a `return` without a value there, and
//! its validator refuses that. It gets a value here, which other languages need too. What is reached is
//! what the behaviours of statements say, in the specification's section "Behaviors".

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
    let ends = unreached_ends(&mut function.body, true);
    if ends.is_empty() {
        return;
    }
    let value = function.expressions.append(zero, Span::UNDEFINED);
    ends.into_iter().for_each(|end| *end = Some(value));
}

/// The values of the statements that naga added where nothing gets to. Those that an author wrote have a
/// place in the text, and are wrong without a value.
fn unreached_ends(
    block: &mut Block,
    is_reached: bool,
) -> Vec<&mut Option<naga::Handle<Expression>>> {
    let before = block.len().saturating_sub(1);
    let is_reached = is_reached && block.iter().take(before).all(goes_on);
    match block.span_iter_mut().last() {
        Some((Statement::Return { value: value @ None }, span)) => {
            let is_added = span.is_none_or(|span| !span.is_defined());
            if is_added && !is_reached { vec![value] } else { Vec::new() }
        }
        Some((Statement::Block(block), _)) => unreached_ends(block, is_reached),
        Some((Statement::If { condition: _, accept, reject }, _)) => {
            let accepted = unreached_ends(accept, is_reached);
            accepted.into_iter().chain(unreached_ends(reject, is_reached)).collect()
        }
        Some((Statement::Switch { selector: _, cases }, _)) => {
            cases.iter_mut().flat_map(|case| unreached_ends(&mut case.body, is_reached)).collect()
        }
        _ => Vec::new(),
    }
}

/// Whether what follows a statement may be reached.
fn goes_on(statement: &Statement) -> bool {
    match statement {
        Statement::Return { .. } | Statement::Break | Statement::Continue => false,
        Statement::Block(block) => block.iter().all(goes_on),
        Statement::If { condition: _, accept, reject } => {
            [accept, reject].into_iter().any(|block| block.iter().all(goes_on))
        }
        // A case that falls through goes on in the next one.
        Statement::Switch { selector: _, cases } => cases.iter().any(|case| {
            leaves(&case.body, Jump::Break) || (!case.fall_through && case.body.iter().all(goes_on))
        }),
        Statement::Loop { body, continuing, break_if } => {
            let continues = || body.iter().all(goes_on) || leaves(body, Jump::Continue);
            let breaks = break_if.is_some() || leaves(continuing, Jump::Break);
            leaves(body, Jump::Break) || (breaks && continues())
        }
        _ => true,
    }
}

/// How a block of a loop or a `switch` is left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Jump {
    Break,
    Continue,
}

/// Whether a statement that is reached leaves what the block is in.
fn leaves(block: &Block, jump: Jump) -> bool {
    for statement in block {
        let is_left = match statement {
            Statement::Break => jump == Jump::Break,
            Statement::Continue => jump == Jump::Continue,
            Statement::Block(block) => leaves(block, jump),
            Statement::If { condition: _, accept, reject } => {
                leaves(accept, jump) || leaves(reject, jump)
            }
            // A `break` in a `switch` leaves that one.
            Statement::Switch { selector: _, cases } if jump == Jump::Continue => {
                cases.iter().any(|case| leaves(&case.body, jump))
            }
            _ => false,
        };
        if is_left || !goes_on(statement) {
            return is_left;
        }
    }
    false
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
            "{ return i; } i += 1;",
            "loop { return i; continuing { break if i > 9; } }",
            "loop { switch x { case 1: { return i; } default: { return 2; } } continuing { break if i > 9; } }",
            "loop { return i; } i += 1;",
            "loop { { return i; } break; }",
            "if x > 0 { return 1; } else { return 2; } if x > 3 { i += 1; }",
            "switch x { case 1: { return 1; } default: { return 2; } } i += 1;",
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
            "loop { if i > 4 { continue; } return i; continuing { break if i > 9; } }",
            "loop { switch x { case 1: { continue; } default: { return 2; } } continuing { break if i > 9; } }",
            "for (; i < 4; i++) { return 1; }",
            "if x > 0 { loop { if i > 4 { return i; } i += 1; } }",
            "switch x { case 1: { return 1; } default: { break; } } i += 1;",
            "switch x { case 1: { if i > 3 { break; } return 1; } default: { return 2; } } i = 3;",
            "if x > 0 { return 1; } i += 1;",
            "loop { if i > 4 { break; } return 1; } i = 3;",
            "loop { if i > 4 { return i; } i += 1; } return;",
        ] {
            assert!(!is_valid(body), "{body}");
        }
    }
}
