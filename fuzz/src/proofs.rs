//! What goes into numeric cases and pictures. The crate needs its harness for these, which `cargo
//! xtask` does without: it fuzzes the same from outside.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use lamplight::bundle::Language;
use lamplight::diagnostic::render::{Form, render};
use lamplight::execute::executors;
use lamplight::proof::check::{Open, failures, failures_as_text};
use lamplight::proof::library::Library;
use lamplight::scene::Equirect;
use lamplight::source::{Memory, SourceSet};

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
];

const MODULE: &str = "fn one(x: f32) -> f32 { return x; }\n\
    fn four(v: vec4f) -> f32 { return v.x; }\nfn nothing() -> f32 { return 1.0; }\n";

/// A case file over a module of three functions, on the evaluator.
fn cases(bytes: &[u8]) -> String {
    let files = [("m.wesl", MODULE.to_owned()), ("m.toml", text(bytes))];
    let files: BTreeMap<String, String> =
        files.into_iter().map(|(name, text)| (name.to_owned(), text)).collect();
    let library = Library::new("package", Arc::new(Memory(files)), Vec::new());
    let sources = Mutex::new(SourceSet::default());
    let opened = executors::find("eval").and_then(|entry| entry.start().ok());
    let mut open: Vec<Open> =
        opened.map(|session| Open { executor: "eval", session }).into_iter().collect();
    match library.check(&sources, &["m.toml".to_owned()], &[Language::Wesl], &mut open) {
        Ok(report) => format!("{} {}", report.outcomes.len(), failures_as_text(&failures(&report))),
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
