//! Every function's documentation says what it computes, from which parameters, and by which source.
//!
//! Its line `Edges:` says what every parameter does outside of its domain: a zero vector, a number
//! that is zero, negative or too large. It names the parameter, or speaks of parameters as a whole,
//! or begins with a reference to another function, "as for `d_ggx`". It may be silent about a
//! parameter whose description says that any value is allowed. A function of one parameter need not
//! name it.

use libtest_mimic::Failed;

use super::{Function, functions, modules, read};

/// The parts that every function's documentation has. Each starts a line.
const DOC_PARTS: [&str; 5] = ["Parameters: ", "Returns: ", "Source: ", "Edges: ", "Error model: "];

/// What the types begin with whose values may be outside of a domain. The members of structures are
/// documented where they are declared.
const NUMBERS: [&str; 6] = ["f32", "i32", "u32", "vec", "mat", "array"];

/// A module is documented in both languages, and its functions refer to functions that exist.
pub fn functions_are_documented(module: &str) -> Result<(), Failed> {
    let text = read(&format!("{module}.wesl"));
    if !text.starts_with("//! ") {
        return Err("the module has no documentation".into());
    }
    let mut faults = undocumented(&text);
    faults.extend(undocumented(&read(&format!("{module}.glsl"))));
    faults.extend(dangling_references(&text));
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n").into()) }
}

/// The parts that the documentation of a module's functions lacks.
pub fn undocumented(module: &str) -> Vec<String> {
    functions(module).iter().flat_map(faults).collect()
}

fn faults(function: &Function) -> Vec<String> {
    let missing = DOC_PARTS
        .iter()
        .filter(|name| doc_part(function, name).is_none())
        .map(|name| format!("`{}` lacks `{name}`", function.name));
    let described = doc_part(function, DOC_PARTS[0]).unwrap_or_default();
    let unknown =
        function.parameters.iter().filter(|name| !described.contains(&format!("`{name}`")));
    let summary = function
        .doc
        .first()
        .filter(|line| line.ends_with('.') && !DOC_PARTS.iter().any(|part| line.starts_with(part)));
    let unsaid = summary
        .is_none()
        .then(|| format!("`{}` does not say in a sentence what it computes", function.name));
    let silent = silent_edges(function).into_iter().map(|name| {
        format!(
            "`{}`: `Edges:` does not say what `{name}` gives outside of its domain",
            function.name
        )
    });
    unsaid
        .into_iter()
        .chain(missing)
        .chain(unknown.map(|name| format!("`{}` does not describe `{name}`", function.name)))
        .chain(silent)
        .collect()
}

/// The text of a part, which begins with its name.
fn doc_part<'f>(function: &'f Function, name: &str) -> Option<&'f str> {
    let mut texts = function.doc.iter().filter_map(|line| line.strip_prefix(name));
    texts.next().filter(|text| !text.is_empty())
}

/// The parameters that the line `Edges:` has to speak of and does not.
fn silent_edges(function: &Function) -> Vec<&str> {
    let (Some(described), Some(edges)) =
        (doc_part(function, DOC_PARTS[0]), doc_part(function, DOC_PARTS[3]))
    else {
        return Vec::new();
    };
    let typed = function.parameters.iter().zip(&function.types);
    let numbers: Vec<&str> = typed
        .filter(|(_, ty)| NUMBERS.iter().any(|start| ty.starts_with(start)))
        .map(|(name, _)| name.as_str())
        .collect();
    let is_only = numbers.len() == 1 && !edges.starts_with("none");
    if is_only || speaks_of_all(edges) {
        return Vec::new();
    }
    let is_silent =
        |name: &&str| !edges.contains(&format!("`{name}`")) && !allows_any(described, name);
    numbers.into_iter().filter(is_silent).collect()
}

/// Whether `Edges:` holds for all parameters, by their common name or that of another function.
fn speaks_of_all(edges: &str) -> bool {
    has_word(edges, &["parameter", "parameters"])
        || ["as `", "as for `"].iter().any(|start| edges.starts_with(start))
}

/// Whether a parameter's description says "any" or "anywhere".
fn allows_any(described: &str, name: &str) -> bool {
    let mut clauses = described.split(';');
    clauses.any(|clause| is_about(clause, name) && has_word(clause, &["any", "anywhere"]))
}

/// Whether a clause begins with a list of names that has this one: "`n`, `l` unit vectors".
fn is_about(clause: &str, name: &str) -> bool {
    let words = clause.split_whitespace().map(|word| word.trim_end_matches(','));
    let mut names = words.take_while(|word| *word == "and" || word.starts_with('`'));
    names.any(|word| word.trim_matches('`') == name)
}

fn has_word(text: &str, wanted: &[&str]) -> bool {
    text.split(|letter: char| !letter.is_alphanumeric()).any(|word| wanted.contains(&word))
}

/// References of `Edges:` to functions that the library does not have.
fn dangling_references(module: &str) -> Vec<String> {
    let library: Vec<String> = modules()
        .iter()
        .flat_map(|module| functions(&read(&format!("{module}.wesl"))))
        .map(|function| function.name)
        .collect();
    let mut faults = Vec::new();
    for function in functions(module) {
        let edges = doc_part(&function, DOC_PARTS[3]).unwrap_or_default();
        let after = edges.match_indices("as for `").map(|(at, start)| &edges[at + start.len()..]);
        let first = edges.strip_prefix("as `");
        for name in after.chain(first).filter_map(|rest| rest.split('`').next()) {
            if !library.iter().any(|known| known == name) {
                let what = format!("`{}`: `Edges:` refers to `{name}`", function.name);
                faults.push(format!("{what}, which is no function of the library"));
            }
        }
    }
    faults
}

/// The rule finds a parameter that `Edges:` is silent about, and no other.
pub fn silent_parameters_are_found() -> Result<(), Failed> {
    let all = "`n`, `l` unit; `p` the point, anywhere; `k` sharpness, at least 0";
    let rules: [(&str, &str, &[&str]); 8] = [
        (all, "0 for a zero `n` or `l`; a negative `k` counts as 0.", &[]),
        (all, "0 for a zero vector.", &["n", "l", "k"]),
        (all, "0 for a zero `n`, or an `l*k` of 0.", &["l", "k"]),
        (all, "none.", &["n", "l", "k"]),
        (all, "no parameter is clamped.", &[]),
        (all, "as for `lambert`.", &[]),
        (all, "a zero `n` as for `lambert`.", &["l", "k"]),
        ("`n`, `l`, `p` and `k` any", "none.", &[]),
    ];
    for (described, edges, wanted) in rules {
        let text = format!(
            "/// A number.\n///\n/// Parameters: {described}.\n/// Returns: 0.\n/// Source: none.\n\
             /// Edges: {edges}\n/// Error model: exact.\n\
             fn some_number(n: vec3f, l: vec3f, p: vec3f, k: f32, map: texture_2d<f32>) -> f32 {{\n"
        );
        let found = functions(&text);
        let silent: Vec<&str> = found.iter().flat_map(silent_edges).collect();
        if silent != wanted {
            return Err(format!("`{edges}`: expected {wanted:?}, found {silent:?}").into());
        }
    }
    Ok(())
}
