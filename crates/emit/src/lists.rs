//! Writes the initial values of constants and variables of HLSL as lists.
//!
//! naga calls functions that it adds, such as `ConstructPair(1.0, 2)`. fxc and dxc accept that.
//! glslang takes such a call for one of the function that stands before it. All three accept lists.

use std::collections::HashMap;

use super::columns;

/// The text with lists instead of calls, wherever a variable of the module is initialised.
pub fn with_plain_constants(text: &str) -> String {
    if !text.contains(" = Construct") {
        return text.to_owned();
    }
    let structs = find_structs(text);
    let line = |line: &str| {
        let declared = line.split_once(" = ").filter(|_| line.starts_with("static "));
        match declared.and_then(|(head, value)| Some((head, value.strip_suffix(";\n")?))) {
            Some((head, value)) => format!("{head} = {};\n", as_list(value, &structs)),
            None => line.to_owned(),
        }
    };
    text.split_inclusive('\n').map(line).collect()
}

/// The members of each structure.
type Structs<'t> = HashMap<&'t str, Vec<MemberContent>>;

/// What a member holds.
#[derive(Clone, Copy, PartialEq, Eq)]
enum MemberContent {
    Value,
    /// Padding.
    Gap,
    /// An array of matrices of two rows, which are structures of columns.
    Columns,
}

fn find_structs(text: &str) -> Structs<'_> {
    let mut structs = Structs::new();
    let first = text.strip_prefix("struct ");
    for part in text.split("\nstruct ").skip(1).chain(first) {
        if let Some((name, rest)) = part.split_once(" {\n")
            && let Some((members, _)) = rest.split_once("\n}")
        {
            let member = |line: &str| match line.trim_start() {
                line if line.contains(" _pad") || line.contains(" _end_pad") => MemberContent::Gap,
                line if line.starts_with(columns::STRUCTURE) => MemberContent::Columns,
                _ => MemberContent::Value,
            };
            // The columns of a matrix stand on one line.
            let members = members.split(';').filter(|member| !member.trim().is_empty());
            structs.insert(name, members.map(member).collect());
        }
    }
    structs
}

/// `ConstructPair(a, b)` written as `{ a, b }`.
fn as_list(value: &str, structs: &Structs<'_>) -> String {
    let list = parse_call(value).and_then(|(word, arguments)| {
        let of = word.strip_prefix("Construct")?;
        match structs.get(of) {
            None => Some(arguments.iter().map(|value| as_list(value, structs)).collect()),
            Some(members) => filled_members(members, &arguments, structs),
        }
    });
    list.map_or_else(|| value.to_owned(), |list: Vec<String>| format!("{{ {} }}", list.join(", ")))
}

/// The values of all members, padding included. naga declares the columns of a matrix of two rows
/// as members.
fn filled_members(
    members: &[MemberContent],
    arguments: &[&str],
    structs: &Structs<'_>,
) -> Option<Vec<String>> {
    let mut values = Vec::new();
    let mut places = members.iter().filter(|member| **member != MemberContent::Gap);
    for argument in arguments {
        let member = *places.next()?;
        match (member, columns_of(argument)) {
            (MemberContent::Columns, _) => values.push(listed_columns(argument)),
            (_, Some(columns)) => {
                places.nth(columns.len().checked_sub(2)?)?;
                values.extend(columns.into_iter().map(str::to_owned));
            }
            _ => values.push(as_list(argument, structs)),
        }
    }
    let mut values = values.into_iter();
    let one = |member: &MemberContent| match member {
        MemberContent::Gap => Some("0".to_owned()),
        _ => values.next(),
    };
    let list = members.iter().map(one).collect::<Option<Vec<String>>>()?;
    values.next().is_none().then_some(list)
}

/// The columns of a value, if it is a matrix of two rows.
fn columns_of(value: &str) -> Option<Vec<&str>> {
    let (word, columns) = parse_call(value)?;
    matches!(word, "float2x2" | "float3x2" | "float4x2").then_some(columns)
}

/// An array of matrices of two rows, as lists of columns.
fn listed_columns(value: &str) -> String {
    let list: Vec<String> = match (columns_of(value), parse_call(value)) {
        (Some(columns), _) => columns.into_iter().map(str::to_owned).collect(),
        (None, Some((_, elements))) => elements.into_iter().map(listed_columns).collect(),
        (None, None) => return value.to_owned(),
    };
    format!("{{ {} }}", list.join(", "))
}

/// Reads a value that is a call: the name of the function, and its arguments.
fn parse_call(value: &str) -> Option<(&str, Vec<&str>)> {
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
