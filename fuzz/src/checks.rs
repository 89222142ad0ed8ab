//! The kinds of input for numeric cases, pictures, models and the language server. They need the
//! crate with its feature for the harness. `cargo xtask` is built without this feature and fuzzes
//! these kinds through the tool.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use lamplight::bundle::Language;
use lamplight::check::check::{OpenExecutor, failures_as_text, report_failures};
use lamplight::check::library::Library;
use lamplight::diagnostic::render::{Form, render};
use lamplight::execute::executors;
use lamplight::lsp::LanguageServer;
use lamplight::model::View;
use lamplight::picture::Picture;
use lamplight::scene::Equirect;
use lamplight::source::{Memory, SourceSet};
use serde_json::{Value, json};

use super::kinds::Kind;

/// Every kind.
pub const KINDS: &[Kind] = &[
    Kind {
        name: "cases",
        corpus: &[("tests/regressions/cases", ""), ("shaderlib", ".toml")],
        words: "[[case]] function inputs values grid log random unit hemisphere grazing same",
        run: cases,
    },
    Kind {
        name: "picture",
        corpus: &[("tests/regressions/picture", "")],
        words: "#?RADIANCE FORMAT=32-bit_rle_rgbe -Y +X",
        run: picture,
    },
    Kind {
        name: "model",
        corpus: &[("tests/regressions/model", "")],
        words: "{} [] \"count\": \"byteOffset\": \"byteLength\": \"byteStride\": \"children\": \"mesh\": \"mode\": \
            \"sparse\": \"normalized\": true 5120 5121 5122 5123 5125 5126 \"SCALAR\" \"MAT4\" 0 -1 1e308 4294967295 \
            18446744073709551615 \"uri\": \"data:,\"",
        run: model,
    },
    Kind {
        name: "lsp",
        corpus: &[
            ("tests/regressions/lsp", ""),
            ("crates/compose/tests/compose_wesl", ".wesl"),
            ("shaderlib", ".wesl"),
            ("crates/compose/tests/compose_glsl", ".glsl"),
            ("shaderlib", ".glsl"),
        ],
        words: "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"textDocument/hover\",\"params\":{}} position line \
            character -1 4294967295 import package:: lamplight:: @if( constants:: fn struct { } ( ) ; \
            #include <lamplight/brdf/diffuse.glsl> #if #ifdef #define #endif #version vec3 float",
        run: lsp,
    },
];

const MODULE: &str = "fn one(x: f32) -> f32 { return x; }\n\
    fn four(v: vec4f) -> f32 { return v.x; }\nfn nothing() -> f32 { return 1.0; }\n";

/// Runs the input as a case file for a module of three functions, on the evaluator.
fn cases(bytes: &[u8]) -> String {
    let files = [("m.wesl", MODULE.to_owned()), ("m.toml", text(bytes))];
    let files: BTreeMap<String, String> =
        files.into_iter().map(|(name, text)| (name.to_owned(), text)).collect();
    let library = Library::new("package", Arc::new(Memory(files)), Vec::new());
    let sources = Mutex::new(SourceSet::default());
    let opened = executors::find_executor("eval").and_then(|entry| entry.start().ok());
    let mut open: Vec<OpenExecutor> =
        opened.map(|session| OpenExecutor { executor: "eval", session }).into_iter().collect();
    match library.check(&sources, &["m.toml".to_owned()], &[Language::Wesl], &mut open) {
        Ok(report) => {
            format!("{} {}", report.outcomes.len(), failures_as_text(&report_failures(&report)))
        }
        Err(problems) => {
            let sources = sources.into_inner().unwrap_or_default();
            [Form::Human, Form::Json].map(|form| render(&sources, &problems, form)).concat()
        }
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn picture(bytes: &[u8]) -> String {
    Equirect::from_radiance(bytes).err().unwrap_or_default()
}

/// Reads a glTF model whose JSON is the input and whose binary part has a square and an image.
fn model(bytes: &[u8]) -> String {
    let mut text = bytes.to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let chunk =
        |kind: &[u8], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), kind, bytes].concat();
    let body = [chunk(b"JSON", &text), chunk(b"BIN\0", &square())].concat();
    let length = (body.len() as u32 + 12).to_le_bytes();
    let file = [b"glTF".as_slice(), &2_u32.to_le_bytes(), &length, &body].concat();
    match lamplight::model::read_model(&file, View::Own) {
        Ok(model) => format!("{:?} {:?} {:?}", model.notes, model.axes, model.scene.eye),
        Err(problem) => problem,
    }
}

/// The binary part of a model: four vertices with a position and texture coordinates, the indices of
/// two triangles, and an image of one pixel.
fn square() -> Vec<u8> {
    let corners: [[f32; 5]; 4] = [
        [-1.0, 1.0, 0.0, 0.0, 0.0],
        [-1.0, -1.0, 0.0, 0.0, 1.0],
        [1.0, -1.0, 0.0, 1.0, 1.0],
        [1.0, 1.0, 0.0, 1.0, 0.0],
    ];
    let indices: [u16; 6] = [0, 1, 2, 0, 2, 3];
    let mut buffer: Vec<u8> =
        corners.concat().iter().flat_map(|number| number.to_le_bytes()).collect();
    buffer.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
    let pixel = Picture { width: 1, height: 1, pixels: vec![128; 3] };
    buffer.extend(pixel.png().unwrap_or_default());
    buffer.resize(256, 0);
    buffer
}

const WESL: &str = "file:///no/such/folder/lamp.wesl";
const GLSL: &str = "file:///no/such/folder/lamp.frag";

/// The requests that are made at places all over each new text.
const QUESTIONS: &[&str] = &[
    "textDocument/hover",
    "textDocument/completion",
    "textDocument/definition",
    "textDocument/references",
    "textDocument/signatureHelp",
    "textDocument/prepareRename",
];

/// The requests that are made about each new text as a whole.
const VIEWS: &[&str] = &[
    "textDocument/documentSymbol",
    "textDocument/formatting",
    "textDocument/semanticTokens/full",
    "textDocument/codeLens",
];

/// The number of places in a text at which requests are made.
const PLACES: usize = 4;

/// Runs the input as a conversation with an editor. A line that is a JSON object is a message of the
/// editor. The lines between two such messages are a new text of one of the editor's two files: of
/// the GLSL file if the text has a directive, which WESL does not know, and of the WESL file if not.
fn lsp(bytes: &[u8]) -> String {
    let mut server = LanguageServer::new(Box::new(|_| None), lamplight::LIBRARY_FILES);
    let mut answers = String::new();
    let mut edited = String::new();
    let all = text(bytes);
    for line in all.lines().chain(["{}"]) {
        match serde_json::from_str(line) {
            Ok(Value::Object(message)) => {
                let new = std::mem::take(&mut edited);
                if !new.is_empty() {
                    converse(&mut server, &new, &mut answers);
                }
                say(&mut server, &Value::Object(message), &mut answers);
            }
            _ => {
                edited.push_str(line);
                edited.push('\n');
            }
        }
    }
    answers
}

/// Sends a new text, waits for its diagnostics, and makes the requests about it.
fn converse(server: &mut LanguageServer, new: &str, answers: &mut String) {
    let is_glsl = new.lines().any(|line| line.trim_start().starts_with('#'));
    let uri = if is_glsl { GLSL } else { WESL };
    let document = json!({ "uri": uri, "version": 1, "text": new });
    let opened =
        json!({ "method": "textDocument/didOpen", "params": { "textDocument": document } });
    say(server, &opened, answers);
    while !server.is_idle() {
        server.look().iter().for_each(|message| answers.push_str(&message.to_string()));
    }
    let lines: Vec<&str> = new.lines().collect();
    let document = json!({ "uri": uri });
    for part in 0..PLACES {
        let line = lines.len() * part / PLACES;
        let length = lines.get(line).map_or(0, |line| line.chars().count());
        let place = json!({ "line": line, "character": length * (part + 1) / PLACES });
        let parameters = json!({ "textDocument": document, "position": place, "context": {} });
        ask(server, QUESTIONS, &parameters, answers);
    }
    ask(server, VIEWS, &json!({ "textDocument": document, "options": {} }), answers);
}

fn ask(server: &mut LanguageServer, methods: &[&str], parameters: &Value, answers: &mut String) {
    for method in methods {
        say(server, &json!({ "id": 1, "method": method, "params": parameters }), answers);
    }
}

/// Sends a message to the server and appends its answers.
fn say(server: &mut LanguageServer, message: &Value, answers: &mut String) {
    server.receive(message).iter().for_each(|answer| answers.push_str(&answer.to_string()));
}
