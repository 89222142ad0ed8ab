//! A function of the shader library, in a module that exists or in a new one.

use super::compiled::{first_problem, translated_module};
use super::formula::FormulaBody;
use super::parameter::{NewParameter, Type, read_parameters, type_of};
use super::{NewFiles, Repository, TaskKind, check_name};

pub const KIND: TaskKind = TaskKind {
    name: "function",
    example: &["brdf::diffuse::minnaert", "nl: f32, nv: f32, k: f32 0..2", "f32"],
    rest: "['let a = nl * nv; return pow(a, k - 1.0)']",
    make,
};

fn make(repository: &Repository<'_>, path: &str, rest: &[&str]) -> Result<NewFiles, String> {
    let parts: Vec<&str> = path.split("::").collect();
    parts.iter().try_for_each(|part| check_name(part, '_'))?;
    let [folder, module, name] = parts[..] else {
        return Err(format!("`{path}` is not the path of a function: FOLDER::MODULE::NAME"));
    };
    let (parameters, result, formula) = match rest {
        [parameters, result] => (parameters, result, None),
        [parameters, result, formula] => (parameters, result, Some(FormulaBody::read(formula)?)),
        _ => {
            let what = "the parameters, the type of the result and, if you like, the formula";
            return Err(format!("after the name: {what}, as in the usage"));
        }
    };
    let new = Signature {
        folder,
        module,
        name,
        parameters: read_parameters(parameters)?,
        result: type_of(result)?,
        formula,
    };
    let stem = format!("shaderlib/{folder}/{module}");
    let reference = format!("crates/check/src/references/{folder}_{module}.rs");
    let edits: [(String, FileEdit); 5] = [
        (format!("{stem}.wesl"), wesl),
        (format!("{stem}.toml"), cases),
        (format!("{stem}.plot.toml"), plot),
        (reference.clone(), reference_text),
        (format!("tests/plain/{folder}/{module}.wesl"), plain),
    ];
    check_formula(repository, &new, &edits[0].0)?;
    let mut files = Vec::new();
    for (file, edit) in edits {
        let text = edit(repository.find(&file).as_deref(), &new)
            .map_err(|problem| format!("`{file}`: {problem}"))?;
        files.push((file, text));
    }
    let made = translated_module(repository.root, (&files[0].0, &files[0].1), [folder, module])?;
    files.push((format!("{stem}.glsl"), made));
    let is_new = repository.find(&format!("{stem}.wesl")).is_none();
    Ok(NewFiles { files, next: steps(&stem, &reference, &new, is_new) })
}

/// Compiles the formula in its module.
fn check_formula(
    repository: &Repository<'_>,
    new: &Signature<'_>,
    file: &str,
) -> Result<(), String> {
    let Some(formula) = &new.formula else { return Ok(()) };
    let arguments = new.list(|one| one.ty.plotted.to_owned());
    let text = wesl_with(repository.find(file).as_deref(), new, &formula.in_wesl())?;
    let path = [new.folder, new.module, new.name];
    match first_problem(repository.root, (file, &text), path, &arguments) {
        None => Ok(()),
        Some(problem) => Err(format!(
            "the formula does not compile: {problem}; it may call what `{file}` declares or imports"
        )),
    }
}

fn steps(stem: &str, reference: &str, new: &Signature<'_>, is_new: bool) -> Vec<String> {
    let Signature { folder, module, name, formula, .. } = new;
    let path = format!("{folder}::{module}::{name}");
    let plain = match formula {
        Some(_) => "has the formula as it was given",
        None => "the published formula, without guards",
    };
    let mut steps = vec![
        format!(
            "{stem}.wesl: the formula, and each line of its comment (test shaderlib::); `Edges:` says, by the name of each parameter, what it returns for zero vectors and outside the domain, `Error model:` the bound that `tolerance` states; for guards, `max(x, 1e-4)` with a bound that `Edges:` names, or from `super::super::math::safe` `safe_pow(x, e)` (1 for `e` = 0, else 0 for `x` at or below 0) and `safe_normalize(v, fallback)`; the module's first lines, if they list its functions"
        ),
        format!("{stem}.glsl is translated from that: `cargo xtask docs` makes it again"),
        format!(
            "{reference}: the formula in f64, from the source and not from the shader, with the limits of guards as the shader has them (`f64::from(1e-4f32)`), what it is written from (`Integral`, `Published`, `Specification` or `Series`), and its first lines, which list the sources; then `cargo build`, since references are part of the command"
        ),
        format!(
            "{stem}.toml: `tolerance` and `laws`, in one of the forms above them (test new::forms), and inputs outside the domain, for which `Edges:` says the result; `cargo xtask check {folder}/{module}` measures the tolerance, and with `--spec` it lists what WGSL allows, which the tolerance should not be below; `shaderlib/tolerances.toml` needs no line"
        ),
        format!("tests/plain/{folder}/{module}.wesl: {plain} (test plain::)"),
        format!("{stem}.plot.toml is complete, unless another parameter should be drawn"),
        format!(
            "when the check passes: cargo xtask docs --costs; cargo xtask record plain:: _budget; if that fails for a missing `Reason:`, `cargo xtask new reason {path} 'what the guards are for'` and the same again"
        ),
        "cargo xtask test shaderlib:: new::forms plain:: catalogue:: (the first build takes minutes); cargo xtask new change 'The library' 'WHAT IT IS.'; a picture (`.figure.toml`) is for what a plot does not show"
            .to_owned(),
    ];
    if is_new {
        steps.push(
            "cargo xtask record guide: pages of the guide count the library's files".to_owned(),
        );
    }
    steps
}

struct Signature<'n> {
    folder: &'n str,
    module: &'n str,
    name: &'n str,
    parameters: Vec<NewParameter<'n>>,
    result: Type,
    formula: Option<FormulaBody>,
}

impl Signature<'_> {
    /// The body in WESL: the formula, or else a value of the result's type.
    fn wesl_body(&self) -> String {
        let nothing = || format!("    return {}();\n", self.result.wesl);
        self.formula.as_ref().map_or_else(nothing, FormulaBody::in_wesl)
    }

    /// `of` each parameter, joined by commas.
    fn list(&self, of: impl Fn(&NewParameter<'_>) -> String) -> String {
        self.parameters.iter().map(of).collect::<Vec<_>>().join(", ")
    }

    /// The documentation comment above the function. The author completes each line.
    fn comment(&self) -> String {
        let names = self.list(|one| format!("`{}`", one.name));
        format!(
            "///\n///\n/// Parameters: {names}\n/// Returns:\n/// Source:\n/// Edges:\n/// Error model:\n"
        )
    }
}

/// The new text of a file from the old one, if there is one.
type FileEdit = fn(Option<&str>, &Signature<'_>) -> Result<String, String>;

fn wesl(old: Option<&str>, new: &Signature<'_>) -> Result<String, String> {
    wesl_with(old, new, &new.wesl_body())
}

fn wesl_with(old: Option<&str>, new: &Signature<'_>, body: &str) -> Result<String, String> {
    let old = old.unwrap_or("//!\n");
    refuse_known(old, &format!("fn {}(", new.name))?;
    let parameters = new.list(|one| format!("{}: {}", one.name, one.ty.wesl));
    let (comment, name, result) = (new.comment(), new.name, new.result.wesl);
    Ok(format!("{old}\n{comment}fn {name}({parameters}) -> {result} {{\n{body}}}\n"))
}

/// The formula without guards, which the library's function is compared with.
fn plain(old: Option<&str>, new: &Signature<'_>) -> Result<String, String> {
    let old = old.map_or(String::new(), |old| format!("{old}\n"));
    refuse_known(&old, &format!("fn {}(", new.name))?;
    let parameters = new.list(|one| format!("{}: {}", one.name, one.ty.wesl));
    let (name, result, body) = (new.name, new.result.wesl, new.wesl_body());
    Ok(format!("{old}fn {name}({parameters}) -> {result} {{\n{body}}}\n"))
}

/// The terms of a tolerance, each with a line of its own.
pub const TOLERANCES: &str = "\
# Choose, and delete these lines. Terms add up, as in { abs = 1e-6, ulp = 2 }; y is the expected value.
# { ulp = 2 }: units in the last place of y
# { abs = 1e-6 }: an error that does not grow with y
# { rel = 1e-5 }: a share of y
# { scaled = { by = \"dot_abs(n, l)\", ulp = 1.5 } }: units of a formula's value; for a sum, of its terms' magnitudes
# { pow = { base = \"max(x, 1e-4)\", exponent = \"e - 1\", ulp = 2 } }: what WGSL allows for a power whose base has this error; both are expressions over the parameters
";

/// The laws, each with a line of its own.
pub const LAWS: &str = "\
# Choose, and delete these lines. Laws are a list, as in [{ range = [0, 1] }, { rising = \"x\" }].
# { range = [0, 1] }: no result is outside
# { reaches = [0, 0.99] }: some result is as low, and some as high
# { rising = \"x\" }, { falling = \"x\" }: over a parameter
# { swap = [\"l\", \"v\"] }: exchanging two parameters changes nothing; several pairs are exchanged at once
# { even = [\"n\", \"l\"] }: negating these parameters changes nothing
# { continuous = \"x\", slope = 4 }: a small step changes the value by no more than that slope
# { at = { d = 0 }, gives = 1 }: the value for one value of a parameter, whatever the others are
# { integral = \"l\", about = \"n\", cosine = true, at_most = 1, within = 0.001 }: over a hemisphere; or `gives`
# { albedo = [\"d_ggx\", \"v_smith_ggx\"], within = 0.001 }: the value is the albedo of functions' product
# { inverse = \"g\", within = 1e-6 }: another function turns the value back into the first parameter
# { equal = \"g\", within = 1e-6 }: the value is that of another function, or of a product of functions
# { area = \"g\", along = \"r\", from = 0, to = \"r\", within = 1e-6 }: the value is an integral of another function
# { finite = 1e9 }: no value is NaN or infinite for arguments up to that magnitude; the library's functions are checked so without it: clamp exponents
";

fn cases(old: Option<&str>, new: &Signature<'_>) -> Result<String, String> {
    let count = new.parameters.len();
    let domains =
        new.parameters.iter().map(|one| format!("{} = {}\n", one.name, one.domain(count)));
    let case = format!(
        "[[case]]\nfunction = \"{}\"\noracle = \"reference\"\n{TOLERANCES}tolerance = {{ ulp = 0 }}\n\
         {LAWS}laws = []\n\n[case.inputs]\n{}",
        new.name,
        domains.collect::<String>()
    );
    Ok(old.map_or(case.clone(), |old| format!("{old}\n{case}")))
}

/// The first number is drawn from left to right, and the last one has a curve for each of three
/// values. Without numbers, the last vector turns.
fn plot(old: Option<&str>, new: &Signature<'_>) -> Result<String, String> {
    let numbers: Vec<&NewParameter<'_>> =
        new.parameters.iter().filter(|one| one.is_number()).collect();
    let across = numbers.first().copied();
    let curves = numbers.last().copied().filter(|_| numbers.len() > 1);
    let turns = new
        .parameters
        .iter()
        .rfind(|one| one.ty.wesl.starts_with("vec"))
        .filter(|_| across.is_none());
    let is_one = |one: &NewParameter<'_>, other: Option<&NewParameter<'_>>| {
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
    if let Some(NewParameter { name, range: [low, high], .. }) = curves {
        let middle =
            [low, high].iter().filter_map(|text| text.parse::<f64>().ok()).sum::<f64>() / 2.0;
        plot += &format!("curves = {{ name = \"{name}\", values = [{low}, {middle}, {high}] }}\n");
    }
    Ok(old.map_or(plot.clone(), |old| format!("{old}\n{plot}")))
}

fn reference_text(old: Option<&str>, new: &Signature<'_>) -> Result<String, String> {
    let Signature { folder, module, name, .. } = new;
    let fresh = format!(
        "//! Sources:\n\nuse super::ReferenceEntry;\n\npub const REFERENCES: ReferenceEntry =\n    \
         ReferenceEntry {{ module: \"{folder}::{module}\", functions: &[] }};\n"
    );
    let old = old.unwrap_or(&fresh);
    let text = with_row(old, &format!("({name:?}, super::Source::Published, {name})"))
        .ok_or("has no list `functions: &[...]`")?;
    let names = new.list(|one| one.name.to_owned());
    let reads = new.list(|one| format!("a.{}()", one.ty.read));
    let (names, reads) = match new.parameters.len() {
        1 => (names, reads),
        _ => (format!("({names})"), format!("({reads})")),
    };
    Ok(format!(
        "{text}\n/// The formula of the source goes here. Until then, no result equals this one.\n\
         fn {name}(a: &mut super::CallArguments<'_>) -> super::Expected {{\n    \
         let {names} = {reads};\n    \
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
