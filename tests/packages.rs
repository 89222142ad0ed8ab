//! The library as packages of other managers: what `lamplight export` writes is complete, builds,
//! and composes by the tools it is for.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use lamplight::source::{Embedded, Files as _};
use libtest_mimic::{Failed, Trial};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::examples::{cargo, run};
use crate::shaderlib::{entry_wesl, modules};
use crate::snapshot::root;

pub fn trials() -> Vec<Trial> {
    vec![
        Trial::test("packages::wesl_toml", wesl_toml_is_read),
        Trial::test("packages::cargo", cargo_package_composes),
        Trial::test("packages::npm", npm_package_is_complete),
    ]
}

/// The `wesl` crate's own reader finds the modules, and no programs.
fn wesl_toml_is_read() -> Result<(), Failed> {
    let package = wesl::PkgBuilder::new("lamplight").scan_toml(root().join("shaderlib"))?;
    let mut found = Vec::new();
    for folder in &package.root.submodules {
        found.extend(folder.submodules.iter().map(|module| format!("{}/{}", folder.name, module.name)));
    }
    found.sort();
    if found == modules() { Ok(()) } else { Err(format!("{found:?}").into()) }
}

fn export(form: &str, folder: &Path) -> Result<(), Failed> {
    run(Command::new(env!("CARGO_BIN_EXE_lamplight")).args(["export", "--form", form]).arg(folder)).map(drop)
}

const MANIFEST: &str = r#"[package]
name = "consumer"
version = "0.1.0"
edition = "2024"

[workspace]

[dependencies]
lamplight_wgsl = { path = "../lamplight_wgsl" }
wesl = { version = "0.4.0", features = ["package"] }

# As for the package's build script, so that the `wesl` crate is built once for both.
[profile.dev]
debug = false
"#;

/// Links every shader of the folder, and prints each after its name.
const CONSUMER: &str = r#"fn main() {
    let mut compiler = wesl::Wesl::new("shaders");
    compiler.add_package(&lamplight_wgsl::lamplight::PACKAGE);
    for name in std::env::args().skip(1) {
        let linked = compiler.compile(&format!("package::{name}").parse().unwrap()).unwrap_or_else(|error| panic!("{name}: {error}"));
        println!("// module {name}\n{linked}");
    }
}
"#;

/// The crate builds, and a crate that depends on it calls every function.
fn cargo_package_composes() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    export("cargo", folder.path())?;
    let names: Vec<String> = modules().iter().map(|module| module.replace('/', "_")).collect();
    let shaders = modules().into_iter().zip(&names).map(|(module, name)| (format!("shaders/{name}.wesl"), entry_wesl(&module)));
    let own = [
        ("Cargo.toml", MANIFEST.to_owned()),
        ("src/main.rs", CONSUMER.to_owned()),
        // The versions that are there already.
        ("Cargo.lock", std::fs::read_to_string(root().join("Cargo.lock"))?),
    ];
    let consumer = folder.path().join("consumer");
    for (path, text) in own.into_iter().map(|(path, text)| (path.to_owned(), text)).chain(shaders) {
        let path = consumer.join(path);
        std::fs::create_dir_all(path.parent().unwrap_or(&consumer))?;
        std::fs::write(path, text)?;
    }
    // Kept between runs: the `wesl` crate takes longer to build than the package.
    let target = root().join("target/packages").to_string_lossy().into_owned();
    let command = ["run", "--quiet", "--offline", "--target-dir", &target, "--"];
    let arguments: Vec<&str> = command.into_iter().chain(names.iter().map(String::as_str)).collect();
    let linked = cargo(&consumer, &arguments)?;
    let linked: Vec<&str> = linked.split("// module ").skip(1).collect();
    for text in &linked {
        let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
        Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).map_err(|error| format!("{error:?}\n{text}"))?;
    }
    if linked.len() == names.len() { Ok(()) } else { Err(format!("{} of {} modules", linked.len(), names.len()).into()) }
}

/// The bundle has every module's text, as JSON and as what JavaScript makes of it.
fn npm_package_is_complete() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let package = folder.path().join("node_modules/lamplight");
    export("npm", &folder.path().join("node_modules"))?;
    let texts = modules().into_iter().map(|module| format!("{module}.wesl"));
    let texts: BTreeMap<String, String> = texts.map(|path| (path.clone(), text(&path))).collect();
    let expected = serde_json::json!({ "name": "lamplight", "edition": "2026_pre", "modules": texts });

    let manifest: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(package.join("package.json"))?)?;
    let exported = |kind: &str| manifest["exports"]["."][kind].as_str().map(|path| package.join(path)).ok_or("no export");
    let bundle = std::fs::read_to_string(exported("import")?)?;
    let object = bundle.strip_prefix("export const weslBundle = ").and_then(|rest| rest.split_once(";\n\nexport default"));
    same(&serde_json::from_str(object.ok_or("not a bundle")?.0)?, &expected)?;
    if !exported("types")?.is_file() {
        return Err("no types".into());
    }
    for path in Embedded.list(&["glsl"]) {
        if std::fs::read_to_string(package.join("glsl/lamplight").join(&path))? != text(&path) {
            return Err(format!("`{path}` differs").into());
        }
    }

    if Command::new("node").arg("--version").output().is_err() {
        eprintln!("packages::npm: node is not installed, so the bundle was read as JSON only");
        return Ok(());
    }
    let script =
        "import lamplight, { weslBundle } from 'lamplight'; console.log(JSON.stringify(lamplight === weslBundle ? lamplight : {}))";
    let printed = run(Command::new("node").current_dir(folder.path()).args(["--input-type=module", "--eval", script]))?;
    same(&serde_json::from_str(&printed)?, &expected)
}

fn text(path: &str) -> String {
    Embedded.read(path).ok().flatten().unwrap_or_default()
}

fn same(found: &serde_json::Value, expected: &serde_json::Value) -> Result<(), Failed> {
    if found == expected { Ok(()) } else { Err(format!("the bundle is {found:#}").into()) }
}
