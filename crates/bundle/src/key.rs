//! Keys as text: `shadow=pcf_3x3,two_sided`.
//!
//! A key lists the axes that differ from their defaults, sorted by name. An axis whose value is
//! `true` stands alone. The permutation without a difference is [`DEFAULT`]. The loader, the tools
//! and the command line read and write keys with this module. Code that `crates/keys/src/` generates for
//! hosts writes keys by itself, with the marks and words that are constants here.

use super::{Axis, Error};

/// The key of the permutation with every axis at its default.
pub const DEFAULT: &str = "default";

/// What stands between the parts of a key.
pub const SEPARATOR: char = ',';

/// What stands between an axis and its value.
pub const ASSIGNS: char = '=';

/// The value that an axis has where a key names it alone.
pub const IMPLIED: &str = "true";

/// The mode of axes whose value the host sets at run time. Keys do not name such axes.
const DYNAMIC: &str = "dynamic";

/// A word of a key, without the blanks around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeyWord<'k> {
    /// Its characters.
    pub text: &'k str,
    /// Bytes of the key before it.
    pub start: usize,
}

/// What stands between two commas of a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeyPart<'k> {
    /// The name of an axis; empty where it is missing, which is a mistake.
    pub axis: KeyWord<'k>,
    /// What follows the `=`; empty where nothing does, which is a mistake. `None` without `=`.
    pub value: Option<KeyWord<'k>>,
}

impl<'k> KeyPart<'k> {
    /// The value that it chooses, which is [`IMPLIED`] without a `=`.
    pub fn chosen(&self) -> &'k str {
        self.value.map_or(IMPLIED, |value| value.text)
    }
}

/// Reads a key: its parts in order. The default permutation has none.
pub fn parts(key: &str) -> impl Iterator<Item = KeyPart<'_>> {
    let is_default = matches!(key.trim(), "" | DEFAULT);
    let mut rest = (!is_default).then_some(KeyWord { text: key, start: 0 });
    std::iter::from_fn(move || {
        let KeyWord { text, start } = rest?;
        let (part, after) = match text.split_once(SEPARATOR) {
            Some((part, after)) => (part, Some(after)),
            None => (text, None),
        };
        rest = after.map(|text| KeyWord { text, start: start + part.len() + 1 });
        Some(match part.split_once(ASSIGNS) {
            Some((axis, value)) => KeyPart {
                axis: trimmed_word(axis, start),
                value: Some(trimmed_word(value, start + axis.len() + 1)),
            },
            None => KeyPart { axis: trimmed_word(part, start), value: None },
        })
    })
}

fn trimmed_word(text: &str, start: usize) -> KeyWord<'_> {
    KeyWord { text: text.trim(), start: start + text.len() - text.trim_start().len() }
}

/// Writes the key of axes that differ from their defaults, given in any order with their values.
pub fn write<'a>(differing: impl IntoIterator<Item = (&'a str, &'a str)>) -> String {
    let mut parts: Vec<(&str, &str)> = differing.into_iter().collect();
    if parts.is_empty() {
        return DEFAULT.to_owned();
    }
    parts.sort_unstable();
    let parts = parts.into_iter().map(|(axis, value)| match value {
        IMPLIED => axis.to_owned(),
        _ => format!("{axis}{ASSIGNS}{value}"),
    });
    parts.collect::<Vec<_>>().join(&SEPARATOR.to_string())
}

/// The canonical form of a key: axes sorted, defaults left out.
///
/// # Errors
/// [`Error::BadKey`] if it names an axis or a value that does not exist, a dynamic axis, or an axis
/// twice.
pub fn canonical(axes: &[Axis], key: &str) -> Result<String, Error> {
    let mut chosen: Vec<(&str, &str)> = Vec::new();
    for part in parts(key) {
        let found = axis_and_value(axes, part)
            .and_then(|(axis, value)| match chosen.iter().any(|(other, _)| *other == axis.name) {
                true => Err(format!("axis `{}` is named twice", axis.name)),
                false => Ok((axis.name.as_str(), value)),
            })
            .map_err(|reason| Error::BadKey { key: key.to_owned(), reason })?;
        chosen.push(found);
    }
    let differs = |(name, value): &(&str, &str)| {
        !axes.iter().any(|axis| axis.name == *name && axis.default == *value)
    };
    Ok(write(chosen.into_iter().filter(differs)))
}

/// The axis and the value that a part names.
fn axis_and_value<'a>(axes: &'a [Axis], part: KeyPart<'a>) -> Result<(&'a Axis, &'a str), String> {
    let name = part.axis.text;
    if name.is_empty() {
        return Err("expected `axis=value`".to_owned());
    }
    let axis = axes.iter().find(|axis| axis.name == name).ok_or_else(|| {
        format!("there is no axis `{name}`{}", quoted_names(axes.iter().map(|axis| &axis.name)))
    })?;
    if axis.mode == DYNAMIC {
        return Err(format!("axis `{name}` is dynamic: its value is chosen while running"));
    }
    let value = part.chosen();
    if axis.values.iter().any(|known| known == value) {
        return Ok((axis, value));
    }
    let known = quoted_names(axis.values.iter());
    Err(match part.value {
        Some(value) if !value.text.is_empty() => {
            format!("axis `{name}` has no value `{}`{known}", value.text)
        }
        _ => format!("axis `{name}` needs a value{known}"),
    })
}

/// Whether a key names an axis with this value.
pub fn has_value(key: &str, axis: &str, value: &str) -> bool {
    parts(key).any(|part| part.axis.text == axis && part.chosen() == value)
}

/// The key without an axis, which then has its default.
pub fn without_axis(key: &str, axis: &str) -> String {
    let others = parts(key).filter(|part| part.axis.text != axis);
    write(others.map(|part| (part.axis.text, part.chosen())))
}

/// The value that a canonical key gives an axis.
pub fn value<'a>(key: &'a str, axis: &'a Axis) -> &'a str {
    let chosen = parts(key).find(|part| part.axis.text == axis.name);
    chosen.map_or(axis.default.as_str(), |part| part.chosen())
}

/// In how many axes two canonical keys differ.
pub fn distance(a: &str, b: &str) -> usize {
    let mut left = parts(a).peekable();
    let mut right = parts(b).peekable();
    let mut differing = 0;
    // Both are sorted by axis, so they are walked together, as in a merge.
    loop {
        match (left.peek().map(words_of), right.peek().map(words_of)) {
            (None, None) => return differing,
            (Some(one), Some(other)) if one == other => {
                left.next();
                right.next();
            }
            (one, other) => {
                differing += 1;
                let (one, other) = (one.map(|(axis, _)| axis), other.map(|(axis, _)| axis));
                if other.is_none() || (one.is_some() && one <= other) {
                    left.next();
                }
                if one.is_none() || (other.is_some() && other <= one) {
                    right.next();
                }
            }
        }
    }
}

fn words_of<'k>(part: &KeyPart<'k>) -> (&'k str, &'k str) {
    (part.axis.text, part.chosen())
}

fn quoted_names<'a>(names: impl Iterator<Item = &'a String>) -> String {
    let names: Vec<&str> = names.map(String::as_str).collect();
    if names.is_empty() { String::new() } else { format!("; there are: {}", names.join(", ")) }
}
