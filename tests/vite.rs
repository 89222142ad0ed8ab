//! The plugin for Vite, with the current major version and the one before: a page is served while its
//! shaders are edited, and is built. Chromium draws with WebGL 2, and TypeScript checks keys.

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use lamplight::browser::{Browser, BrowserPage, PATIENCE};
use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

use crate::{clients, npm};

type Outcome = Result<(), Failed>;

const LAMPLIGHT: &str = env!("CARGO_BIN_EXE_lamplight");

/// Folders of `tests/vite/` with a lock file each.
const VERSIONS: [&str; 2] = ["7", "8"];

pub fn tests() -> Vec<Trial> {
    type TestOfVersion = fn(&str) -> Outcome;
    const TESTS: [(&str, TestOfVersion); 4] = [
        ("edits_arrive", edits_arrive),
        ("build_has_what_is_named", build_has_what_is_named),
        ("types_refuse_wrong_keys", types_refuse_wrong_keys),
        ("mistakes_end_a_build", mistakes_end_a_build),
    ];
    let mut tests = Vec::new();
    for version in VERSIONS {
        tests.extend(TESTS.map(|(name, test)| {
            Trial::test(format!("vite::{version}::{name}"), move || test(version))
        }));
    }
    tests.push(Trial::test("vite::usage", usage));
    tests.push(Trial::test("vite::few_lines", || clients::few_lines("../vite/app/main.ts")));
    tests
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn copy_folder(from: &Path, to: &Path) -> Outcome {
    std::fs::create_dir_all(to)?;
    for file in std::fs::read_dir(from)? {
        let file = file?;
        let place = to.join(file.file_name());
        match file.file_type()?.is_dir() {
            true => copy_folder(&file.path(), &place)?,
            false => drop(std::fs::copy(file.path(), place)?),
        }
    }
    Ok(())
}

/// A copy of the app, in a folder below one that has the packages.
struct App {
    folder: TempDir,
}

impl App {
    fn new(version: &str) -> Result<Self, Failed> {
        let name = format!("vite{version}");
        let packages = npm::installed(&root().join("tests/vite").join(version), &name)?;
        let folder = tempfile::tempdir_in(packages.parent().ok_or("no folder")?)?;
        for package in ["bundle", "vite"] {
            let place = folder.path().join("node_modules/@lamplight").join(package);
            copy_folder(&root().join("packages").join(package), &place)?;
        }
        copy_folder(&root().join("tests/vite/app"), folder.path())?;
        std::fs::copy(root().join("tests/vite/serve.mjs"), folder.path().join("serve.mjs"))?;
        Ok(Self { folder })
    }

    fn edit(&self, file: &str, before: &str, after: &str) -> Outcome {
        let place = self.folder.path().join(file);
        let text = std::fs::read_to_string(&place)?;
        let edited = text.replace(before, after);
        match edited == text {
            true => Err(format!("{file} has no `{before}`").into()),
            false => Ok(std::fs::write(place, edited)?),
        }
    }

    /// A command of an installed package.
    fn npx(&self, words: &[&str]) -> Result<Output, Failed> {
        let mut command = Command::new("npx");
        command.arg("--no-install").args(words).current_dir(self.folder.path());
        let output = command.env("LAMPLIGHT", LAMPLIGHT).env("NO_COLOR", "1").output();
        Ok(output.map_err(|error| format!("npx: {error}; install it with: apt-get install npm"))?)
    }

    fn build(&self) -> Outcome {
        let output = self.npx(&["vite", "build"])?;
        match output.status.success() {
            true => Ok(()),
            false => Err(said(&output).into()),
        }
    }

    /// The files of a build, by their extensions, sorted.
    fn built(&self) -> Result<Vec<(String, PathBuf)>, Failed> {
        let mut found = Vec::new();
        for file in std::fs::read_dir(self.folder.path().join("dist/assets"))? {
            let path = file?.path();
            let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
            found.push((extension, path));
        }
        found.sort();
        Ok(found)
    }

    fn serve(&self, kind: &str) -> Result<Served, Failed> {
        let mut child = Command::new("node")
            .args(["serve.mjs", kind])
            .current_dir(self.folder.path())
            .env("LAMPLIGHT", LAMPLIGHT)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| format!("node: {error}; install it with: apt-get install nodejs"))?;
        let mut address = String::new();
        let output = child.stdout.take().ok_or("no output")?;
        BufReader::new(output).read_line(&mut address)?;
        Ok(Served { child, address: address.trim().to_owned() })
    }
}

/// A server of Vite.
struct Served {
    child: Child,
    address: String,
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn said(output: &Output) -> String {
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    format!("{out}{err}")
}

/// The text of Vite's overlay; empty if there is none.
const OVERLAY: &str = "[...document.querySelectorAll('vite-error-overlay')]
    .map((one) => one.shadowRoot.textContent).join('')";

/// Waits until the page has drawn this colour, without an error.
fn drawn(page: &BrowserPage, color: &str) -> Outcome {
    let is_there = format!("document.title === 'drawn {color}' && ({OVERLAY}) === ''");
    page.until(&is_there, PATIENCE).map_err(|problem| {
        let state = page.evaluate(&format!("document.title + ({OVERLAY})"), PATIENCE);
        format!("{problem}; there is: {state:?}").into()
    })
}

/// Waits until the overlay has all of these texts.
fn shown(page: &BrowserPage, texts: &[&str]) -> Outcome {
    let wanted = serde_json::json!(texts);
    let is_there = format!("(shown => {wanted}.every(text => shown.includes(text)))({OVERLAY})");
    page.until(&is_there, PATIENCE)?;
    Ok(())
}

/// The page stays the same one through edits, mistakes and their corrections.
fn edits_arrive(version: &str) -> Outcome {
    let app = App::new(version)?;
    let served = app.serve("dev")?;
    let page = Browser::shared()?.open(&served.address)?;
    drawn(&page, "255 153 51 255")?;
    page.evaluate("window.isSame = true", PATIENCE)?;
    app.edit("tints.wesl", "0.6, 0.2", "0.4, 0.2")?;
    drawn(&page, "255 102 51 255")?;
    app.edit("tints.wesl", "0.4, 0.2", "0.4, no_such")?;
    shown(&page, &["tints.wesl:2:46", "no definition in scope for identifier: `no_such`", "^^^^"])?;
    app.edit("tints.wesl", "0.4, no_such", "0.4, 0.0")?;
    drawn(&page, "255 102 0 255")?;
    app.edit("lamplight.toml", "default = \"white\"", "default = \"wite\"")?;
    shown(&page, &["lamplight.toml:6:58", "did you mean `white`?"])?;
    app.edit("lamplight.toml", "default = \"wite\"", "default = \"white\"")?;
    drawn(&page, "255 102 0 255")?;
    let tints = app.folder.path().join("tints.wesl");
    let text = std::fs::read(&tints)?;
    std::fs::remove_file(&tints)?;
    shown(&page, &["there is no module `package::tints`"])?;
    std::fs::write(&tints, text)?;
    app.edit("ball.wesl", "lamp.strength;", "0.5 * lamp.strength;")?;
    drawn(&page, "128 51 0 255")?;
    match page.evaluate("window.isSame === true", PATIENCE)? == true {
        true => Ok(()),
        false => Err("the page was loaded again".into()),
    }
}

/// What the code names goes into the code. Where a key is known only to the page, the bundle is there.
fn build_has_what_is_named(version: &str) -> Outcome {
    let app = App::new(version)?;
    app.build()?;
    let named = app.built()?;
    let text = std::fs::read_to_string(&named.first().ok_or("nothing was built")?.1)?;
    let kinds: Vec<&str> = named.iter().map(|(extension, _)| extension.as_str()).collect();
    // The colour of the permutation that is named, and that of another one.
    if kinds != ["js"] || !text.contains("0.6") || text.contains("vec3(0.2, 0.6, 1.0)") {
        return Err(format!("{kinds:?}: {text}").into());
    }
    draws(&app, "255 153 51 255")?;
    let chosen = "tint: location.hash === \"#cold\" ? \"cold\" : \"warm\"";
    app.edit("main.ts", "tint: \"warm\"", chosen)?;
    app.build()?;
    let kinds: Vec<String> = app.built()?.into_iter().map(|(extension, _)| extension).collect();
    if kinds != ["js", "lamplight"] {
        return Err(format!("{kinds:?}").into());
    }
    draws(&app, "255 153 51 255")
}

fn draws(app: &App, color: &str) -> Outcome {
    let served = app.serve("preview")?;
    let mut page = Browser::shared()?.open(&served.address)?;
    drawn(&page, color)?;
    match page.errors() {
        [] => Ok(()),
        errors => Err(format!("{errors:?}").into()),
    }
}

/// Each wrong call is an error at its place, and the right ones are none.
fn types_refuse_wrong_keys(version: &str) -> Outcome {
    const WRONG: [(&str, &str, &str); 5] = [
        ("tint: \"warm\"", "tint: \"hot\"", "main.ts(12,"),
        ("bright: true", "bright: 1", "main.ts(12,"),
        ("tint: \"warm\"", "tnt: \"warm\"", "main.ts(12,"),
        ("\"fs_main\"", "\"main\"", "main.ts(12,"),
        ("programs.ball.layout", "programs.bal.layout", "main.ts(13,"),
    ];
    let app = App::new(version)?;
    app.build()?;
    let output = app.npx(&["tsc", "--noEmit"])?;
    if !output.status.success() {
        return Err(said(&output).into());
    }
    let main = app.folder.path().join("main.ts");
    let right = std::fs::read(&main)?;
    for (before, after, place) in WRONG {
        app.edit("main.ts", before, after)?;
        let output = app.npx(&["tsc", "--noEmit"])?;
        let said = said(&output);
        if output.status.success() || said.matches("error TS").count() != 1 || !said.contains(place)
        {
            return Err(format!("{after}: {said}").into());
        }
        std::fs::write(&main, &right)?;
    }
    Ok(())
}

/// A shader that does not compile, a key that there is not, and a command that is not installed.
fn mistakes_end_a_build(version: &str) -> Outcome {
    const MISTAKES: [(&str, &str, &str, &[&str]); 3] = [
        ("tints.wesl", "1.0, 0.6, 0.2", "no_such", &["tints.wesl:2:36", "identifier: `no_such`"]),
        ("main.ts", "\"warm\"", "\"hot\"", &["axis `tint` has no value `hot`; there are: white"]),
        (
            "vite.config.js",
            "lamplight({",
            "lamplight({ command: \"no-such-lamplight\",",
            &["`no-such-lamplight` cannot be run (ENOENT)", "install it with: cargo install --git"],
        ),
    ];
    let app = App::new(version)?;
    for (file, before, after, texts) in MISTAKES {
        let right = std::fs::read(app.folder.path().join(file))?;
        app.edit(file, before, after)?;
        let output = app.npx(&["vite", "build"])?;
        let said = said(&output);
        if output.status.success() || !texts.iter().all(|text| said.contains(text)) {
            return Err(format!("{file}: {said}").into());
        }
        std::fs::write(app.folder.path().join(file), right)?;
    }
    Ok(())
}

/// What is found in code, and the files of a rule for make.
fn usage() -> Outcome {
    let app = App::new("8")?;
    let test = app.folder.path().join("node_modules/@lamplight/vite/test/usage.mjs");
    let output = Command::new("node").arg(test).output()?;
    match output.status.success() {
        true => Ok(()),
        false => Err(said(&output).into()),
    }
}
