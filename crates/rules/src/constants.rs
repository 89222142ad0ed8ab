//! Built-in functions with constant arguments that have no value.

use super::names::{Global, Module, is_of_subgroups};
use super::syntax::{DeclarationKind, ExprId, ExprKind, Tree};
use super::{Problem, Rule};

pub fn check(tree: &Tree<'_>, module: &Module<'_, '_>) -> Vec<Problem> {
    let mut problems = Vec::new();
    let has_subgroups = tree.enabled.contains(&"subgroups");
    for expression in &tree.expressions {
        let ExprKind::Call { callee, template: _, arguments } = &expression.kind else { continue };
        if module.find(callee).is_some() {
            continue;
        }
        if is_of_subgroups(callee) && !has_subgroups {
            let message = format!("`{callee}` needs `enable subgroups;`");
            problems.push(Problem::new(Rule::Grammar, expression.place, message));
        }
        if let Some(message) = wrong_call(module, callee, arguments) {
            problems.push(Problem::new(Rule::Constant, expression.place, message));
        }
    }
    problems
}

/// A whole number without a suffix where it becomes an `i32` that it does not fit.
pub fn check_untyped(tree: &Tree<'_>, id: ExprId) -> Option<Problem> {
    let ExprKind::Literal(text) = tree.kind(tree.inner(id)) else { return None };
    let is_whole = text.parse::<u64>().is_ok_and(|value| value > i32::MAX as u64);
    let message = format!("{text} does not fit `i32`, the type that it gets here");
    is_whole.then(|| Problem::new(Rule::Constant, tree.place(id), message))
}

/// Why a call of a built-in function has no value.
fn wrong_call(module: &Module<'_, '_>, name: &str, arguments: &[ExprId]) -> Option<String> {
    let values = |at: usize| arguments.get(at).and_then(|id| values_of(module, *id, 0));
    let number = |at: usize| values(at).and_then(|found| found.first().copied());
    match name {
        "inverseSqrt" => {
            let is_wrong = values(0)?.iter().any(|value| *value <= 0.0);
            is_wrong.then(|| "`inverseSqrt` needs a number above 0".to_owned())
        }
        "extractBits" | "insertBits" => {
            let first = arguments.len().checked_sub(2)?;
            let is_wrong = number(first)? + number(first + 1)? > 32.0;
            is_wrong.then(|| format!("offset and count of `{name}` are more than 32 bits"))
        }
        "ldexp" => {
            let most = match (written_suffix(module, arguments), values(0)) {
                (Some('h'), _) => 16.0,
                (Some(_), _) | (None, None) => 128.0,
                // A number without a suffix has the range of f64.
                (None, Some(_)) => return None,
            };
            let is_wrong = values(1)?.iter().any(|value| *value > most);
            is_wrong.then(|| format!("the exponent of `ldexp` is above {most}"))
        }
        "smoothstep" => {
            let (low, high) = (values(0)?, values(1)?);
            let is_wrong = low.iter().zip(&high).any(|(low, high)| low == high);
            is_wrong.then(|| "both edges of `smoothstep` are the same".to_owned())
        }
        "fma" => {
            let (left, right) = (values(0)?, values(1)?);
            let products = left.iter().zip(&right).map(|(left, right)| left * right);
            overflow(name, products, written_suffix(module, arguments))
        }
        "cross" => {
            let (left, right) = (values(0)?, values(1)?);
            let products = left.iter().flat_map(|left| right.iter().map(move |right| left * right));
            overflow(name, products, written_suffix(module, arguments))
        }
        _ if name.starts_with("texture") => wrong_texture(module, name, arguments),
        _ => None,
    }
}

/// Why products are out of the range of their type.
fn overflow(
    name: &str,
    mut products: impl Iterator<Item = f64>,
    suffix: Option<char>,
) -> Option<String> {
    let most = match suffix {
        Some('h') => 65504.0,
        Some(_) => f64::from(f32::MAX),
        None => f64::MAX,
    };
    let is_wrong = products.any(|product| product.abs() > most);
    is_wrong.then(|| format!("a product in `{name}` is out of range"))
}

/// The suffix that a number among the arguments has, `f` or `h`.
fn written_suffix(module: &Module<'_, '_>, arguments: &[ExprId]) -> Option<char> {
    arguments.iter().find_map(|id| match module.tree.kind(*id) {
        ExprKind::Literal(text) => text.chars().last().filter(|last| matches!(last, 'f' | 'h')),
        ExprKind::Call { callee, template: _, arguments } => {
            let own = callee.strip_prefix("vec").and_then(|rest| rest.chars().nth(1));
            own.filter(|last| matches!(last, 'f' | 'h'))
                .or_else(|| written_suffix(module, arguments))
        }
        ExprKind::Unary { operator: _, operand } => written_suffix(module, &[*operand]),
        _ => None,
    })
}

/// Why a texture of this kind cannot be read so.
fn wrong_texture(module: &Module<'_, '_>, name: &str, arguments: &[ExprId]) -> Option<String> {
    let at = usize::from(component(module, name, arguments).is_some());
    let of_type = module.declared_type(*arguments.get(at)?);
    let kind = of_type.and_then(|id| module.type_of(id)).map_or("", |(kind, _)| kind);
    if at == 1 && kind.starts_with("texture_depth_") {
        return Some("a depth texture has no component to choose".to_owned());
    }
    let offset = offset_values(module, name, kind, arguments)?;
    if kind.contains("_cube") && offset.len() > 1 {
        return Some("cube textures are sampled without an offset".to_owned());
    }
    let is_wrong = offset.len() > 1 && offset.iter().any(|value| !(-8.0..=7.0).contains(value));
    is_wrong.then(|| "an offset of texels must be in -8..=7".to_owned())
}

/// The component that `textureGather` of colours has before the texture.
fn component(module: &Module<'_, '_>, name: &str, arguments: &[ExprId]) -> Option<f64> {
    let first = arguments.first().filter(|_| name == "textureGather")?;
    match values_of(module, *first, 0)?.as_slice() {
        [component] => Some(*component),
        _ => None,
    }
}

/// The offset of texels, where the last argument is one.
fn offset_values(
    module: &Module<'_, '_>,
    name: &str,
    kind: &str,
    arguments: &[ExprId],
) -> Option<Vec<f64>> {
    let first = match name {
        "textureSample"
        | "textureSampleBias"
        | "textureSampleCompare"
        | "textureGather"
        | "textureSampleCompareLevel"
        | "textureSampleLevel"
        | "textureGatherCompare" => 3,
        // Two gradients stand before, and the layer of an array.
        "textureSampleGrad" if kind.is_empty() => 6,
        "textureSampleGrad" => 5 + usize::from(kind.contains("_array")),
        _ => return None,
    };
    let first = first + usize::from(component(module, name, arguments).is_some());
    let last = arguments.len().checked_sub(1).filter(|last| *last >= first)?;
    values_of(module, arguments[last], 0)
}

/// The components of a constant of literals; `None` for anything else.
fn values_of(module: &Module<'_, '_>, id: ExprId, depth: usize) -> Option<Vec<f64>> {
    if depth > 16 {
        return None;
    }
    match module.tree.kind(id) {
        ExprKind::Literal(text) => literal(text).map(|value| vec![value]),
        ExprKind::Parenthesized(inner) => values_of(module, *inner, depth + 1),
        ExprKind::Unary { operator: "-", operand } => {
            let values = values_of(module, *operand, depth + 1)?;
            Some(values.into_iter().map(|value| -value).collect())
        }
        ExprKind::Call { callee, template: _, arguments } => {
            construct(module, callee, arguments, depth)
        }
        ExprKind::Name { name: _, template: _, local: Some(local) } => {
            values_of(module, module.tree.locals[*local as usize].constant?, depth + 1)
        }
        ExprKind::Name { name, template, local: None } if template.is_empty() => {
            (module.find(name) == Some(Global::Constant)).then_some(())?;
            let mut declared = module.tree.declarations.iter();
            let found =
                declared.find(|own| own.name == *name && own.kind == DeclarationKind::Const)?;
            values_of(module, found.value?, depth + 1)
        }
        _ => None,
    }
}

/// The components of a vector, or of a conversion.
fn construct(
    module: &Module<'_, '_>,
    callee: &str,
    arguments: &[ExprId],
    depth: usize,
) -> Option<Vec<f64>> {
    if module.find(callee).is_some() {
        return None;
    }
    if matches!(callee, "i32" | "u32" | "f32" | "f16") {
        return values_of(module, *arguments.first()?, depth + 1);
    }
    let count = callee.strip_prefix("vec")?.chars().next()?.to_digit(10)? as usize;
    let parts: Option<Vec<Vec<f64>>> =
        arguments.iter().map(|id| values_of(module, *id, depth + 1)).collect();
    let found = parts?.concat();
    match found.len() {
        0 => Some(vec![0.0; count]),
        1 => Some(vec![found[0]; count]),
        _ => Some(found),
    }
}

fn literal(text: &str) -> Option<f64> {
    if let Some(digits) = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        let digits = digits.trim_end_matches(['i', 'u']);
        return u64::from_str_radix(digits, 16).ok().map(|value| value as f64);
    }
    text.trim_end_matches(['i', 'u', 'f', 'h']).parse().ok()
}
