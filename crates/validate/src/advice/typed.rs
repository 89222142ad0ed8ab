//! Advice for the errors of naga's validator, which names types.

use std::ops::Range;

use lamplight_rules::{Declared, Lookup, Piece, Place, Step};

use super::convert::{common_operand, converted, factor_of_matrix, of_numbers, short_type};
use super::stage::{Interface, Port, Variable, advise_held, advise_port, advise_variable};
use super::{Mistake, Source};

/// What is wrong with the types of an error. Types are as naga writes them for WGSL.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Wrong {
    /// The two sides of an operator.
    Operands { left: String, right: String },
    /// The one value of an operator.
    Operand { operator: &'static str, found: String },
    /// What a function returns.
    Returned { found: Option<String>, expected: Option<String> },
    /// A condition.
    Condition { found: String },
    /// What is assigned.
    Stored { found: String, expected: String },
    /// An argument of a function, by its number from 0.
    Argument { function: String, at: usize, found: String, expected: String },
    /// What is in brackets behind an array.
    Index { found: String },
    /// The arguments of a constructor, with how many components it takes and has.
    Components { given: u32, expected: u32 },
    /// The two choices of `select`.
    Choices { reject: String, accept: String },
    /// The coordinates of a texture, by the argument's number from 0.
    Coordinates { at: usize, found: String, expected: String },
    /// An index beyond the end.
    Bounds { length: u32 },
    /// An input or output of an entry point.
    Port(Port, Interface),
    /// A variable of the module.
    Variable(String, Variable),
    /// A structure that holds a texture or a sampler.
    Held(String),
    /// A variable of the module that is assigned to, and cannot be.
    ReadOnly { name: String, is_uniform: bool },
    /// A function that samples where there is no level.
    Level,
}

/// Adds what to write, and the place where.
pub fn advise_typed(text: &str, wrong: &Wrong, mistake: &mut Mistake) {
    match wrong {
        Wrong::Port(port, wrong) => return advise_port(text, port, wrong, mistake),
        Wrong::Variable(name, wrong) => return advise_variable(text, name, wrong, mistake),
        Wrong::Held(structure) => return advise_held(text, structure, mistake),
        _ => {}
    }
    let source = Source::new(text);
    let Some(lookup) = &source.lookup else { return };
    let place = mistake.labels.first().map_or(0..0, |(range, _)| range.clone());
    match wrong {
        Wrong::Operands { left, right } => operands(&source, lookup, &place, left, right, mistake),
        Wrong::Operand { operator, found } => {
            operand(&source, lookup, &place, operator, found, mistake);
        }
        Wrong::Returned { found, expected } => {
            returned(&source, lookup, &place, found.as_deref(), expected.as_deref(), mistake);
        }
        Wrong::Condition { found } => condition(&source, lookup, &place, found, mistake),
        Wrong::Stored { found, expected } => stored(&source, lookup, found, expected, mistake),
        Wrong::Argument { function, at, found, expected } => {
            let call = called(lookup, mistake, *at, |name| name == function);
            argument(&source, call, *at, found, expected, mistake);
        }
        Wrong::Coordinates { at, found, expected } => {
            let call = called(lookup, mistake, *at, |name| name.starts_with("texture"));
            argument(&source, call, *at, found, expected, mistake);
        }
        Wrong::Index { found } => {
            let Some(Piece::Index { base: _, index }) = lookup.piece(&place) else { return };
            mistake.place(index.range(), format!("this is `{found}`"));
            give(converted(source.part(index), found, "u32"), mistake);
        }
        Wrong::Components { given, expected } => {
            components(&source, lookup, &place, *given, *expected, mistake);
        }
        Wrong::Choices { reject, accept } => {
            choices(&source, lookup, &place, reject, accept, mistake);
        }
        Wrong::Bounds { length } => bounds(&source, lookup, &place, *length, mistake),
        Wrong::ReadOnly { name, is_uniform } => {
            read_only(&source, lookup, name, *is_uniform, mistake);
        }
        Wrong::Level => level(&source, lookup, mistake),
        Wrong::Port(..) | Wrong::Variable(..) | Wrong::Held(_) => {}
    }
}

/// A condition that is no `bool`.
fn condition(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    place: &Range<usize>,
    found: &str,
    mistake: &mut Mistake,
) {
    let Some((_, Step::Condition(value))) = lookup.step(place) else { return };
    mistake.labels = vec![(value.range(), format!("this is `{found}`"))];
    give(converted(source.part(value), found, "bool"), mistake);
}

/// An index beyond the end.
fn bounds(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    place: &Range<usize>,
    length: u32,
    mistake: &mut Mistake,
) {
    let Some(Piece::Index { base, index: _ }) = lookup.piece(place) else { return };
    let (base, last) = (source.part(base), length.saturating_sub(1));
    mistake.help(format!("the last of its {length} elements is `{base}[{last}]`"));
}

/// An argument of another type than its parameter.
fn argument(
    source: &Source<'_>,
    call: Option<(Place, &str, Vec<Place>)>,
    at: usize,
    found: &str,
    expected: &str,
    mistake: &mut Mistake,
) {
    let Some((call, _, arguments)) = call else { return };
    let argument = arguments[at];
    mistake.labels = vec![(argument.range(), format!("this is `{}`", short_type(found)))];
    if in_another_order(source, &arguments, at, found, expected) {
        return mistake.help("the arguments are in another order than they are declared");
    }
    let value = converted(source.part(argument), found, expected);
    give(value.map(|value| source.replaced(call, argument, &value)), mistake);
}

/// A variable of the module that is assigned to, and cannot be.
fn read_only(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    name: &str,
    is_uniform: bool,
    mistake: &mut Mistake,
) {
    let Some(declared) = lookup.declared(name, 0) else { return };
    let of_type = declared.of_type.map_or("", |of| source.part(of));
    mistake.labels.push((declared.place.range(), "declared here".to_owned()));
    match is_uniform {
        true => mistake.help(format!(
            "a new value is one of your own: `let changed = ...;`, or `var` if it changes again, \
             instead of `{name}`"
        )),
        false => mistake.write(format!("var<storage, read_write> {name}: {of_type};")),
    }
}

/// A lookup of a texture by the level that derivatives choose, where there are none.
fn level(source: &Source<'_>, lookup: &Lookup<'_>, mistake: &mut Mistake) {
    let is_texture = |name: &str| name.starts_with("texture");
    let Some((_, name, arguments)) = called(lookup, mistake, 1, is_texture) else { return };
    let texts: Vec<&str> = arguments.iter().map(|one| source.part(*one)).collect();
    let (base, compares) = (name.trim_end_matches("Bias"), name.ends_with("Compare"));
    let kept = texts.len().min(if compares { 4 } else { 3 });
    let texts = texts[..kept].join(", ");
    mistake.write(match compares {
        true => format!("{base}Level({texts})"),
        false => format!("{base}Level({texts}, 0.0)"),
    });
}

/// The call that an error is about, with its name and its arguments, of which there are more than some.
/// An argument may be a call too, so the name must be one of the function's.
fn called<'t>(
    lookup: &Lookup<'t>,
    mistake: &Mistake,
    least: usize,
    is_function: impl Fn(&str) -> bool,
) -> Option<(Place, &'t str, Vec<Place>)> {
    mistake.labels.iter().find_map(|(range, _)| match lookup.call(range.start)? {
        (place, Piece::Call { name, arguments })
            if arguments.len() > least && is_function(name) =>
        {
            Some((place, name, arguments))
        }
        _ => None,
    })
}

/// Says what to write, where that is known.
fn give(value: Option<String>, mistake: &mut Mistake) {
    if let Some(value) = value {
        mistake.write(value);
    }
}

/// Whether the next argument has the type that this one should have: a name tells that.
fn in_another_order(
    source: &Source<'_>,
    arguments: &[Place],
    at: usize,
    found: &str,
    expected: &str,
) -> bool {
    let is_vector = |name: &str| name.starts_with("vec");
    let Some(next) = arguments.get(at + 1) else { return false };
    let declared = source.lookup.as_ref().and_then(|lookup| {
        lookup.declared(source.part(*next), next.range().start).and_then(|one| one.of_type)
    });
    let next_type = declared.map(|of_type| source.part(of_type));
    next_type.is_some_and(|next| short_type(next) == short_type(expected))
        && is_vector(found) != is_vector(expected)
}

fn operands(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    place: &Range<usize>,
    left_type: &str,
    right_type: &str,
    mistake: &mut Mistake,
) {
    let Some(Piece::Binary { operator, left, right }) = lookup.piece(place) else { return };
    let (left_text, right_text) = (source.part(left), source.part(right));
    if matches!(operator, "&&" | "||") {
        return conditions(operator, (left_text, left_type), (right_text, right_type), mistake);
    }
    if let ("&" | "|" | "^", Some(Piece::Binary { operator: inner, left: first, right: last })) =
        (operator, lookup.piece(&right.range()))
        && right_type == "bool"
    {
        let (first, last) = (source.part(first), source.part(last));
        return mistake.help(format!(
            "`{inner}` binds tighter than `{operator}`: write `({left_text} {operator} {first}) \
             {inner} {last}`"
        ));
    }
    if operator != "*" && (left_type.starts_with("mat") || right_type.starts_with("mat")) {
        return;
    }
    let wanted = if left_type.starts_with("mat") && right_type.starts_with("vec") {
        factor_of_matrix(left_type, true).map(|wanted| (false, wanted))
    } else if left_type.starts_with("vec") && right_type.starts_with("mat") {
        factor_of_matrix(right_type, false).map(|wanted| (true, wanted))
    } else {
        common_operand(left_type, right_type).and_then(|left_stays| match left_stays {
            true => Some((false, wanted_operand(right_type, left_type)?)),
            false => Some((true, wanted_operand(left_type, right_type)?)),
        })
    };
    let Some((is_left, wanted)) = wanted else { return };
    let (text, found) = if is_left { (left_text, left_type) } else { (right_text, right_type) };
    say_why(source, lookup, if is_left { left } else { right }, found, mistake);
    let Some(value) = converted(text, found, &wanted) else { return };
    mistake.write(match is_left {
        true => format!("{value} {operator} {right_text}"),
        false => format!("{left_text} {operator} {value}"),
    });
}

/// Sides of `&&` and `||`, each with its type.
fn conditions(
    operator: &str,
    (left, left_type): (&str, &str),
    (right, right_type): (&str, &str),
    mistake: &mut Mistake,
) {
    if let Some(value) = converted(left, left_type, "bool").filter(|_| left_type != "bool") {
        mistake.write(format!("{value} {operator} {right}"));
    }
    if let Some(value) = converted(right, right_type, "bool").filter(|_| right_type != "bool") {
        mistake.write(format!("{left} {operator} {value}"));
    }
}

/// The type that an operand should have beside another one.
fn wanted_operand(found: &str, other: &str) -> Option<String> {
    let same_numbers = of_numbers(found, other)?;
    // Two vectors have one size, and a scalar goes with every vector.
    match found.starts_with("vec") && other.starts_with("vec") {
        true => Some(other.to_owned()),
        false => Some(same_numbers),
    }
}

/// Why a name has its type, where its declaration does not say it.
fn say_why(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    operand: Place,
    found: &str,
    mistake: &mut Mistake,
) {
    let name = source.part(operand);
    let declared = lookup.declared(name, operand.range().start);
    let Some(Declared { keyword, place, of_type: None, value: Some(value), .. }) = declared else {
        return;
    };
    let value = source.part(value);
    let label = format!("`{name}` is `{}`, since `{value}` is", short_type(found));
    if mistake.labels.iter().all(|(range, _)| *range != place.range()) {
        mistake.labels.push((place.range(), label));
    }
    if let Some(float) = converted(value, found, "f32").filter(|_| super::convert::is_number(value))
    {
        mistake.help(format!("`{keyword} {name} = {float};` makes it an `f32`"));
    }
}

fn operand(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    place: &Range<usize>,
    operator: &str,
    found: &str,
    mistake: &mut Mistake,
) {
    let Some(Piece::Unary { operator: _, operand }) = lookup.piece(place) else { return };
    let text = source.part(operand);
    match (operator, found) {
        ("!", "u32") => mistake.write(format!("{text} == 0u")),
        ("!", "i32") => mistake.write(format!("{text} == 0")),
        ("!", "f32" | "f16") => mistake.write(format!("{text} == 0.0")),
        ("-", "u32") => mistake.write(format!("-i32({text})")),
        ("~", "bool") => mistake.write(format!("!{text}")),
        _ => {}
    }
}

fn returned(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    place: &Range<usize>,
    found: Option<&str>,
    expected: Option<&str>,
    mistake: &mut Mistake,
) {
    let Some(head) = lookup.head(place.start) else { return };
    let Some((statement, Step::Return(value))) = lookup.step(place) else {
        if let Some(expected) = expected {
            mistake.help(format!(
                "write `return {}(...);` at its end, or a `return` in each branch",
                short_type(expected)
            ));
        }
        return;
    };
    match (value, found, expected) {
        (Some(value), Some(found), Some(expected)) => {
            let text = source.part(value);
            mistake.labels = vec![(value.range(), format!("this is `{}`", short_type(found)))];
            if let Some(result) = head.result {
                let label = format!("`{}` returns this", head.name);
                mistake.labels.push((result.range(), label));
            }
            give(converted(text, found, expected).map(|text| format!("return {text};")), mistake);
            mistake.help(format!("or let `{}` return `{}`", head.name, short_type(found)));
        }
        (None, _, Some(expected)) => {
            mistake.place(statement.range(), "without a value");
            mistake.help(format!("write a value of `{}` after `return`", short_type(expected)));
        }
        (Some(value), Some(found), None) => {
            mistake.place(value.range(), format!("this is `{}`", short_type(found)));
        }
        _ => {}
    }
}

fn stored(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    found: &str,
    expected: &str,
    mistake: &mut Mistake,
) {
    // naga makes an assignment of `&&` and `||`, and gives their values as the places.
    let sides = mistake.labels.iter().find_map(|(range, _)| match lookup.piece(range) {
        Some(Piece::Binary { operator: operator @ ("&&" | "||"), left, right }) => {
            Some((range.clone(), operator, left, right))
        }
        _ => None,
    });
    if let Some((range, operator, left, right)) = sides {
        let (left_text, right_text) = (source.part(left), source.part(right));
        mistake.message =
            format!("`{operator}` needs `bool` on both sides, and finds `{}`", short_type(found));
        mistake.labels = vec![(right.range(), format!("this is `{}`", short_type(found)))];
        let value = converted(right_text, found, "bool");
        let _ = range;
        give(value.map(|value| format!("{left_text} {operator} {value}")), mistake);
        return;
    }
    let assigned = mistake.labels.iter().find_map(|(range, _)| match lookup.step(range) {
        Some((place, Step::Assign { target: Some(target), operator, value })) => {
            Some((place, target, operator, value))
        }
        _ => None,
    });
    let Some((_, target, operator, value)) = assigned else { return };
    mistake.labels = vec![
        (value.range(), format!("this is `{}`", short_type(found))),
        (target.range(), format!("this is `{}`", short_type(expected))),
    ];
    let text = converted(source.part(value), found, expected);
    give(text.map(|text| format!("{} {operator} {text};", source.part(target))), mistake);
}

fn components(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    place: &Range<usize>,
    given: u32,
    expected: u32,
    mistake: &mut Mistake,
) {
    let Some((call, Piece::Call { name, arguments })) = lookup.call(place.start) else { return };
    if given <= expected {
        mistake.help(format!("`{name}` needs {} more", expected - given));
        return;
    }
    // A name among the arguments that is a vector is likely the one with too many.
    let vector = arguments.iter().find_map(|argument| {
        let declared = lookup.declared(source.part(*argument), argument.range().start)?;
        let of_type = short_type(source.part(declared.of_type?));
        let size: u32 = of_type.strip_prefix("vec")?.get(0..1)?.parse().ok()?;
        Some((*argument, size))
    });
    if let Some((argument, size)) = vector
        && let Some(kept @ 2..=3) = size.checked_sub(given - expected)
    {
        let value = format!("{}.{}", source.part(argument), &"xyzw"[..kept as usize]);
        mistake.write(source.replaced(call, argument, &value));
    }
}

fn choices(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    place: &Range<usize>,
    reject: &str,
    accept: &str,
    mistake: &mut Mistake,
) {
    let Some((call, Piece::Call { arguments, .. })) = lookup.call(place.start) else { return };
    let (Some(first), Some(second)) = (arguments.first(), arguments.get(1)) else { return };
    let (argument, found, wanted) = match reject.starts_with("vec") {
        true => (*second, accept, reject),
        false => (*first, reject, accept),
    };
    let value = converted(source.part(argument), found, wanted);
    give(value.map(|value| source.replaced(call, argument, &value)), mistake);
}
