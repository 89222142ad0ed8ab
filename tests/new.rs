//! `cargo xtask new`: the crate's own parsers read the files that it writes, and tests fail until
//! the parts that it leaves empty are written.

mod axis_values;
mod contributing;
mod functions;
#[path = "../xtask/make/src/new/mod.rs"]
mod made;

use std::collections::BTreeMap;
use std::path::Path;

use lamplight::diagnostic::Diagnostics;
use lamplight::diagnostic::render::{Form, render};
use lamplight::source::{SourceId, SourceSet};
use libtest_mimic::{Failed, Trial};

use crate::described;
use crate::snapshot::root;

type Outcome = Result<(), Failed>;
type Run = fn() -> Outcome;

pub fn tests() -> Vec<Trial> {
    let all: [(&str, Run); 19] = [
        ("function", functions::in_modules),
        ("function_types", functions::of_types),
        ("function_formula", functions::with_formula),
        ("function_translation", functions::in_glsl),
        ("forms", functions::forms),
        ("reason", functions::reason),
        ("axis_value", axis_values::is_listed),
        ("axis_value_places", axis_values::is_told),
        ("diagnostic", diagnostic),
        ("executor", executor),
        ("executor_own", own_executor),
        ("target", target),
        ("target_version", target_version),
        ("scene", scene),
        ("change", change),
        ("examples", examples),
        ("mistakes", mistakes),
        ("interface", interface),
        ("contributing", contributing::is_true),
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

/// A new diagnostic has an empty title and page, which tests then demand.
fn diagnostic() -> Outcome {
    let files = make("diagnostic", "unknown-swizzle", &[])?;
    let text = text(&files, "crates/diagnostic/src/codes/unknown-swizzle.md")?;
    match text == "#\n\nPage: \n" {
        true => Ok(()),
        false => Err(format!("expected an empty title and page, found:\n{text}").into()),
    }
}

/// A new version of a language is complete, except for what is unlike the version that it is made
/// after: the target with its version, an executor, and the guide. Nothing of it names the other.
fn target() -> Outcome {
    for (name, rest, like, version) in [
        ("glsl499", &[][..], "glsl450", "Version::Desktop(499)"),
        ("essl399", &[], "essl300", "rules: &[\"own\"]"),
        ("glsl398", &["glsl330"], "glsl330", "Version::Desktop(398)"),
        ("msl99", &[], "msl", "extension: \"msl99.metal\""),
        ("wgsl99", &["wgsl"], "wgsl", "extension: \"wgsl99\""),
    ] {
        let files = make("target", name, rest)?;
        let constant = format!("Target::{}", name.to_uppercase());
        let other = format!("Target::{}", like.to_uppercase());
        let wanted = [
            (format!("crates/emit/src/targets/{name}.rs"), version.to_owned()),
            (format!("crates/execute/src/executors/{name}.rs"), format!("name: \"{name}\"")),
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
        // What a version lacks, another one may have.
        let (before, after) = page.split_once("\n## What GLSL does not have\n").ok_or("a page")?;
        let (lacking, after) = after.split_once("\n## ").ok_or("no section follows")?;
        let of_like = |line: &&str| line.starts_with('|') && line.contains(&format!("`{like}`"));
        let has_name = |line: &str| line.contains(&format!("`{name}`"));
        let lines = [before, after].into_iter().flat_map(str::lines).filter(of_like);
        let wrong = lines
            .filter(|line| !has_name(line))
            .chain(lacking.lines().filter(|line| has_name(line)));
        if let Some(line) = wrong.into_iter().next() {
            return Err(format!("docs/guide/targets.md, `{name}` beside `{like}`: `{line}`").into());
        }
    }
    Ok(())
}

/// A new version of GLSL numbers its bindings if it can, and gets what it lacks from the table that
/// refuses it. Rules of a later version are none of its own.
fn target_version() -> Outcome {
    for (name, numbering, lacks, lacks_not) in [
        ("essl310", "Explicit", "`textureQueryLevels`", "`bitCount`"),
        ("essl299", "Named", "`bitCount`", "none"),
        ("glsl430", "Explicit", "`textureSamples`", "`textureQueryLevels`"),
        ("glsl410", "Named", "`unpackHalf2x16`", "`bitCount`"),
    ] {
        let made = made::make(&root(), "target", name, &[])?;
        let steps = made.next.join("\n");
        let files: BTreeMap<String, String> = made.files.into_iter().collect();
        let path = format!("crates/emit/src/targets/{name}.rs");
        let text = text(&files, &path)?;
        if !text.contains(&format!("Numbering::{numbering})")) {
            return Err(format!("{path} should have `Numbering::{numbering}`:\n{text}").into());
        }
        // The head comment and the guide's first table are about the same bindings.
        let (says, column) = match numbering {
            "Explicit" => ("`layout(binding", "`glsl450`"),
            _ => ("no explicit bindings", "`glsl330`, `essl300`"),
        };
        let guide = self::text(&files, "docs/guide/targets.md")?;
        let header = guide.lines().find(|line| line.starts_with("| |")).unwrap_or_default();
        let is_beside = header.split('|').any(|cell| {
            cell.contains(&format!("`{name}`")) && column.split(", ").all(|one| cell.contains(one))
        });
        if !text.contains(says) || text.contains("WebGL") || !is_beside {
            return Err(format!("{name}: {says}, beside {column}:\n{header}\n{text}").into());
        }
        if !steps.contains(lacks) || steps.contains(lacks_not) {
            return Err(format!("{name} lacks {lacks}, and not {lacks_not}:\n{steps}").into());
        }
    }
    Ok(())
}

/// A line is added at the end of its section of the changelog, and nothing else changes.
fn change() -> Outcome {
    let folder = tempfile::tempdir()?;
    let old = "# Changelog\n\n## Unreleased\n\n### One\n\n- First.\n\n### Two\n\n- Second.\n\n\
        ### Empty\n\n### Last\n\n## 0.1.0\n\n### Two\n\n- Old.\n";
    std::fs::write(folder.path().join("CHANGELOG.md"), old)?;
    for (section, after, line) in [
        ("One", "- First.\n", "- New.\n"),
        ("Two", "- Second.\n", "- New.\n"),
        ("Empty", "### Empty\n", "\n- New.\n"),
        ("Last", "### Last\n", "\n- New.\n"),
    ] {
        let made = made::make(folder.path(), "change", section, &["New."])?;
        let new = old.replace(after, &format!("{after}{line}"));
        if made.files != [("CHANGELOG.md".to_owned(), new)] {
            return Err(format!("{section}: found {:?}", made.files).into());
        }
    }
    match made::make(folder.path(), "change", "Three", &["New."]) {
        Err(message) if message.contains("One, Two, Empty, Last") => Ok(()),
        found => Err(format!("expected the known sections, found {found:?}").into()),
    }
}

/// The file of an executor without wgpu has a session with all of its functions. The file of an
/// executor for a device of wgpu names the choices of devices and of shaders.
fn own_executor() -> Outcome {
    let path = "crates/execute/src/executors/fresh.rs";
    for (rest, parts) in [
        (&["own"][..], &["impl Session for ", "run_batches(", "draw_pixels(", "emit_kernel("][..]),
        (&[], &["`AdapterName::Without`", "`Shaders::Emitted(Target::SPIRV)`"]),
    ] {
        let files = make("executor", "fresh", rest)?;
        let text = text(&files, path)?;
        balanced(text)?;
        if let Some(part) = parts.iter().find(|part| !text.contains(**part)) {
            return Err(format!("{path} with {rest:?} has no `{part}`:\n{text}").into());
        }
        if text.contains("NAME") || !text.contains("about: \"\"") {
            return Err(format!("{path} should have its name and an empty `about`:\n{text}").into());
        }
    }
    Ok(())
}

/// A new executor opens a device of wgpu, or is a copy of another one with comments that explain its
/// fields. Its description is empty, which tests notice.
fn executor() -> Outcome {
    rust("executor", "crates/execute/src/executors/fresh.rs")?;
    let copy = make("executor", "other", &["vulkan"])?;
    let text = text(&copy, "crates/execute/src/executors/other.rs")?;
    let known = std::fs::read_to_string(root().join("crates/execute/src/executors/vulkan.rs"))?;
    let code = |text: &str| -> String {
        let is_code = |line: &&str| !line.trim_start().starts_with("//");
        text.lines().filter(is_code).map(|line| format!("{line}\n")).collect()
    };
    let about = known.lines().find(|line| line.contains("about: ")).ok_or("no description")?;
    let renamed = known.replace("name: \"vulkan\"", "name: \"other\"");
    let expected = code(&renamed.replace(about, "    about: \"\","));
    if code(text) != expected {
        return Err(format!("expected the code\n{expected}\nfound:\n{text}").into());
    }
    let lines =
        ["//! other, as `vulkan` is. TODO", "//! Runs on: every system", "    // One line for"];
    if let Some(lost) = lines.iter().find(|lines| !text.contains(**lines)) {
        return Err(format!("a copy has no `{lost}`:\n{text}").into());
    }
    match described::same_twice(
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

/// A new scene has objects, a lamp and a preset. The preset's words are missing, which is an error.
fn scene() -> Outcome {
    rust("scene", "crates/scenes/src/sets/fresh.rs")?;
    let files = make("scene", "fresh", &[])?;
    let scene = text(&files, "crates/scenes/src/sets/fresh.rs")?;
    let presets = text(&files, "shaderlib/presets.toml")?;
    let parts = ["Shape::cuboid(", "Lamp {", "Eye {"];
    let lost = parts.iter().find(|part| !scene.contains(**part));
    match (lost, presets.ends_with("deviations = []\n"), presets.contains("scene = \"fresh\"")) {
        (None, true, true) => Ok(()),
        _ => Err(format!("a scene lacks {lost:?}, or a preset at the end of:\n{presets}").into()),
    }
}

/// If only some systems have the graphics API of a new executor, the executor is built for these
/// systems only, and wgpu's feature for the API is turned on.
fn interface() -> Outcome {
    let folder = tempfile::tempdir()?;
    let wgpu = "[dependencies]\nwgpu = { version = \"30\", features = [\"std\", \"gles\"] }\n";
    std::fs::write(folder.path().join("Cargo.toml"), wgpu)?;
    std::fs::create_dir_all(folder.path().join("crates/execute/src/executors"))?;
    let made = made::make(folder.path(), "executor", "dx12", &[])?;
    let files: BTreeMap<String, String> = made.files.into_iter().collect();
    for (path, part) in [
        ("crates/execute/src/executors/dx12.rs", "//! Runs on: windows\n"),
        ("crates/execute/src/executors/dx12.rs", "backend: wgpu::Backends::DX12"),
        ("Cargo.toml", "\"gles\", \"dx12\"] }"),
    ] {
        if !text(&files, path)?.contains(part) {
            return Err(format!("{path} of `new executor dx12` has no `{part}`").into());
        }
    }
    Ok(())
}

/// A new entry is a Rust file with the entry's name. Its description is empty, which tests notice.
fn rust(kind: &str, path: &str) -> Outcome {
    let files = make(kind, "fresh", &[])?;
    let text = text(&files, path)?;
    balanced(text)?;
    if described::undescribed("fresh", "").is_none()
        || described::undescribed("fresh", "What.").is_some()
    {
        return Err("`undescribed` should notice an empty description, and no other".into());
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
        match made::make(&root(), kind.name, name, rest) {
            // Somebody may have followed an example.
            Err(problem) if !problem.contains("already") => {
                return Err(format!("{}: {problem}", kind.name).into());
            }
            _ => {}
        }
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
        ("target", "dxil", "no target is like `dxil`: name one of essl300"),
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
        if !made.as_ref().is_err_and(|message| message.contains(expected)) {
            return Err(format!("{parameters}: expected `{expected}`, found {made:?}").into());
        }
    }
    for (kind, name, expected) in wrong {
        let rest: &[&str] = if kind == "function" { &["x: f32", "f32"] } else { &[] };
        match made::make(Path::new(&root()), kind, name, rest) {
            Err(message) if message.contains(expected) => {}
            Err(message) => {
                let what = format!("expected `{expected}`, found `{message}`");
                return Err(format!("{kind} {name}: {what}").into());
            }
            Ok(_) => return Err(format!("{kind} {name}: expected `{expected}`, it is made").into()),
        }
    }
    Ok(())
}
