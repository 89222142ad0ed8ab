//! The configuration of each editor in `editors/`: it has the form that the editor reads, names
//! what the server offers, and the guide describes it.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::Failed;
use serde_json::{Value, json};
use toml::Table;

use super::{Outcome, expect, neovim_output};

/// What the server reads, by the names that editors have for it.
const LANGUAGES: [&str; 3] = ["glsl", "wesl", "wgsl"];

fn folder(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn read(path: &str) -> Result<String, Failed> {
    fs::read_to_string(folder(path)).map_err(|error| format!("{path}: {error}").into())
}

fn words(found: &Value) -> BTreeSet<String> {
    let found = found.as_array().into_iter().flatten();
    found.filter_map(Value::as_str).map(str::to_lowercase).collect()
}

fn languages() -> BTreeSet<String> {
    LANGUAGES.map(str::to_owned).into()
}

/// The guide has a section for each folder of `editors/`, and shows the files that authors copy.
pub fn guide() -> Outcome {
    let guide = read("docs/guide/editors.md")?;
    let mut known = BTreeSet::new();
    for entry in fs::read_dir(folder("editors"))? {
        known.insert(entry?.file_name().to_string_lossy().into_owned());
    }
    let sections = [
        ("helix", "Helix"),
        ("neovim", "Neovim"),
        ("vscode", "Visual Studio Code"),
        ("zed", "Zed"),
    ];
    expect(known == sections.map(|(name, _)| name.to_owned()).into(), &known)?;
    for (name, title) in sections {
        let section =
            guide.split("\n## ").find(|section| section.starts_with(&format!("{title}\n")));
        let section = section.ok_or_else(|| format!("the guide has no section `{title}`"))?;
        expect(section.contains(&format!("editors/{name}")), &section)?;
    }
    for file in ["editors/neovim/lamplight.lua", "editors/helix/languages.toml"] {
        let text = read(file)?;
        expect(guide.contains(&format!("```text\n{text}```")), &(file, text))?;
    }
    Ok(())
}

pub fn helix() -> Outcome {
    let found: Table = read("editors/helix/languages.toml")?.parse()?;
    let found = serde_json::to_value(found)?;
    let server = &found["language-server"]["lamplight"];
    expect(server["command"] == "lamplight" && server["args"] == json!(["lsp"]), server)?;
    let mut named = BTreeSet::new();
    for language in found["language"].as_array().ok_or("no languages")? {
        expect(language["language-servers"] == json!(["lamplight"]), language)?;
        named.extend(language["name"].as_str().map(str::to_owned));
    }
    expect(named == languages(), &named)?;
    let wesl = &found["language"][0];
    expect(wesl["name"] == "wesl" && wesl["file-types"] == json!(["wesl"]), wesl)?;
    expect(wesl["scope"].is_string() && wesl["grammar"].is_string(), wesl)
}

pub fn zed() -> Outcome {
    let extension: Table = read("editors/zed/extension.toml")?.parse()?;
    let extension = serde_json::to_value(extension)?;
    let package: Table = read("editors/zed/Cargo.toml")?.parse()?;
    let package = serde_json::to_value(package)?;
    expect(extension["version"] == env!("CARGO_PKG_VERSION"), &extension)?;
    expect(package["package"]["version"] == extension["version"], &package)?;
    expect(extension["id"] == "lamplight" && extension["schema_version"] == 1, &extension)?;
    expect(package["lib"]["crate-type"] == json!(["cdylib"]), &package)?;
    let server = &extension["language_servers"]["lamplight"];
    expect(words(&server["languages"]) == languages(), server)?;
    let language: Table = read("editors/zed/languages/wesl/config.toml")?.parse()?;
    let language = serde_json::to_value(language)?;
    expect(words(&server["languages"]).contains("wesl") && language["name"] == "WESL", &language)?;
    let grammar = language["grammar"].as_str().ok_or("no grammar")?;
    let commit = extension["grammars"][grammar]["commit"].as_str().ok_or("no such grammar")?;
    expect(commit.len() == 40 && commit.bytes().all(|byte| byte.is_ascii_hexdigit()), &commit)?;
    let code = read("editors/zed/src/lib.rs")?;
    expect(code.contains(r#"args: vec!["lsp".to_owned()]"#), &code)?;
    let queries = read("editors/zed/languages/wesl/highlights.scm")?;
    // Words in quotes may be brackets.
    let bare: String = queries.split('"').step_by(2).collect();
    for pair in ["()", "[]"] {
        let count = |bracket| bare.matches(bracket).count();
        expect(count(&pair[..1]) == count(&pair[1..]), &bare)?;
    }
    Ok(())
}

/// The extension's package, its grammar, and what its code asks the server for.
pub fn vscode() -> Outcome {
    let package: Value = serde_json::from_str(&read("editors/vscode/package.json")?)?;
    expect(package["version"] == env!("CARGO_PKG_VERSION"), &package)?;
    let code = read("editors/vscode/extension.js")?;
    let contributes = &package["contributes"];
    let events: Vec<String> =
        LANGUAGES.iter().map(|language| format!("onLanguage:{language}")).collect();
    let events = events.into_iter().chain(["onDebugResolve:lamplight".to_owned()]);
    let expected: BTreeSet<String> = events.map(|event| event.to_lowercase()).collect();
    expect(words(&package["activationEvents"]) == expected, &package)?;
    let mut named = BTreeSet::new();
    for language in contributes["languages"].as_array().ok_or("no languages")? {
        named.extend(language["id"].as_str().map(str::to_owned));
        let file = language["configuration"].as_str().ok_or("no configuration")?;
        serde_json::from_str::<Value>(&read(&format!("editors/vscode/{file}"))?)?;
    }
    expect(named == languages(), &named)?;
    for command in contributes["commands"].as_array().ok_or("no commands")? {
        let name = command["command"].as_str().ok_or("no name")?;
        expect(code.contains(&format!("registerCommand('{name}'")), &name)?;
    }
    let adapter = "DebugAdapterExecutable(command, ['dap'])";
    for expected in ["lamplight/permutation", "lamplight.composed", "args: ['lsp']", adapter] {
        expect(code.contains(expected), &expected)?;
    }
    debugger(contributes)?;
    for grammar in contributes["grammars"].as_array().ok_or("no grammars")? {
        let file = grammar["path"].as_str().ok_or("no path")?;
        let text: Value = serde_json::from_str(&read(&format!("editors/vscode/{file}"))?)?;
        expect(text["scopeName"] == grammar["scopeName"], grammar)?;
        check_grammar(&text, &text["repository"])?;
    }
    Ok(())
}

/// The adapter reads what a launch has beside options, which `dap::options_of_a_launch` compares, and the
/// snippets say nothing else.
fn debugger(contributes: &Value) -> Outcome {
    let debugger = &contributes["debuggers"][0];
    expect(
        debugger["type"] == "lamplight" && words(&debugger["languages"]) == languages(),
        debugger,
    )?;
    let launch = &debugger["configurationAttributes"]["launch"];
    let named = launch["properties"].as_object().ok_or("no attributes")?;
    let adapter = read("src/cli/dap.rs")? + &read("crates/dap/src/session.rs")?;
    for name in ["program", "stopOnEntry", "cwd", "args"] {
        expect(named.contains_key(name) && adapter.contains(&format!("\"{name}\"")), &name)?;
    }
    let all = debugger["initialConfigurations"].as_array().ok_or("no configurations")?;
    let snippets = debugger["configurationSnippets"].as_array().ok_or("no snippets")?;
    for body in all.iter().chain(snippets.iter().map(|snippet| &snippet["body"])) {
        expect(body["type"] == "lamplight" && body["request"] == "launch", body)?;
        for name in body.as_object().ok_or("no object")?.keys() {
            let is_own = ["type", "request", "name"].contains(&name.as_str());
            expect(is_own || named.contains_key(name), name)?;
        }
    }
    let broken = contributes["breakpoints"].as_array().ok_or("no breakpoints")?;
    let broken = broken.iter().filter_map(|one| one["language"].as_str().map(str::to_owned));
    expect(broken.collect::<BTreeSet<_>>() == languages(), contributes)
}

/// The commands of the guide make a `.vsix`, with the grammar and the client that the code needs.
pub fn vsix() -> Outcome {
    let scratch = tempfile::tempdir()?;
    copy_folder(&folder("editors/vscode"), scratch.path())?;
    let guide = read("docs/guide/editors.md")?;
    for line in ["npm install", "npx @vscode/vsce package"] {
        expect(guide.contains(&format!("\n{line}\n")), &line)?;
        let mut words = line.split(' ');
        let program = words.next().ok_or("no program")?;
        let mut command = Command::new(program);
        // npm asks nobody whether it may fetch what it runs.
        command.args(words).env("npm_config_yes", "true").current_dir(scratch.path());
        let output = command
            .output()
            .map_err(|error| format!("{program}: {error}; install it with: apt-get install npm"))?;
        let printed =
            String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
        expect(output.status.success(), &(line, printed))?;
    }
    let name = format!("lamplight-{}.vsix", env!("CARGO_PKG_VERSION"));
    expect(guide.contains(&name), &name)?;
    let bytes = fs::read(scratch.path().join(&name))?;
    // The names of files are plain in an archive of this kind.
    for file in [
        "extension.js",
        "picture.js",
        "package.json",
        "language-configuration.json",
        "syntaxes/wesl.tmLanguage.json",
        "node_modules/vscode-languageclient/node.js",
    ] {
        let path = format!("extension/{file}");
        expect(bytes.windows(path.len()).any(|found| found == path.as_bytes()), &path)?;
    }
    Ok(())
}

fn copy_folder(from: &Path, to: &Path) -> Outcome {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        // What an author has installed here is installed anew.
        match entry.file_type()?.is_dir() {
            true if entry.file_name() == "node_modules" => {}
            true => copy_folder(&entry.path(), &target)?,
            false => drop(fs::copy(entry.path(), target)?),
        }
    }
    Ok(())
}

/// Each rule that a grammar includes is there, and its brackets and groups close.
fn check_grammar(part: &Value, rules: &Value) -> Outcome {
    match part {
        Value::Object(fields) => {
            if let Some(name) = fields.get("include").and_then(Value::as_str) {
                let rule = name.strip_prefix('#').ok_or("not of this grammar")?;
                expect(rules.get(rule).is_some(), &name)?;
            }
            for key in ["match", "begin", "end"] {
                let Some(pattern) = fields.get(key).and_then(Value::as_str) else { continue };
                let plain = pattern.replace("\\\\", "").replace("\\(", "").replace("\\)", "");
                expect(plain.matches('(').count() == plain.matches(')').count(), &pattern)?;
            }
            expect(fields.contains_key("begin") == fields.contains_key("end"), part)?;
            fields.values().try_for_each(|field| check_grammar(field, rules))
        }
        Value::Array(parts) => parts.iter().try_for_each(|part| check_grammar(part, rules)),
        _ => Ok(()),
    }
}

/// Neovim with the configuration that authors copy starts the server by itself.
pub fn neovim() -> Outcome {
    let program = Path::new(env!("CARGO_BIN_EXE_lamplight"));
    let programs = program.parent().ok_or("no folder")?.to_owned();
    let others = std::env::var_os("PATH").unwrap_or_default();
    let all =
        std::env::join_paths(std::iter::once(programs).chain(std::env::split_paths(&others)))?;
    let waits = "lua vim.wait(60000, function() return #vim.diagnostic.get(0) > 0 end, 50) \
                 print(#vim.diagnostic.get(0) > 0 and vim.bo.filetype or 'no diagnostics')";
    let printed = neovim_output(|command| {
        command
            .arg(folder("editors/neovim/lamplight.lua"))
            .args(["main.wesl", "-c", waits, "-c", "qall!"])
            .env("PATH", all);
    })?;
    expect(printed.trim().ends_with("wesl"), &printed)
}
