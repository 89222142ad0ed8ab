//! Which names axes and values may have. Both languages must be able to express them.

use std::collections::BTreeMap;

use crate::axis::{Axis, AxisKind};
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_syntax::wesl::is_keyword;

/// The only word of the constraint language that is not a keyword of WGSL.
///
/// Reserved words of WGSL are allowed for programs and values, since those never become
/// declarations. An axis becomes one in `constants`, so axes may not have reserved names.
const IN: &str = "in";

/// Macros that GLSL compilers or the library define.
const MACROS: &[&str] =
    &["VULKAN", "LAMPLIGHT_COMBINED_SAMPLERS", "LAMPLIGHT_PREFIX", "LAMPLIGHT_PREFIXED"];

/// The error if the name of a program, a feature or a value is not an identifier, or is a keyword.
pub fn check_name(name: &str, what: &str, span: Span) -> Option<Diagnostic> {
    let problem = name_problem(name)?;
    Some(
        Diagnostic::error(codes::BAD_NAME, format!("{what} cannot be called `{name}`: {problem}"))
            .at(span, "not a usable name"),
    )
}

/// The error if the name of an axis is not an identifier, is a keyword, or is a reserved word of
/// WGSL.
pub fn check_axis(name: &str, span: Span) -> Option<Diagnostic> {
    let reserved = || {
        naga::keywords::wgsl::RESERVED
            .contains(&name)
            .then(|| "it is a reserved word of WGSL".to_owned())
    };
    let problem = name_problem(name).or_else(reserved)?;
    Some(
        Diagnostic::error(codes::BAD_NAME, format!("an axis cannot be called `{name}`: {problem}"))
            .at(span, "not a usable name"),
    )
}

/// Reports axes whose GLSL macros are reserved or would mean two things.
pub fn macro_collisions(axes: &[Axis]) -> Vec<Diagnostic> {
    let mut owners: BTreeMap<String, (String, Span)> = BTreeMap::new();
    let mut problems = Vec::new();
    for (name, meaning, span) in
        axes.iter().filter(|axis| name_problem(&axis.name).is_none()).flat_map(axis_macros)
    {
        if name.starts_with("GL_") || name.contains("__") || MACROS.contains(&name.as_str()) {
            let message = format!("{meaning} would be the GLSL macro `{name}`, which is reserved");
            problems
                .push(Diagnostic::error(codes::BAD_NAME, message).at(span, "choose another name"));
        }
        match owners.get(&name) {
            Some((other, first)) => {
                problems.push(macro_collision(&name, (&meaning, span), (other, *first)))
            }
            None => drop(owners.insert(name, (meaning, span))),
        }
    }
    problems
}

fn axis_macros(axis: &Axis) -> Vec<(String, String, Span)> {
    let values = if axis.kind == AxisKind::Enum { axis.value_names() } else { Vec::new() };
    let values = values.into_iter().map(|value| format!("value `{value}` of axis `{}`", axis.name));
    let meanings = std::iter::once(format!("axis `{}`", axis.name)).chain(values);
    axis.macros()
        .into_iter()
        .zip(meanings)
        .map(|(name, meaning)| (name, meaning, axis.span))
        .collect()
}

fn macro_collision(name: &str, second: (&str, Span), first: (&str, Span)) -> Diagnostic {
    let message = format!("{} and {} would both be the GLSL macro `{name}`", first.0, second.0);
    let diagnostic =
        Diagnostic::error(codes::MACRO_COLLISION, message).at(second.1, "rename this one");
    if first.1 == second.1 { diagnostic } else { diagnostic.at(first.1, "or this one") }
}

fn name_problem(name: &str) -> Option<String> {
    if is_keyword(name) || name == IN {
        return Some("it is a keyword".to_owned());
    }
    let fits = |(index, c): (usize, char)| {
        c == '_' || c.is_ascii_alphabetic() || (index > 0 && c.is_ascii_digit())
    };
    if name.is_empty() || !name.chars().enumerate().all(fits) {
        return Some("names are ASCII letters, digits and `_`, and start with no digit".to_owned());
    }
    (name == "_" || name.starts_with("__"))
        .then(|| "WGSL has no identifiers `_` or `__...`".to_owned())
}
