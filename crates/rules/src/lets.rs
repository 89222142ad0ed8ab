//! Values of `let` that are made of constants.
//!
//! They are no constants: `let a = 0; 1 / a` is computed as the shader runs, where it has a value.
//! naga puts the value of `a` in the place of its name, and refuses `1 / 0`.

use super::lookup::each_statement;
use super::names::{Global, Module};
use super::parse;
use super::syntax::{DeclarationKind, ExprId, ExprKind, LocalId, StatementKind, Tree};

/// The text with `var` in the place of `let` where the value is made of constants and of other such
/// values: naga computes nothing of what a variable holds. Everything keeps its place. `None` where there
/// is none. It needs a large stack.
pub fn with_variables(text: &str) -> Option<String> {
    let (tree, _) = parse::parse(text)?.ok()?;
    let module = Module::read(&tree);
    let (mut made, mut found, mut changed) = (text.to_owned(), Vec::new(), Vec::new());
    for function in &tree.functions {
        each_statement(&function.body, &mut |statement| match &statement.kind {
            StatementKind::Declare(local, declaration)
                if declaration.kind == DeclarationKind::Let =>
            {
                let is_such = |value: ExprId| is_of_constants(&tree, &module, &found, value);
                let start = statement.place.start as usize;
                let is_such = declaration.value.is_some_and(is_such);
                if is_such && text[start..].starts_with("let") {
                    made.replace_range(start..start + 3, "var");
                    found.push(*local);
                }
            }
            StatementKind::Assign { target: Some(target), operator: _, value: _ }
            | StatementKind::Count { target } => changed.extend(root(&tree, *target)),
            _ => {}
        });
    }
    let pointed = tree.expressions.iter().filter_map(|expression| match expression.kind {
        ExprKind::AddressOf(inner) => root(&tree, inner),
        _ => None,
    });
    changed.extend(pointed);
    // What changes a `let` is wrong, and has to stay so.
    let is_right = !found.is_empty() && !changed.iter().any(|local| found.contains(local));
    is_right.then_some(made)
}

/// The local that an expression is, or is a part of.
fn root(tree: &Tree<'_>, id: ExprId) -> Option<LocalId> {
    match tree.kind(id) {
        ExprKind::Name { name: _, template: _, local } => *local,
        ExprKind::Member { base, name: _ } | ExprKind::Index { base, index: _ } => {
            root(tree, *base)
        }
        ExprKind::Parenthesized(inner)
        | ExprKind::AddressOf(inner)
        | ExprKind::Indirection(inner) => root(tree, *inner),
        ExprKind::Literal(_)
        | ExprKind::Call { .. }
        | ExprKind::Unary { .. }
        | ExprKind::Binary { .. } => None,
    }
}

/// Whether a value is made of constants, and of locals that are known to be.
fn is_of_constants(
    tree: &Tree<'_>,
    module: &Module<'_, '_>,
    known: &[LocalId],
    value: ExprId,
) -> bool {
    let all =
        |values: &[ExprId]| values.iter().all(|value| is_of_constants(tree, module, known, *value));
    match tree.kind(value) {
        ExprKind::Literal(_) => true,
        ExprKind::Name { name: _, template: _, local: Some(local) } => {
            let is_constant = tree.locals[*local as usize].constant.is_some();
            is_constant || known.contains(local)
        }
        ExprKind::Name { name, template: _, local: None } => {
            matches!(module.find(name), Some(Global::Constant(_)))
        }
        ExprKind::Call { callee, template: _, arguments } => {
            !matches!(module.find(callee), Some(Global::Function(_))) && all(arguments)
        }
        ExprKind::Member { base, name: _ } => all(&[*base]),
        ExprKind::Index { base, index } => all(&[*base, *index]),
        ExprKind::Unary { operator: _, operand } => all(&[*operand]),
        ExprKind::Binary { operator: _, left, right } => all(&[*left, *right]),
        ExprKind::Parenthesized(inner) => all(&[*inner]),
        ExprKind::AddressOf(_) | ExprKind::Indirection(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::with_variables;

    /// Which names become variables.
    #[track_caller]
    fn variables(body: &str) -> String {
        let text = format!(
            "const c = 2; @group(0) @binding(0) var t: texture_2d<f32>; var<private> p: i32;
            fn g(x: i32) -> i32 {{ return x; }} fn f(x: i32) {{ {body} }}"
        );
        let made = with_variables(&text).unwrap_or_default();
        let names = made.split("var ").skip(2);
        names.filter_map(|rest| rest.split([' ', ':']).next()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn values_of_constants_become_variables() {
        assert_eq!(variables("let a = 33u; let b = vec2f(f32(c), 1.0)[0] + abs(-1.0);"), "a b");
        assert_eq!(variables("let a = 1; if true { let b: i32 = a * (2 + c); }"), "a b");
        assert_eq!(variables("const k = 3; let a = k; for (let b = a; b > 4;) {}"), "a b");
    }

    #[test]
    fn others_stay() {
        for body in ["let a = x;", "let a = p;", "let a = &p;", "let a = g(1);", "let a = x + 1;"] {
            assert_eq!(variables(body), "", "{body}");
        }
        assert_eq!(variables("let a = &p; let b = *a; let d = t; const e = 1;"), "");
    }

    #[test]
    fn what_must_not_change_stays() {
        for body in [
            "let a = 1; a = 2;",
            "let a = 1; (a) += 2;",
            "for (let a = 0; a < 4; a++) {}",
            "let a = vec2(1); a.x = 2;",
            "let a = array(1, 2); let p = &a[1];",
            "let a = 1; g(*&a);",
        ] {
            assert_eq!(variables(body), "", "{body}");
        }
    }

    #[test]
    fn everything_keeps_its_place() {
        let text = "fn f() { let a = 0; let b = 1 / a; }";
        assert_eq!(with_variables(text).unwrap(), "fn f() { var a = 0; var b = 1 / a; }");
    }
}
