//! Packages that depend on others, and the library as packages of cargo and npm.
//!
//! A folder of `tests/packages/` is a package with its dependencies. Its file `command` has command
//! lines, as in `tests/diagnostics/`; a snapshot holds what they print. The packages that
//! `lamplight export` writes are complete, can be built, and work with the tools for which they are
//! made.

mod app;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use lamplight::LIBRARY_FILES;
use lamplight::source::Files as _;
use lamplight_testing::commands::transcript;
use libtest_mimic::{Failed, Trial};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use wesl::{CodegenModule, CodegenPkg};

use crate::examples::{cargo, run};
use crate::shaderlib::{entry_wesl, modules};
use crate::snapshot::{self, root};

pub fn tests() -> Vec<Trial> {
    let case = |(name, path): (String, PathBuf)| {
        let check = move |name: &str| {
            snapshot::check(
                "packages",
                name,
                &transcript(env!("CARGO_BIN_EXE_lamplight"), &path, true)?,
            )
        };
        Trial::test(format!("packages::case::{name}"), move || check(&name))
    };
    let cases = snapshot::cases("packages").into_iter().map(case);
    let exported = [
        Trial::test("packages::wesl_toml", wesl_toml_is_read),
        Trial::test("packages::cargo", cargo_package_composes),
        Trial::test("packages::cargo_with_visibility", cargo_package_is_public),
        Trial::test("packages::npm", npm_package_is_complete),
    ];
    let apps = crate::is_whole().then(|| Trial::test("packages::apps", app::apps_compose));
    exported.into_iter().chain(apps).chain(cases).collect()
}

/// The `wesl` crate finds all modules in the library's `wesl.toml`, and no programs.
fn wesl_toml_is_read() -> Result<(), Failed> {
    let package = wesl::PkgBuilder::new("lamplight").scan_toml(root().join("shaderlib"))?;
    let mut found = Vec::new();
    for folder in &package.root.submodules {
        found.extend(
            folder.submodules.iter().map(|module| format!("{}/{}", folder.name, module.name)),
        );
    }
    found.sort();
    match found == modules() {
        true => Ok(()),
        false => Err(format!("found {found:?}, expected {:?}", modules()).into()),
    }
}

fn export(form: &str, folder: &Path) -> Result<(), Failed> {
    run(Command::new(env!("CARGO_BIN_EXE_lamplight")).args(["export", "--form", form]).arg(folder))
        .map(drop)
}

/// Cargo can package the crate for publishing. With the modules that its build script makes, a user's
/// shader that calls every function of a module links and is valid.
fn cargo_package_composes() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    export("cargo", folder.path())?;
    let package = folder.path().join("lamplight_wgsl");
    // With this lock file, cargo needs only versions that are already downloaded.
    std::fs::copy(root().join("Cargo.lock"), package.join("Cargo.lock"))?;
    cargo(&package, &["package", "--quiet", "--offline", "--no-verify", "--allow-dirty"])?;

    let scanned = wesl::PkgBuilder::new("lamplight").scan_toml(&package)?;
    let built = scanned.validate().map_err(|error| error.to_string())?;
    let constants: &CodegenPkg = Box::leak(Box::new(CodegenPkg {
        crate_name: "lamplight_wgsl",
        root: constant(built.root),
        dependencies: &[],
    }));
    let shaders = folder.path().join("shaders");
    std::fs::create_dir_all(&shaders)?;
    let mut compiler = wesl::Wesl::new(&shaders);
    compiler.add_package(constants);
    for module in modules() {
        let name = module.replace('/', "_");
        std::fs::write(shaders.join(format!("{name}.wesl")), entry_wesl(&module))?;
        let path =
            format!("package::{name}").parse().map_err(|error| format!("{name}: {error}"))?;
        let linked =
            compiler.compile(&path).map_err(|error| format!("{module}: {error}"))?.to_string();
        let parsed =
            naga::front::wgsl::parse_str(&linked).map_err(|error| error.emit_to_string(&linked))?;
        Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&parsed)
            .map_err(|error| format!("{error:?}\n{linked}"))?;
    }
    Ok(())
}

/// In the crate for `wesl` 0.6, other packages can name each function of each module.
fn cargo_package_is_public() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let command = ["export", "--form", "cargo", "--wesl", "0.6"];
    run(Command::new(env!("CARGO_BIN_EXE_lamplight")).args(command).arg(folder.path()))?;
    let package = folder.path().join("lamplight_wgsl");
    let manifest = "[package]\nname = \"app\"\nroot = \".\"\n\n[dependencies]\n\
                    lamplight = { path = \"lamplight_wgsl\" }\n";
    std::fs::write(folder.path().join("wesl.toml"), manifest)?;
    for module in modules() {
        let name = module.replace('/', "_");
        std::fs::write(folder.path().join(format!("{name}.wesl")), entry_wesl(&module))?;
    }
    let linted = run(Command::new(env!("CARGO_BIN_EXE_lamplight")).arg("lint").arg(folder.path()))?;
    if !linted.contains(" 0 errors, 0 warnings") {
        return Err(linted.into());
    }
    let specular = std::fs::read_to_string(package.join("src/shaders/brdf/specular.wesl"))?;
    if !specular.contains("\npublic fn blinn_phong(") {
        return Err("the items of the crate are not public".into());
    }
    Ok(())
}

/// A module in the form of the constants that the build script writes.
fn constant(module: wesl::Module) -> &'static CodegenModule {
    let submodules: Vec<&CodegenModule> = module.submodules.into_iter().map(constant).collect();
    Box::leak(Box::new(CodegenModule {
        name: module.name.leak(),
        source: module.source.leak(),
        submodules: submodules.leak(),
    }))
}

/// The npm package has the text of every module, read as JSON and as imported by node.
fn npm_package_is_complete() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let package = folder.path().join("node_modules/lamplight");
    export("npm", &folder.path().join("node_modules"))?;
    let texts = modules().into_iter().map(|module| format!("{module}.wesl"));
    let texts: BTreeMap<String, String> = texts.map(|path| (path.clone(), text(&path))).collect();
    let expected =
        serde_json::json!({ "name": "lamplight", "edition": "2026_pre", "modules": texts });

    let manifest: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(package.join("package.json"))?)?;
    let exported = |kind: &str| {
        manifest["exports"]["."][kind].as_str().map(|path| package.join(path)).ok_or("no export")
    };
    let bundle = std::fs::read_to_string(exported("import")?)?;
    let object = bundle
        .strip_prefix("export const weslBundle = ")
        .and_then(|rest| rest.split_once(";\n\nexport default"));
    same(&serde_json::from_str(object.ok_or("not a bundle")?.0)?, &expected)?;
    if !exported("types")?.is_file() {
        return Err("the file that `exports` names for `types` does not exist".into());
    }
    for path in LIBRARY_FILES.list(&["glsl"]) {
        if std::fs::read_to_string(package.join("glsl/lamplight").join(&path))? != text(&path) {
            return Err(format!("`{path}` in the package differs from the library's").into());
        }
    }

    if Command::new("node").arg("--version").output().is_err() {
        return Err("node is not installed: `apt-get install nodejs`".into());
    }
    let script = "import lamplight, { weslBundle } from 'lamplight'; console.log(JSON.stringify(lamplight === weslBundle ? lamplight : {}))";
    let printed = run(Command::new("node").current_dir(folder.path()).args([
        "--input-type=module",
        "--eval",
        script,
    ]))?;
    same(&serde_json::from_str(&printed)?, &expected)
}

fn text(path: &str) -> String {
    LIBRARY_FILES.read(path).ok().flatten().unwrap_or_default()
}

fn same(found: &serde_json::Value, expected: &serde_json::Value) -> Result<(), Failed> {
    match found == expected {
        true => Ok(()),
        false => Err(format!("the package's bundle is {found:#}, expected {expected:#}").into()),
    }
}
