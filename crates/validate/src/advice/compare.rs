//! Comparisons of what cannot be compared. naga names no place, and the type as its developers see it.

use std::ops::Range;

use lamplight_rules::Place;

use super::{Mistake, Source};

/// How naga's sentence begins before the comparison and the type of its left side.
pub const OPERANDS: &str = "Incompatible operands";

/// What naga calls comparisons.
const OPERATORS: &[(&str, &str)] = &[
    ("Equal", "=="),
    ("NotEqual", "!="),
    ("Less", "<"),
    ("LessEqual", "<="),
    ("Greater", ">"),
    ("GreaterEqual", ">="),
];

/// Says what is wrong with the comparison in a place, from naga's sentence about it. `sentence_of` is what
/// naga says of another text.
pub fn advise_compared(
    text: &str,
    sentence: &str,
    within: &Range<usize>,
    sentence_of: &dyn Fn(&str) -> Option<String>,
) -> Option<Mistake> {
    let rest = sentence.strip_prefix(OPERANDS)?.strip_prefix(": ")?;
    let (name, of_type) = rest.split_once('(')?;
    let (_, operator) = OPERATORS.iter().find(|(known, _)| *known == name)?;
    let source = Source::new(text);
    let lookup = source.lookup.as_ref()?;
    // The wrong one is that without which naga says something else.
    let is_wrong = |[place, ..]: &[Place; 3]| {
        let place = place.range();
        let without = format!("{}true{}", &text[..place.start], &text[place.end..]);
        sentence_of(&without).is_none_or(|other| !other.starts_with(OPERANDS))
    };
    let operations = lookup.operations(operator, within);
    let [place, left, right] = match operations.as_slice() {
        [one] => *one,
        several => *several.iter().find(|one| is_wrong(one))?,
    };
    let members = members(of_type);
    let structure = lookup.structure_of(&members).filter(|_| of_type.starts_with("Struct"));
    let what = structure.map_or_else(|| kind(of_type).to_owned(), |name| format!("`{name}`"));
    let mut mistake = Mistake {
        message: format!("`{operator}` does not work with {what}"),
        labels: vec![(place.range(), format!("the left side is {what}"))],
        notes: Vec::new(),
    };
    let [left, right] = [left, right].map(|side| source.part(side));
    match (structure, members.first(), by_columns(of_type, operator, [left, right])) {
        (Some(_), Some(member), _) => mistake.help(format!(
            "compare members, such as `{left}.{member} {operator} {right}.{member}`"
        )),
        (_, _, Some(code)) => mistake.write(code),
        _ => mistake.help("numbers, `bool` and vectors of them can be compared"),
    }
    Some(mistake)
}

/// The comparison of two matrices by their columns.
fn by_columns(of_type: &str, operator: &str, [left, right]: [&str; 2]) -> Option<String> {
    let columns = match of_type.strip_prefix("Matrix { columns: ")?.split(',').next()? {
        "Bi" => 2,
        "Tri" => 3,
        _ => 4,
    };
    let (all, joined) = match operator {
        "==" => ("all", " && "),
        "!=" => ("any", " || "),
        _ => return None,
    };
    let one = |at| format!("{all}({left}[{at}] {operator} {right}[{at}])");
    Some((0..columns).map(one).collect::<Vec<_>>().join(joined))
}

/// The names of members in what naga prints of a structure.
fn members(of_type: &str) -> Vec<&str> {
    let parts = of_type.split("StructMember { name: Some(\"").skip(1);
    parts.filter_map(|part| part.split('"').next()).collect()
}

fn kind(of_type: &str) -> &'static str {
    const KINDS: &[(&str, &str)] = &[
        ("Matrix", "a matrix"),
        ("Array", "an array"),
        ("Struct", "a structure"),
        ("Pointer", "a pointer"),
        ("ValuePointer", "a pointer"),
        ("Image", "a texture"),
        ("Sampler", "a sampler"),
        ("Atomic", "an atomic variable"),
        ("Scalar", "this number"),
        ("Vector", "this vector"),
    ];
    let found = KINDS.iter().find(|(name, _)| of_type.starts_with(name));
    found.map_or("this type", |(_, words)| words)
}
