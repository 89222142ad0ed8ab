//! What is shown at which file: what is wrong with open documents, with the other modules of their
//! packages, and with the files that declare these packages.
//!
//! A document whose import or manifest is broken says so itself, since the other file may be closed.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::look::{is_module, module_problems, module_settings};
use super::places::Places;
use super::wire::notification_message;
use super::{Document, LanguageServer, inactive, place, report};
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostics, Severity};
use lamplight_files::limits::EDITOR_FILES;
use lamplight_lint::EXTENSIONS;

/// Diagnostics by the address of the file that they are shown at.
type Found = BTreeMap<String, Vec<Value>>;

/// What was found, and what the editor shows of it.
#[derive(Default)]
pub struct Findings {
    /// By the file whose analysis found it.
    found: BTreeMap<PathBuf, Found>,
    /// By address, what the editor shows.
    shown: BTreeMap<String, Vec<Value>>,
    /// By open document: the files that its analysis read. None are known where its package could
    /// not be opened.
    read: BTreeMap<PathBuf, BTreeSet<String>>,
}

/// What is wrong with a module, its imports and its package.
struct Analysis {
    sources: SourceSet,
    problems: Diagnostics,
    /// The permutation that the problems are about.
    note: Option<String>,
    /// What the permutation takes away.
    inactive: Vec<Value>,
    /// Whether the package was opened.
    is_opened: bool,
}

impl LanguageServer {
    /// Analyses a file that is open, or that is a closed module of an open package. Returns the
    /// messages with what is shown now.
    pub(super) fn publish(&mut self, file: &Path) -> Vec<Value> {
        let uri = place::file_address(file);
        let (found, read) = match self.documents.get(file) {
            Some(document) => self.found_in(document, &uri, true),
            None => match self.closed_document(file) {
                Some(document) => self.found_in(&document, &uri, false),
                None => (Found::new(), None),
            },
        };
        match read.filter(|_| self.documents.contains_key(file)) {
            Some(read) => drop(self.findings.read.insert(file.to_owned(), read)),
            None => drop(self.findings.read.remove(file)),
        }
        let old = match found.is_empty() && !self.documents.contains_key(file) {
            true => self.findings.found.remove(file),
            false => self.findings.found.insert(file.to_owned(), found.clone()),
        };
        let old = old.unwrap_or_default();
        let mut addresses: BTreeSet<&String> = old.keys().chain(found.keys()).collect();
        addresses.insert(&uri);
        addresses.into_iter().filter_map(|address| self.message_about(address, file)).collect()
    }

    /// The message with the diagnostics of a file, if they are not what the editor shows.
    fn message_about(&mut self, address: &str, analysed: &Path) -> Option<Value> {
        let path = place::path_of_address(address);
        let open = path.as_ref().and_then(|path| self.documents.get(path));
        if let Some(document) = open {
            if path.as_deref() != Some(analysed) {
                return None;
            }
            let own = self.findings.found.get(analysed).and_then(|found| found.get(address));
            let diagnostics = own.cloned().unwrap_or_default();
            let message = message(address, Some(&document.version), &diagnostics);
            self.findings.shown.insert(address.to_owned(), diagnostics);
            return Some(message);
        }
        let diagnostics = self.findings.of_closed(address, path.as_deref());
        if self.findings.shown.get(address).map_or(&[][..], Vec::as_slice) == diagnostics {
            return None;
        }
        let message = message(address, None, &diagnostics);
        self.findings.shown.insert(address.to_owned(), diagnostics);
        Some(message)
    }

    /// A module on the disk that belongs to the package of an open document.
    fn closed_document(&self, file: &Path) -> Option<Document> {
        let (root, path) = super::package_of_file(file);
        let is_known = self.documents.values().any(|document| document.root == root);
        if !is_known || !is_module(&path) {
            return None;
        }
        let opened = self.opened(&root)?;
        let text = opened.packages.root.files.read(&path).ok()??;
        Some(Document { text, version: Value::Null, root, path })
    }

    /// What is wrong, by the file that it is shown at; and the files that were read, if the package
    /// could be opened.
    fn found_in(
        &self,
        document: &Document,
        uri: &str,
        is_open: bool,
    ) -> (Found, Option<BTreeSet<String>>) {
        let analysis = self.analyse(document, is_open);
        let places = Places::new(&analysis.sources, &*self.library);
        let mut found = Found::new();
        let mut show = |address: &str, diagnostic: Value| {
            found.entry(address.to_owned()).or_default().push(diagnostic);
        };
        for problem in &analysis.problems {
            let note = analysis.note.as_deref();
            // It is shown in the file of its first label.
            match problem.labels.first().and_then(|first| places.address(first.span.source)) {
                Some(address) => {
                    show(&address, report::diagnostic_json(&places, problem, note));
                    if address != uri && is_open && problem.severity == Severity::Error {
                        show(uri, report::pointing_json(&places, problem, &document.text));
                    }
                }
                None => show(uri, report::unplaced_json(problem, &document.text)),
            }
        }
        analysis.inactive.into_iter().for_each(|hint| show(uri, hint));
        let read = analysis.sources.iter().map(|(_, source)| source.path.clone());
        let read = analysis.is_opened.then(|| read.collect());
        (found, read)
    }

    fn analyse(&self, document: &Document, is_open: bool) -> Analysis {
        let failed = |sources, problems, is_opened| Analysis {
            sources,
            problems,
            note: None,
            inactive: Vec::new(),
            is_opened,
        };
        let mut opened = match self.open_package(&document.root) {
            Ok(opened) => opened,
            Err((sources, problems)) => return failed(sources, problems, false),
        };
        let mut problems = std::mem::take(&mut opened.problems);
        if !is_module(&document.path) {
            return failed(opened.sources, problems, true);
        }
        let (settings, note) =
            module_settings(&opened, &document.path, &self.choice(&document.root));
        match self.graph(&mut opened, &document.path) {
            Ok(graph) => {
                problems.extend(module_problems(&graph, &settings, &document.path));
                let inactive = match is_open {
                    true => inactive::inactive_hints(&document.text, &graph, &settings),
                    false => Vec::new(),
                };
                Analysis {
                    sources: opened.sources,
                    problems,
                    note: Some(note),
                    inactive,
                    is_opened: true,
                }
            }
            Err(more) => {
                problems.extend(more);
                failed(opened.sources, problems, true)
            }
        }
    }

    /// Closed modules of all open packages. A package with too many has none: `lint` checks it.
    pub(super) fn closed_modules(&self) -> Vec<PathBuf> {
        let roots: BTreeSet<&PathBuf> =
            self.documents.values().map(|document| &document.root).collect();
        let mut closed = Vec::new();
        for root in roots {
            let Some(opened) = self.opened(root) else { continue };
            let modules = opened.packages.root.files.list(EXTENSIONS);
            if modules.len() <= EDITOR_FILES {
                closed.extend(modules.iter().map(|path| root.join(path)));
            }
        }
        closed.retain(|path| !self.documents.contains_key(path));
        closed
    }

    /// Files of which something is shown, and whose package has no open document any more.
    pub(super) fn left_files(&self) -> Vec<PathBuf> {
        let is_left = |file: &&PathBuf| {
            let (root, _) = super::package_of_file(file);
            !self.documents.values().any(|document| document.root == root)
        };
        self.findings.found.keys().filter(is_left).cloned().collect()
    }
}

impl Findings {
    /// Whether the analysis of an open document may change with a file.
    pub fn may_read(&self, document: &Path, file: &str) -> bool {
        self.read.get(document).is_none_or(|read| read.contains(file))
    }

    /// What is shown of a closed file: what its own analysis found, or else all others.
    fn of_closed(&self, address: &str, path: Option<&Path>) -> Vec<Value> {
        let own = path.and_then(|path| self.found.get(path)).and_then(|found| found.get(address));
        if let Some(own) = own {
            return own.clone();
        }
        let mut all: Vec<Value> = Vec::new();
        for diagnostic in self.found.values().filter_map(|found| found.get(address)).flatten() {
            if !all.contains(diagnostic) {
                all.push(diagnostic.clone());
            }
        }
        all
    }
}

fn message(address: &str, version: Option<&Value>, diagnostics: &[Value]) -> Value {
    let mut parameters = json!({ "uri": address, "diagnostics": diagnostics });
    if let Some(version) = version {
        parameters["version"] = version.clone();
    }
    notification_message("textDocument/publishDiagnostics", parameters)
}
