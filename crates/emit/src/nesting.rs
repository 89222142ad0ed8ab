//! How deep the statements of a function nest, as browsers count them in WGSL. naga writes each
//! `else if` within the braces of the `else` before it, so a long chain of them nests deeply.

use naga::{Block, Module, Statement};

use lamplight_validate::inner_blocks;

/// The most statements within each other that browsers take. A branch is one statement and its block
/// another; a case is one more.
const DEEPEST: usize = 127;

/// Why browsers would refuse the module as WGSL; `None` where they take it.
pub fn nesting_lack(module: &Module) -> Option<String> {
    let points = module.entry_points.iter().map(|point| (Some(&point.name), &point.function));
    let functions = module.functions.iter().map(|(_, function)| (function.name.as_ref(), function));
    let mut all = functions.chain(points);
    let (name, _) = all.find(|(_, function)| depth(&function.body) > DEEPEST)?;
    let name = name.map_or("a function", String::as_str);
    Some(format!(
        "`{name}` nests its statements more than {DEEPEST} deep, of which `else if` takes two each: \
         put a part of them into a function of their own"
    ))
}

fn depth(block: &Block) -> usize {
    let of_statement = |statement: &Statement| {
        let own = match statement {
            Statement::Block(_) => 0,
            Statement::Switch { selector: _, cases: _ } => 2,
            _ => 1,
        };
        own + inner_blocks(statement).into_iter().map(depth).max().unwrap_or(0)
    };
    1 + block.iter().map(of_statement).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_are_those_of_tint() {
        let is_refused = |count: usize, open: &str, close: &str| {
            let (open, close) = (open.repeat(count), close.repeat(count));
            let text = format!("fn f(x: f32) -> f32 {{ {open} {close} return x; }}");
            nesting_lack(&naga::front::wgsl::parse_str(&text).unwrap()).is_some()
        };
        for (open, close, most) in [
            ("if x > 1 {", "}", 63),
            ("if x > 1 { } else {", "}", 63),
            ("switch i32(x) { default {", "} }", 42),
        ] {
            assert!(!is_refused(most, open, close), "{open}");
            assert!(is_refused(most + 1, open, close), "{open}");
        }
    }
}
