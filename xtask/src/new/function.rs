//! A function of the shader library, in a module that exists or in a new one.

use super::{Kind, Made, Repository, check_name, refuse_rest};

pub const KIND: Kind =
    Kind { name: "function", example: &["brdf::diffuse::minnaert"], rest: "", make };

fn make(repository: &Repository<'_>, path: &str, rest: &[&str]) -> Result<Made, String> {
    refuse_rest(rest)?;
    let parts: Vec<&str> = path.split("::").collect();
    parts.iter().try_for_each(|part| check_name(part, '_'))?;
    let [folder, module, name] = parts[..] else {
        return Err(format!("`{path}` is not the path of a function: FOLDER::MODULE::NAME"));
    };
    let stem = format!("shaderlib/{folder}/{module}");
    let reference = format!("src/proof/references/{folder}_{module}.rs");
    let edits: [(String, Edit); 5] = [
        (format!("{stem}.wesl"), wesl),
        (format!("{stem}.glsl"), glsl),
        (format!("{stem}.toml"), cases),
        (format!("{stem}.plot.toml"), plot),
        (reference.clone(), reference_text),
    ];
    let names = Names { folder, module, name };
    let mut files = Vec::new();
    for (file, edit) in edits {
        let text = edit(repository.find(&file).as_deref(), &names)
            .map_err(|problem| format!("`{file}`: {problem}"))?;
        files.push((file, text));
    }
    let next = vec![
        format!("{stem}.wesl: the formula, and each line of its comment (trial shaderlib::)"),
        format!("{stem}.glsl: the same comment and formula (trial shaderlib::)"),
        format!("{reference}: the formula in f64, from the source and not from the shader (check)"),
        format!("{stem}.toml: inputs, tolerance and laws (check)"),
        format!("cargo run -- check {folder}/{module}; cargo xtask docs"),
    ];
    Ok(Made { files, next })
}

struct Names<'n> {
    folder: &'n str,
    module: &'n str,
    name: &'n str,
}

/// The new text of a file from the old one, if there is one.
type Edit = fn(Option<&str>, &Names<'_>) -> Result<String, String>;

/// What stands above a function. Each line wants its words.
const COMMENT: &str = "\
///
///
/// Parameters: `x`
/// Returns:
/// Source:
/// Edges:
/// Error model:
";

fn wesl(old: Option<&str>, names: &Names<'_>) -> Result<String, String> {
    let name = names.name;
    let old = old.unwrap_or("//!\n");
    refuse_known(old, &format!("fn {name}("))?;
    Ok(format!("{old}\n{COMMENT}fn {name}(x: f32) -> f32 {{\n    return x;\n}}\n"))
}

/// Gives names their prefix. It stands before the declarations and after them.
const PREFIX: &str = "#ifdef LAMPLIGHT_PREFIX\n#include \"../prefix.glsl\"\n#endif\n";

fn glsl(old: Option<&str>, names: &Names<'_>) -> Result<String, String> {
    let Names { folder, module, name } = names;
    let guard = format!("LAMPLIGHT_{}_{}_GLSL", folder.to_uppercase(), module.to_uppercase());
    let end = format!("\n{PREFIX}\n#endif\n");
    let new = format!("//!\n\n#ifndef {guard}\n#define {guard}\n\n{PREFIX}{end}");
    let old = old.unwrap_or(&new);
    refuse_known(old, &format!(" {name}("))?;
    let before = old.strip_suffix(&end).ok_or_else(|| format!("does not end with\n{end}"))?;
    Ok(format!("{before}\n{COMMENT}float {name}(float x) {{\n    return x;\n}}\n{end}"))
}

fn cases(old: Option<&str>, names: &Names<'_>) -> Result<String, String> {
    let case = format!(
        "[[case]]\nfunction = \"{}\"\noracle = \"reference\"\ntolerance = {{ ulp = 0 }}\nlaws = []\n\n\
         [case.inputs]\nx = [{{ grid = [0, 1], count = 33 }}]\n",
        names.name
    );
    Ok(old.map_or(case.clone(), |old| format!("{old}\n{case}")))
}

fn plot(old: Option<&str>, names: &Names<'_>) -> Result<String, String> {
    let name = names.name;
    let plot =
        format!("[{name}]\nvalue = \"{name}(x)\"\nx = {{ label = \"x\", from = 0, to = 1 }}\n");
    Ok(old.map_or(plot.clone(), |old| format!("{old}\n{plot}")))
}

fn reference_text(old: Option<&str>, names: &Names<'_>) -> Result<String, String> {
    let Names { folder, module, name } = names;
    let new = format!(
        "//! Sources:\n\nuse super::Entry;\n\npub const REFERENCES: Entry =\n    \
         Entry {{ module: \"{folder}::{module}\", functions: &[] }};\n"
    );
    let old = old.unwrap_or(&new);
    let row = format!("(\"{name}\", |a| {name}(a.f64()).into())");
    let text = with_row(old, &row).ok_or("has no list `functions: &[...]`")?;
    Ok(format!(
        "{text}\n/// Not a number until the published formula stands here.\n\
         fn {name}(x: f64) -> f64 {{\n    x * f64::NAN\n}}\n"
    ))
}

/// The text with one more row at the end of the list of functions.
fn with_row(text: &str, row: &str) -> Option<String> {
    let start = text.find("functions: &[")? + "functions: &[".len();
    let mut depth = 1_usize;
    let end = text[start..].char_indices().find_map(|(at, letter)| {
        depth += usize::from(letter == '[');
        depth -= usize::from(letter == ']');
        (depth == 0).then_some(start + at)
    })?;
    let rows = text[start..end].trim_end().trim_end_matches(',');
    let joint = if rows.is_empty() { "" } else { "," };
    Some(format!("{}{rows}{joint}\n        {row},\n    {}", &text[..start], &text[end..]))
}

fn refuse_known(text: &str, declaration: &str) -> Result<(), String> {
    match text.contains(declaration) {
        true => Err(format!("declares `{}` already", declaration.trim())),
        false => Ok(()),
    }
}
