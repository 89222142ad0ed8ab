//! A function of the shader library, in a module that exists or in a new one.

use lamplight::bundle::Language;

use super::parameter::{Parameter, TYPES, Type, read_parameters, type_of};
use super::{Kind, Made, Repository, check_name};

pub const KIND: Kind = Kind {
    name: "function",
    example: &["brdf::diffuse::minnaert", "nl: f32, nv: f32, k: f32 0..2", "f32"],
    rest: "[FORMULA IN WESL]",
    make,
};

fn make(repository: &Repository<'_>, path: &str, rest: &[&str]) -> Result<Made, String> {
    let parts: Vec<&str> = path.split("::").collect();
    parts.iter().try_for_each(|part| check_name(part, '_'))?;
    let [folder, module, name] = parts[..] else {
        return Err(format!("`{path}` is not the path of a function: FOLDER::MODULE::NAME"));
    };
    let (parameters, result, formula) = match rest {
        [parameters, result] => (parameters, result, None),
        [parameters, result, formula] => (parameters, result, Some(*formula)),
        _ => {
            let what = "the parameters, the type of the result and, if you like, the formula";
            return Err(format!("after the name: {what}, as in the usage"));
        }
    };
    let signature = Signature {
        folder,
        module,
        name,
        parameters: read_parameters(parameters)?,
        result: type_of(result)?,
        formula,
    };
    let stem = format!("shaderlib/{folder}/{module}");
    let reference = format!("src/proof/references/{folder}_{module}.rs");
    let edits: [(String, Edit); 6] = [
        (format!("{stem}.wesl"), wesl),
        (format!("{stem}.glsl"), glsl),
        (format!("{stem}.toml"), cases),
        (format!("{stem}.plot.toml"), plot),
        (reference.clone(), reference_text),
        (format!("tests/plain/{folder}/{module}.wesl"), plain),
    ];
    let mut files = Vec::new();
    for (file, edit) in edits {
        let text = edit(repository.find(&file).as_deref(), &signature)
            .map_err(|problem| format!("`{file}`: {problem}"))?;
        files.push((file, text));
    }
    Ok(Made { files, next: steps(&stem, &reference, &signature) })
}

fn steps(stem: &str, reference: &str, signature: &Signature<'_>) -> Vec<String> {
    let Signature { folder, module, formula, .. } = signature;
    let plain = match formula {
        Some(_) => "has the formula as it was given",
        None => "the published formula, without guards",
    };
    vec![
        format!(
            "{stem}.wesl: the formula, and each line of its comment (trial shaderlib::); `Edges:` says what it returns for zero vectors and outside the domain, `Error model:` the bound that `tolerance` states; for guards, `max(x, 1e-4)`, or `safe_pow` and `safe_normalize` of `super::super::math::safe`"
        ),
        format!("{stem}.glsl: the same comment and formula (trial shaderlib::)"),
        format!("{reference}: the formula in f64, from the source and not from the shader (check)"),
        format!(
            "{stem}.toml: `tolerance`, such as {{ ulp = 2 }}, with a power also `pow = {{ base = \"nl * nv\", exponent = \"k\", ulp = 2 }}`, `check` measures it; `laws`, such as {{ range = [0, 1] }}, `check` lists them if one is wrong"
        ),
        format!(
            "tests/plain/{folder}/{module}.wesl: {plain} (trial plain::); a line `/// Reason:` only if `cargo xtask record plain::` asks for one"
        ),
        format!("{stem}.plot.toml is complete, unless another parameter should be drawn"),
        format!(
            "cargo run -- check {folder}/{module}; cargo xtask docs --costs; cargo xtask record plain:: _budget"
        ),
    ]
}

struct Signature<'n> {
    folder: &'n str,
    module: &'n str,
    name: &'n str,
    parameters: Vec<Parameter<'n>>,
    result: Type,
    /// An expression in WESL that GLSL has too, up to the names of types.
    formula: Option<&'n str>,
}

impl Signature<'_> {
    /// What the function returns.
    fn value(&self, language: Language) -> String {
        let (formula, result) = (self.formula, self.result);
        match language {
            Language::Wesl => formula.map_or(format!("{}()", result.wesl), str::to_owned),
            Language::Glsl => formula.map_or(format!("{}(0)", result.glsl), in_glsl),
        }
    }

    /// Something of each parameter, with commas between.
    fn list(&self, of: impl Fn(&Parameter<'_>) -> String) -> String {
        self.parameters.iter().map(of).collect::<Vec<_>>().join(", ")
    }

    /// What stands above the function. Each line wants its words.
    fn comment(&self) -> String {
        let names = self.list(|one| format!("`{}`", one.name));
        format!(
            "///\n///\n/// Parameters: {names}\n/// Returns:\n/// Source:\n/// Edges:\n/// Error model:\n"
        )
    }
}

/// The new text of a file from the old one, if there is one.
type Edit = fn(Option<&str>, &Signature<'_>) -> Result<String, String>;

fn wesl(old: Option<&str>, new: &Signature<'_>) -> Result<String, String> {
    let old = old.unwrap_or("//!\n");
    refuse_known(old, &format!("fn {}(", new.name))?;
    let parameters = new.list(|one| format!("{}: {}", one.name, one.ty.wesl));
    let (comment, name, result) = (new.comment(), new.name, new.result.wesl);
    let value = new.value(Language::Wesl);
    Ok(format!("{old}\n{comment}fn {name}({parameters}) -> {result} {{\n    return {value};\n}}\n"))
}

/// The formula without guards, which the library's function is compared with.
fn plain(old: Option<&str>, new: &Signature<'_>) -> Result<String, String> {
    let old = old.map_or(String::new(), |old| format!("{old}\n"));
    refuse_known(&old, &format!("fn {}(", new.name))?;
    let parameters = new.list(|one| format!("{}: {}", one.name, one.ty.wesl));
    let (name, result, value) = (new.name, new.result.wesl, new.value(Language::Wesl));
    Ok(format!("{old}fn {name}({parameters}) -> {result} {{\n    return {value};\n}}\n"))
}

/// An expression of WESL with GLSL's names of types.
fn in_glsl(formula: &str) -> String {
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
    let name = |word: &str| {
        let known = TYPES.iter().find(|ty| ty.wesl == word);
        known.map_or(word.to_owned(), |ty| ty.glsl.to_owned())
    };
    let ends = formula.char_indices().filter(|(_, letter)| !is_part(*letter));
    let ends = ends
        .map(|(at, letter)| (at, at + letter.len_utf8()))
        .chain([(formula.len(), formula.len())]);
    let mut start = 0;
    let mut text = String::new();
    for (end, next) in ends {
        text += &name(&formula[start..end]);
        text += &formula[end..next];
        start = next;
    }
    text
}

/// Gives names their prefix. It stands before the declarations and after them.
const PREFIX: &str = "#ifdef LAMPLIGHT_PREFIX\n#include \"../prefix.glsl\"\n#endif\n";

fn glsl(old: Option<&str>, new: &Signature<'_>) -> Result<String, String> {
    let (folder, module) = (new.folder.to_uppercase(), new.module.to_uppercase());
    let guard = format!("LAMPLIGHT_{folder}_{module}_GLSL");
    let end = format!("\n{PREFIX}\n#endif\n");
    let fresh = format!("//!\n\n#ifndef {guard}\n#define {guard}\n\n{PREFIX}{end}");
    let old = old.unwrap_or(&fresh);
    refuse_known(old, &format!(" {}(", new.name))?;
    let before = old.strip_suffix(&end).ok_or_else(|| format!("does not end with\n{end}"))?;
    let parameters = new.list(|one| format!("{} {}", one.ty.glsl, one.name));
    let (comment, name, result) = (new.comment(), new.name, new.result.glsl);
    let value = new.value(Language::Glsl);
    Ok(format!(
        "{before}\n{comment}{result} {name}({parameters}) {{\n    return {value};\n}}\n{end}"
    ))
}

fn cases(old: Option<&str>, new: &Signature<'_>) -> Result<String, String> {
    let count = new.parameters.len();
    let domains =
        new.parameters.iter().map(|one| format!("{} = {}\n", one.name, one.domain(count)));
    let case = format!(
        "[[case]]\nfunction = \"{}\"\noracle = \"reference\"\ntolerance = {{ ulp = 0 }}\n\
         laws = []\n\n[case.inputs]\n{}",
        new.name,
        domains.collect::<String>()
    );
    Ok(old.map_or(case.clone(), |old| format!("{old}\n{case}")))
}

/// The first number is drawn from left to right, and the last one has a curve for each of three
/// values. Without numbers, the last vector turns.
fn plot(old: Option<&str>, new: &Signature<'_>) -> Result<String, String> {
    let numbers: Vec<&Parameter<'_>> =
        new.parameters.iter().filter(|one| one.is_number()).collect();
    let across = numbers.first().copied();
    let curves = numbers.last().copied().filter(|_| numbers.len() > 1);
    let turns = new
        .parameters
        .iter()
        .rfind(|one| one.ty.wesl.starts_with("vec"))
        .filter(|_| across.is_none());
    let is_one = |one: &Parameter<'_>, other: Option<&Parameter<'_>>| {
        other.is_some_and(|other| other.name == one.name)
    };
    let arguments = new.list(|one| match one.ty.wesl {
        _ if is_one(one, across) => "x".to_owned(),
        _ if is_one(one, curves) => one.name.to_owned(),
        "vec2f" if is_one(one, turns) => "vec2f(sin(radians(x)), cos(radians(x)))".to_owned(),
        "vec3f" if is_one(one, turns) => "vec3f(sin(radians(x)), 0.0, cos(radians(x)))".to_owned(),
        "vec4f" if is_one(one, turns) => {
            "vec4f(sin(radians(x)), 0.0, cos(radians(x)), 1.0)".to_owned()
        }
        "i32" | "u32" if across.is_none() && turns.is_none() => format!("{}(x)", one.ty.wesl),
        _ => one.ty.plotted.to_owned(),
    });
    let value = new.result.number.replace('$', &format!("{}({arguments})", new.name));
    let (label, [low, high], unit) = match (across, turns) {
        (Some(across), _) => (across.name.to_owned(), across.range, ""),
        (None, Some(turns)) => {
            (format!("angle of {}", turns.name), ["0", "90"], ", unit = \"degrees\"")
        }
        (None, None) => ("number".to_owned(), ["0", "4"], ", unit = \"integers\""),
    };
    let mut plot = format!(
        "[{}]\nvalue = \"{value}\"\nx = {{ label = \"{label}\", from = {low}, to = {high}{unit} }}\n",
        new.name
    );
    if let Some(Parameter { name, range: [low, high], .. }) = curves {
        let middle =
            [low, high].iter().filter_map(|text| text.parse::<f64>().ok()).sum::<f64>() / 2.0;
        plot += &format!("curves = {{ name = \"{name}\", values = [{low}, {middle}, {high}] }}\n");
    }
    Ok(old.map_or(plot.clone(), |old| format!("{old}\n{plot}")))
}

fn reference_text(old: Option<&str>, new: &Signature<'_>) -> Result<String, String> {
    let Signature { folder, module, name, .. } = new;
    let fresh = format!(
        "//! Sources:\n\nuse super::Entry;\n\npub const REFERENCES: Entry =\n    \
         Entry {{ module: \"{folder}::{module}\", functions: &[] }};\n"
    );
    let old = old.unwrap_or(&fresh);
    let text =
        with_row(old, &format!("({name:?}, {name})")).ok_or("has no list `functions: &[...]`")?;
    let names = new.list(|one| one.name.to_owned());
    let reads = new.list(|one| format!("a.{}()", one.ty.read));
    let (names, reads) = match new.parameters.len() {
        1 => (names, reads),
        _ => (format!("({names})"), format!("({reads})")),
    };
    Ok(format!(
        "{text}\n/// The formula of the source goes here. Until then, no result equals this one.\n\
         fn {name}(a: &mut super::Arguments<'_>) -> super::Expected {{\n    let {names} = {reads};\n    \
         {}.into()\n}}\n",
        new.result.nothing
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
