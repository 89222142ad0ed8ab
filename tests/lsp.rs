//! The language server: a process that is asked over its protocol, and Neovim as a real client.

mod cost;
mod editors;
mod folders;
mod format;
mod glsl;
mod glsl_names;
mod incremental;
mod lines;
mod members;
mod published;
mod session;
mod streams;

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Command;

use folders::folder_that_is_not_there;
use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};
use session::{MAIN, MANIFEST, Session, UTIL};

type Outcome = Result<(), Failed>;

type Run = fn() -> Outcome;

const TESTS: &[(&str, Run)] = &[
    ("diagnostics", diagnostics),
    ("shows_what_lint_reports", published::as_lint),
    ("shows_what_is_broken_elsewhere", published::elsewhere),
    ("hover", hover),
    ("definition", definition),
    ("references_and_rename", references_and_rename),
    ("no_conversation_ends", streams::endless),
    ("the_editor_has_gone", streams::gone),
    ("completion", completion),
    ("members", members::found),
    ("actions", actions),
    ("inactive", inactive),
    ("permutation", permutation),
    ("formatting", format::formatting),
    ("symbols_and_signature", symbols_and_signature),
    ("folder_that_is_not_there", folder_that_is_not_there),
    ("survives", survives),
    ("neovim", neovim),
    ("cost", cost::recorded),
    ("cost_written", cost::written),
    ("incremental", incremental::as_fresh),
    ("module_becomes_item", incremental::module_becomes_item),
    ("item_is_passed_on_too", incremental::item_is_passed_on_too),
    ("long_lines", lines::long_lines),
    ("glsl::hover", glsl::hover),
    ("glsl::definition", glsl::definition),
    ("glsl::completion", glsl::completion),
    ("glsl::symbols", glsl::symbols),
    ("glsl::library", glsl::library),
    ("glsl::references", glsl_names::references),
    ("glsl::rename", glsl_names::rename),
    ("glsl::refused", glsl_names::refused),
    ("glsl::signature", glsl_names::signature),
    ("glsl::workspace", glsl_names::workspace),
    ("editors::guide", editors::guide),
    ("editors::helix", editors::helix),
    ("editors::neovim", editors::neovim),
    ("editors::vscode", editors::vscode),
    ("editors::vsix", editors::vsix),
    ("editors::zed", editors::zed),
];

pub fn tests() -> Vec<Trial> {
    let test = |(name, run): &(&str, Run)| Trial::test(format!("lsp::{name}"), *run);
    TESTS.iter().map(test).collect()
}

/// Fails unless a condition holds, with the place of the call and what the server answered.
#[track_caller]
fn expect(is_so: bool, found: &impl std::fmt::Debug) -> Outcome {
    let place = std::panic::Location::caller();
    if is_so { Ok(()) } else { Err(format!("{place}: unexpected answer: {found:#?}").into()) }
}

fn codes(found: &[Value]) -> Vec<&str> {
    found.iter().filter_map(|found| found["code"].as_str()).collect()
}

/// Errors of syntax, names and types are reported at the author's places, for the permutation that
/// is shown. A file that is closed has none.
fn diagnostics() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let first = session.diagnostics("main.wesl")?;
    expect(codes(&first).iter().all(|code| *code == "inactive"), &first)?;
    session.change(&MAIN.replace("vec4f(sum)", "vec4f(summ)"))?;
    let unknown = session.diagnostics("main.wesl")?;
    let error = unknown.iter().find(|found| found["severity"] == 1).ok_or("no error")?;
    expect(error["range"]["start"] == json!({ "line": 17, "character": 17 }), error)?;
    expect(
        error["message"].as_str().is_some_and(|text| text.contains("permutation `default`")),
        error,
    )?;
    session.change(&MAIN.replace("let up =", "let up"))?;
    session.diagnostics("main.wesl")?;
    session.change(&MAIN.replace("fs_main(", "fs_main"))?;
    let syntax = session.diagnostics("main.wesl")?;
    expect(codes(&syntax).contains(&"unbalanced-bracket"), &syntax)?;
    let used = MAIN.replace("vec4f(sum)", "vec4f(nothing)");
    session.change(&format!("import package::util::nothing;\n{used}"))?;
    let missing = session.diagnostics("main.wesl")?;
    expect(codes(&missing).contains(&"missing-item"), &missing)?;
    let uri = session.uri("main.wesl")?;
    session.notify("textDocument/didClose", json!({ "textDocument": { "uri": uri } }))?;
    let closed = session.diagnostics("main.wesl")?;
    expect(closed.is_empty(), &closed)
}

fn hover() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let text = |found: &Value| found["contents"]["value"].as_str().unwrap_or_default().to_owned();
    let library = text(&session.at("textDocument/hover", MAIN, "lambert(n", json!({}))?);
    expect(library.contains("fn lambert(") && library.contains("**Error model**"), &library)?;
    expect(library.contains("**Source**"), &library)?;
    let own = text(&session.at("textDocument/hover", MAIN, "half(sum)", json!({}))?);
    expect(own.contains("Half of it.") && own.contains("fn half(x: f32) -> f32"), &own)?;
    let axis = text(&session.at("textDocument/hover", MAIN, "cone ==", json!({}))?);
    expect(axis.contains("`hard`, `soft`") && axis.contains("4 permutations"), &axis)?;
    let feature = text(&session.at("textDocument/hover", MAIN, "TINT)", json!({}))?);
    expect(feature.contains("A warm colour."), &feature)?;
    let local = text(&session.at("textDocument/hover", MAIN, "up);", json!({}))?);
    expect(local.contains("let up = vec3f"), &local)
}

fn definition() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let own = session.at("textDocument/definition", MAIN, "half(sum)", json!({}))?;
    expect(own[0]["uri"] == json!(session.uri("util.wesl")?), &own)?;
    expect(own[0]["range"]["start"] == json!({ "line": 1, "character": 3 }), &own)?;
    let local = session.at("textDocument/definition", MAIN, "up);", json!({}))?;
    expect(local[0]["range"]["start"] == json!({ "line": 10, "character": 8 }), &local)?;
    // A module of the library is a file that the editor can open.
    let library = session.at("textDocument/definition", MAIN, "lambert(n", json!({}))?;
    let uri = library[0]["uri"].as_str().unwrap_or_default();
    let line = library[0]["range"]["start"]["line"].as_u64().unwrap_or(0) as usize;
    let text = fs::read_to_string(uri.trim_start_matches("file://"))?;
    expect(text.lines().nth(line).is_some_and(|line| line.starts_with("fn lambert")), &library)
}

/// Words that no declaration can have as its name.
const NO_NAMES: [&str; 15] = [
    "fn", "__x", "_", "", "2x", "a b", "package", "super", "import", "self", "vec4f", "f32",
    "sampler", "NULL", "async",
];

fn references_and_rename() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let context = json!({ "context": { "includeDeclaration": true } });
    let found = session.at("textDocument/references", MAIN, "half(sum)", context)?;
    // The references are the declaration, the import and two calls.
    expect(found.as_array().map(Vec::len) == Some(4), &found)?;
    let renamed =
        session.at("textDocument/rename", MAIN, "half(sum)", json!({ "newName": "halved" }))?;
    let changes = renamed["changes"].as_object().ok_or("no changes")?;
    let count = |name: &str| -> Result<usize, Failed> {
        Ok(changes.get(&session.uri(name)?).and_then(Value::as_array).map_or(0, Vec::len))
    };
    expect(count("main.wesl")? == 3 && count("util.wesl")? == 1, &renamed)?;
    let local =
        session.at("textDocument/rename", MAIN, "sum = lambert", json!({ "newName": "lit" }))?;
    let edits = local["changes"].as_object().and_then(|changes| changes.values().next().cloned());
    expect(edits.as_ref().and_then(Value::as_array).map(Vec::len) == Some(8), &local)?;
    let clashes = [("half(sum)", "fade"), ("half(sum)", "lambert"), ("lambert(n", "other")];
    let unusable = NO_NAMES.map(|new| ("half(sum)", new));
    for (words, new) in clashes.into_iter().chain(unusable) {
        let parameters = session.place(MAIN, words, json!({ "newName": new }))?;
        let refused = session.answer("textDocument/rename", parameters)?;
        let reason = refused.as_ref().err().and_then(|error| error["message"].as_str());
        expect(reason.is_some_and(|reason| reason.contains(' ')), &(words, new, &refused))?;
    }
    Ok(())
}

fn labels(found: &Value) -> Vec<&str> {
    found.as_array().into_iter().flatten().filter_map(|item| item["label"].as_str()).collect()
}

fn completion() -> Outcome {
    let complete = |written: &str| -> Result<Value, Failed> {
        let text = MAIN.replace("    return vec4f(sum);", &format!("    {written}¤"));
        let plain = text.replace('¤', "");
        let mut session = Session::new(&plain)?;
        let parameters = session.place(&text, "¤", json!({}))?;
        session.ask("textDocument/completion", parameters)
    };
    let path = complete("lamplight::brdf::")?;
    expect(labels(&path).contains(&"fresnel"), &labels(&path))?;
    let items = complete("lamplight::brdf::fresnel::")?;
    expect(labels(&items).contains(&"schlick") || labels(&items).len() > 1, &labels(&items))?;
    let own = complete("package::util::ha")?;
    expect(labels(&own) == ["half"], &labels(&own))?;
    let axes = complete("@if(")?;
    expect(["fog", "cone", "TINT"].iter().all(|name| labels(&axes).contains(name)), &axes)?;
    let values = complete("@if(cone == ")?;
    expect(labels(&values) == ["hard", "soft"], &values)?;
    let names = complete("blinn_ph")?;
    let entry = names.as_array().into_iter().flatten().find(|item| item["label"] == "blinn_phong");
    let edit = entry.map(|entry| entry["additionalTextEdits"][0].clone()).unwrap_or_default();
    let import = "import lamplight::brdf::specular::blinn_phong;\n";
    expect(edit["newText"] == import && edit["range"]["start"]["line"] == 2, &names)?;
    let locals = complete("u")?;
    expect(labels(&locals).contains(&"up"), &labels(&locals))
}

fn actions() -> Outcome {
    let calls = "    @if(MISTY) sum = 0.0;\n    return vec4f(phong(n, n, n, 2.0));";
    let text = MAIN
        .replace("    return vec4f(sum);", calls)
        .replace("diffuse::lambert;", "diffuse::{lambert, oren_nayar};");
    let mut session = Session::new(&text)?;
    let published = session.diagnostics("main.wesl")?;
    let parameters = json!({
        "textDocument": { "uri": session.uri("main.wesl")? },
        "range": { "start": { "line": 0, "character": 0 }, "end": { "line": 0, "character": 0 } },
        "context": { "diagnostics": published },
    });
    let found = session.ask("textDocument/codeAction", parameters)?;
    let edit = |title: &str| {
        let found = found.as_array()?.iter().find(|found| found["title"] == title)?;
        Some(found["edit"]["changes"].as_object()?.values().next()?[0]["newText"].clone())
    };
    expect(edit("Declare the feature `MISTY`") == Some(json!("MISTY = false\n")), &found)?;
    let import = "import lamplight::brdf::specular::phong;\n";
    let title = "Import `lamplight::brdf::specular::phong`";
    expect(edit(title) == Some(json!(import)), &(&found, &published))?;
    // The server warns of an unused import, and offers to remove it.
    session.change(&MAIN.replace("diffuse::lambert;", "diffuse::{lambert, oren_nayar};"))?;
    let published = session.diagnostics("main.wesl")?;
    let parameters = json!({
        "textDocument": { "uri": session.uri("main.wesl")? },
        "context": { "diagnostics": published },
    });
    let found = session.ask("textDocument/codeAction", parameters)?;
    let edit = &found[0]["edit"]["changes"][session.uri("main.wesl")?][0];
    expect(found[0]["title"] == "Remove the import of `oren_nayar`", &(&found, &published))?;
    let range = json!({
        "start": { "line": 1, "character": 41 },
        "end": { "line": 1, "character": 53 },
    });
    expect(edit["range"] == range && edit["newText"] == "", edit)
}

fn inactive() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let published = session.diagnostics("main.wesl")?;
    let lines: Vec<u64> = published
        .iter()
        .filter(|found| found["code"] == "inactive" && found["tags"] == json!([1]))
        .filter_map(|found| found["range"]["start"]["line"].as_u64())
        .collect();
    expect(lines == [3, 12, 15, 16], &published)?;
    let document = json!({ "textDocument": { "uri": session.uri("main.wesl")? } });
    let tokens = session.ask("textDocument/semanticTokens/full", document.clone())?;
    // The inactive lines are four of a function, three of a block and two statements. Each token
    // has five numbers.
    expect(tokens["data"].as_array().map(Vec::len) == Some(9 * 5), &tokens)?;
    let hints = session.ask("textDocument/inlayHint", document)?;
    expect(hints.as_array().map(Vec::len) == Some(4), &hints)
}

fn permutation() -> Outcome {
    let mut session = Session::new(MAIN)?;
    session.diagnostics("main.wesl")?;
    let uri = session.uri("main.wesl")?;
    let wrong = json!({ "uri": uri, "set": "fog,,cone" });
    expect(session.answer("lamplight/permutation", wrong)?.is_err(), &"a part without an axis")?;
    let parameters = json!({ "uri": uri, "set": "cone = soft , fog" });
    let chosen = session.ask("lamplight/permutation", parameters)?;
    expect(
        chosen["values"]["fog"] == "true" && chosen["axes"]["cone"]["values"][1] == "soft",
        &chosen,
    )?;
    let published = session.diagnostics("main.wesl")?;
    expect(published.iter().filter(|found| found["code"] == "inactive").count() == 1, &published)?;
    let command = json!({ "command": "lamplight.composed", "arguments": [uri] });
    let text = session.ask("workspace/executeCommand", command)?;
    expect(text.as_str().is_some_and(|text| text.contains("sum = fade(sum);")), &text)?;
    let document = json!({ "textDocument": { "uri": uri } });
    let lenses = session.ask("textDocument/codeLens", document)?;
    expect(lenses[0]["command"]["title"] == "4 permutations: composed text", &lenses)
}

fn symbols_and_signature() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let document = json!({ "textDocument": { "uri": session.uri("main.wesl")? } });
    let symbols = session.ask("textDocument/documentSymbol", document)?;
    let names: Vec<&str> = symbols
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|found| found["name"].as_str())
        .collect();
    expect(names == ["fade", "fs_main"], &symbols)?;
    let all = session.ask("workspace/symbol", json!({ "query": "hal" }))?;
    expect(all.as_array().into_iter().flatten().any(|found| found["name"] == "half"), &all)?;
    let signature = session.at("textDocument/signatureHelp", MAIN, " up);", json!({}))?;
    expect(signature["activeParameter"] == 1, &signature)?;
    let label = signature["signatures"][0]["label"].as_str().unwrap_or_default();
    expect(label.starts_with("fn lambert(") && label.contains("f32"), &signature)
}

/// After any wrong message and any broken text, the server answers the next request.
fn survives() -> Outcome {
    let mut session = Session::new(MAIN)?;
    session.diagnostics("main.wesl")?;
    send_garbage(&mut session)?;
    let deep = "(".repeat(100_000);
    let halves: Vec<String> = (0..MAIN.len()).step_by(37).map(|at| MAIN[..at].to_owned()).collect();
    let texts = halves.into_iter().chain([deep, "/*".to_owned(), "\u{feff}@if(".to_owned()]);
    for text in texts {
        session.change(&text)?;
        ask_beyond_the_end(&mut session, &text)?;
    }
    for method in ["textDocument/hover", "textDocument/rename", "no/such", "lamplight/permutation"]
    {
        let refused = session.answer(method, json!({ "position": -1 }))?;
        expect(refused.is_err(), &(method, refused))?;
    }
    session.change(MAIN)?;
    let hover = session.at("textDocument/hover", MAIN, "half(sum)", json!({}))?;
    expect(hover["contents"]["value"].is_string(), &hover)?;
    session.ask("shutdown", Value::Null)?;
    session.notify("exit", Value::Null)?;
    let status = session.child.wait()?;
    expect(status.success(), &status)
}

/// Bytes that are no messages, and messages that mean nothing.
fn send_garbage(session: &mut Session) -> Outcome {
    let raw: &[&[u8]] = &[
        b"Content-Length: 5\r\n\r\n{\"a\":",
        b"Content-Length: nonsense\r\n\r\n",
        b"Content-Length: -5\r\n\r\n{\"a\"}",
        b"Content-Type: application/vscode-jsonrpc\r\n\r\n{\"jsonrpc\":\"2.0\",\"id\":7}",
        b"garbage\r\n\r\nContent-Length: 2\r\n\r\n[]",
        b"Content-Length: 4\r\n\r\nnull",
        b"Content-Length: 3\r\n\r\n\xff\xfe\xfd",
    ];
    for bytes in raw {
        session.to.as_mut().ok_or("closed")?.write_all(bytes)?;
    }
    for message in [
        json!({ "jsonrpc": "2.0", "id": "x", "method": 3 }),
        json!({ "jsonrpc": "2.0", "method": "textDocument/didChange", "params": [1, 2] }),
        json!({ "jsonrpc": "2.0", "method": "textDocument/didOpen",
            "params": { "textDocument": { "uri": "untitled:1", "text": "fn" } } }),
        json!({ "jsonrpc": "2.0", "id": 1, "result": null }),
    ] {
        session.send(&message)?;
    }
    Ok(())
}

/// Each question about a place beyond the end of the text is answered.
fn ask_beyond_the_end(session: &mut Session, text: &str) -> Outcome {
    for method in [
        "textDocument/hover",
        "textDocument/completion",
        "textDocument/definition",
        "textDocument/formatting",
        "textDocument/codeLens",
        "textDocument/signatureHelp",
    ] {
        let mut parameters = session.place(MAIN, "import", json!({}))?;
        parameters["position"] = json!({ "line": text.matches('\n').count(), "character": 9999 });
        let answered = session.answer(method, parameters)?;
        expect(answered.is_ok(), &(method, answered))?;
    }
    Ok(())
}

/// What Neovim prints, run without a screen in a package with a mistake in `main.wesl`.
/// `cargo xtask test` installs it.
fn neovim_output(arguments: impl FnOnce(&mut Command)) -> Result<String, Failed> {
    let folder = tempfile::tempdir()?;
    let root = folder.path().canonicalize()?;
    fs::write(root.join("lamplight.toml"), MANIFEST)?;
    fs::write(root.join("util.wesl"), UTIL)?;
    fs::write(root.join("main.wesl"), MAIN.replace("vec4f(sum)", "vec4f(summ)"))?;
    let mut command = Command::new("nvim");
    command
        .args(["--headless", "--clean", "-u"])
        .env("XDG_CACHE_HOME", root.join("cache"))
        .env("XDG_STATE_HOME", root.join("state"))
        .current_dir(&root);
    arguments(&mut command);
    let output = command
        .output()
        .map_err(|error| format!("nvim: {error}; install it with: apt-get install neovim"))?;
    Ok(String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned())
}

/// Neovim uses the server.
fn neovim() -> Outcome {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lsp/neovim.lua");
    let printed = neovim_output(|command| {
        command
            .args(["NONE", "-c"])
            .arg(format!("luafile {}", script.display()))
            .arg("main.wesl")
            .env("LAMPLIGHT", env!("CARGO_BIN_EXE_lamplight"));
    })?;
    let expected =
        ["diagnostics: ok", "hover: ok", "definition: ok", "rename: ok", "completion: ok"];
    expect(expected.iter().all(|line| printed.contains(line)), &printed)
}
