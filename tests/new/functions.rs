//! `cargo xtask new function`.

use std::collections::BTreeMap;

use lamplight::bundle::Language;
use lamplight::catalogue::plot;
use lamplight::compose::{self, Keep, Options};
use lamplight::diagnostic::render::{Form, render};
use lamplight::permute::Settings;
use lamplight::proof::cases;
use lamplight::resolve::{self, Packages};
use lamplight::source::{Embedded, Files, Memory, Package, ReadError, SourceSet};
use lamplight::validate::validate;

use super::{Outcome, balanced, made, make, parsed, text};
use crate::shaderlib;

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
        let reference = format!("src/proof/references/{}.rs", module.replace("::", "_"));
        let text = text(&files, &reference)?;
        balanced(text)?;
        let row = "(\"unheard_of\", unheard_of)";
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
            let glsl = format!("float(unheard_of({}(0){second}) == {0}(0))", ty.glsl);
            compiles(&files, stem, &value, &glsl)
                .map_err(|problem| format!("{}: {value}: {problem:?}", ty.wesl))?;
            parsed(text(&files, &format!("{stem}.toml"))?, cases::parse_cases)?;
            balanced(text(&files, "src/proof/references/brdf_fresh.rs")?)?;
        }
    }
    Ok(())
}

/// The library, with some files replaced.
struct Overlay(Memory);

impl Files for Overlay {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        Ok(self.0.read(path)?.or(Embedded.read(path)?))
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        let mut all = [self.0.list(extensions), Embedded.list(extensions)].concat();
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
        let packages = Packages {
            root: Package { name: "user".into(), files: Box::new(own) },
            dependencies: vec![Package { name: "lamplight".into(), files: Box::new(library) }],
        };
        let mut sources = SourceSet::default();
        let options = Options { keep: Keep::EntryPoints, ..Options::default() };
        resolve::load(&mut sources, &packages, root, language)
            .and_then(|graph| compose::compose(&graph, &Settings::default(), &options))
            .and_then(|composed| validate(&composed))
            .map_err(|problems| render(&sources, &problems, Form::Human))?;
    }
    Ok(())
}
