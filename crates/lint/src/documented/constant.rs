//! Values of constant expressions, as far as people write them as arguments.

use lamplight_rules::{Declared, Lookup, Piece, Place};

/// The numbers of a value: one, or those of a vector.
pub type Numbers = Vec<f64>;

/// How far names are followed.
const DEPTH: u8 = 16;

/// The value of an expression, if it is the same in every call.
pub fn constant_value(text: &str, lookup: &Lookup<'_>, place: Place) -> Option<Numbers> {
    value_of(text, lookup, place, DEPTH)
}

fn value_of(text: &str, lookup: &Lookup<'_>, place: Place, depth: u8) -> Option<Numbers> {
    let depth = depth.checked_sub(1)?;
    let of = |place: Place| value_of(text, lookup, place, depth);
    let part = text.get(place.range())?;
    match lookup.piece(&place.range())? {
        Piece::Literal => {
            let digits = part.trim_end_matches(['f', 'h', 'i', 'u']);
            digits.parse().ok().map(|number| vec![number])
        }
        Piece::Parenthesized(inner) => of(inner),
        Piece::Unary { operator: "-", operand } => {
            Some(of(operand)?.iter().map(|one| -one).collect())
        }
        Piece::Binary { operator, left, right } => binary(operator, &of(left)?, &of(right)?),
        Piece::Name(name) => match lookup.declared(name, place.start as usize)? {
            Declared { keyword: "const" | "let", value: Some(value), .. } => of(value),
            _ => None,
        },
        Piece::Call { name, arguments } => {
            let values: Option<Vec<Numbers>> = arguments.into_iter().map(of).collect();
            called(name, values?)
        }
        _ => None,
    }
}

fn binary(operator: &str, left: &[f64], right: &[f64]) -> Option<Numbers> {
    let apply = |one: f64, other: f64| match operator {
        "+" => Some(one + other),
        "-" => Some(one - other),
        "*" => Some(one * other),
        "/" if other != 0.0 => Some(one / other),
        _ => None,
    };
    match (left, right) {
        ([one], many) => many.iter().map(|other| apply(*one, *other)).collect(),
        (many, [other]) => many.iter().map(|one| apply(*one, *other)).collect(),
        (many, others) if many.len() == others.len() => {
            many.iter().zip(others).map(|(one, other)| apply(*one, *other)).collect()
        }
        _ => None,
    }
}

fn called(name: &str, arguments: Vec<Numbers>) -> Option<Numbers> {
    if let Some(size) = name.strip_prefix("vec").and_then(|rest| rest.chars().next()?.to_digit(10))
    {
        let mut all: Numbers = arguments.into_iter().flatten().collect();
        if all.len() == 1 {
            all = vec![all[0]; size as usize];
        }
        return (all.len() == size as usize).then_some(all);
    }
    let [argument] = arguments.as_slice() else { return None };
    let function: fn(f64) -> f64 = match name {
        "f32" | "f16" => |x| x,
        "radians" => f64::to_radians,
        "degrees" => f64::to_degrees,
        "cos" => f64::cos,
        "sin" => f64::sin,
        "tan" => f64::tan,
        "sqrt" => f64::sqrt,
        "abs" => f64::abs,
        "normalize" => {
            let length = length_of(argument);
            return (length > 0.0).then(|| argument.iter().map(|one| one / length).collect());
        }
        "length" => return Some(vec![length_of(argument)]),
        _ => return None,
    };
    Some(argument.iter().map(|one| function(*one)).collect())
}

/// The length of a vector.
pub fn length_of(numbers: &[f64]) -> f64 {
    numbers.iter().map(|one| one * one).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(expression: &str) -> Option<Numbers> {
        let text = format!("const half = 0.5;\nfn f(x: f32) {{ let y = {expression}; }}");
        let start = text.find("y = ")? + 4;
        let place = Place { start: start as u32, end: (start + expression.len()) as u32 };
        constant_value(&text, &Lookup::read(&text)?, place)
    }

    #[test]
    fn constants_have_values() {
        assert_eq!(value("-30.0"), Some(vec![-30.0]));
        assert_eq!(value("half * 4"), Some(vec![2.0]));
        assert_eq!(value("vec3f(0, 1, 1)"), Some(vec![0.0, 1.0, 1.0]));
        assert_eq!(value("vec3f(2.0)"), Some(vec![2.0, 2.0, 2.0]));
        assert_eq!(value("cos(0.0)"), Some(vec![1.0]));
        assert_eq!(value("length(vec2f(3.0, 4.0))"), Some(vec![5.0]));
        assert_eq!(value("x"), None);
        assert_eq!(value("x * 2.0"), None);
        assert_eq!(value("1.0 / 0.0"), None);
    }
}
