//! Keys as text: `shadow=pcf_3x3,two_sided`.

use super::{Axis, Error};

/// The key of the permutation with every axis at its default.
pub const DEFAULT: &str = "default";

/// The key with its axes sorted and every default left out; `axis` alone means `axis=true`.
pub fn canonical(axes: &[Axis], key: &str) -> Result<String, Error> {
    let bad = |reason: String| Error::BadKey { key: key.to_owned(), reason };
    let mut parts: Vec<(&str, &str)> = Vec::new();
    for part in parts_of(key) {
        let (name, value) = split(part);
        let axis = axes
            .iter()
            .find(|axis| axis.name == name)
            .ok_or_else(|| bad(format!("there is no axis `{name}`{}", list(axes.iter().map(|axis| &axis.name)))))?;
        if !axis.values.iter().any(|known| known == value) {
            return Err(bad(format!("axis `{name}` has no value `{value}`{}", list(axis.values.iter()))));
        }
        if parts.iter().any(|(other, _)| *other == name) {
            return Err(bad(format!("axis `{name}` is named twice")));
        }
        parts.push((name, value));
    }
    parts.retain(|(name, value)| !axes.iter().any(|axis| axis.name == *name && axis.default == *value));
    parts.sort_unstable();
    let parts = parts.iter().map(|(name, value)| if *value == "true" { (*name).to_owned() } else { format!("{name}={value}") });
    let key = parts.collect::<Vec<_>>().join(",");
    Ok(if key.is_empty() { DEFAULT.to_owned() } else { key })
}

/// The value that a canonical key gives an axis.
pub fn value<'a>(key: &'a str, axis: &'a Axis) -> &'a str {
    let chosen = parts_of(key).map(split).find(|(name, _)| *name == axis.name);
    chosen.map_or(axis.default.as_str(), |(_, value)| value)
}

/// In how many axes two canonical keys differ.
pub fn distance(a: &str, b: &str) -> usize {
    let mut left = parts_of(a).peekable();
    let mut right = parts_of(b).peekable();
    let mut differing = 0;
    // Both are sorted by axis: one walk over the two, as in merging.
    loop {
        match (left.peek().copied(), right.peek().copied()) {
            (None, None) => return differing,
            (Some(one), Some(other)) if one == other => {
                left.next();
                right.next();
            }
            (one, other) => {
                differing += 1;
                let (one, other) = (one.map(|part| split(part).0), other.map(|part| split(part).0));
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

/// The parts between commas; none for the defaults.
fn parts_of(key: &str) -> impl Iterator<Item = &str> {
    let key = if key.trim() == DEFAULT { "" } else { key };
    key.split(',').map(str::trim).filter(|part| !part.is_empty())
}

fn split(part: &str) -> (&str, &str) {
    part.split_once('=').map_or((part, "true"), |(name, value)| (name.trim(), value.trim()))
}

fn list<'a>(names: impl Iterator<Item = &'a String>) -> String {
    let names: Vec<&str> = names.map(String::as_str).collect();
    if names.is_empty() { String::new() } else { format!("; there are: {}", names.join(", ")) }
}
