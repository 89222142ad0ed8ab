//! Advice for the errors of naga's parser. It does not publish their kinds, so its sentences tell
//! them apart.

use std::ops::Range;

use lamplight_rules::{Declared, Lookup, Piece, Place, Step};

use super::convert::{converted, is_number, short_type};
use super::{Mistake, Source, names, tokens};

type Advice = fn(&Source<'_>, &str, &mut Mistake);

/// How naga's sentences begin, and what is done about each. `quoted` is the first text in backticks.
const TABLE: &[(&str, Advice)] = &[
    ("the type of `", initial_value),
    ("automatic conversions cannot convert", conversion),
    ("inconsistent type passed as argument", inconsistent),
    ("wrong type passed as argument", wrong_argument),
    ("too many arguments passed to", too_many),
    ("wrong number of arguments", wrong_number),
    ("type mismatch for reject and accept", select_order),
    ("invalid `switch` case selector", case_selector),
    ("function does not return any value", no_value),
    ("unused return value", unused_value),
    ("declaration of `", recursive),
    ("invalid left-hand side of assignment", assigned),
    ("this operation is not supported in a const", not_constant),
    ("the operand of the `&` operator", address),
    ("atomic variables cannot be accessed", atomic),
    ("increment/decrement operation", counted),
    ("the concrete type `", too_large),
    ("invalid field accessor `", names::member),
    ("redefinition of `", names::redefined),
    ("name `", names::reserved),
    ("identifier starts with a reserved prefix", names::prefixed),
    ("unknown builtin", names::built_in),
    ("unknown attribute", names::attribute),
    ("unknown address space", names::address_space),
    ("workgroup size is missing", workgroup_size),
    ("variable `@", group),
    ("the `f16` enable extension", half),
    ("expected ", tokens::expected),
];

/// Adds what to write, and better places, to an error of naga's parser.
pub fn advise_parsed(text: &str, mistake: &mut Mistake) {
    let Some((_, advice)) = TABLE.iter().find(|(start, _)| mistake.message.starts_with(start))
    else {
        return template_argument(mistake);
    };
    let source = Source::new(text);
    let quoted = mistake.message.split('`').nth(1).unwrap_or_default().to_owned();
    advice(&source, &quoted, mistake);
}

/// The first label's place as a part of the text.
fn place(mistake: &Mistake) -> Range<usize> {
    mistake.labels.first().map_or(0..0, |(range, _)| range.clone())
}

fn last_quoted(message: &str) -> &str {
    message.split('`').rev().nth(1).unwrap_or_default()
}

/// `vec3` and `texture_2d` without what stands between `<` and `>`.
fn template_argument(mistake: &mut Mistake) {
    let Some(name) = mistake
        .message
        .strip_prefix('`')
        .and_then(|rest| rest.split_once("` needs a template argument"))
        .map(|(name, _)| name.to_owned())
    else {
        return;
    };
    mistake.message = format!("`{name}` does not say of what");
    mistake.labels.iter_mut().for_each(|(_, label)| *label = "without a type".to_owned());
    match name.as_str() {
        vector if vector.starts_with("vec") || vector.starts_with("mat") => {
            mistake.help(format!("write `{name}f` for floats, `{name}i` for integers"))
        }
        "array" => mistake.write("array<f32, 4>"),
        "ptr" => mistake.write("ptr<function, f32>"),
        "atomic" => mistake.write("atomic<u32>"),
        storage if storage.starts_with("texture_storage") => {
            mistake.write(format!("{name}<rgba8unorm, write>"));
        }
        _ => mistake.write(format!("{name}<f32>")),
    }
}

fn initial_value(source: &Source<'_>, name: &str, mistake: &mut Mistake) {
    let Some((_, types)) = mistake.message.split_once("expected to be `") else { return };
    let types: Vec<String> = types.split('`').map(str::to_owned).collect();
    let (Some(wanted), Some(found)) = (types.first(), types.get(2)) else { return };
    let at = place(mistake);
    let Some(lookup) = &source.lookup else { return };
    mistake.message = format!("`{name}` is declared as `{wanted}`, and its value is `{found}`");
    let value = match lookup.step(&at) {
        Some((_, Step::Declare { keyword: _, name: _, value })) => value,
        _ => lookup.declared(name, source.text.len()).and_then(|one| one.value),
    };
    let Some(value) = value else { return };
    let of_type = lookup.declared(name, at.end + 1).and_then(|one| one.of_type);
    mistake.labels = vec![(value.range(), format!("this is `{found}`"))];
    if let Some(of_type) = of_type {
        mistake.labels.push((of_type.range(), "declared as this".to_owned()));
    }
    if let Some(value) = converted(source.part(value), found, wanted) {
        mistake.write(value);
    }
    if !found.starts_with("Abstract") {
        mistake.help(format!("or declare it as `{}`", short_type(found)));
    }
}

/// A value that should have another type: it is the second label, and where it is needed the first.
fn conversion(source: &Source<'_>, found: &str, mistake: &mut Mistake) {
    let wanted = last_quoted(&mistake.message).to_owned();
    let [_, (at, _), ..] = mistake.labels.as_slice() else { return };
    let at = at.clone();
    let Some(lookup) = &source.lookup else { return };
    if fits_no_count(lookup, &at, mistake) {
        return;
    }
    let plain = match lookup.piece(&at) {
        Some(Piece::Binary { operator, left, right }) => {
            let sides = [left, right].map(|side| converted_name(source, side, found, &wanted));
            Some(format!("{} {operator} {}", sides[0], sides[1]))
        }
        _ => converted(source.slice(&at), found, &wanted),
    };
    mistake.message = format!("this is `{found}`, and `{wanted}` is needed here");
    let reason = mistake.labels.remove(0);
    mistake.place(at.clone(), format!("this is `{found}`"));
    if !(reason.0.start <= at.start && at.end <= reason.0.end) {
        mistake.labels.push((reason.0, format!("this is `{wanted}`")));
    }
    if let Some(plain) = plain.filter(|plain| plain != source.slice(&at)) {
        mistake.write(plain);
    }
}

/// Whether an argument has the type of another parameter since there are too few or too many: then that
/// is what is wrong.
fn fits_no_count(lookup: &Lookup<'_>, at: &Range<usize>, mistake: &mut Mistake) -> bool {
    let Some((call, name, _)) = lookup.call_around(at) else { return false };
    let (Some(head), Some(Piece::Call { arguments, .. })) =
        (lookup.head_named(name), lookup.piece(&call.range()))
    else {
        return false;
    };
    let (wanted, found) = (head.parameters.len(), arguments.len());
    if wanted != found {
        mistake.message = format!("`{name}` takes {}, not {found}", counted_words(wanted));
        mistake.labels = vec![(call.range(), "in this call".to_owned())];
    }
    wanted != found
}

/// A side of an operator, converted unless it is a number, which goes with every type.
fn converted_name(source: &Source<'_>, side: Place, found: &str, wanted: &str) -> String {
    let text = source.part(side);
    match is_number(text) {
        true => text.to_owned(),
        false => converted(text, found, wanted).unwrap_or_else(|| text.to_owned()),
    }
}

/// The number of an argument in naga's sentence, from 0.
fn argument_number(message: &str) -> Option<usize> {
    let digits = message.split_once('#')?.1;
    let end = digits.find(|one: char| !one.is_ascii_digit()).unwrap_or(digits.len());
    digits[..end].parse::<usize>().ok()?.checked_sub(1)
}

/// The types in naga's list of those that are allowed, without those that only constants have.
fn allowed_types(mistake: &Mistake) -> Vec<String> {
    let allowed = mistake.notes.iter().filter_map(|note| note.strip_prefix("allowed type: "));
    let used = allowed.filter(|name| {
        !["Abstract", "f16", "f64", "i64", "u64"].iter().any(|rare| name.contains(rare))
    });
    used.map(str::to_owned).collect()
}

/// Leaves naga's list out of the notes.
fn without_list(mistake: &mut Mistake) {
    mistake.notes.retain(|note| {
        !note.starts_with("allowed type")
            && !note.contains("accepts the following types")
            && !note.starts_with("because argument")
            && !note.starts_with("(or types")
    });
}

/// An argument whose type does not go with that of an argument before it.
fn inconsistent(source: &Source<'_>, _: &str, mistake: &mut Mistake) {
    let Some(at) = argument_number(&mistake.message) else { return };
    let of = |start: &str| {
        let label = mistake.labels.iter().find_map(|(_, label)| label.split_once(start))?;
        Some(label.1.trim_end_matches(", which constrains subsequent arguments").to_owned())
    };
    let (Some(found), Some(first_type)) = (of("has type "), of("this argument has type ")) else {
        return;
    };
    // Both begin with the same words.
    let found = mistake
        .labels
        .iter()
        .find_map(|(_, label)| label.split_once(&format!("argument #{} has type ", at + 1)))
        .map_or(found, |(_, name)| name.trim_matches('`').to_owned());
    let Some(lookup) = &source.lookup else { return };
    let Some((call, Piece::Call { name, arguments })) = lookup.call(place(mistake).start) else {
        return;
    };
    let (Some(argument), Some(first)) = (arguments.get(at), arguments.first()) else { return };
    let first_type = first_type.trim_matches('`').to_owned();
    mistake.message = format!(
        "`{name}` takes arguments of one type, and finds `{}` and `{}`",
        short_type(&first_type),
        short_type(&found)
    );
    without_list(mistake);
    mistake.labels = vec![
        (argument.range(), format!("this is `{}`", short_type(&found))),
        (first.range(), format!("this is `{}`", short_type(&first_type))),
    ];
    mistake.labels.dedup_by(|one, other| one.0 == other.0);
    let is_larger = short_type(&first_type) > short_type(&found) && found.starts_with("vec");
    let text = match is_larger {
        true => converted(source.part(*first), &first_type, &found)
            .map(|value| source.replaced(call, *first, &value)),
        false => with_converted(source, call, &arguments, at, &found, &first_type),
    };
    if let Some(text) = text {
        mistake.write(text);
    }
}

/// A call whose arguments from one on have the type of the first: numbers behind it have the same
/// mistake.
fn with_converted(
    source: &Source<'_>,
    call: Place,
    arguments: &[Place],
    at: usize,
    found: &str,
    wanted: &str,
) -> Option<String> {
    let mut text = source.part(call).to_owned();
    for (index, argument) in arguments.iter().enumerate().skip(at).rev() {
        let value = source.part(*argument);
        if index > at && !is_number(value) {
            continue;
        }
        let start = argument.start as usize - call.start as usize;
        let end = argument.end as usize - call.start as usize;
        let found = if is_number(value) { "AbstractFloat" } else { found };
        text.replace_range(start..end, &converted(value, found, wanted)?);
    }
    Some(text)
}

fn wrong_argument(source: &Source<'_>, name: &str, mistake: &mut Mistake) {
    let Some(at) = argument_number(&mistake.message) else { return };
    let found = mistake.labels.iter().find_map(|(_, label)| label.split_once("has type `"));
    let Some(found) = found.map(|(_, rest)| rest.trim_end_matches('`').to_owned()) else { return };
    let allowed = allowed_types(mistake);
    without_list(mistake);
    let short: Vec<String> = allowed.iter().map(|name| format!("`{}`", short_type(name))).collect();
    mistake.message = format!(
        "`{name}` takes {} as argument {}, and finds `{}`",
        either(&short),
        at + 1,
        short_type(&found)
    );
    let Some(lookup) = &source.lookup else { return };
    let Some((call, Piece::Call { arguments, .. })) = lookup.call(place(mistake).start) else {
        return;
    };
    let Some(argument) = arguments.get(at) else { return };
    mistake.labels = vec![(argument.range(), format!("this is `{}`", short_type(&found)))];
    let value = source.part(*argument);
    match name {
        "normalize" if !found.starts_with("vec") => {
            mistake.help(format!("of one number only the sign is left: `sign({value})`"));
        }
        "cross" => {
            let vectors: Vec<String> = arguments
                .iter()
                .filter_map(|one| converted(source.part(*one), &found, "vec3<f32>"))
                .map(|text| text.replace("1.0)", "0.0)"))
                .collect();
            mistake.write(format!("cross({}).z", vectors.join(", ")));
        }
        _ => {
            // What has the same size comes first.
            let size = |name: &str| name.strip_prefix("vec").and_then(|rest| rest.chars().next());
            let near = allowed.iter().find(|one| size(one) == size(&found)).or(allowed.first());
            let text = near.and_then(|near| converted(value, &found, near));
            if let Some(text) = text {
                mistake.write(source.replaced(call, *argument, &text));
            }
        }
    }
}

/// `a, b or c`.
fn either(words: &[String]) -> String {
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, before)) => format!("{} or {last}", before.join(", ")),
        None => "another type".to_owned(),
    }
}

fn too_many(source: &Source<'_>, name: &str, mistake: &mut Mistake) {
    let Some(lookup) = &source.lookup else { return };
    let Some((_, Piece::Call { arguments, .. })) = lookup.call(place(mistake).start) else {
        return;
    };
    let texts: Vec<&str> = arguments.iter().map(|argument| source.part(*argument)).collect();
    let most = mistake.notes.iter().find_map(|note| {
        let number = note.split_once("at most ")?.1;
        number.split(' ').next()?.parse::<usize>().ok()
    });
    mistake.notes.clear();
    let Some(most) = most else { return };
    mistake.message = format!("`{name}` takes {}, not {}", counted_words(most), texts.len());
    if let Some(extra) = arguments.get(most) {
        mistake.place(extra.range(), "too much");
        mistake.labels.truncate(1);
    }
    match (name, texts.as_slice()) {
        ("max" | "min", [first, second, rest @ ..]) => {
            let nested = rest.iter().fold(format!("{name}({first}, {second})"), |inner, one| {
                format!("{name}({inner}, {one})")
            });
            mistake.write(nested);
        }
        ("atan", [y, x]) => mistake.write(format!("atan2({y}, {x})")),
        _ => mistake.write(format!("{name}({})", texts[..most.min(texts.len())].join(", "))),
    }
}

fn counted_words(count: usize) -> String {
    if count == 1 { "1 argument".to_owned() } else { format!("{count} arguments") }
}

/// Functions of textures, with their arguments.
const TEXTURES: [(&str, &[&str]); 7] = [
    ("textureSample", &["t", "s", "uv"]),
    ("textureSampleLevel", &["t", "s", "uv", "0.0"]),
    ("textureSampleBias", &["t", "s", "uv", "bias"]),
    ("textureSampleCompare", &["t", "s", "uv", "depth"]),
    ("textureSampleCompareLevel", &["t", "s", "uv", "depth"]),
    ("textureLoad", &["t", "texel", "0"]),
    ("textureStore", &["t", "texel", "value"]),
];

fn wrong_number(source: &Source<'_>, _: &str, mistake: &mut Mistake) {
    let Some(lookup) = &source.lookup else { return };
    let Some((_, Piece::Call { name, arguments })) = lookup.call(place(mistake).start) else {
        return;
    };
    mistake.message = format!("`{name}`: {}", mistake.message);
    mistake.labels.iter_mut().for_each(|(_, label)| *label = "in this call".to_owned());
    if let Some(head) = lookup.head_named(name) {
        let parameters: Vec<String> = head
            .parameters
            .iter()
            .map(|one| format!("{}: {}", one.name, one.of_type.map_or("", |of| source.part(of))))
            .collect();
        mistake.notes.push(format!("declared: `{name}({})`", parameters.join(", ")));
        return;
    }
    let Some((_, expected)) = TEXTURES.iter().find(|(known, _)| *known == name) else { return };
    let mut texts: Vec<String> = arguments.iter().map(|one| source.part(*one).to_owned()).collect();
    let is_sampler = |name: &String| {
        lookup
            .declared(name, 0)
            .and_then(|one| one.of_type)
            .is_some_and(|of_type| source.part(of_type).starts_with("sampler"))
    };
    if expected.get(1) == Some(&"s")
        && texts.len() < expected.len()
        && !texts.iter().any(is_sampler)
    {
        texts.insert(1.min(texts.len()), sampler_name(source).unwrap_or("s").to_owned());
    }
    for missing in expected.iter().skip(texts.len()) {
        texts.push((*missing).to_owned());
    }
    texts.truncate(expected.len());
    mistake.write(format!("{name}({})", texts.join(", ")));
}

/// The first sampler of the module.
pub(super) fn sampler_name<'t>(source: &Source<'t>) -> Option<&'t str> {
    source.text.match_indices(": sampler").find_map(|(at, _)| {
        let before = &source.text[..at];
        let start = before.rfind(|one: char| !(one.is_alphanumeric() || one == '_'))? + 1;
        Some(&before[start..])
    })
}

fn select_order(source: &Source<'_>, _: &str, mistake: &mut Mistake) {
    let Some(lookup) = &source.lookup else { return };
    let at = place(mistake);
    let Some((call, _, _)) = lookup.call_around(&at) else { return };
    let Some(Piece::Call { arguments, .. }) = lookup.piece(&call.range()) else { return };
    let texts: Vec<&str> = arguments.iter().map(|argument| source.part(*argument)).collect();
    let [first, second, third] = texts.as_slice() else { return };
    let is_bool = mistake.labels.iter().any(|(_, label)| label.contains("value of type `bool`"));
    if is_bool {
        mistake.message = "`select` takes the condition as its last argument".to_owned();
        mistake.labels = vec![(at, "this is `bool`".to_owned())];
        mistake.help(format!(
            "`select(otherwise, value, condition)`: write `select({third}, {second}, {first})`"
        ));
        return;
    }
    let of = |start: &str| {
        let label = mistake.labels.iter().find_map(|(_, label)| label.split_once(start));
        label.map(|(_, rest)| rest.trim_matches('`').to_owned())
    };
    let (Some(reject), Some(accept)) = (of("reject value of type "), of("accept value of type "))
    else {
        return;
    };
    mistake.message = format!(
        "the two choices of `select` are `{}` and `{}`",
        short_type(&reject),
        short_type(&accept)
    );
    let text = match reject.starts_with("vec") {
        true => converted(second, &accept, &reject)
            .map(|value| format!("select({first}, {value}, {third})")),
        false => converted(first, &reject, &accept)
            .map(|value| format!("select({value}, {second}, {third})")),
    };
    if let Some(text) = text {
        mistake.write(text);
    }
}

fn case_selector(source: &Source<'_>, _: &str, mistake: &mut Mistake) {
    let value = source.slice(&place(mistake));
    mistake.message = "a `case` has another type than what `switch` looks at".to_owned();
    mistake.labels.iter_mut().for_each(|(_, label)| *label = "this case".to_owned());
    let digits = value.trim_end_matches(['u', 'i']);
    if is_number(value) && digits != value {
        mistake.help(format!("write `{digits}`, which has the type that is needed"));
    } else {
        mistake.help("write both as `i32`, or both as `u32`");
    }
}

fn no_value(source: &Source<'_>, _: &str, mistake: &mut Mistake) {
    let call = source.slice(&place(mistake)).to_owned();
    let name = call.split('(').next().unwrap_or_default();
    mistake.message = format!("`{name}` returns nothing");
    mistake.labels.iter_mut().for_each(|(_, label)| *label = "there is no value here".to_owned());
    mistake.notes.clear();
    let step = source.lookup.as_ref().and_then(|lookup| lookup.step(&place(mistake)));
    if let Some((_, Step::Declare { keyword, name: declared, .. })) = step {
        mistake.help(format!("write `{call};` without `{keyword} {declared} =`"));
    } else {
        mistake.write(format!("{call};"));
    }
}

fn unused_value(source: &Source<'_>, _: &str, mistake: &mut Mistake) {
    let at = place(mistake);
    let name = source.slice(&at).to_owned();
    mistake.message = format!("`{name}` does nothing but return a value, which is not used");
    mistake.labels = vec![(at.clone(), "its value is lost".to_owned())];
    mistake.notes.clear();
    let call = source.lookup.as_ref().and_then(|lookup| lookup.call(at.start));
    if let Some((call, _)) = call {
        mistake.help(format!("use it, or write `_ = {};`", source.part(call)));
    }
}

fn recursive(source: &Source<'_>, name: &str, mistake: &mut Mistake) {
    if source.lookup.as_ref().is_some_and(|lookup| lookup.head_named(name).is_some()) {
        if let Some(second) = mistake.labels.get(1).cloned() {
            mistake.labels.swap(0, 1);
            mistake.labels[1].1 = "in this function".to_owned();
            mistake.labels[0] = (second.0, "it calls itself here".to_owned());
        }
        mistake.message = format!("`{name}` calls itself, and shaders have no recursion");
        mistake.help(
            "write a loop: `var result = 1;` and `for (var i = 2; i <= n; i++) { result *= i; }`",
        );
    }
}

fn assigned(source: &Source<'_>, _: &str, mistake: &mut Mistake) {
    let at = place(mistake);
    let Some(lookup) = &source.lookup else { return };
    let target = source.slice(&at);
    let step = lookup.step(&at);
    if mistake.notes.iter().any(|note| note.contains("swizzle")) {
        return swizzled(source, lookup, step, mistake);
    }
    let name = target.split(['.', '[']).next().unwrap_or_default();
    let Some(declared) = lookup.declared(name, at.start) else { return };
    let value = declared.value.map_or("...", |value| source.part(value));
    let help = match declared.keyword {
        "let" => format!("write `var {name} = {value};`, since a `let` does not change"),
        "const" if lookup.all_declared(name, at.start).is_empty() => {
            format!("write `var<private> {name} = {value};`, since a `const` does not change")
        }
        "const" => format!("write `var {name} = {value};`, since a `const` does not change"),
        "override" => {
            "an `override` is set when the pipeline is made: copy it to a `var`".to_owned()
        }
        "parameter" => {
            let rest = match &step {
                Some((_, Step::Assign { operator, value, .. })) => {
                    format!(", then `changed {operator} {};`", source.part(*value))
                }
                _ => String::new(),
            };
            mistake.message = format!("the parameter `{name}` cannot change");
            mistake.notes.clear();
            mistake.help(format!("copy it: `var changed = {name};`{rest}"));
            return mistake.labels.truncate(2);
        }
        _ => return,
    };
    mistake.message = format!("`{name}` is a `{}`, and cannot change", declared.keyword);
    mistake.notes.clear();
    mistake.labels.truncate(1);
    mistake.labels.push((declared.place.range(), "declared here".to_owned()));
    mistake.help(help);
}

/// Several components that are assigned to at once.
fn swizzled(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    step: Option<(Place, Step<'_>)>,
    mistake: &mut Mistake,
) {
    let Some((_, Step::Assign { target: Some(target), operator, value })) = step else { return };
    let Some(Piece::Member { base, name }) = lookup.piece(&target.range()) else { return };
    let (base, value) = (source.part(base), source.part(value));
    let lines: Vec<String> = name
        .chars()
        .zip("xyzw".chars())
        .map(|(to, from)| format!("{base}.{to} {operator} {value}.{from};"))
        .collect();
    mistake.message = "WGSL assigns to one component at a time".to_owned();
    mistake.notes.clear();
    mistake.write(lines.join(" "));
}

fn not_constant(source: &Source<'_>, _: &str, mistake: &mut Mistake) {
    let at = place(mistake);
    let Some(lookup) = &source.lookup else { return };
    let name = source.slice(&at);
    let step = lookup.step(&at);
    if let Some((_, Step::Declare { keyword: "const", name, value: Some(value) })) = step
        && value.range().start <= at.start
        && at.end <= value.range().end
    {
        mistake.message = format!("the value of the constant `{name}` is not known before it runs");
        mistake.labels = vec![(value.range(), "this changes from call to call".to_owned())];
        mistake.write(format!("let {name} = {};", source.part(value)));
        return;
    }
    if let Some(Declared {
        keyword: keyword @ ("let" | "var"), value: Some(value), place, ..
    }) = lookup.declared(name, at.start)
    {
        let value = source.part(value);
        mistake.message = format!("`{name}` is a `{keyword}`, and a constant is needed here");
        mistake.labels =
            vec![(at, "not a constant".to_owned()), (place.range(), "declared here".to_owned())];
        mistake.write(format!("const {name} = {value};"));
    }
}

fn address(source: &Source<'_>, _: &str, mistake: &mut Mistake) {
    let at = place(mistake);
    let Some(lookup) = &source.lookup else { return };
    let Some(Piece::AddressOf(operand)) = lookup.piece(&at) else { return };
    let name = source.part(operand);
    let Some(declared) = lookup.declared(name, at.start) else { return };
    mistake.message = format!("`{name}` has no address: only a `var` has one");
    mistake.labels = vec![
        (at, "its address is taken here".to_owned()),
        (declared.place.range(), format!("a `{}`", declared.keyword)),
    ];
    match (declared.keyword, declared.value) {
        ("parameter", _) => mistake.help(format!("copy it: `var copy = {name};` and `&copy`")),
        (_, Some(value)) => mistake.write(format!("var {name} = {};", source.part(value))),
        _ => {}
    }
}

fn atomic(source: &Source<'_>, _: &str, mistake: &mut Mistake) {
    let at = place(mistake);
    let name = source.slice(&at).to_owned();
    mistake.message = "an atomic is read and written by functions of its own".to_owned();
    let Some(lookup) = &source.lookup else { return };
    if let Some((call, function, _)) = lookup.call_around(&at)
        && function.starts_with("atomic")
    {
        mistake.message = format!("`{function}` takes the address of an atomic");
        let inner = Place { start: at.start as u32, end: at.end as u32 };
        mistake.write(source.replaced(call, inner, &format!("&{name}")));
        return;
    }
    match lookup.step(&at) {
        Some((_, Step::Assign { target: Some(target), operator: "=", value }))
            if target.range() == at =>
        {
            mistake.write(format!("atomicStore(&{name}, {});", source.part(value)));
        }
        _ => mistake.write(format!("atomicLoad(&{name})")),
    }
}

fn counted(source: &Source<'_>, _: &str, mistake: &mut Mistake) {
    let at = place(mistake);
    let name = source.slice(&at).trim_end_matches(['+', '-']).to_owned();
    let declared = source.lookup.as_ref().and_then(|lookup| lookup.declared(&name, at.start + 1));
    match declared {
        Some(Declared {
            keyword: keyword @ ("let" | "const"), value: Some(value), place, ..
        }) => {
            mistake.message = format!("`{name}` is a `{keyword}`, and cannot change");
            mistake.labels =
                vec![(at, "changed here".to_owned()), (place.range(), "declared here".to_owned())];
            mistake.write(format!("var {name} = {}", source.part(value)));
        }
        _ => mistake.help(format!(
            "`++` and `--` are for integers in variables: `{name} += 1.0;` for a float"
        )),
    }
}

fn too_large(source: &Source<'_>, wanted: &str, mistake: &mut Mistake) {
    let value = last_quoted(&mistake.message).to_owned();
    mistake.message = format!("`{value}` is not a value of `{wanted}`");
    mistake.labels.iter_mut().for_each(|(_, label)| *label = "out of its range".to_owned());
    let declared = source.lookup.as_ref().and_then(|lookup| lookup.step(&place(mistake)));
    let other = match wanted {
        "u32" if value.starts_with('-') => "i32",
        "i32" if value.parse::<u32>().is_ok() => "u32",
        _ => "f32",
    };
    match declared {
        Some((_, Step::Declare { keyword, name, .. })) => {
            mistake.write(format!("{keyword} {name}: {other} = {value};"));
            mistake.help(format!("where it is returned, the result is `{other}` too"));
        }
        _ => mistake.help(format!("`{other}` has it")),
    }
}

fn workgroup_size(_: &Source<'_>, _: &str, mistake: &mut Mistake) {
    mistake.message = "a compute shader has no size of its workgroups".to_owned();
    mistake.labels.iter_mut().for_each(|(_, label)| *label = "without a size".to_owned());
    mistake.write("@compute @workgroup_size(64)");
}

fn group(_: &Source<'_>, attribute: &str, mistake: &mut Mistake) {
    let missing = match attribute.starts_with("@binding") {
        true => "@group(0)",
        false => "@binding(0)",
    };
    mistake.message = format!("a variable with `{attribute}` needs `{missing}` too");
    mistake.labels.iter_mut().for_each(|(_, label)| *label = format!("without `{missing}`"));
    mistake.write(match attribute.starts_with("@binding") {
        true => format!("{missing} {attribute}"),
        false => format!("{attribute} {missing}"),
    });
}

fn half(_: &Source<'_>, _: &str, mistake: &mut Mistake) {
    mistake.message = "`f16` is used, and nothing enables it".to_owned();
    mistake.labels.iter_mut().for_each(|(_, label)| *label = "used here".to_owned());
    mistake.notes.clear();
    mistake.help("write `enable f16;` as the first line, for targets that have it, or use `f32`");
}

/// Declarations that a lookup finds at the place of a name.
pub(super) fn declared_type<'t>(
    source: &Source<'t>,
    lookup: &Lookup<'t>,
    name: &str,
    at: usize,
) -> Option<&'t str> {
    lookup.declared(name, at)?.of_type.map(|of_type| source.part(of_type))
}
