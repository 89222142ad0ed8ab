//! What the guards of the library cost. `tests/plain/` has each function as its published formula,
//! transcribed straightforwardly: without guards for zero vectors, NaN and values out of range.
//!
//! Lines above a function there are data: `Reason:` says why the library's function may cost more,
//! and `At:` gives arguments inside the domain, where the usual ones are not. `unguarded.toml` lists
//! the functions without a plain text. `docs/costs.md` has all figures.

mod rest;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use lamplight::LIBRARY_FILES;
use lamplight::catalogue::{self, CatalogueItem, CatalogueItemKind, CatalogueModule};
use lamplight::source::Disk;
use libtest_mimic::{Failed, Trial};
use serde_json::Value;

use crate::snapshot;

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("plain::every_function_has_one", every_function),
        Trial::test("plain::texts_are_valid", texts_are_valid),
        Trial::test("plain::agree_with_the_library", agree),
        Trial::test("plain::what_guards_cost", what_guards_cost),
        Trial::test("plain::where_the_rest_goes", rest::where_the_rest_goes)
            .with_ignored_flag(true),
    ]
}

/// The GPU whose figures are compared.
const GPU: &str = "navi21";
/// Guards may cost this share of the cycles ...
const SHARE: f64 = 0.1;
/// ... or so many cycles, whichever is more.
const CYCLES: i64 = 2;
/// How far two values of one formula may be from each other: the plain text may lose digits by
/// cancellation.
const TOLERANCE: f64 = 2e-4;

fn folder() -> PathBuf {
    snapshot::root().join("tests/plain")
}

/// Functions by their path below the package.
fn functions(modules: Vec<CatalogueModule>) -> BTreeMap<String, CatalogueItem> {
    let items = modules.into_iter().flat_map(|module| module.items);
    let functions = items.filter(|item| item.kind == CatalogueItemKind::Function);
    functions.map(|item| (format!("{}::{}", item.module, item.name), item)).collect()
}

fn plain_functions() -> Result<BTreeMap<String, CatalogueItem>, Failed> {
    Ok(functions(catalogue::own_modules(&Disk::new(folder())?)))
}

fn library_functions() -> BTreeMap<String, CatalogueItem> {
    functions(catalogue::library_modules(LIBRARY_FILES))
}

/// What a line of a function's comment says after this word.
fn comment_value<'i>(item: &'i CatalogueItem, word: &str) -> Option<&'i str> {
    item.doc.iter().find_map(|line| line.trim().strip_prefix(word)).map(str::trim)
}

/// Every function of the library has a plain text with the same signature, or a reason why not.
fn every_function() -> Outcome {
    let listed = std::fs::read_to_string(folder().join("unguarded.toml"))?;
    let listed: BTreeMap<String, Vec<String>> = toml::from_str(&listed)?;
    let listed: Vec<&String> = listed.values().flatten().collect();
    let unguarded: BTreeSet<&String> = listed.iter().copied().collect();
    let (library, plain) = (library_functions(), plain_functions()?);
    let mut wrong = Vec::new();
    if unguarded.len() != listed.len() {
        wrong.push("unguarded.toml lists a function twice".to_owned());
    }
    for (path, item) in &library {
        match (plain.get(path), unguarded.contains(path)) {
            (Some(plain), false) if plain.wesl == item.wesl => {}
            (Some(plain), false) => wrong.push(format!("{}\n  and not {}", item.wesl, plain.wesl)),
            (None, true) => {}
            (None, false) => wrong.push(format!("`{path}` has no plain text")),
            (Some(_), true) => wrong.push(format!("`{path}` has a plain text, and is unguarded")),
        }
    }
    let named = plain.keys().chain(unguarded);
    let unknown = named.filter(|path| !library.contains_key(*path));
    wrong.extend(unknown.map(|path| format!("the library has no `{path}`")));
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n").into()) }
}

fn lamplight(arguments: &[&str], input: &str) -> Result<String, Failed> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    command.current_dir(folder()).args(arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn()?;
    let mut pipe = child.stdin.take().ok_or("there is no standard input")?;
    let input = input.to_owned();
    // From a thread of its own: both pipes may be full.
    let writer = std::thread::spawn(move || pipe.write_all(input.as_bytes()));
    let output = child.wait_with_output()?;
    writer.join().map_err(|_| "the writer panicked")??;
    match output.status.success() {
        true => Ok(String::from_utf8(output.stdout)?),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned().into()),
    }
}

/// naga accepts every plain text, and the lints have nothing to say.
fn texts_are_valid() -> Outcome {
    let found = lamplight(&["lint", "."], "")?;
    match found.contains("0 errors, 0 warnings") {
        true => Ok(()),
        false => Err(found.into()),
    }
}

/// Arguments of each type. A function with several parameters of a type takes them in turn.
const ARGUMENTS: [(&str, &[&str]); 12] = [
    ("f32", &["0.3", "0.6", "0.45", "0.7", "0.5", "0.35", "0.8", "0.4"]),
    ("i32", &["3", "8"]),
    ("u32", &["3u", "8u"]),
    ("vec2f", &["vec2f(0.3, 0.6)"]),
    ("vec3f", &["vec3f(0.2, 0.5, 0.7)", "vec3f(0.6, 0.3, 0.4)"]),
    ("vec4f", &["vec4f(0.3, 0.5, 0.7, 0.9)"]),
    ("vec3u", &["vec3u(16u, 8u, 24u)"]),
    ("mat3x3f", &["mat3x3f(2.0, 0.0, 0.5, 0.0, 1.0, 0.0, 0.3, 0.0, 1.5)"]),
    (
        "mat4x4f",
        &["mat4x4f(2., 0., 0.5, 0., 0., 1., 0., 0., 0.3, 0., 1.5, 0.2, 0.1, 0.2, 0.3, 1.)"],
    ),
    (
        "array<vec3f, 4>",
        &["array<vec3f, 4>(vec3f(0.9), vec3f(0.1, 0.2, 0.1), vec3f(0.2, 0.1, 0.3), vec3f(0.1))"],
    ),
    (
        "Light",
        &[
            "lamplight::lighting::light::Light(vec3f(1.), 3u, vec3f(0.1), 10., vec3f(1., 3., 2.), 4., \
           vec3f(0., -1., 0.), 0.3, vec3f(1., 0.1, 0.01), 0.9, 0.8, 1., 1., 0)",
        ],
    ),
    ("ShadowUv", &["lamplight::shadow::coord::ShadowUv(vec2f(0.3, 0.6), 0.5, true)"]),
];

/// Unit vectors for the parameters that are called so: the normal, and the directions to the light
/// and to the viewer.
const UNIT: [(&str, &str); 3] = [
    ("n", "vec3f(0.0, 0.6, 0.8)"),
    ("l", "vec3f(0.48, 0.6, 0.64)"),
    ("v", "vec3f(-0.36, 0.48, 0.8)"),
];

/// A call's arguments inside the domain.
fn arguments_of(item: &CatalogueItem) -> Result<String, Failed> {
    if let Some(given) = comment_value(item, "At:") {
        return Ok(given.to_owned());
    }
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    let mut one = |name: &str, ty: &'static str, values: &[&'static str]| {
        let count = seen.entry(ty).or_default();
        *count += 1;
        let unit = UNIT.iter().find(|(unit, _)| *unit == name && ty == "vec3f");
        unit.map_or(values[(*count - 1) % values.len()], |(_, value)| value)
    };
    let mut arguments = Vec::new();
    for member in &item.members {
        let known = ARGUMENTS.iter().find(|(ty, _)| *ty == member.ty);
        let (ty, values) = known.ok_or_else(|| format!("no argument of type `{}`", member.ty))?;
        arguments.push(one(&member.name, ty, values));
    }
    Ok(arguments.join(", "))
}

/// The plain formula and the library have the same value inside the domain. Functions that sample
/// textures are left out, since no expression can name a texture: their plain texts differ from the
/// library's in the functions that they call, and in the tests of places off the map.
fn agree() -> Outcome {
    let plain = plain_functions()?;
    let samples =
        |item: &CatalogueItem| item.members.iter().any(|member| member.ty.contains("texture"));
    let compared: Vec<(&String, &CatalogueItem)> =
        plain.iter().filter(|(_, item)| !samples(item)).collect();
    let mut lines = String::new();
    for (path, item) in &compared {
        let arguments = arguments_of(item).map_err(|error| format!("`{path}`: {error:?}"))?;
        writeln!(lines, "{path}({arguments})\nlamplight::{path}({arguments})")?;
    }
    let values = lamplight(&["eval", "--root", "."], &lines)?;
    let values: Vec<&str> = values.lines().collect();
    let mut wrong = Vec::new();
    for ((path, _), pair) in compared.iter().zip(values.chunks(2)) {
        if !pair.last().is_some_and(|library| are_close(pair[0], library)) {
            wrong.push(format!("`{path}`: plain and library are {pair:?}"));
        }
    }
    if values.len() != 2 * compared.len() {
        wrong.push(format!("{} values of {} functions", values.len(), compared.len()));
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n").into()) }
}

/// Whether two printed values are equal but for rounding.
fn are_close(one: &str, other: &str) -> bool {
    let words = || one.split(' ').zip(other.split(' '));
    let close = |(one, other): (&str, &str)| match (one.parse::<f64>(), other.parse::<f64>()) {
        (Ok(one), Ok(other)) => {
            (one - other).abs() <= TOLERANCE * one.abs().max(other.abs()).max(1e-3)
        }
        _ => one == other,
    };
    one.split(' ').count() == other.split(' ').count() && words().all(close)
}

/// Cycles of vector instructions on the dearest and on the cheapest path.
type Figures = (i64, i64);

/// The driver, and the figures by the name of what was measured.
fn measured(arguments: &[&str]) -> Result<(String, BTreeMap<String, Figures>), Failed> {
    let common = ["cost", "--gpu", GPU, "--json"];
    let found: Vec<Value> =
        serde_json::from_str(&lamplight(&[&common[..], arguments].concat(), "")?)?;
    let driver = found.first().and_then(|object| object["driver"].as_str()).unwrap_or_default();
    let figure = |object: &Value, name: &str| object["net"][name].as_i64().unwrap_or_default();
    let one = |object: &Value| {
        let name = object["name"].as_str().unwrap_or_default().to_owned();
        (name, (figure(object, "cycles"), figure(object, "least_cycles")))
    };
    Ok((driver.to_owned(), found.iter().map(one).collect()))
}

/// The plain figures, by the library's path.
fn measured_plain() -> Result<BTreeMap<String, Figures>, Failed> {
    let plain = plain_functions()?;
    let modules: BTreeSet<&String> = plain.values().map(|item| &item.module).collect();
    let files: Vec<String> =
        modules.iter().map(|module| module.replace("::", "/") + ".wesl").collect();
    let files = files.iter().map(String::as_str);
    let arguments: Vec<&str> = ["--root", "."].into_iter().chain(files).collect();
    let (_, figures) = measured(&arguments)?;
    let path = |name: &str| name.replace(".wesl ", "::").replace('/', "::");
    Ok(figures.into_iter().map(|(name, figures)| (path(&name), figures)).collect())
}

/// Whether the dearest path through the guards costs more than a little.
fn is_dear((cycles, _): Figures, (plain, _): Figures) -> bool {
    (cycles - plain) as f64 > SHARE * plain as f64 && cycles - plain > CYCLES
}

fn geometric_mean(ratios: &[f64]) -> f64 {
    (ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len().max(1) as f64).exp()
}

/// The cycles of all paths: `26`, or `9 to 26`.
fn written_range((most, least): Figures) -> String {
    if most == least { most.to_string() } else { format!("{least} to {most}") }
}

/// A function whose guards cost more than a little says why, and no other does. `docs/costs.md` is
/// what is measured now; `UPDATE_EXPECT=1` writes it. Another version of Mesa is not compared, and
/// the test says so.
fn what_guards_cost() -> Outcome {
    let page = snapshot::root().join("docs/costs.md");
    let is_updated = std::env::var_os("UPDATE_EXPECT").is_some();
    let recorded = std::fs::read_to_string(&page).unwrap_or_default();
    let (driver, library) = measured(&[])?;
    if !is_updated && !recorded.contains(&format!("`{driver}`")) {
        eprintln!("not compared: docs/costs.md was not measured by `{driver}`");
        return Ok(());
    }
    let plain = measured_plain()?;
    let (mut rows, mut wrong, mut ratios) = (String::new(), Vec::new(), Vec::new());
    for (path, item) in plain_functions()? {
        let (with, without) = (library.get(&path), plain.get(&path));
        let (with, without) =
            with.zip(without).ok_or_else(|| format!("`{path}` has no figures"))?;
        let reason = comment_value(&item, "Reason:");
        match (is_dear(*with, *without), reason) {
            (true, None) => wrong.push(format!("`{path}` is dear, and has no `Reason:`")),
            (false, Some(_)) => wrong.push(format!("`{path}` is cheap, and has a `Reason:`")),
            _ => {}
        }
        let [library, plain] = [*with, *without].map(written_range);
        let ratio = with.0 as f64 / without.0.max(1) as f64;
        ratios.push(ratio);
        let reason = reason.unwrap_or_default();
        writeln!(rows, "| `{path}` | {library} | {plain} | {ratio:.2} | {reason} |")?;
    }
    let head = std::fs::read_to_string(folder().join("page.md"))?;
    let head = rest::filled(&head)?;
    let head = head
        .replace("{mean}", &format!("{:.2}", geometric_mean(&ratios)))
        .replace("{worst}", &format!("{:.2}", ratios.iter().copied().fold(0.0, f64::max)));
    let text = head.replace("{driver}", &driver).replace("{gpu}", GPU).replace("{rows}", &rows);
    if is_updated {
        std::fs::write(&page, &text)?;
    } else if text != recorded {
        wrong
            .push("docs/costs.md is not what is measured: `cargo xtask record plain::`".to_owned());
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n").into()) }
}
