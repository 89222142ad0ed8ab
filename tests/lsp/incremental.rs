//! A server that keeps what a keystroke does not change answers as one that begins with the same
//! texts: after each of many random edits, both are asked the same.
//!
//! `LAMPLIGHT_LSP_EDITS` gives another number of edits, `LAMPLIGHT_LSP_SEED` another seed.

mod texts;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::PathBuf;

use lamplight::lsp::LanguageServer;
use libtest_mimic::Failed;
use serde_json::{Value, json};
use tempfile::TempDir;

use super::Outcome;
use texts::{FILES, MANIFEST, MANIFESTS, PIECES, file_name, source};

const EDITS: usize = 80;
const QUESTIONS: &[&str] = &[
    "textDocument/hover",
    "textDocument/definition",
    "textDocument/references",
    "textDocument/completion",
    "textDocument/signatureHelp",
    "textDocument/prepareRename",
];

const OF_FILES: &[&str] = &[
    "textDocument/documentSymbol",
    "textDocument/semanticTokens/full",
    "textDocument/inlayHint",
    "textDocument/codeLens",
    "textDocument/formatting",
];

struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        ((self.0 >> 33) as usize) % bound.max(1)
    }
}

/// A server in this process, with the diagnostics that it published last for each file.
struct Editor {
    server: LanguageServer,
    published: BTreeMap<String, Value>,
}

impl Editor {
    fn new() -> Self {
        Self {
            server: LanguageServer::new(Box::new(|_| None), lamplight::LIBRARY_FILES),
            published: BTreeMap::new(),
        }
    }

    fn notify(&mut self, method: &str, parameters: Value) {
        self.server.receive(&json!({ "jsonrpc": "2.0", "method": method, "params": parameters }));
    }

    fn open(&mut self, uri: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": "wesl", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    fn ask(&mut self, method: &str, parameters: &Value) -> Value {
        let message = json!({ "jsonrpc": "2.0", "id": 1, "method": method, "params": parameters });
        self.server.receive(&message).pop().unwrap_or_default()
    }

    /// Lets the server check all files, and stores the diagnostics that it publishes for each.
    fn look(&mut self) {
        while !self.server.is_idle() {
            for message in self.server.look() {
                let uri = message["params"]["uri"].as_str().unwrap_or_default().to_owned();
                self.published.insert(uri, message["params"]["diagnostics"].clone());
            }
        }
    }
}

/// A package, a server that has been asked about it all the time, and the texts of the editor.
struct Editing {
    folder: TempDir,
    editor: Editor,
    open: BTreeMap<usize, String>,
    chosen: Option<&'static str>,
    random: Random,
    /// The requests that had an answer that is not empty at least once.
    answered: BTreeSet<&'static str>,
}

impl Editing {
    fn new(seed: u64) -> Result<Self, Failed> {
        let folder = tempfile::tempdir()?;
        fs::write(folder.path().join("lamplight.toml"), MANIFEST)?;
        for index in 0..FILES {
            fs::write(folder.path().join(file_name(index)), source(index))?;
        }
        let random = Random(seed);
        let mut editing = Self {
            folder,
            editor: Editor::new(),
            open: BTreeMap::new(),
            chosen: None,
            random,
            answered: BTreeSet::new(),
        };
        for index in [5, 3, FILES - 1] {
            editing.open.insert(index, source(index));
            let uri = editing.uri(index)?;
            editing.editor.open(&uri, &source(index));
        }
        Ok(editing)
    }

    fn path(&self, index: usize) -> Result<PathBuf, Failed> {
        Ok(self.folder.path().canonicalize()?.join(file_name(index)))
    }

    fn uri(&self, index: usize) -> Result<String, Failed> {
        Ok(format!("file://{}", self.path(index)?.display()))
    }

    /// A text with something put in, taken out, or written anew.
    fn edited(&mut self, text: &str, index: usize) -> String {
        let places: Vec<usize> =
            text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
        let at = places[self.random.below(places.len())];
        let piece = PIECES[self.random.below(PIECES.len())];
        match self.random.below(8) {
            0 => source(index),
            1 | 2 => {
                let end = places[self.random.below(places.len())].max(at);
                let end = text.floor_char_boundary(end.min(at + 12));
                format!("{}{}", &text[..at], &text[end..])
            }
            3 => {
                let line = text[..at].rfind('\n').map_or(0, |end| end + 1);
                format!("{}{piece}{}", &text[..line], &text[line..])
            }
            _ => format!("{}{piece}{}", &text[..at], &text[at..]),
        }
    }

    fn step(&mut self) -> Outcome {
        let index = self.random.below(FILES);
        let uri = self.uri(index)?;
        match (self.random.below(12), self.open.get(&index).cloned()) {
            (0, _) => {
                self.chosen = Some(["fog=true", "cone=soft,TINT=true", ""][self.random.below(3)]);
                let (first, set) = (self.first_uri()?, self.chosen);
                self.editor.ask("lamplight/permutation", &json!({ "uri": first, "set": set }));
            }
            (1, None) => {
                let manifest = MANIFESTS[self.random.below(MANIFESTS.len())];
                fs::write(self.folder.path().join("lamplight.toml"), manifest)?;
                self.editor.notify("workspace/didChangeWatchedFiles", json!({ "changes": [] }));
            }
            (5..=7, None) => self.change_silently(index)?,
            (1, Some(_)) if self.open.len() > 1 => {
                self.open.remove(&index);
                let document = json!({ "textDocument": { "uri": uri } });
                self.editor.notify("textDocument/didClose", document);
                self.editor.published.remove(&uri);
            }
            (2..=4, None) => {
                let text = fs::read_to_string(self.path(index)?)?;
                self.editor.open(&uri, &text);
                self.open.insert(index, text);
            }
            (_, None) => {
                let text = fs::read_to_string(self.path(index)?)?;
                let text = self.edited(&text, index);
                fs::write(self.path(index)?, &text)?;
                self.editor.notify("workspace/didChangeWatchedFiles", json!({ "changes": [] }));
            }
            (_, Some(text)) => {
                let text = self.edited(&text, index);
                let change = json!({
                    "textDocument": { "uri": uri, "version": 2 },
                    "contentChanges": [{ "text": text }],
                });
                self.editor.notify("textDocument/didChange", change);
                self.open.insert(index, text);
            }
        }
        Ok(())
    }

    /// Changes a file on the disk, often to one that is as long, and tells the server nothing of it.
    /// The next keystroke in a document that reads the file notices it, so one is made in each.
    fn change_silently(&mut self, index: usize) -> Outcome {
        let text = fs::read_to_string(self.path(index)?)?;
        let text = match self.random.below(4) {
            0 => self.edited(&text, index),
            1 => text.replace("sum", "sun"),
            2 => text.replace("fog", "fug"),
            _ => text.replace("term", "turn"),
        };
        fs::write(self.path(index)?, &text)?;
        for (other, text) in self.open.clone() {
            let text = format!("{text}\n");
            let change = json!({
                "textDocument": { "uri": self.uri(other)?, "version": 3 },
                "contentChanges": [{ "text": text }],
            });
            self.editor.notify("textDocument/didChange", change);
            self.open.insert(other, text);
        }
        Ok(())
    }

    fn first_uri(&self) -> Result<String, Failed> {
        self.uri(*self.open.keys().next().ok_or("nothing is open")?)
    }

    /// A new server that has seen only the current texts.
    fn fresh(&self) -> Result<Editor, Failed> {
        let mut fresh = Editor::new();
        for (index, text) in &self.open {
            fresh.open(&self.uri(*index)?, text);
        }
        if let Some(set) = self.chosen {
            fresh.ask("lamplight/permutation", &json!({ "uri": self.first_uri()?, "set": set }));
        }
        Ok(fresh)
    }

    fn compare(&mut self, step: usize) -> Outcome {
        let mut fresh = self.fresh()?;
        self.editor.look();
        fresh.look();
        let open = self.open.clone();
        for (index, text) in &open {
            let uri = self.uri(*index)?;
            let new = fresh
                .published
                .get(&uri)
                .ok_or("a fresh server published nothing for an open file")?;
            differs(step, "diagnostics", text, self.editor.published.get(&uri), new)?;
            self.note_answer("diagnostics", new);
            let line = self.random.below(text.lines().count() + 1);
            let character = self.random.below(30);
            let parameters = json!({
                "textDocument": { "uri": uri },
                "position": { "line": line, "character": character },
                "context": { "includeDeclaration": true },
            });
            for method in QUESTIONS.iter().chain(OF_FILES) {
                let kept = self.editor.ask(method, &parameters);
                let new = fresh.ask(method, &parameters);
                differs(step, method, text, Some(&kept), &new)?;
                self.note_answer(method, &new["result"]);
            }
        }
        let query = json!({ "query": "term" });
        let kept = self.editor.ask("workspace/symbol", &query);
        let new = fresh.ask("workspace/symbol", &query);
        differs(step, "workspace/symbol", "", Some(&kept), &new)?;
        self.note_answer("workspace/symbol", &new["result"]);
        Ok(())
    }

    fn note_answer(&mut self, question: &'static str, answer: &Value) {
        let parts = answer.get("items").or_else(|| answer.get("data")).unwrap_or(answer);
        if !parts.is_null() && parts.as_array().is_none_or(|parts| !parts.is_empty()) {
            self.answered.insert(question);
        }
    }
}

fn differs(step: usize, what: &str, text: &str, kept: Option<&Value>, new: &Value) -> Outcome {
    if kept == Some(new) {
        return Ok(());
    }
    Err(format!("step {step}, {what} of\n{text}\nkept: {kept:#?}\nnew: {new:#?}").into())
}

fn number(name: &str) -> Result<Option<u64>, Failed> {
    let found = std::env::var(name).ok();
    found.map(|text| text.parse().map_err(|_| format!("{name} is no number").into())).transpose()
}

pub fn as_fresh() -> Outcome {
    let edits = number("LAMPLIGHT_LSP_EDITS")?.map_or(EDITS, |edits| edits as usize);
    let seed = number("LAMPLIGHT_LSP_SEED")?.unwrap_or(16);
    let mut editing = Editing::new(seed)?;
    for step in 0..edits {
        editing.step()?;
        editing.compare(step)?;
    }
    let questions = QUESTIONS.iter().chain(OF_FILES).chain(&["diagnostics", "workspace/symbol"]);
    let unanswered: Vec<_> =
        questions.filter(|question| !editing.answered.contains(*question)).collect();
    if edits >= EDITS && !unanswered.is_empty() {
        return Err(format!("only empty answers to {unanswered:?} in {edits} edits").into());
    }
    Ok(())
}

/// `import package::a::b` means the module `a/b.wesl` until the module `a` declares an item `b`.
/// Then it means this item, and the server notices.
pub fn module_becomes_item() -> Outcome {
    let user = "import package::a::b;\nfn g() -> f32 { return b(); }\n";
    let files = [("a.wesl", ""), ("a/b.wesl", "fn c() {}\n"), ("x.wesl", user)];
    noticed(&files, "fn b() -> f32 { return 1.0; }\n")
}

/// A module declares an item, and from then on passes on another one of the name where it does not.
pub fn item_is_passed_on_too() -> Outcome {
    let user = "import package::a::b;\nfn g() -> f32 { return b(); }\n";
    let declared = "@if(N) public fn b() -> f32 { return 1.0; }\n";
    let other = "public fn b() -> f32 { return 2.0; }\n";
    let files = [("a.wesl", declared), ("c.wesl", other), ("x.wesl", user)];
    noticed(&files, &format!("@if(!N) public import package::c::b;\n{declared}"))
}

/// The server answers as a new one about the use of `b` in the last file, after `a.wesl` has changed.
fn noticed(files: &[(&str, &str)], changed: &str) -> Outcome {
    let folder = tempfile::tempdir()?;
    let root = folder.path().canonicalize()?;
    fs::create_dir(root.join("a"))?;
    for (file, text) in files {
        fs::write(root.join(file), text)?;
    }
    let (first, last) = (files[0].1, files[files.len() - 1].1);
    let uri = |file: &str| format!("file://{}", root.join(file).display());
    let mut kept = Editor::new();
    kept.open(&uri("x.wesl"), last);
    kept.open(&uri("a.wesl"), first);
    kept.look();
    let change = json!({
        "textDocument": { "uri": uri("a.wesl"), "version": 2 },
        "contentChanges": [{ "text": changed }],
    });
    kept.notify("textDocument/didChange", change);
    kept.look();
    let mut new = Editor::new();
    new.open(&uri("x.wesl"), last);
    new.open(&uri("a.wesl"), changed);
    new.look();
    let call = json!({
        "textDocument": { "uri": uri("x.wesl") },
        "position": { "line": 1, "character": 24 },
    });
    let answers = [&mut kept, &mut new].map(|one| one.ask("textDocument/definition", &call));
    if answers[1]["result"].is_null() {
        return Err(format!("a new server finds nothing: {}", answers[1]).into());
    }
    differs(1, "definition", last, Some(&answers[0]), &answers[1])?;
    let published = [&kept, &new].map(|one| one.published.get(&uri("x.wesl")));
    let fresh = published[1].ok_or("nothing was published for x.wesl")?;
    differs(1, "diagnostics", last, published[0], fresh)
}
