//! Built-in functions with constant arguments: those that have no value, and those that naga does
//! not compute.

mod builtin;
mod evaluate;
mod fold;
mod value;

pub use fold::fold;

use super::names::{Module, is_of_subgroups};
use super::syntax::{ExprId, ExprKind, Tree};
use super::{Problem, Rule, Severity};
pub use evaluate::Constants;
pub use value::Kind;
use value::{Shape, Value};

pub fn check(tree: &Tree<'_>, module: &Module<'_, '_>) -> Vec<Problem> {
    let mut problems = Vec::new();
    let constants = Constants::of(module);
    let has_subgroups = tree.enabled.contains(&"subgroups");
    for expression in &tree.expressions {
        let (callee, template, arguments) = match &expression.kind {
            ExprKind::Call { callee, template, arguments } if module.find(callee).is_none() => {
                (callee, template, arguments)
            }
            ExprKind::Binary { operator, left, right } => {
                if let Some(message) = wrong_operands(&constants, operator, *left, *right) {
                    problems.push(Problem::new(Rule::Constant, expression.place, message));
                }
                continue;
            }
            _ => continue,
        };
        if is_of_subgroups(callee) && !has_subgroups {
            let message = format!("`{callee}` needs `enable subgroups;`");
            problems.push(Problem::new(Rule::Grammar, expression.place, message));
        }
        let wrong = match *callee {
            "bitcast" => wrong_bitcast(&constants, template, arguments),
            _ => wrong_call(&constants, callee, arguments),
        };
        if let Some(message) = wrong {
            problems.push(Problem::new(Rule::Constant, expression.place, message));
        }
    }
    problems
}

/// A whole number without a type where it becomes an `i32` that it does not fit. naga makes a float of it,
/// so this is wrong for every target.
pub fn check_untyped(constants: &Constants<'_, '_, '_>, id: ExprId) -> Option<Problem> {
    let tree = constants.module.tree;
    let is_beyond = match tree.kind(tree.inner(id)) {
        // It may have more digits than a value keeps.
        ExprKind::Literal(text) => text.parse::<u64>().is_ok_and(|value| value > i32::MAX as u64),
        _ => constants.value(id).is_some_and(|value| {
            let fits = |part: &f64| (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(part);
            value.kind == Kind::AbstractInt && !value.parts.iter().all(fits)
        }),
    };
    let message = "this does not fit `i32`, the type that it gets here".to_owned();
    let problem = Problem::new(Rule::Constant, tree.place(id), message);
    is_beyond.then_some(Problem { severity: Severity::Error, ..problem })
}

/// Why operands do not go together. naga finds it, but for those that it never computes: the right
/// sides of `&&` and `||` that do not count.
fn wrong_operands(
    constants: &Constants<'_, '_, '_>,
    operator: &str,
    left: ExprId,
    right: ExprId,
) -> Option<String> {
    match operator {
        "&&" | "||" => (constants.type_of(right)? != (Kind::Bool, Shape::Scalar))
            .then(|| format!("the right side of `{operator}` is no `bool`")),
        "==" | "!=" | "<" | "<=" | ">" | ">=" => {
            let (left, right) = (constants.type_of(left)?.1, constants.type_of(right)?.1);
            (left != right).then(|| format!("the sides of `{operator}` have other types"))
        }
        _ => None,
    }
}

/// Why a call of a built-in function has no value.
fn wrong_call(
    constants: &Constants<'_, '_, '_>,
    name: &str,
    arguments: &[ExprId],
) -> Option<String> {
    let value = |at: usize| arguments.get(at).and_then(|id| constants.value(*id));
    let number = |at: usize| value(at).and_then(|found| found.number());
    match name {
        "inverseSqrt" => {
            let is_wrong = value(0)?.parts.iter().any(|part| *part <= 0.0);
            is_wrong.then(|| "`inverseSqrt` needs a number above 0".to_owned())
        }
        "extractBits" | "insertBits" => {
            let first = arguments.len().checked_sub(2)?;
            let is_wrong = number(first)? + number(first + 1)? > 32.0;
            is_wrong.then(|| format!("offset and count of `{name}` are more than 32 bits"))
        }
        "ldexp" => {
            let most = match constants.kind(*arguments.first()?) {
                Some(Kind::F16) => 16.0,
                // A number without a suffix has the range of f64.
                Some(Kind::AbstractInt | Kind::AbstractFloat) => 1024.0,
                _ => 128.0,
            };
            let is_wrong = value(1)?.parts.iter().any(|part| *part > most);
            is_wrong.then(|| format!("the exponent of `ldexp` is above {most}"))
        }
        "clamp" => {
            let (low, high) = (value(1)?, value(2)?);
            let is_wrong = low.parts.iter().zip(&high.parts).any(|(low, high)| low > high);
            is_wrong.then(|| "the lower bound of `clamp` is above the upper one".to_owned())
        }
        "smoothstep" => {
            let (low, high) = (value(0)?, value(1)?);
            let is_wrong = low.parts.iter().zip(&high.parts).any(|(low, high)| low == high);
            is_wrong.then(|| "both edges of `smoothstep` are the same".to_owned())
        }
        "fma" | "cross" => overflow(name, &value(0)?, &value(1)?),
        _ if name.starts_with("subgroup") || name == "quadBroadcast" => {
            wrong_invocation(constants, name, *arguments.get(1)?)
        }
        "quantizeToF16" | "pack2x16float" => {
            let is_wrong = value(0)?.parts.iter().any(|part| part.abs() > LARGEST_F16);
            is_wrong.then(|| format!("`{name}` needs numbers of at most {LARGEST_F16}"))
        }
        _ if name.starts_with("texture") => wrong_texture(constants, name, arguments),
        _ => None,
    }
}

/// The largest number of `f16`.
pub const LARGEST_F16: f64 = 65504.0;

/// Why the bits of an expression cannot be taken for those of a type: the types, where they are known
/// here, have other sizes, or no bits.
fn wrong_bitcast(
    constants: &Constants<'_, '_, '_>,
    template: &[ExprId],
    arguments: &[ExprId],
) -> Option<String> {
    let ([into], [from]) = (template, arguments) else { return None };
    let into = constants.type_at(*into)?;
    if into.0 == Kind::Bool {
        return Some("`bool` has no bits for `bitcast`".to_owned());
    }
    let from = constants.type_of(*from)?;
    let bits = |(kind, shape): (Kind, Shape)| match kind {
        Kind::F16 => 16 * shape.count(),
        _ => 32 * shape.count(),
    };
    (bits(into) != bits(from))
        .then(|| format!("`bitcast` of {} bits into {}", bits(from), bits(into)))
}

/// Why invocations cannot be chosen by this number.
fn wrong_invocation(
    constants: &Constants<'_, '_, '_>,
    name: &str,
    number: ExprId,
) -> Option<String> {
    let is_relative =
        matches!(name, "subgroupShuffleUp" | "subgroupShuffleDown" | "subgroupShuffleXor");
    if is_relative && constants.kind(number) == Some(Kind::I32) {
        return Some(format!("`{name}` takes an unsigned number"));
    }
    let most = if name == "quadBroadcast" { 4.0 } else { 128.0 };
    let is_wrong = !(0.0..most).contains(&constants.value(number)?.number()?);
    is_wrong.then(|| format!("`{name}` takes numbers below {most}"))
}

/// Why a product in `fma` or `cross` is out of the range of its type.
fn overflow(name: &str, left: &Value, right: &Value) -> Option<String> {
    let kind = left.kind.common(right.kind)?;
    let products = left.parts.iter().enumerate().flat_map(|(at, left)| {
        let others = right.parts.iter().enumerate();
        others
            .filter(move |(other, _)| (at == *other) == (name == "fma"))
            .map(move |(_, right)| left * right)
    });
    let is_wrong = products.map(|product| kind.round(product)).any(|product| product.is_none());
    is_wrong.then(|| format!("a product in `{name}` is out of range"))
}

/// Why a texture of this kind cannot be read so.
fn wrong_texture(
    constants: &Constants<'_, '_, '_>,
    name: &str,
    arguments: &[ExprId],
) -> Option<String> {
    let module = constants.module;
    let at = usize::from(component(constants, name, arguments).is_some());
    let of_type = module.declared_type(*arguments.get(at)?);
    let kind = of_type.and_then(|id| module.type_of(id)).map_or("", |(kind, _)| kind);
    if name == "textureSampleGrad" && kind.starts_with("texture_depth_") {
        return Some("a depth texture is not sampled with gradients".to_owned());
    }
    if at == 1 && kind.starts_with("texture_depth_") {
        return Some("a depth texture has no component to choose".to_owned());
    }
    let offset = offset_values(constants, name, kind, arguments)?;
    if kind.contains("_cube") && offset.len() > 1 {
        return Some("cube textures are sampled without an offset".to_owned());
    }
    let is_wrong = offset.len() > 1 && offset.iter().any(|value| !(-8.0..=7.0).contains(value));
    is_wrong.then(|| "an offset of texels must be in -8..=7".to_owned())
}

/// The component that `textureGather` of colours has before the texture.
fn component(constants: &Constants<'_, '_, '_>, name: &str, arguments: &[ExprId]) -> Option<f64> {
    let first = arguments.first().filter(|_| name == "textureGather")?;
    constants.value(*first)?.number()
}

/// The offset of texels, where the last argument is one.
fn offset_values(
    constants: &Constants<'_, '_, '_>,
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
    let first = first + usize::from(component(constants, name, arguments).is_some());
    let last = arguments.len().checked_sub(1).filter(|last| *last >= first)?;
    Some(constants.value(arguments[last])?.parts)
}
