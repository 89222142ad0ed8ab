//! A language server over WESL, WGSL and GLSL: what editors ask, answered from the same stages
//! that composing goes through.
//!
//! [`LanguageServer::receive`] takes one message and returns the messages to send;
//! [`LanguageServer::look`] returns the diagnostics of documents that changed. Nothing here reads
//! or writes a stream, and a message that is not valid has an answer too.

mod actions;
mod capabilities;
mod choose;
mod complete;
mod declared;
mod dependents;
mod failure;
mod file_cache;
mod format;
mod glsl;
mod hover;
mod inactive;
mod look;
mod members;
mod navigate;
mod package;
mod place;
mod places;
mod publish;
mod report;
pub mod wire;
mod workspace;

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Value, json};

use failure::RequestError;
use lamplight_catalogue as catalogue;
use lamplight_compose::project;
use lamplight_compose::resolve::Graph;
use lamplight_compose::resolve::wesl::KeptModules;
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Embedded, SourceSet};
use lamplight_files::limits::{EDIT_STEPS, Steps};
use look::ChosenValues;
use package::{OpenTexts, OpenedPackage, PackageModules};
use wire::{NO_METHOD, answer_message, error_message, notification_message};
use workspace::Workspace;

/// Where a file of the embedded library lies on the disk, for editors to show.
pub type LibraryPaths = Box<dyn Fn(&str) -> Option<PathBuf>>;

/// A text that an editor has open.
struct Document {
    text: String,
    version: Value,
    /// Root folder of its package, and its path below that.
    root: PathBuf,
    path: String,
}

/// The state of one session.
pub struct LanguageServer {
    documents: BTreeMap<PathBuf, Document>,
    workspace: Workspace,
    /// The permutation that the editor chose, by root folder of a package.
    choices: BTreeMap<PathBuf, ChosenValues>,
    /// By root folder of a package: what was parsed, which a keystroke in one file does not change.
    kept: RefCell<BTreeMap<PathBuf, KeptModules>>,
    file_cache: Arc<file_cache::FileCache>,
    declared: declared::DeclaredPackages,
    /// By root folder of a package: its modules, kept until a document changes.
    modules: BTreeMap<PathBuf, Arc<PackageModules>>,
    /// The same for the GLSL files of a package.
    whole: BTreeMap<PathBuf, Arc<glsl::Whole>>,
    /// Documents to analyse, the one that was edited last first.
    changed: VecDeque<PathBuf>,
    /// Modules on the disk to analyse when no document waits.
    closed: VecDeque<PathBuf>,
    findings: publish::Findings,
    items: Option<Arc<Vec<catalogue::CatalogueModule>>>,
    library: LibraryPaths,
    files: Embedded,
    is_shut_down: bool,
    /// The exit code, once the editor sent `exit`.
    pub exit: Option<u8>,
}

type Handler = fn(&mut LanguageServer, &Value) -> Result<Value, RequestError>;

/// What editors ask for.
const REQUESTS: &[(&str, Handler)] = &[
    ("textDocument/hover", hover::hover_at),
    ("textDocument/signatureHelp", hover::signature_help),
    ("textDocument/definition", navigate::definition_at),
    ("textDocument/references", navigate::references_at),
    ("textDocument/prepareRename", navigate::prepare_rename),
    ("textDocument/rename", navigate::rename_symbol),
    ("textDocument/documentSymbol", navigate::document_symbols),
    ("workspace/symbol", navigate::workspace_symbols),
    ("textDocument/completion", complete::complete_at),
    ("textDocument/codeAction", actions::code_actions),
    ("textDocument/formatting", format::format_document),
    ("textDocument/rangeFormatting", format::format_range),
    ("textDocument/onTypeFormatting", format::format_typed),
    ("textDocument/semanticTokens/full", inactive::semantic_tokens),
    ("textDocument/inlayHint", inactive::inlay_hints),
    ("textDocument/codeLens", choose::code_lenses),
    ("workspace/executeCommand", choose::execute_command),
    ("lamplight/permutation", choose::choose_permutation),
];

impl LanguageServer {
    /// A session before `initialize`.
    pub fn new(library: LibraryPaths, files: Embedded) -> Self {
        Self {
            documents: BTreeMap::new(),
            workspace: Workspace::default(),
            choices: BTreeMap::new(),
            kept: RefCell::default(),
            file_cache: Arc::default(),
            declared: declared::DeclaredPackages::default(),
            modules: BTreeMap::new(),
            whole: BTreeMap::new(),
            changed: VecDeque::new(),
            closed: VecDeque::new(),
            findings: publish::Findings::default(),
            items: None,
            library,
            files,
            is_shut_down: false,
            exit: None,
        }
    }

    /// Handles a message; returns the messages to send.
    pub fn receive(&mut self, message: &Value) -> Vec<Value> {
        let nothing = Value::Null;
        let method = message.get("method").and_then(Value::as_str);
        let parameters = message.get("params").unwrap_or(&nothing);
        match (method, message.get("id")) {
            (Some(method), Some(id)) => vec![self.request(method, id, parameters)],
            (Some(method), None) => self.notified(method, parameters),
            // An answer to a request of the server, which needs none.
            (None, _) if message.get("result").or(message.get("error")).is_some() => Vec::new(),
            (None, id) => {
                vec![error_message(
                    id.unwrap_or(&nothing),
                    wire::PARSE_ERROR,
                    "a message has a method",
                )]
            }
        }
    }

    fn request(&mut self, method: &str, id: &Value, parameters: &Value) -> Value {
        match method {
            "initialize" => {
                self.workspace = Workspace::of_editor(parameters);
                return answer_message(id, capabilities::server_capabilities());
            }
            "shutdown" => {
                self.is_shut_down = true;
                return answer_message(id, Value::Null);
            }
            _ => {}
        }
        let Some((_, handler)) = REQUESTS.iter().find(|(known, _)| *known == method) else {
            return error_message(id, NO_METHOD, &format!("there is no request `{method}`"));
        };
        // Manifests are open for their diagnostics alone.
        if method.starts_with("textDocument/")
            && self.document(parameters).is_ok_and(|found| !look::is_module(&found.path))
        {
            return answer_message(id, Value::Null);
        }
        match handler(self, parameters) {
            Ok(result) => answer_message(id, result),
            Err(error) => error_message(id, error.number(), &error.to_string()),
        }
    }

    fn notified(&mut self, method: &str, parameters: &Value) -> Vec<Value> {
        let document = parameters.get("textDocument");
        let uri = document.and_then(|found| found.get("uri")).and_then(Value::as_str);
        let path = uri.and_then(place::path_of_address);
        match (method, path) {
            ("initialized", _) => return self.workspace.watch_request().into_iter().collect(),
            ("workspace/didChangeWorkspaceFolders", _) => {
                self.workspace.change_folders(parameters);
            }
            ("exit", _) => self.exit = Some(u8::from(!self.is_shut_down)),
            ("textDocument/didOpen", Some(path)) => {
                let text = document.and_then(|found| found.get("text")).and_then(Value::as_str);
                let version = document.and_then(|found| found.get("version")).cloned();
                if let Some(text) = text {
                    self.open(path, text.to_owned(), version.unwrap_or_default());
                }
            }
            ("textDocument/didChange", Some(path)) => {
                let version = document.and_then(|found| found.get("version")).cloned();
                return self.change(&path, parameters, version.unwrap_or_default());
            }
            ("textDocument/didClose", Some(path)) => {
                self.documents.remove(&path);
                self.forget(None);
                self.changed.push_front(path);
                self.check_closed();
            }
            ("textDocument/didSave" | "workspace/didChangeWatchedFiles", _) => {
                self.forget(None);
                self.check_closed();
            }
            _ => {}
        }
        Vec::new()
    }

    fn open(&mut self, path: PathBuf, text: String, version: Value) {
        let (root, below) = package_of_file(&path);
        let is_new = !self.documents.values().any(|document| document.root == root);
        let document = Document { text, version, root, path: below };
        self.documents.insert(path.clone(), document);
        self.forget(Some(&path));
        if is_new {
            self.check_closed();
        }
    }

    fn change(&mut self, path: &Path, parameters: &Value, version: Value) -> Vec<Value> {
        let Some(document) = self.documents.get_mut(path) else { return Vec::new() };
        let mut steps = Steps::new(EDIT_STEPS);
        let changes = parameters.get("contentChanges").and_then(Value::as_array);
        for change in changes.into_iter().flatten() {
            let Some(new) = change.get("text").and_then(Value::as_str) else { continue };
            // An edit searches its position from the start of the text, and moves the text after
            // it.
            if steps.spend((2 * document.text.len() + new.len()) as u64).is_err() {
                return self.close_overloaded(path);
            }
            let range = change.get("range").map(|range| {
                let byte = |end: &str| place::byte_of_position(&document.text, range.get(end)?);
                byte("start").zip(byte("end")).filter(|(start, end)| start <= end)
            });
            match range {
                None => new.clone_into(&mut document.text),
                Some(Some((start, end))) => document.text.replace_range(start..end, new),
                Some(None) => {}
            }
        }
        document.version = version;
        self.forget_edited(path);
        Vec::new()
    }

    /// Forgets a document whose edits were too large to apply: its text is no longer that of the
    /// editor, so no answer about it would be right.
    fn close_overloaded(&mut self, path: &Path) -> Vec<Value> {
        self.documents.remove(path);
        self.forget(None);
        let words = format!(
            "the edits of one message to `{}` are too large: close the file and open it again",
            path.display()
        );
        vec![notification_message("window/showMessage", json!({ "type": 1, "message": words }))]
    }

    /// Has all closed modules of open packages analysed, and whatever is shown of other packages
    /// cleared.
    fn check_closed(&mut self) {
        self.closed = self.left_files().into_iter().chain(self.closed_modules()).collect();
    }

    /// Drops cached results after files or documents came, went or were saved. Every open document
    /// is analysed again, the opened one first.
    fn forget(&mut self, opened: Option<&Path>) {
        self.file_cache.forget_listings();
        self.look_again(opened, |_| true);
    }

    /// Drops cached results after an edit. Documents that read the edited one are analysed again.
    fn forget_edited(&mut self, edited: &Path) {
        let Some(document) = self.documents.get(edited) else { return };
        let shown = document.root.join(&document.path).to_string_lossy().into_owned();
        let users: BTreeSet<PathBuf> = self
            .documents
            .keys()
            .filter(|path| self.changed.contains(path) || self.findings.may_read(path, &shown))
            .cloned()
            .collect();
        self.look_again(Some(edited), |path| users.contains(path));
    }

    fn look_again(&mut self, first: Option<&Path>, is_meant: impl Fn(&Path) -> bool) {
        self.modules.clear();
        self.whole.clear();
        let others = self.documents.keys().map(PathBuf::as_path);
        let others = others.filter(|path| Some(*path) != first && is_meant(path));
        self.changed = first.into_iter().chain(others).map(Path::to_owned).collect();
        let documents = &self.documents;
        let is_open = |root: &PathBuf| documents.values().any(|document| document.root == *root);
        self.kept.get_mut().retain(|root, _| is_open(root));
    }

    /// Whether every document was analysed since it changed, and the other modules of its package
    /// since something was saved.
    pub fn is_idle(&self) -> bool {
        self.changed.is_empty() && self.closed.is_empty()
    }

    /// The messages with the diagnostics of the next changed document, or else of a closed module.
    /// To be called when no message waits.
    pub fn look(&mut self) -> Vec<Value> {
        match self.changed.pop_front().or_else(|| self.closed.pop_front()) {
            Some(path) => self.publish(&path),
            None => Vec::new(),
        }
    }

    /// The open texts of a package.
    fn texts(&self, root: &Path) -> OpenTexts {
        let own = self.documents.values().filter(|document| document.root == root);
        Arc::new(own.map(|document| (document.path.clone(), document.text.clone())).collect())
    }

    fn choice(&self, root: &Path) -> ChosenValues {
        self.choices.get(root).cloned().unwrap_or_default()
    }

    fn opened(&self, root: &Path) -> Option<OpenedPackage> {
        self.open_package(root).ok()
    }

    fn open_package(&self, root: &Path) -> Result<OpenedPackage, (SourceSet, Diagnostics)> {
        let (files, declared) = (self.files, &self.declared);
        package::open_package(root, files, &self.texts(root), &self.file_cache, declared)
    }

    /// A graph with a module as its root.
    fn graph(&self, opened: &mut OpenedPackage, path: &str) -> Result<Graph, Diagnostics> {
        let root = opened.root.clone();
        self.with_kept(&root, |kept| look::module_graph(opened, path, kept))
    }

    fn with_kept<T>(&self, root: &Path, work: impl FnOnce(&mut KeptModules) -> T) -> T {
        let mut all = self.kept.borrow_mut();
        work(all.entry(root.to_owned()).or_default())
    }

    /// All modules of a package, read again once a document changed.
    fn modules(&mut self, root: &Path) -> Option<Arc<PackageModules>> {
        if let Some(known) = self.modules.get(root) {
            return Some(Arc::clone(known));
        }
        let mut opened = self.opened(root)?;
        let modules = self.with_kept(root, |kept| package::read_modules(&mut opened, kept))?;
        let modules = Arc::new(modules);
        self.modules.insert(root.to_owned(), Arc::clone(&modules));
        Some(modules)
    }

    /// All GLSL files of a package, read again once a document changed.
    fn whole(&mut self, root: &Path) -> Option<Arc<glsl::Whole>> {
        if let Some(known) = self.whole.get(root) {
            return Some(Arc::clone(known));
        }
        let whole = Arc::new(glsl::read_whole(self.opened(root)?)?);
        self.whole.insert(root.to_owned(), Arc::clone(&whole));
        Some(whole)
    }

    /// The library's items, as `show` prints them.
    fn items(&mut self) -> Arc<Vec<catalogue::CatalogueModule>> {
        Arc::clone(
            self.items.get_or_insert_with(|| Arc::new(catalogue::library_modules(self.files))),
        )
    }

    /// The document that parameters name, and the byte of their position in it.
    fn requested_place(&self, parameters: &Value) -> Result<(&Document, usize), RequestError> {
        let document = self.document(parameters)?;
        let wrong = RequestError::Parameter("position");
        let position = parameters.get("position");
        let byte = position.and_then(|found| place::byte_of_position(&document.text, found));
        Ok((document, byte.ok_or(wrong)?))
    }

    fn document(&self, parameters: &Value) -> Result<&Document, RequestError> {
        let uri = parameters.get("textDocument").and_then(|found| found.get("uri"));
        let uri = uri.or_else(|| parameters.get("uri")).and_then(Value::as_str);
        let uri = uri.ok_or(RequestError::Parameter("textDocument"))?;
        let open = place::path_of_address(uri).and_then(|path| self.documents.get(&path));
        open.ok_or(RequestError::NotOpen)
    }
}

/// The package of a file, which need not be on the disk yet, and its path there.
fn package_of_file(file: &Path) -> (PathBuf, String) {
    let folder = file.parent().unwrap_or(Path::new("/"));
    let real = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let name = file.file_name().unwrap_or_default();
    let root = project::package_at(&real).or_else(|| project::package_above(&real));
    let root = root.and_then(|root| root.canonicalize().ok());
    let root = root.filter(|root| real.starts_with(root)).unwrap_or_else(|| real.clone());
    let below = real.strip_prefix(&root).unwrap_or(Path::new("")).join(name);
    (root, below.to_string_lossy().replace('\\', "/"))
}
