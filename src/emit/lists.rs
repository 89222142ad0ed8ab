//! Writes the initial values of constants and variables of HLSL as lists.
//!
//! naga calls functions that it adds, such as `ConstructPair(1.0, 2)`. fxc and dxc accept that.
//! glslang takes such a call for one of the function that stands before it. All three accept lists.

use std::collections::HashMap;

/// The text with lists instead of calls, wherever a variable of the module is initialised.
pub fn with_plain_constants(text: &str) -> String {
    if !text.contains(" = Construct") {
        return text.to_owned();
    }
    let structs = structs(text);
    let line = |line: &str| {
        let declared = line.split_once(" = ").filter(|_| line.starts_with("static "));
        match declared.and_then(|(head, value)| Some((head, value.strip_suffix(";\n")?))) {
            Some((head, value)) => format!("{head} = {};\n", listed(value, &structs)),
            None => line.to_owned(),
        }
    };
    text.split_inclusive('\n').map(line).collect()
}

/// For each structure, whether each of its members is padding.
type Structs<'t> = HashMap<&'t str, Vec<bool>>;

fn structs(text: &str) -> Structs<'_> {
    let mut structs = Structs::new();
    let first = text.strip_prefix("struct ");
    for part in text.split("\nstruct ").skip(1).chain(first) {
        if let Some((name, rest)) = part.split_once(" {\n")
            && let Some((members, _)) = rest.split_once("\n}")
        {
            let is_gap = |line: &str| line.contains(" _pad") || line.contains(" _end_pad");
            // The columns of a matrix stand on one line.
            let members = members.split(';').filter(|member| !member.trim().is_empty());
            structs.insert(name, members.map(is_gap).collect());
        }
    }
    structs
}

/// `ConstructPair(a, b)` written as `{ a, b }`.
fn listed(value: &str, structs: &Structs<'_>) -> String {
    let list = call(value).and_then(|(word, arguments)| {
        let of = word.strip_prefix("Construct")?;
        match structs.get(of) {
            None => Some(arguments.iter().map(|value| listed(value, structs)).collect()),
            Some(members) => filled(members, &arguments, structs),
        }
    });
    list.map_or_else(|| value.to_owned(), |list: Vec<String>| format!("{{ {} }}", list.join(", ")))
}

/// The values of all members, padding included. naga declares the columns of a matrix of two rows
/// as members.
fn filled(members: &[bool], arguments: &[&str], structs: &Structs<'_>) -> Option<Vec<String>> {
    let mut values = Vec::new();
    for argument in arguments {
        match call(argument) {
            Some(("float2x2" | "float3x2" | "float4x2", columns)) => {
                values.extend(columns.into_iter().map(str::to_owned));
            }
            _ => values.push(listed(argument, structs)),
        }
    }
    let mut values = values.into_iter();
    let member = |is_gap: &bool| if *is_gap { Some("0".to_owned()) } else { values.next() };
    let list = members.iter().map(member).collect::<Option<Vec<String>>>()?;
    values.next().is_none().then_some(list)
}

/// Reads a value that is a call: the name of the function, and its arguments.
fn call(value: &str) -> Option<(&str, Vec<&str>)> {
    let (word, rest) = value.split_once('(')?;
    let rest = rest.strip_suffix(')')?;
    let (mut depth, mut start, mut arguments) = (0_usize, 0, Vec::new());
    for (at, byte) in rest.bytes().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' => depth = depth.checked_sub(1)?,
            b',' if depth == 0 => {
                arguments.push(rest[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    arguments.push(rest[start..].trim());
    (depth == 0).then_some((word, arguments))
}
