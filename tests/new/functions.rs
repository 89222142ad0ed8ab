//! `cargo xtask new function`.

use std::collections::BTreeMap;

use lamplight::LIBRARY_FILES;
use lamplight::bundle::Language;
use lamplight::catalogue::plot;
use lamplight::check::cases;
use lamplight::compose::{self, Keep, Options};
use lamplight::diagnostic::render::{Form, render};
use lamplight::permute::Settings;
use lamplight::resolve::{self, Packages};
use lamplight::source::{Files, Memory, Package, ReadError, SourceSet};
use lamplight::validate::validate;
use libtest_mimic::Failed;

use super::{Outcome, balanced, made, make, parsed, text};
use crate::shaderlib;
use crate::snapshot::root;

/// A new function, in a module that exists and in new ones, has a case, a plot and a reference. It
/// compiles, and its documentation is demanded.
pub fn in_modules() -> Outcome {
    for module in ["brdf::diffuse", "brdf::fresh", "optics::fresh"] {
        let parameters = "n: vec3f, nl: f32, k: f32 0..2";
        let files = make("function", &format!("{module}::unheard_of"), &[parameters, "f32"])?;
        let stem = format!("shaderlib/{}", module.replace("::", "/"));
        let cases = parsed(text(&files, &format!("{stem}.toml"))?, cases::parse_cases)?;
        if !cases.cases.iter().any(|case| case.function == "unheard_of") {
            return Err(format!("{stem}.toml has no case for `unheard_of`").into());
        }
        let plots = parsed(text(&files, &format!("{stem}.plot.toml"))?, plot::parse_plots)?;
        if !plots.contains_key("unheard_of") {
            return Err(format!("{stem}.plot.toml has no plot for `unheard_of`").into());
        }
        compiles(
            &files,
            &stem,
            "unheard_of(vec3f(), 0.5, 1.0)",
            "unheard_of(vec3(0.0), 0.5, 1.0)",
        )?;
        for extension in ["wesl", "glsl"] {
            let faults = shaderlib::undocumented(text(&files, &format!("{stem}.{extension}"))?);
            let wanted = ["in a sentence", "lacks `Source: `", "lacks `Error model: `"];
            if !wanted.iter().all(|part| faults.iter().any(|fault| fault.contains(part))) {
                let what = format!("expected the faults {wanted:?}, found {faults:?}");
                return Err(format!("{stem}.{extension}: {what}").into());
            }
        }
        let plain = text(&files, &format!("tests/plain/{}.wesl", module.replace("::", "/")))?;
        if !plain.contains("fn unheard_of(n: vec3f, nl: f32, k: f32) -> f32 {\n    return f32();") {
            return Err(format!("no plain text of `unheard_of`:\n{plain}").into());
        }
        let reference = format!("crates/check/src/references/{}.rs", module.replace("::", "_"));
        let text = text(&files, &reference)?;
        balanced(text)?;
        let row = "(\"unheard_of\", super::Source::Published, unheard_of)";
        let reads = "let (n, nl, k) = (a.vec3(), a.f64(), a.f64());";
        if let Some(part) = [row, reads].iter().find(|part| !text.contains(**part)) {
            return Err(format!("{reference} has no `{part}`:\n{text}").into());
        }
    }
    Ok(())
}

/// A formula stands in both languages, and in the text without guards.
pub fn with_formula() -> Outcome {
    let formula = "vec3f(nl, f32(2u), nv) * pow(nl, k)";
    let rest = ["nl: f32, nv: f32, k: f32 0..2", "vec3f", formula];
    let files = make("function", "brdf::fresh::unheard_of", &rest)?;
    let stem = "shaderlib/brdf/fresh";
    compiles(&files, stem, "unheard_of(0.5, 0.5, 1.0).x", "unheard_of(0.5, 0.5, 1.0).x")?;
    for (path, wanted) in [
        ("shaderlib/brdf/fresh.wesl", formula),
        ("tests/plain/brdf/fresh.wesl", formula),
        ("shaderlib/brdf/fresh.glsl", "vec3(nl, float(2u), nv) * pow(nl, k)"),
    ] {
        let text = text(&files, path)?;
        if !text.contains(&format!("    return {wanted};\n")) {
            return Err(format!("{path} should return {wanted}:\n{text}").into());
        }
    }
    Ok(())
}

/// Statements are in both languages. GLSL has the type of each declaration, and its own spelling of
/// calls. What does not compile is refused, and so is what has no form in GLSL.
pub fn in_glsl() -> Outcome {
    let make_body = |body: &str| {
        let rest = ["nl: f32, nv: f32, k: f32 0..2", "f32", body];
        made::make(&root(), "function", "brdf::diffuse::unheard_of", &rest)
    };
    let body = "let a = vec3f(nl, nv, k); let n = 2; let m = 3u; var s = dot(a, a); \
                s += saturate(select(f32(n), f32(m), nl > nv)); return inverseSqrt(s)";
    let files: BTreeMap<String, String> = make_body(body)?.files.into_iter().collect();
    let glsl = text(&files, "shaderlib/brdf/diffuse.glsl")?;
    let wanted = "\
    vec3 a = vec3(nl, nv, k);
    int n = 2;
    uint m = 3u;
    float s = dot(a, a);
    s += clamp(nl > nv ? float(m) : float(n), 0.0, 1.0);
    return inversesqrt(s);
}
";
    if !glsl.contains(wanted) {
        return Err(format!("expected in GLSL:\n{wanted}\nfound:\n{glsl}").into());
    }
    for path in ["shaderlib/brdf/diffuse.wesl", "tests/plain/brdf/diffuse.wesl"] {
        let text = text(&files, path)?;
        if !text.contains("    let n = 2;\n    let m = 3u;\n    var s = dot(a, a);\n") {
            return Err(format!("{path} should have the formula as given:\n{text}").into());
        }
    }
    for (body, expected) in [
        ("unknown_function(nl)", "the formula does not compile: "),
        ("let a = nl", "the last statement of a formula is `return VALUE`"),
        ("if (nl > 0.0) { k = 1.0 }; return k", "is none of the statements of a formula"),
        ("return nl; return nv", "only the last statement"),
        (" ; ", "the formula is empty"),
        ("sqrt(nl) % nv", "an operand of `%` that is computed"),
    ] {
        let made = make_body(body);
        if !made.as_ref().is_err_and(|message| message.contains(expected)) {
            return Err(format!("{body}: expected `{expected}`, found {made:?}").into());
        }
    }
    Ok(())
}

/// A new case lists every term of a tolerance and every law that the guide explains, in forms that
/// the crate reads. No case of the library keeps this list.
pub fn forms() -> Outcome {
    let guide = std::fs::read_to_string(root().join("docs/guide/cases.md"))?;
    let section = |name: &str| -> Result<Vec<String>, Failed> {
        let (_, rest) = guide.split_once(&format!("\n## {name}\n")).ok_or("no such section")?;
        let rest = rest.split_once("\n## ").map_or(rest, |(section, _)| section);
        let row = |line: &str| Some(line.strip_prefix("| `")?.trim_start_matches("{ ").to_owned());
        let word = |row: String| row.split(' ').next().map(str::to_owned);
        Ok(rest.lines().filter_map(row).filter_map(word).collect())
    };
    use made::function::{LAWS, TOLERANCES};
    for (name, listed) in [("Tolerances", TOLERANCES), ("Laws", LAWS)] {
        let words = section(name)?;
        let lost = words.iter().find(|word| !listed.contains(&format!("{{ {word} = ")));
        if let Some(word) = lost {
            return Err(format!("a new case lacks the form of `{word}`:\n{listed}").into());
        }
        if words.is_empty() {
            return Err(format!("the guide lists no {name}").into());
        }
        for line in listed.lines().skip(1) {
            let form = line.trim_start_matches("# ");
            let form = form.rsplit_once("}: ").map_or(form, |(form, _)| form).to_owned() + "}";
            let value = if name == "Laws" {
                format!("laws = [{form}]")
            } else {
                format!("tolerance = {form}")
            };
            let inputs = "[case.inputs]\nn = { unit = 4 }\nl = { unit = 4 }\nv = { unit = 4 }\nx = 1\nd = 1\nnl = 1\nnv = 1\nk = 1\n";
            let case = format!("[[case]]\nfunction = \"f\"\noracle = \"eval\"\n{value}\n{inputs}");
            parsed(&case, cases::parse_cases)?;
        }
    }
    let first = LAWS.lines().next().unwrap_or_default();
    let mark = first.split('.').next().unwrap_or_default();
    let library = LIBRARY_FILES.list(&["toml"]);
    let kept = library.iter().find(|path| {
        LIBRARY_FILES.read(path).ok().flatten().is_some_and(|text| text.contains(mark))
    });
    match kept {
        Some(path) => Err(format!("shaderlib/{path}: choose forms, and delete their list").into()),
        None if library.is_empty() => Err("the library has no cases".into()),
        None => Ok(()),
    }
}

/// The reason for a guard stands above the function's plain text, once. A module that is new has the
/// step that counts the library's files anew.
pub fn reason() -> Outcome {
    let why = "A negative width would divide by zero.";
    let path = "tests/plain/brdf/diffuse.wesl";
    let files = make("reason", "brdf::diffuse::wrap", &[why])?;
    let made = text(&files, path)?;
    let old = std::fs::read_to_string(root().join(path))?;
    let line = format!("/// Reason: {why}\n");
    if !made.contains(&format!("{line}fn wrap(")) || made.replace(&line, "") != old {
        return Err(format!("{path} should only gain a reason for `wrap`:\n{made}").into());
    }
    for (name, rest, expected) in [
        ("brdf::diffuse::unheard_of", &[why][..], "has no `fn unheard_of(`"),
        ("lighting::cluster::cluster_slice", &[why], "already"),
        ("brdf::diffuse::wrap", &[], "name a function and say why"),
    ] {
        let made = made::make(&root(), "reason", name, rest);
        if !made.as_ref().is_err_and(|message| message.contains(expected)) {
            return Err(format!("{name}: expected `{expected}`, found {made:?}").into());
        }
    }
    let counts = |module: &str| -> Result<bool, String> {
        let path = format!("{module}::unheard_of");
        let made = made::make(&root(), "function", &path, &["x: f32", "f32"])?;
        Ok(made.next.iter().any(|step| step.starts_with("cargo xtask record guide")))
    };
    match (counts("brdf::diffuse")?, counts("brdf::fresh")?) {
        (false, true) => Ok(()),
        found => Err(format!("only a new module changes the guide's counts: {found:?}").into()),
    }
}

/// A function may take and return each type that the command knows. Its plot calls it correctly.
pub fn of_types() -> Outcome {
    for ty in made::parameter::TYPES {
        let parameters = format!("p: {}, q: f32 0..4", ty.wesl);
        for parameters in [&parameters, parameters.trim_end_matches(", q: f32 0..4")] {
            let files = make("function", "brdf::fresh::unheard_of", &[parameters, ty.wesl])?;
            let stem = "shaderlib/brdf/fresh";
            let plots = parsed(text(&files, &format!("{stem}.plot.toml"))?, plot::parse_plots)?;
            let plot = plots.get("unheard_of").ok_or("no plot for `unheard_of`")?;
            let value = plot
                .value
                .replace(", q)", ", 0.5)")
                .replace(", x)", ", 0.5)")
                .replace("(x", "(0.5");
            let second = if parameters.contains('q') { ", 0.5" } else { "" };
            let glsl = in_glsl_words(ty.wesl);
            let glsl = format!("float(unheard_of({glsl}(0){second}) == {glsl}(0))");
            compiles(&files, stem, &value, &glsl)
                .map_err(|problem| format!("{}: {value}: {problem:?}", ty.wesl))?;
            parsed(text(&files, &format!("{stem}.toml"))?, cases::parse_cases)?;
            balanced(text(&files, "crates/check/src/references/brdf_fresh.rs")?)?;
        }
    }
    Ok(())
}

/// The name of a type in GLSL.
fn in_glsl_words(wesl: &str) -> &str {
    match wesl {
        "f32" => "float",
        "i32" => "int",
        "u32" => "uint",
        "mat3x3f" => "mat3",
        "mat4x4f" => "mat4",
        other => other.trim_end_matches('f'),
    }
}

/// The library, with some files replaced.
struct Overlay(Memory);

impl Files for Overlay {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        Ok(self.0.read(path)?.or(LIBRARY_FILES.read(path)?))
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        let mut all = [self.0.list(extensions), LIBRARY_FILES.list(extensions)].concat();
        all.sort();
        all.dedup();
        all
    }
}

/// Fails unless the module compiles in both languages, called so.
fn compiles(files: &BTreeMap<String, String>, stem: &str, wesl: &str, glsl: &str) -> Outcome {
    let below = |(path, text): (&String, &String)| {
        path.strip_prefix("shaderlib/").map(|path| (path.to_owned(), text.clone()))
    };
    let module = stem.trim_start_matches("shaderlib/");
    let path = module.replace('/', "::");
    let wesl = format!(
        "import lamplight::{path}::unheard_of;\n@fragment fn main() -> @location(0) vec4f {{\n    \
         return vec4f({wesl});\n}}\n"
    );
    let glsl = format!(
        "#version 450\n#include <lamplight/{module}.glsl>\nlayout(location = 0) out vec4 colour;\n\
         void main() {{\n    colour = vec4({glsl});\n}}\n"
    );
    let roots = [("main.wesl", wesl, Language::Wesl), ("main.frag.glsl", glsl, Language::Glsl)];
    for (root, text, language) in roots {
        let own = Memory([(root.to_owned(), text)].into());
        let library = Overlay(Memory(files.iter().filter_map(below).collect()));
        let packages = Packages::new(
            Package { name: "user".into(), files: Box::new(own) },
            vec![Package { name: "lamplight".into(), files: Box::new(library) }],
        );
        let mut sources = SourceSet::default();
        let options = Options { keep: Keep::EntryPoints, ..Options::default() };
        resolve::load(&mut sources, &packages, root, language)
            .and_then(|graph| compose::compose(&graph, &Settings::default(), &options))
            .and_then(|composed| validate(&composed))
            .map_err(|problems| render(&sources, &problems, Form::Human))?;
    }
    Ok(())
}
