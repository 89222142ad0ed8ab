//! The pages and modules that are generated from the library's files are up to date, and the
//! presets and light probes are valid.

mod figures;
mod plots;

use std::collections::{BTreeMap, BTreeSet};

use lamplight::LIBRARY_FILES;
use lamplight::catalogue::{self, CatalogueItemKind, preset, probe};
use lamplight::check::catalogue::{CatalogueFiles, catalogue_files, made_modules};
use lamplight::diagnostic::Diagnostic;
use lamplight::diagnostic::render::{Form, render};
use lamplight::project;
use lamplight::source::{Files as _, SourceSet};
use libtest_mimic::{Failed, Trial};

use crate::snapshot::root;

const MEND: &str = "run: cargo xtask docs";

pub fn tests() -> Vec<Trial> {
    let mut tests = vec![
        Trial::test("catalogue::pages_are_up_to_date", pages_are_up_to_date),
        Trial::test("catalogue::modules_are_up_to_date", modules_are_up_to_date),
        Trial::test("catalogue::same_bytes_twice", same_bytes_twice),
        Trial::test("catalogue::every_item_has_a_twin", every_item_has_a_twin),
        Trial::test("catalogue::every_member_is_described", every_member_is_described),
        Trial::test("catalogue::every_plain_function_is_plotted", every_plain_function_is_plotted),
        Trial::test("catalogue::presets", presets_ship),
        Trial::test("catalogue::preset_mistakes", preset_mistakes_are_reported),
        Trial::test("catalogue::preset_fields", preset_numbers_name_fields),
        Trial::test("catalogue::probe_forms_agree", probe_forms_agree),
    ];
    tests.extend(figures::tests());
    tests.extend(plots::tests());
    tests
}

/// `docs/catalogue` has exactly the pages that `cargo xtask docs` would write now.
fn pages_are_up_to_date() -> Result<(), Failed> {
    same_on_disk("docs/catalogue", &made(catalogue_files(LIBRARY_FILES))?)?;
    let found = on_disk("docs/catalogue");
    let mut expected: BTreeSet<String> =
        made(catalogue_files(LIBRARY_FILES))?.into_keys().collect();
    expected.extend(figures::pictures()?);
    let stale: Vec<&String> = found.iter().filter(|path| !expected.contains(*path)).collect();
    if stale.is_empty() {
        Ok(())
    } else {
        Err(format!("docs/catalogue has files that nothing makes: {stale:?}; delete them").into())
    }
}

fn modules_are_up_to_date() -> Result<(), Failed> {
    let made = made(made_modules(LIBRARY_FILES))?;
    same_on_disk("shaderlib", &made)?;
    let by_hand = |path: &String| !made.contains_key(path) && path != "filter/sampling.glsl";
    let left: Vec<String> = LIBRARY_FILES.list(&["glsl"]).into_iter().filter(by_hand).collect();
    match left.is_empty() {
        true => Ok(()),
        false => Err(format!("shaderlib has GLSL that nothing makes: {left:?}; delete it").into()),
    }
}

fn same_on_disk(folder: &str, files: &CatalogueFiles) -> Result<(), Failed> {
    let differs = |(path, text): &(&String, &String)| {
        std::fs::read_to_string(root().join(folder).join(path)).ok().as_ref() != Some(*text)
    };
    let changed: Vec<&String> = files.iter().filter(differs).map(|(path, _)| path).collect();
    if changed.is_empty() {
        Ok(())
    } else {
        Err(format!("{folder} is not up to date: {changed:?}\n{MEND}").into())
    }
}

fn on_disk(folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![String::new()];
    while let Some(below) = folders.pop() {
        for entry in std::fs::read_dir(root().join(folder).join(&below))
            .expect("the catalogue is there")
            .flatten()
        {
            let path = format!("{below}{}", entry.file_name().to_string_lossy());
            // The command keeps a list of the files that it wrote. This list is not committed.
            if path.ends_with(".lamplight-outputs") {
                continue;
            }
            if entry.path().is_dir() { folders.push(path + "/") } else { found.push(path) }
        }
    }
    found
}

fn same_bytes_twice() -> Result<(), Failed> {
    match made(catalogue_files(LIBRARY_FILES))? == made(catalogue_files(LIBRARY_FILES))? {
        true => Ok(()),
        false => Err("the pages of the catalogue were made twice and differ".into()),
    }
}

fn made(
    files: Result<CatalogueFiles, (SourceSet, Vec<Diagnostic>)>,
) -> Result<CatalogueFiles, Failed> {
    files.map_err(|(sources, problems)| render(&sources, &problems, Form::Human).into())
}

fn every_item_has_a_twin() -> Result<(), Failed> {
    let items =
        catalogue::library_modules(LIBRARY_FILES).into_iter().flat_map(|module| module.items);
    let alone: Vec<String> =
        items.filter(|item| item.glsl.is_none()).map(|item| item.path()).collect();
    if alone.is_empty() { Ok(()) } else { Err(format!("not in GLSL: {alone:?}").into()) }
}

/// Every parameter of a function and every field of a struct has a description, and no part of the
/// line `Parameters:` is missing from them.
fn every_member_is_described() -> Result<(), Failed> {
    let items =
        catalogue::library_modules(LIBRARY_FILES).into_iter().flat_map(|module| module.items);
    let silent = |item: &catalogue::CatalogueItem| -> Vec<String> {
        let members = item.members.iter().filter(|member| member.doc.is_empty());
        let silent = members.map(|member| format!("{}: `{}`", item.path(), member.name));
        let section = item.section("Parameters").unwrap_or_default();
        let pieces = section.trim_end_matches('.').split("; ");
        let is_lost = |piece: &&str| {
            let words = piece.rsplit('`').next().unwrap_or_default().trim();
            item.members.iter().all(|member| !member.doc.contains(words))
        };
        let has_members = !item.members.is_empty();
        let lost = pieces
            .filter(|piece| has_members && is_lost(piece))
            .map(|piece| format!("{}: {piece}", item.path()));
        silent.chain(lost).collect()
    };
    let silent: Vec<String> = items.flat_map(|item| silent(&item)).collect();
    if silent.is_empty() { Ok(()) } else { Err(format!("not described: {silent:?}").into()) }
}

/// A function of numbers that returns a number can be plotted without choosing anything, so each of
/// them must have a plot.
fn every_plain_function_is_plotted() -> Result<(), Failed> {
    let files = made(catalogue_files(LIBRARY_FILES))?;
    let items = catalogue::library_modules(LIBRARY_FILES)
        .into_iter()
        .flat_map(|module| module.items)
        .filter(|item| item.kind == CatalogueItemKind::Function);
    let plain = items.filter(|item| {
        item.result.as_deref() == Some("f32")
            && item.members.iter().all(|member| member.ty == "f32")
    });
    let missing: Vec<String> = plain
        .map(|item| item.path())
        .filter(|path| !files.contains_key(&format!("{}.svg", path.replace("::", "/"))))
        .collect();
    if missing.is_empty() {
        Ok(())
    } else {
        Err(format!("without a plot in NAME.plot.toml: {missing:?}").into())
    }
}

fn presets() -> Result<Vec<preset::Preset>, Failed> {
    let (mut sources, manifest) = project::library_manifest()
        .map_err(|(sources, problems)| render(&sources, &problems, Form::Human))?;
    catalogue::library_examples(LIBRARY_FILES, &mut sources, &manifest)
        .map(|(presets, _)| presets)
        .map_err(|problems| render(&sources, &problems, Form::Human).into())
}

/// There are presets enough, and each is described. Reading them already checks their programs,
/// keys, scenes and probes.
fn presets_ship() -> Result<(), Failed> {
    let presets = presets()?;
    let count = presets.len();
    if count < 40 {
        return Err(format!("found {count} presets, expected at least 40").into());
    }
    let mut problems = Vec::new();
    for preset in &presets {
        let preset::Preset { name, doc, look, source, .. } = preset;
        let words = [("doc", doc), ("look", look), ("source", source)];
        let empty = words.iter().filter(|(_, text)| text.trim().is_empty());
        problems.extend(empty.map(|(key, _)| format!("`{name}` has no words for `{key}`")));
    }
    match problems.is_empty() {
        true => Ok(()),
        false => Err(format!("shaderlib/presets.toml: {}", problems.join("; ")).into()),
    }
}

/// Each kind of mistake in a preset gives its own code, and a place in the file.
fn preset_mistakes_are_reported() -> Result<(), Failed> {
    let (_, manifest) = project::library_manifest()
        .map_err(|(sources, problems)| render(&sources, &problems, Form::Human))?;
    let head = "[a]\ndoc = \"d\"\nlook = \"l\"\nsource = \"s\"\ndeviations = []\n";
    let cases = [
        ("program = \"forwards\"\nkey = \"default\"\nscene = \"floor\"", "unknown-program"),
        ("program = \"forward\"\nkey = \"shadw=hard\"\nscene = \"floor\"", "unknown-axis"),
        (
            "program = \"forward\"\nkey = \"two_sided,frequency=vertex\"\nscene = \"floor\"",
            "invalid-permutation",
        ),
        (
            "program = \"forward\"\nkey = \"two_sided,max_lights=1\"\nscene = \"floor\"",
            "data-syntax",
        ),
        ("program = \"forward\"\nkey = \"default\"\nscene = \"flor\"", "data-syntax"),
        ("program = \"forward\"\nkey = \"default\"\nscene = \"floor\"\ncolour = 1", "data-syntax"),
        (
            "program = \"forward\"\nkey = \"default\"\nscene = \"floor\"\nprobe = \"x\"",
            "data-syntax",
        ),
        (
            "program = \"forward\"\nkey = \"default\"\nscene = \"floor\"\nsafe_light = { range = 1 }",
            "data-syntax",
        ),
        (
            "program = \"forward\"\nkey = \"default\"\nscene = \"floor\"\nopen = [\"lights.color\"]",
            "data-syntax",
        ),
        (
            "program = \"forward\"\nkey = \"default\"\nscene = \"floor\"\nopen = [\"light.range\"]\nlight = { range = 1 }",
            "data-syntax",
        ),
    ];
    for (text, code) in cases {
        let mut sources = SourceSet::default();
        let id = sources.add("presets.toml", format!("{head}{text}\n"));
        let problems =
            preset::parse_presets(&sources, id, &manifest, &[]).err().unwrap_or_default();
        if !problems.iter().any(|problem| problem.code.name == code && !problem.labels.is_empty()) {
            return Err(format!(
                "expected `{code}` for\n{text}\ngot\n{}",
                render(&sources, &problems, Form::Human)
            )
            .into());
        }
    }
    Ok(())
}

/// A group of a preset's numbers is named after a uniform. If that is a struct of the library, the
/// struct must have every field that the preset sets.
fn preset_numbers_name_fields() -> Result<(), Failed> {
    let structs: BTreeMap<String, Vec<String>> = catalogue::library_modules(LIBRARY_FILES)
        .into_iter()
        .flat_map(|module| module.items)
        .filter(|item| item.kind == CatalogueItemKind::Struct)
        .map(|item| {
            (item.name.to_lowercase(), item.members.into_iter().map(|member| member.name).collect())
        })
        .collect();
    let mut wrong = Vec::new();
    let presets = presets()?;
    let safe = presets.iter().filter_map(preset::Preset::safe_form);
    for preset in presets.iter().cloned().chain(safe) {
        for (group, fields) in &preset.numbers {
            let Some(known) = structs.get(group) else { continue };
            wrong.extend(
                fields
                    .keys()
                    .filter(|field| !known.contains(field) && !is_of_listing(group, field))
                    .map(|field| format!("{}: {group}.{field}", preset.name)),
            );
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(format!("no such fields: {wrong:?}").into()) }
}

/// Whether a number is one that only the program `published` reads of a lamp.
fn is_of_listing(group: &str, field: &str) -> bool {
    (group, field) == ("light", "specular")
}

/// One light probe was published twice, with two digits and with six. The two differ by no more than
/// rounding, so a wrong digit in either would be noticed.
fn probe_forms_agree() -> Result<(), Failed> {
    let probes = probe::library_probes(LIBRARY_FILES, &mut SourceSet::default())
        .map_err(|problems| format!("{problems:?}"))?;
    let find = |name: &str| {
        probes.iter().find(|probe| probe.name == name).ok_or_else(|| format!("no probe `{name}`"))
    };
    let (two, six) = (find("old_town_square")?, find("old_town_square_6_digits")?);
    let pairs = two
        .coefficients
        .iter()
        .flatten()
        .zip(six.coefficients.iter().flatten())
        .zip(probe::ORDER.iter().flat_map(|name| [name; 3]));
    let apart: Vec<String> = pairs
        .filter(|((two, six), _)| (*two - *six).abs() > 0.005 + 1e-9)
        .map(|((two, six), name)| format!("{name}: {two} and {six}"))
        .collect();
    if apart.is_empty() { Ok(()) } else { Err(format!("the two forms differ: {apart:?}").into()) }
}
