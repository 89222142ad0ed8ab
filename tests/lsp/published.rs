//! What `lint` reports, the editor shows: at open files, at closed ones, and at those that declare a
//! package.

use std::collections::BTreeMap;
use std::fs;
use std::process::Command;

use libtest_mimic::Failed;
use serde_json::{Value, json};

use super::session::{MAIN, Session};
use super::{Outcome, expect};

/// Modules that are invalid, each for another reason.
const INVALID: &[(&str, &str)] = &[
    ("syntax", "fn f( -> f32 { return 1.0; }"),
    ("type", "fn f() -> f32 { return 1u; }"),
    ("name", "fn f() -> f32 { return nothing; }"),
    ("call", "fn g(a: f32) -> f32 { return a; }\nfn f() -> f32 { return g(1.0, 2.0); }"),
    ("kind", "struct S { a: f32 }\nfn f(s: S) -> f32 { return s.b; }"),
    ("assign", "fn f() { let a = 1.0; a = 2.0; }"),
    ("twice", "const a = 1;\nconst a = 2;"),
    ("cycle", "fn f() { g(); }\nfn g() { f(); }"),
    ("cycle_and_type", "const a = b;\nconst b = a;\nfn f() -> f32 { return 1u; }"),
    ("import", "import package::util::nothing;\nfn f() -> f32 { return nothing(); }"),
    ("position", "@vertex fn f() -> @location(0) vec4f { return vec4f(); }"),
    ("location_out", "@fragment fn f() -> vec4f { return vec4f(); }"),
    ("location_in", "@fragment fn f(a: f32) -> @location(0) vec4f { return vec4f(a); }"),
    (
        "location_twice",
        "@fragment fn f(@location(0) a: f32, @location(0) b: f32) -> @location(0) vec4f {\n\
         return vec4f(a + b); }",
    ),
    ("flat", "@fragment fn f(@location(0) a: i32) -> @location(0) vec4f { return vec4f(f32(a)); }"),
    (
        "stage_of_built_in",
        "@fragment fn f(@builtin(vertex_index) a: u32) -> @location(0) vec4f {\n\
         return vec4f(f32(a)); }",
    ),
    (
        "type_of_built_in",
        "@vertex fn f(@builtin(vertex_index) a: f32) -> @builtin(position) vec4f {\n\
         return vec4f(a); }",
    ),
    ("depth", "@fragment fn f() -> @builtin(frag_depth) vec4f { return vec4f(); }"),
    (
        "derivative",
        "// A comment with f in it.\n@vertex fn f(@location(0) a: f32) -> @builtin(position) vec4f {\n\
         return vec4f(dpdx(a)); }",
    ),
    (
        "sample",
        "@group(0) @binding(0) var t: texture_2d<f32>;\n@group(0) @binding(1) var s: sampler;\n\
         fn look() -> vec4f { return textureSample(t, s, vec2f()); }\n\
         @vertex fn f() -> @builtin(position) vec4f { return look(); }",
    ),
    ("discard", "@vertex fn f() -> @builtin(position) vec4f { discard; return vec4f(); }"),
    ("barrier", "@fragment fn f() -> @location(0) vec4f { workgroupBarrier(); return vec4f(); }"),
    ("workgroup", "@compute @workgroup_size(0) fn f() {}"),
    ("result", "@compute @workgroup_size(1) fn f() -> @location(0) f32 { return 1.0; }"),
    (
        "binding",
        "@group(0) @binding(0) var<uniform> a: f32;\n@group(0) @binding(0) var<uniform> b: f32;\n\
         @fragment fn f() -> @location(0) vec4f { return vec4f(a + b); }",
    ),
    ("attribute", "@fragmen fn f() {}"),
    ("condition", "@if(FLAG &&) fn f() {}"),
    (
        "discard.vert",
        "#version 450\nvoid main() { if (gl_VertexIndex > 0) discard; gl_Position = vec4(1.0); }",
    ),
    ("derivative.vert", "#version 450\nvoid main() { gl_Position = vec4(dFdx(1.0)); }"),
    ("shared.frag", "#version 450\nshared float a;\nvoid main() { a = 1.0; }"),
    ("barrier.frag", "#version 450\nvoid main() { barrier(); }"),
    (
        "location_twice.frag",
        "#version 450\nlayout(location = 0) out vec4 a;\nlayout(location = 0) out vec4 b;\n\
         void main() { a = vec4(1.0); b = vec4(1.0); }",
    ),
];

/// Modules that naga accepts and browsers refuse, or that draw nothing. Each has a warning.
const DOUBTFUL: &[(&str, &str)] = &[
    (
        "memory",
        "var<workgroup> a: f32;\n@fragment fn f() -> @location(0) vec4f { return vec4f(a); }",
    ),
    ("atomic", "var<workgroup> a: atomic<u32>;\n@compute @workgroup_size(1) fn f() { a = 1u; }"),
    (
        "high_location",
        "@fragment fn f(@location(40) a: f32) -> @location(0) vec4f { return vec4f(a); }",
    ),
    ("unplaced.vert", "#version 450\nvoid main() {}"),
];

/// The file of a module, which is in WESL if the name does not say otherwise.
fn file_of(name: &str) -> String {
    if name.contains('.') { name.to_owned() } else { format!("{name}.wesl") }
}

/// The severity, code and line of what is shown at each file, without hints.
type Shown = BTreeMap<String, Vec<(u64, String, u64)>>;

fn shown_of(diagnostics: &[Value]) -> Vec<(u64, String, u64)> {
    let mut shown: Vec<_> = diagnostics
        .iter()
        .filter(|found| found["code"] != "inactive")
        .map(|found| {
            let code = found["code"].as_str().unwrap_or_default().to_owned();
            let line = found["range"]["start"]["line"].as_u64().unwrap_or(0) + 1;
            (found["severity"].as_u64().unwrap_or(0), code, line)
        })
        .collect();
    shown.sort();
    shown
}

/// What `lint` reports about a folder.
fn linted(session: &Session) -> Result<Shown, Failed> {
    let output = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(["lint", "--diagnostics", "json"])
        .current_dir(session.folder.path())
        .output()?;
    let text = String::from_utf8(output.stderr)?;
    let mut shown = Shown::new();
    for line in text.lines().filter(|line| line.starts_with('{')) {
        let found: Value = serde_json::from_str(line)?;
        let label = &found["labels"][0];
        let file = label["file"].as_str().ok_or_else(|| format!("no place: {line}"))?;
        let name = file.rsplit('/').next().unwrap_or(file).to_owned();
        let severity = if found["severity"] == "error" { 1 } else { 2 };
        let code = found["code"].as_str().unwrap_or_default().to_owned();
        let line = label["line"].as_u64().unwrap_or(0);
        shown.entry(name).or_default().push((severity, code, line));
    }
    shown.values_mut().for_each(|found| found.sort());
    Ok(shown)
}

/// Every invalid module has its errors while it is closed, and the same ones when it is opened.
pub fn as_lint() -> Outcome {
    let mut session = Session::new(MAIN)?;
    session.diagnostics("main.wesl")?;
    let mut modules: Vec<(String, &str)> =
        INVALID.iter().chain(DOUBTFUL).map(|(name, text)| (file_of(name), *text)).collect();
    for (file, text) in &modules {
        fs::write(session.folder.path().join(file), text)?;
    }
    let linted = linted(&session)?;
    session.notify("workspace/didChangeWatchedFiles", json!({ "changes": [] }))?;
    let mut differences = Vec::new();
    // Closed files are analysed one after another, by name.
    modules.sort();
    for (file, _) in &modules {
        let closed = shown_of(&session.diagnostics(file)?);
        differences.extend(difference(file, "closed", &linted, &closed));
    }
    for (file, text) in &modules {
        session.open(file, text)?;
        let open = shown_of(&session.diagnostics(file)?);
        differences.extend(difference(file, "open", &linted, &open));
    }
    if differences.is_empty() { Ok(()) } else { Err(differences.join("\n").into()) }
}

fn difference(
    file: &str,
    state: &str,
    linted: &Shown,
    shown: &[(u64, String, u64)],
) -> Option<String> {
    let reported = linted.get(file).map(Vec::as_slice).unwrap_or_default();
    let is_doubtful = DOUBTFUL.iter().any(|(name, _)| file_of(name) == file);
    let least = if is_doubtful { 2 } else { 1 };
    let is_silent = !reported.iter().any(|(severity, ..)| *severity == least);
    match reported == shown && !is_silent {
        true => None,
        false => Some(format!("{file}, {state}: `lint` has {reported:?}, the editor {shown:?}")),
    }
}

/// A change of another file, and the file that has the error.
type Broken = (&'static str, &'static str, &'static str);

const BROKEN: &[Broken] = &[
    ("a manifest with a syntax error", "wesl.toml", "[dependencies\n"),
    (
        "a dependency that is missing",
        "wesl.toml",
        "[package]\nname = \"p\"\nedition = \"2026_pre\"\nroot = \".\"\n\
         [dependencies]\nfar = { path = \"far\" }\n",
    ),
    ("an unknown key", "lamplight.toml", "[program.lamp]\nwesl = \"main.wesl\"\ncolour = 1\n"),
    ("an import that does not parse", "util.wesl", "fn half(x: f32) -> f32 {\n"),
    ("an import with a wrong type", "util.wesl", "fn half(x: f32) -> f32 {\n    return 1u;\n}\n"),
];

/// The module that is open. It uses what it imports.
const USER: &str = "import package::util::half;\n\n@fragment\nfn fs_main() -> @location(0) vec4f {\n\
                    \u{20}   return vec4f(half(1.0));\n}\n";

/// A document has an error where another file of its package is broken, and so has that file, though
/// it is closed. Both go when the file is mended.
pub fn elsewhere() -> Outcome {
    for (what, file, text) in BROKEN {
        let mut session = Session::new(USER)?;
        let fine = session.diagnostics("main.wesl")?;
        expect(shown_of(&fine).is_empty(), &(what, &fine))?;
        let path = session.folder.path().join(file);
        let before = fs::read_to_string(&path).ok();
        fs::write(&path, text)?;
        session.notify("workspace/didChangeWatchedFiles", json!({ "changes": [] }))?;
        let is_error = |found: &Value| found["severity"] == 1;
        let has_error = |shown: &[Value]| shown.iter().any(is_error);
        let (here, _) = until(&mut session, file, has_error)?;
        let error = here.iter().find(|found| is_error(found)).ok_or(*what)?;
        let related = &error["relatedInformation"][0]["location"]["uri"];
        expect(*related == json!(session.uri(file)?), &(what, error))?;
        expect(error["message"].as_str().is_some_and(|text| text.contains(file)), error)?;
        match before {
            Some(before) => fs::write(&path, before)?,
            None => fs::remove_file(&path)?,
        }
        session.notify("workspace/didChangeWatchedFiles", json!({ "changes": [] }))?;
        until(&mut session, file, |shown| shown_of(shown).is_empty())?;
    }
    Ok(())
}

/// The diagnostics of the open module and of another file, once both are as they must become.
fn until(
    session: &mut Session,
    file: &str,
    holds: impl Fn(&[Value]) -> bool,
) -> Result<(Vec<Value>, Vec<Value>), Failed> {
    let addresses = [session.uri("main.wesl")?, session.uri(file)?];
    let mut last: [Option<Vec<Value>>; 2] = [None, None];
    for _ in 0..MESSAGES {
        let message = session.receive()?;
        let parameters = &message["params"];
        if message["method"] == "textDocument/publishDiagnostics"
            && let Some(at) = addresses.iter().position(|uri| parameters["uri"] == json!(uri))
        {
            last[at] = Some(parameters["diagnostics"].as_array().cloned().unwrap_or_default());
        }
        if let [Some(here), Some(there)] = &last
            && holds(here)
            && holds(there)
        {
            return Ok((here.clone(), there.clone()));
        }
    }
    Err(format!("`main.wesl` and `{file}` have {last:?} after {MESSAGES} messages").into())
}

/// The most messages of the server about one change.
const MESSAGES: usize = 20;
