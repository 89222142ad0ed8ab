//! Every function's documentation says what it computes, from which parameters, and by which source.

use libtest_mimic::Failed;

use super::{Function, functions, read};

/// The parts that every function's documentation has. Each starts a line.
const DOC_PARTS: [&str; 5] = ["Parameters: ", "Returns: ", "Source: ", "Edges: ", "Error model: "];

pub fn functions_are_documented(module: &str) -> Result<(), Failed> {
    let text = read(&format!("{module}.wesl"));
    if !text.starts_with("//! ") {
        return Err("the module has no documentation".into());
    }
    let faults = undocumented(&text);
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n").into()) }
}

/// The parts that the documentation of a module's functions lacks.
pub fn undocumented(module: &str) -> Vec<String> {
    functions(module).iter().flat_map(faults).collect()
}

fn faults(function: &Function) -> Vec<String> {
    let part = |name: &str| {
        function.doc.iter().find_map(|line| line.strip_prefix(name)).filter(|text| !text.is_empty())
    };
    let missing = DOC_PARTS
        .iter()
        .filter(|name| part(name).is_none())
        .map(|name| format!("`{}` lacks `{name}`", function.name));
    let described = part(DOC_PARTS[0]).unwrap_or_default();
    let unknown =
        function.parameters.iter().filter(|name| !described.contains(&format!("`{name}`")));
    let summary = function
        .doc
        .first()
        .filter(|line| line.ends_with('.') && !DOC_PARTS.iter().any(|part| line.starts_with(part)));
    let unsaid = summary
        .is_none()
        .then(|| format!("`{}` does not say in a sentence what it computes", function.name));
    unsaid
        .into_iter()
        .chain(missing)
        .chain(unknown.map(|name| format!("`{}` does not describe `{name}`", function.name)))
        .collect()
}
