//! `cargo xtask new`: the crate's own parsers read the files that it writes, and trials fail until
//! the parts that it leaves empty are written.

#[path = "../xtask/src/new/mod.rs"]
mod made;

use std::collections::BTreeMap;
use std::path::Path;

use lamplight::bundle::Language;
use lamplight::catalogue::plot;
use lamplight::compose::{self, Keep, Options};
use lamplight::diagnostic::Diagnostics;
use lamplight::diagnostic::render::{Form, render};
use lamplight::permute::{Settings, lock, manifest};
use lamplight::picture::needs::Table;
use lamplight::proof::cases;
use lamplight::resolve::{self, Packages};
use lamplight::source::{Embedded, Files, Memory, Package, ReadError, SourceId, SourceSet};
use lamplight::validate::validate;
use libtest_mimic::{Failed, Trial};

use crate::snapshot::root;
use crate::{house, scene, shaderlib};

type Outcome = Result<(), Failed>;
type Run = fn() -> Outcome;

pub fn trials() -> Vec<Trial> {
    let all: [(&str, Run); 9] = [
        ("function", function),
        ("function_types", function_types),
        ("axis_value", axis_value),
        ("diagnostic", diagnostic),
        ("executor", executor),
        ("target", target),
        ("scene", || rust("scene", "src/scene/sets/fresh.rs")),
        ("examples", examples),
        ("mistakes", mistakes),
    ];
    all.into_iter().map(|(name, run)| Trial::test(format!("new::{name}"), run)).collect()
}

/// The files that the command would write, by path. Nothing is written here.
fn make(kind: &str, name: &str, rest: &[&str]) -> Result<BTreeMap<String, String>, Failed> {
    let made = made::make(&root(), kind, name, rest)?;
    match made.next.is_empty() {
        true => Err(format!("`new {kind} {name}` does not say what to do next").into()),
        false => Ok(made.files.into_iter().collect()),
    }
}

fn text<'t>(files: &'t BTreeMap<String, String>, path: &str) -> Result<&'t str, Failed> {
    let missing = || format!("`{path}` is not written, only {:?}", files.keys());
    Ok(files.get(path).map(String::as_str).ok_or_else(missing)?)
}

/// Runs one of the crate's parsers on a text.
fn parsed<T>(
    text: &str,
    parse: impl FnOnce(&SourceSet, SourceId) -> Result<T, Diagnostics>,
) -> Result<T, Failed> {
    let mut sources = SourceSet::default();
    let id = sources.add("made.toml", text.to_owned());
    parse(&sources, id).map_err(|problems| render(&sources, &problems, Form::Human).into())
}

/// A new function, in a module that exists and in new ones, has a case, a plot and a reference. It
/// compiles, and its documentation is demanded.
fn function() -> Outcome {
    for module in ["brdf::diffuse", "brdf::fresh", "optics::fresh"] {
        let parameters = "n: vec3f, nl: f32, k: f32 0..2";
        let files = make("function", &format!("{module}::minnaert"), &[parameters, "f32"])?;
        let stem = format!("shaderlib/{}", module.replace("::", "/"));
        let cases = parsed(text(&files, &format!("{stem}.toml"))?, cases::parse_cases)?;
        if !cases.cases.iter().any(|case| case.function == "minnaert") {
            return Err(format!("{stem}.toml has no case for `minnaert`").into());
        }
        let plots = parsed(text(&files, &format!("{stem}.plot.toml"))?, plot::parse_plots)?;
        if !plots.contains_key("minnaert") {
            return Err(format!("{stem}.plot.toml has no plot for `minnaert`").into());
        }
        compiles(&files, &stem, "minnaert(vec3f(), 0.5, 1.0)", "minnaert(vec3(0.0), 0.5, 1.0)")?;
        for extension in ["wesl", "glsl"] {
            let faults = shaderlib::undocumented(text(&files, &format!("{stem}.{extension}"))?);
            let wanted = ["in a sentence", "lacks `Source: `", "lacks `Error model: `"];
            if !wanted.iter().all(|part| faults.iter().any(|fault| fault.contains(part))) {
                let what = format!("expected the faults {wanted:?}, found {faults:?}");
                return Err(format!("{stem}.{extension}: {what}").into());
            }
        }
        let reference = format!("src/proof/references/{}.rs", module.replace("::", "_"));
        let text = text(&files, &reference)?;
        balanced(text)?;
        let row = "(\"minnaert\", minnaert)";
        let reads = "let (n, nl, k) = (a.vec3(), a.f64(), a.f64());";
        if let Some(part) = [row, reads].iter().find(|part| !text.contains(**part)) {
            return Err(format!("{reference} has no `{part}`:\n{text}").into());
        }
    }
    Ok(())
}

/// A function may take and return each type that the command knows. Its plot calls it correctly.
fn function_types() -> Outcome {
    for ty in made::parameter::TYPES {
        let parameters = format!("p: {}, q: f32 0..4", ty.wesl);
        for parameters in [&parameters, parameters.trim_end_matches(", q: f32 0..4")] {
            let files = make("function", "brdf::fresh::minnaert", &[parameters, ty.wesl])?;
            let stem = "shaderlib/brdf/fresh";
            let plots = parsed(text(&files, &format!("{stem}.plot.toml"))?, plot::parse_plots)?;
            let plot = plots.get("minnaert").ok_or("no plot for `minnaert`")?;
            let value = plot
                .value
                .replace(", q)", ", 0.5)")
                .replace(", x)", ", 0.5)")
                .replace("(x", "(0.5");
            let second = if parameters.contains('q') { ", 0.5" } else { "" };
            let glsl = format!("float(minnaert({}(0){second}) == {0}(0))", ty.glsl);
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
        "import lamplight::{path}::minnaert;\n@fragment fn main() -> @location(0) vec4f {{\n    \
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

/// A new value of an axis is in the manifest, in the lock file and in the table of pictures.
fn axis_value() -> Outcome {
    let files = make("axis-value", "forward::fog=height", &[])?;
    let manifest = parsed(text(&files, "shaderlib/lamplight.toml")?, manifest::parse)?;
    let program = manifest.program("forward").ok_or("no program `forward`")?;
    let axis = program.space.axis("fog").ok_or("no axis `fog`")?;
    if axis.value_names().last().map(String::as_str) != Some("height") {
        let values = axis.value_names();
        return Err(format!("the last value of `fog` should be `height`: {values:?}").into());
    }
    let known =
        parsed(&std::fs::read_to_string(root().join("shaderlib/lamplight.lock"))?, lock::parse)?;
    let extended = manifest
        .programs
        .iter()
        .fold(known, |lock, program| lock.extended(&program.name, &program.space));
    if extended.to_string() != text(&files, "shaderlib/lamplight.lock")? {
        return Err("the lock file differs from what `lamplight keys --lock` would write".into());
    }
    let pictures = text(&files, "shaderlib/pictures.toml")?;
    parsed(pictures, |sources, id| Table::parse(sources, id, &manifest))?;
    let without = pictures.replace("height = {}\n", "");
    match parsed(&without, |sources, id| Table::parse(sources, id, &manifest)) {
        Err(problem) if problem.message().unwrap_or_default().contains("`fog=height`") => Ok(()),
        Err(problem) => {
            let found = problem.message().unwrap_or_default();
            Err(format!("without a row, expected an error for `fog=height`, found {found}").into())
        }
        Ok(_) => Err("a table of pictures without a row for `fog=height` is accepted".into()),
    }
}

/// A new diagnostic has an empty title and page, which trials then demand.
fn diagnostic() -> Outcome {
    let files = make("diagnostic", "unknown-swizzle", &[])?;
    let text = text(&files, "src/diagnostic/codes/unknown-swizzle.md")?;
    match text == "#\n\nPage: \n" {
        true => Ok(()),
        false => Err(format!("expected an empty title and page, found:\n{text}").into()),
    }
}

/// A new version of a language is complete, except for what is unlike the version that it is made
/// after: the target with its version, an executor, and the guide. Nothing of it names the other.
fn target() -> Outcome {
    for (name, rest, like, version) in [
        ("glsl460", &[][..], "glsl450", "Version::Desktop(460)"),
        ("essl310", &[], "essl300", "Version::new_gles(310)"),
        ("glsl400", &["glsl330"], "glsl330", "Version::Desktop(400)"),
        ("msl24", &[], "msl", "extension: \"msl24.metal\""),
        ("wgsl2", &["wgsl"], "wgsl", "extension: \"wgsl2\""),
    ] {
        let files = make("target", name, rest)?;
        let constant = format!("Target::{}", name.to_uppercase());
        let other = format!("Target::{}", like.to_uppercase());
        let wanted = [
            (format!("src/emit/targets/{name}.rs"), version.to_owned()),
            (format!("src/execute/executors/{name}.rs"), format!("name: \"{name}\"")),
        ];
        for (path, part) in wanted {
            let text = text(&files, &path)?;
            if !text.contains(&part)
                || !text.contains(&constant)
                || text.replace(&constant, "").contains(&other)
            {
                return Err(format!("{path} should have `{part}`, not `{other}`:\n{text}").into());
            }
        }
        let page = text(&files, "docs/guide/targets.md")?;
        let unnamed = |line: &&str| line.starts_with('|') && line.contains(&format!("`{like}`"));
        let lost = page.lines().filter(unnamed).find(|line| !line.contains(&format!("`{name}`")));
        if let Some(line) = lost {
            return Err(format!("docs/guide/targets.md has no `{name}` in `{line}`").into());
        }
    }
    Ok(())
}

/// A new executor opens a device of wgpu, or is a copy of another one. Its description is empty, or
/// that of the other, which trials notice.
fn executor() -> Outcome {
    rust("executor", "src/execute/executors/fresh.rs")?;
    let copy = make("executor", "other", &["vulkan"])?;
    let text = text(&copy, "src/execute/executors/other.rs")?;
    let known = std::fs::read_to_string(root().join("src/execute/executors/vulkan.rs"))?;
    if text != known.replace("name: \"vulkan\"", "name: \"other\"") {
        return Err(
            format!("expected a copy of vulkan.rs with another name, found:\n{text}").into()
        );
    }
    let windows = make("executor", "dx12", &[])?;
    for (path, part) in [
        ("src/execute/executors/dx12.rs", "//! Runs on: windows\n"),
        ("src/execute/executors/dx12.rs", "backend: wgpu::Backends::DX12"),
        ("Cargo.toml", "\"naga-ir\", \"dx12\"] }"),
    ] {
        if !self::text(&windows, path)?.contains(part) {
            return Err(format!("{path} of `new executor dx12` has no `{part}`").into());
        }
    }
    match house::same_twice(
        "folder",
        "description",
        [("a", "x".to_owned()), ("b", "x".to_owned())].into_iter(),
    )
    .len()
    {
        1 => Ok(()),
        _ => Err("`same_twice` should notice a description that two entries have".into()),
    }
}

/// A new entry is a Rust file with the entry's name. Its description is empty, which trials notice.
fn rust(kind: &str, path: &str) -> Outcome {
    let files = make(kind, "fresh", &[])?;
    let text = text(&files, path)?;
    balanced(text)?;
    if house::undescribed("fresh", "").is_none() || house::undescribed("fresh", "What.").is_some() {
        return Err("`undescribed` should notice an empty description, and no other".into());
    }
    if kind == "scene" && scene::nothing_is_shown(&[]).is_none() {
        return Err("`nothing_is_shown` should notice an empty scene".into());
    }
    let has_name = text.contains("name: \"fresh\"") || text.contains("Target::FRESH");
    match has_name && text.contains("about: \"\"") {
        true => Ok(()),
        false => Err(format!("{path} should have its name and an empty `about`:\n{text}").into()),
    }
}

/// Fails unless every bracket is closed by its own kind.
fn balanced(text: &str) -> Outcome {
    let code: String = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let mut open = Vec::new();
    for letter in code.chars() {
        match letter {
            '(' => open.push(')'),
            '[' => open.push(']'),
            '{' => open.push('}'),
            ')' | ']' | '}' if open.pop() != Some(letter) => {
                return Err(format!("`{letter}` closes no open bracket:\n{text}").into());
            }
            _ => {}
        }
    }
    match open.is_empty() {
        true => Ok(()),
        false => Err(format!("brackets are open, {open:?} are missing:\n{text}").into()),
    }
}

/// The example of each kind in the usage can be made. Further arguments are in brackets.
fn examples() -> Outcome {
    for kind in made::KINDS {
        if !(kind.rest.is_empty() || kind.rest.starts_with('[') && kind.rest.ends_with(']')) {
            return Err(format!("{}: `{}` should be in brackets", kind.name, kind.rest).into());
        }
        let [name, rest @ ..] = kind.example else { return Err("an example has no name".into()) };
        make(kind.name, name, rest).map_err(|problem| format!("{}: {problem:?}", kind.name))?;
    }
    Ok(())
}

/// Wrong names, and names that exist already, are refused with a reason.
fn mistakes() -> Outcome {
    let wrong = [
        ("functions", "brdf::diffuse::fresh", "there is no kind `functions`"),
        ("function", "lambert", "is not the path of a function"),
        ("function", "brdf::diffuse::Lambert", "must be small letters"),
        ("function", "brdf::diffuse::lambert", "already"),
        ("axis-value", "forward.fog", "is not a value of an axis"),
        ("axis-value", "forward::fog=linear", "has the value `linear` already"),
        ("axis-value", "forward::mist=linear", "has no `[program.forward.axis.mist]`"),
        ("axis-value", "forward::max_lights=many", "has no list of names"),
        ("target", "hlsl", "exists already"),
        ("target", "dxil", "no target is like `dxil`: name one of essl300, glsl330"),
        ("executor", "eval", "exists already"),
        ("scene", "Room", "must be small letters"),
        ("diagnostic", "unknown_axis", "must be small letters"),
        ("diagnostic", "unknown-axis", "exists already"),
    ];
    for (parameters, result, expected) in [
        ("x: f16", "f32", "`f16` is not one of the types f32, i32"),
        ("x: f32, x: f32", "f32", "two parameters are called `x`"),
        ("x: f32 0-1", "f32", "is not a parameter: NAME: TYPE"),
        ("x: f32", "Light", "`Light` is not one of the types"),
    ] {
        let made = made::make(&root(), "function", "brdf::fresh::f", &[parameters, result]);
        if !made.as_ref().is_err_and(|said| said.contains(expected)) {
            return Err(format!("{parameters}: expected `{expected}`, found {made:?}").into());
        }
    }
    for (kind, name, expected) in wrong {
        let rest: &[&str] = if kind == "function" { &["x: f32", "f32"] } else { &[] };
        match made::make(Path::new(&root()), kind, name, rest) {
            Err(said) if said.contains(expected) => {}
            Err(said) => {
                let what = format!("expected `{expected}`, found `{said}`");
                return Err(format!("{kind} {name}: {what}").into());
            }
            Ok(_) => return Err(format!("{kind} {name}: expected `{expected}`, it is made").into()),
        }
    }
    Ok(())
}
