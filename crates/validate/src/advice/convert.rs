//! What to write so that a value has another type.

/// The numbers of a type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Float,
    Half,
    Signed,
    Unsigned,
    Bool,
    /// A constant without a type yet.
    AbstractFloat,
    AbstractInt,
}

/// A type, as far as values are converted to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Shape {
    /// 1 for a scalar.
    size: u8,
    kind: Kind,
}

const KINDS: [(&str, Kind); 7] = [
    ("f32", Kind::Float),
    ("f16", Kind::Half),
    ("i32", Kind::Signed),
    ("u32", Kind::Unsigned),
    ("bool", Kind::Bool),
    ("AbstractFloat", Kind::AbstractFloat),
    ("AbstractInt", Kind::AbstractInt),
];

fn shape_of(name: &str) -> Option<Shape> {
    let kind = |name: &str| KINDS.iter().find(|one| one.0 == name).map(|one| one.1);
    if let Some(kind) = kind(name) {
        return Some(Shape { size: 1, kind });
    }
    let rest = name.strip_prefix("vec")?;
    let size = rest.bytes().next().filter(|digit| (b'2'..=b'4').contains(digit))? - b'0';
    let inner = match &rest[1..] {
        "f" => "f32",
        "h" => "f16",
        "i" => "i32",
        "u" => "u32",
        template => template.strip_prefix('<')?.strip_suffix('>')?,
    };
    Some(Shape { size, kind: kind(inner)? })
}

/// A type as authors usually write it: `vec3f` for `vec3<f32>`.
pub fn short_type(name: &str) -> String {
    const SHORT: [(&str, &str); 4] =
        [("<f32>", "f"), ("<f16>", "h"), ("<i32>", "i"), ("<u32>", "u")];
    let is_vector = name.strip_prefix("vec").is_some_and(|rest| rest.len() > 1);
    let is_matrix = name.strip_prefix("mat").is_some_and(|rest| rest.len() > 3);
    let short = SHORT.iter().find_map(|(long, letter)| {
        let start = name.strip_suffix(long)?;
        Some(format!("{start}{letter}"))
    });
    short.filter(|_| is_vector || is_matrix).unwrap_or_else(|| name.to_owned())
}

/// A text with all its types as authors usually write them, but for those that `author` has.
pub fn with_short_types(text: &str, author: &str) -> String {
    // Numbers that have no type yet.
    let mut short = text
        .replace("`AbstractFloat`", "a float")
        .replace("`AbstractInt`", "an integer")
        .replace("<AbstractFloat>", "<f32>")
        .replace("<AbstractInt>", "<i32>");
    for base in ["vec2", "vec3", "vec4"].into_iter().map(str::to_owned).chain(matrices()) {
        for scalar in ["f32", "f16", "i32", "u32"] {
            let long = format!("{base}<{scalar}>");
            if short.contains(&long) && !author.contains(&long) {
                short = short.replace(&long, &short_type(&long));
            }
        }
    }
    short
}

fn matrices() -> impl Iterator<Item = String> {
    (2..=4).flat_map(|columns| (2..=4).map(move |rows| format!("mat{columns}x{rows}")))
}

/// Whether a text is a number, perhaps with a sign.
pub fn is_number(value: &str) -> bool {
    value.trim_start_matches('-').starts_with(|first: char| first.is_ascii_digit())
        && value
            .trim_start_matches('-')
            .chars()
            .all(|one| one.is_ascii_alphanumeric() || one == '.')
}

/// Whether a member can be written behind a text as it is.
fn is_simple(value: &str) -> bool {
    let (mut depth, mut last) = (0_i32, ' ');
    value.chars().all(|one| {
        // A template list follows its name without a blank.
        let opens = matches!(one, '(' | '[') || one == '<' && last.is_alphanumeric();
        let closes = matches!(one, ')' | ']') || one == '>' && depth > 0 && last != ' ';
        depth += i32::from(opens) - i32::from(closes);
        last = one;
        depth > 0 || one.is_alphanumeric() || matches!(one, '_' | '.' | ')' | ']' | ':' | '>')
    })
}

/// A value for a member, an index or an operator behind or before it.
fn operand(value: &str) -> String {
    if is_simple(value) { value.to_owned() } else { format!("({value})") }
}

/// What makes a value of the type `found` one of the type `wanted`.
pub fn converted(value: &str, found: &str, wanted: &str) -> Option<String> {
    if let Some(pointed) = found.strip_prefix("ptr<") {
        let inner = pointed.split(',').nth(1)?.trim().trim_end_matches('>');
        return (inner == wanted).then(|| format!("*{value}"));
    }
    if let Some(pointed) = wanted.strip_prefix("ptr<function, ") {
        return (pointed.strip_suffix('>')? == found).then(|| format!("&{value}"));
    }
    let (from, to) = (shape_of(found)?, shape_of(wanted)?);
    let name = short_type(wanted);
    if to.kind == Kind::Bool {
        return to_bool(value, from, to);
    }
    if from.kind == Kind::Bool {
        return (to.size == from.size).then(|| format!("select({name}(), {name}(1), {value})"));
    }
    match (from.size, to.size) {
        (1, 1) => Some(as_scalar(value, from.kind, to.kind, &name)),
        (1, _) => {
            let scalar = KINDS.iter().find(|one| one.1 == to.kind).map_or("f32", |one| one.0);
            Some(format!("{name}({})", as_scalar(value, from.kind, to.kind, scalar)))
        }
        (_, 1) => Some(format!("{}.x", operand(value))),
        (from_size, to_size) if from_size == to_size => Some(format!("{name}({value})")),
        (from_size, to_size) if from_size > to_size => {
            Some(format!("{}.{}", operand(value), &"xyzw"[..to_size.into()]))
        }
        (2, 4) => Some(format!("{name}({value}, 0.0, 1.0)")),
        _ => Some(format!("{name}({value}, 1.0)")),
    }
    .filter(|text| text != value)
}

fn to_bool(value: &str, from: Shape, to: Shape) -> Option<String> {
    match (from.kind, from.size, to.size) {
        (Kind::Bool, 2..=4, 1) => Some(format!("all({value})")),
        (Kind::Float | Kind::Half | Kind::AbstractFloat, 1, 1) => {
            Some(format!("{} != 0.0", operand(value)))
        }
        (Kind::Unsigned, 1, 1) => Some(format!("{} != 0u", operand(value))),
        (Kind::Signed | Kind::AbstractInt, 1, 1) => Some(format!("{} != 0", operand(value))),
        _ => None,
    }
}

fn as_scalar(value: &str, from: Kind, to: Kind, name: &str) -> String {
    let digits = value.trim_end_matches(['i', 'u', 'f', 'h']);
    let is_whole =
        is_number(value) && digits.trim_start_matches('-').bytes().all(|b| b.is_ascii_digit());
    let point_zero = digits.strip_suffix(".0").filter(|_| is_number(value));
    match (to, is_whole, point_zero) {
        (Kind::Float | Kind::Half, true, _) => format!("{digits}.0"),
        (Kind::Unsigned, true, _) if !value.starts_with('-') => format!("{digits}u"),
        (Kind::Signed, true, _) => digits.to_owned(),
        (Kind::Signed | Kind::Unsigned, _, Some(whole)) => whole.to_owned(),
        (Kind::Float, _, _) if from == Kind::AbstractFloat => value.to_owned(),
        _ if from == to => value.to_owned(),
        _ => format!("{name}({value})"),
    }
}

/// The types that a product of a matrix and a vector takes, by the side that the vector is on:
/// what the vector should be.
pub fn factor_of_matrix(matrix: &str, vector_is_right: bool) -> Option<String> {
    let rest = matrix.strip_prefix("mat")?;
    let columns = rest.get(0..1)?;
    let rows = rest.get(2..3)?;
    let scalar = rest.get(3..)?;
    Some(format!("vec{}{scalar}", if vector_is_right { columns } else { rows }))
}

/// The type that two operands should have, and which one has it already: `true` for the left one.
pub fn common_operand(left: &str, right: &str) -> Option<bool> {
    let (one, other) = (shape_of(left)?, shape_of(right)?);
    let rank = |kind: Kind| match kind {
        Kind::Bool => None,
        Kind::AbstractInt => Some(0),
        Kind::Signed => Some(1),
        Kind::Unsigned => Some(2),
        Kind::AbstractFloat => Some(3),
        Kind::Half => Some(4),
        Kind::Float => Some(5),
    };
    match (one.size, other.size) {
        // Of two vectors, the smaller one stays.
        (a, b) if a != b && a > 1 && b > 1 => Some(a < b),
        _ => Some(rank(one.kind)? >= rank(other.kind)?),
    }
}

/// The type with the size of one and the numbers of another: `vec3f` and `i32` give `vec3<i32>`.
pub fn of_numbers(size_of: &str, numbers_of: &str) -> Option<String> {
    let (one, other) = (shape_of(size_of)?, shape_of(numbers_of)?);
    let scalar = KINDS.iter().find(|kind| kind.1 == other.kind)?.0;
    Some(if one.size == 1 { scalar.to_owned() } else { format!("vec{}<{scalar}>", one.size) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_converted() {
        for (value, found, wanted, expected) in [
            ("n", "i32", "f32", Some("f32(n)")),
            ("3", "i32", "f32", Some("3.0")),
            ("2i", "i32", "f32", Some("2.0")),
            ("2.5", "AbstractFloat", "i32", Some("i32(2.5)")),
            ("2.0", "AbstractFloat", "u32", Some("2")),
            ("c", "vec3<f32>", "vec4<f32>", Some("vec4f(c, 1.0)")),
            ("uv", "vec2<f32>", "vec4<f32>", Some("vec4f(uv, 0.0, 1.0)")),
            ("a + b", "vec4<f32>", "vec3<f32>", Some("(a + b).xyz")),
            ("f(a + b)", "vec4<f32>", "f32", Some("f(a + b).x")),
            ("vec3<f32>(1.0)", "vec3<f32>", "vec2<f32>", Some("vec3<f32>(1.0).xy")),
            ("a < b", "vec3<f32>", "vec2<f32>", Some("(a < b).xy")),
            ("0.0", "AbstractFloat", "vec3<f32>", Some("vec3f(0.0)")),
            ("1", "AbstractInt", "vec3<f32>", Some("vec3f(1.0)")),
            ("1.0", "f32", "vec3<f32>", Some("vec3f(1.0)")),
            ("x", "f32", "vec3<f32>", Some("vec3f(x)")),
            ("a == b", "vec2<bool>", "bool", Some("all(a == b)")),
            ("x", "f32", "bool", Some("x != 0.0")),
            ("n & 1u", "u32", "bool", Some("(n & 1u) != 0u")),
            ("x", "ptr<function, f32>", "f32", Some("*x")),
            ("y", "f32", "ptr<function, f32>", Some("&y")),
            ("s", "sampler", "f32", None),
        ] {
            assert_eq!(converted(value, found, wanted).as_deref(), expected, "{value}: {wanted}");
        }
    }

    #[test]
    fn types_are_short_unless_the_author_writes_them_long() {
        let text = "`vec3<f32>` and `mat4x4<f32>`";
        assert_eq!(with_short_types(text, ""), "`vec3f` and `mat4x4f`");
        assert_eq!(with_short_types(text, "a: vec3<f32>"), "`vec3<f32>` and `mat4x4f`");
        assert_eq!(with_short_types("`texture_2d<f32>`", ""), "`texture_2d<f32>`");
        assert_eq!(
            with_short_types("`vec2<AbstractInt>`, `AbstractInt`", ""),
            "`vec2i`, an integer"
        );
    }

    #[test]
    fn operands_and_factors() {
        assert_eq!(common_operand("f32", "i32"), Some(true));
        assert_eq!(common_operand("u32", "i32"), Some(true));
        assert_eq!(common_operand("vec3<f32>", "vec2<f32>"), Some(false));
        assert_eq!(common_operand("bool", "i32"), None);
        assert_eq!(factor_of_matrix("mat4x4<f32>", true).as_deref(), Some("vec4<f32>"));
        assert_eq!(factor_of_matrix("mat4x3<f32>", false).as_deref(), Some("vec3<f32>"));
        assert_eq!(of_numbers("vec3<f32>", "i32").as_deref(), Some("vec3<i32>"));
    }
}
