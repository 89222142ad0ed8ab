//! An app that takes the library from the crate that `export --form cargo` writes, with the compiler
//! that the crate is for. Cargo builds it, so this runs at night.

use std::path::Path;
use std::process::Command;

use libtest_mimic::Failed;
use naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::examples::{cargo, run};
use crate::shaderlib::{entry_wesl, modules};
use crate::snapshot::root;

/// How an app composes `FOLDER/NAME.wesl`, for each version of the compiler.
const VERSIONS: [(&str, &str); 2] = [
    (
        "0.4",
        "let mut compiler = wesl::Wesl::new(&folder);
        compiler.add_package(&lamplight_wgsl::lamplight::PACKAGE);
        let path = format!(\"package::{name}\").parse()?;
        let made = compiler.compile(&path)?;",
    ),
    (
        "0.6",
        "let mut options = wesl::CompileOptions::default();
        options.dependencies.push(&lamplight_wgsl::lamplight::PACKAGE);
        let compiler = wesl::Compiler::new(options);
        let made = compiler.compile(format!(\"{folder}/{name}.wesl\"))?;",
    ),
];

/// Builds an app for each version, and has it compose a shader that calls every function of a module,
/// for each module. naga validates what it writes.
pub fn apps_compose() -> Result<(), Failed> {
    for (version, compose) in VERSIONS {
        let folder = tempfile::tempdir()?;
        let command = ["export", "--form", "cargo", "--wesl", version];
        run(Command::new(env!("CARGO_BIN_EXE_lamplight")).args(command).arg(folder.path()))?;
        // The crate is a workspace of its own, so it is not in the app's folder.
        let app = folder.path().join("app");
        write_app(&app, version, compose)?;
        cargo(&app, &["build", "--quiet", "--ignore-rust-version"])?;
        for module in modules() {
            let name = module.replace('/', "_");
            let built = app.join("target/debug/app");
            run(Command::new(built).current_dir(&app).args(["shaders", &name]))?;
            let made = app.join("shaders").join(format!("{name}.wgsl"));
            validate_text(&std::fs::read_to_string(made)?)
                .map_err(|message| format!("wesl {version}: {module}: {message}"))?;
        }
    }
    Ok(())
}

fn write_app(folder: &Path, version: &str, compose: &str) -> Result<(), Failed> {
    let manifest = format!(
        "[package]\nname = \"app\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n\
         [dependencies]\nlamplight_wgsl = {{ path = \"../lamplight_wgsl\" }}\nwesl = \"{version}\"\n"
    );
    let main = format!(
        "fn main() -> Result<(), Box<dyn std::error::Error>> {{
        let [folder, name] = [1, 2].map(|at| std::env::args().nth(at).unwrap_or_default());
        {compose}
        std::fs::write(format!(\"{{folder}}/{{name}}.wgsl\"), made.to_string())?;
        Ok(())\n}}\n"
    );
    std::fs::create_dir_all(folder.join("src"))?;
    std::fs::write(folder.join("Cargo.toml"), manifest)?;
    // With this lock file, the versions are those that are downloaded already where they fit.
    std::fs::copy(root().join("Cargo.lock"), folder.join("Cargo.lock"))?;
    std::fs::write(folder.join("src/main.rs"), main)?;
    std::fs::create_dir_all(folder.join("shaders"))?;
    for module in modules() {
        let file = format!("{}.wesl", module.replace('/', "_"));
        std::fs::write(folder.join("shaders").join(file), entry_wesl(&module))?;
    }
    Ok(())
}

fn validate_text(text: &str) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map(drop)
        .map_err(|error| format!("{error:?}\n{text}"))
}
