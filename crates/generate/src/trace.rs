//! Remembers what a whole run read and what it wrote. If none of that changed, the next run has
//! nothing to do.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use super::stamp::{BundleStamp, Look};
use super::{Request, Summary};
use crate::cache::{Cache, hash_parts};
use lamplight_bundle::contents::to_hex;
use lamplight_compose::resolve::Packages;
use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::render::{Form, render};
use lamplight_diagnostic::source::{Files, Package, ReadError, SourceSet};

/// A package, and what was asked of its files.
type FileQuestion = (String, String);

/// Makes packages that record what is asked of them.
#[derive(Debug, Clone, Default)]
pub struct Observer(Arc<Mutex<BTreeMap<FileQuestion, String>>>);

impl Observer {
    /// The same packages, with their questions recorded.
    pub fn observe(&self, packages: Packages) -> Packages {
        packages.map(|package| Package {
            files: Box::new(Observed {
                package: package.name.clone(),
                files: package.files,
                observer: self.clone(),
            }),
            name: package.name,
        })
    }

    /// Whether the files still give the same answers. Each recorded question is asked once.
    pub fn is_current(&self, packages: &Packages) -> bool {
        is_current(&self.answers(), packages)
    }

    fn answers(&self) -> BTreeMap<FileQuestion, String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn note(&self, package: &str, question: String, answer: String) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .insert((package.to_owned(), question), answer);
    }
}

/// A run that succeeded.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Trace {
    /// Packages, questions and answers.
    reads: Vec<(String, String, String)>,
    /// The bundle that was written.
    output: BundleStamp,
    /// The summary of the run that made the bundle.
    pub summary: Summary,
    /// The warnings of that run.
    pub warnings: RunWarnings,
}

/// The warnings of a run. They are kept as text, since the author's files are not read when there
/// is nothing to do.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RunWarnings {
    /// The manifest as it was named on the command line, since warnings name files in the same way.
    manifest: String,
    /// The warnings in each of [`FORMS`].
    texts: Vec<String>,
}

const FORMS: [Form; 4] = [Form::Human, Form::Colored, Form::Short, Form::Json];

impl RunWarnings {
    /// The warnings of a run, as each form writes them.
    pub fn new(manifest: &Path, sources: &SourceSet, warnings: &[Diagnostic]) -> Self {
        let texts = FORMS.map(|form| {
            if warnings.is_empty() { String::new() } else { render(sources, warnings, form) }
        });
        Self { manifest: manifest.to_string_lossy().into_owned(), texts: texts.into() }
    }

    /// The warnings in one form.
    pub fn text(&self, form: Form) -> &str {
        FORMS
            .iter()
            .zip(&self.texts)
            .find(|(known, _)| **known == form)
            .map_or("", |(_, text)| text)
    }

    /// Whether the warnings are right for a run that names the manifest so.
    fn is_of(&self, manifest: &Path) -> bool {
        self.texts.iter().all(String::is_empty) || Path::new(&self.manifest) == manifest
    }
}

/// A run that may have been made before.
#[derive(Clone, Copy)]
pub struct TracedRun<'a> {
    /// The manifest's file.
    pub manifest: &'a Path,
    /// What was read before the packages were: the manifest and what declares them.
    pub declared: &'a SourceSet,
    /// What of the manifest is asked for.
    pub request: &'a Request,
    /// Where its files come from.
    pub packages: &'a Packages,
    /// The bundle.
    pub out: &'a Path,
    /// The version of the program that optimises SPIR-V, if the run needs it.
    pub optimiser: Option<&'a str>,
}

impl Trace {
    /// The trace of a run whose packages `observer` watched; `None` where there is no bundle.
    pub fn new(
        observer: &Observer,
        out: &Path,
        summary: Summary,
        warnings: RunWarnings,
    ) -> Option<Self> {
        let reads = observer
            .answers()
            .into_iter()
            .map(|((package, question), answer)| (package, question, answer));
        Some(Self { reads: reads.collect(), output: BundleStamp::of(out)?, summary, warnings })
    }

    /// A name for the content of the bundle that was written.
    pub fn bundle(&self) -> &str {
        self.output.content()
    }

    /// Finds the trace of an equal run, if everything that it read is the same and the bundle is
    /// the one that it wrote. The look says whether blobs that seem unchanged are read.
    pub fn find(cache: &Cache, run: TracedRun<'_>, look: Look) -> Option<Self> {
        let mut trace: Self =
            serde_json::from_slice(&cache.get("runs", trace_key(cache, run))?).ok()?;
        let reads = trace.reads.iter().map(|(package, question, answer)| {
            ((package.clone(), question.clone()), answer.clone())
        });
        let is_same =
            trace.warnings.is_of(run.manifest) && is_current(&reads.collect(), run.packages);
        let now = is_same.then(|| trace.output.renewed(run.out, look)).flatten()?;
        if now != trace.output {
            trace.output = now;
            trace.keep(cache, run);
        }
        Some(trace)
    }

    /// Keeps the trace for [`Self::find`].
    pub fn keep(&self, cache: &Cache, run: TracedRun<'_>) {
        cache.put("runs", trace_key(cache, run), serde_json::to_vec(self).ok());
    }
}

fn trace_key(cache: &Cache, run: TracedRun<'_>) -> lamplight_bundle::Hash {
    let TracedRun { manifest: _, declared, request, packages: _, out: _, optimiser } = run;
    let Request { program, only, targets, conventions, shard } = request;
    let only = only.as_ref().map(|only| &only.text);
    let request =
        format!("{program:?} {only:?} {targets:?} {conventions:?} {shard:?} {optimiser:?}");
    let texts = declared.iter().map(|(_, source)| &*source.text);
    hash_parts(&["run", cache.build(), &request].into_iter().chain(texts).collect::<Vec<_>>())
}

fn is_current(reads: &BTreeMap<FileQuestion, String>, packages: &Packages) -> bool {
    let find = |name: &str| packages.all().find(|package| package.name == name);
    reads.iter().all(|((package, question), answer)| {
        find(package).is_some_and(|package| ask_files(&*package.files, question) == *answer)
    })
}

/// Asks the files again. A question that starts with `*.` asks for a list of files, any other for
/// the file at that path.
fn ask_files(files: &dyn Files, question: &str) -> String {
    match question.strip_prefix("*.") {
        Some(extensions) => listed_answer(&files.list(&extensions.split(',').collect::<Vec<_>>())),
        None => read_answer(&files.read(question)),
    }
}

fn read_answer(answer: &Result<Option<String>, ReadError>) -> String {
    match answer {
        Ok(Some(text)) => to_hex(&hash_parts(&[text])),
        Ok(None) => "none".to_owned(),
        Err(error) => format!("{error:?}"),
    }
}

fn listed_answer(paths: &[String]) -> String {
    to_hex(&hash_parts(&paths.iter().map(String::as_str).collect::<Vec<_>>()))
}

struct Observed {
    package: String,
    files: Box<dyn Files>,
    observer: Observer,
}

impl Files for Observed {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        let answer = self.files.read(path);
        self.observer.note(&self.package, path.to_owned(), read_answer(&answer));
        answer
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        let answer = self.files.list(extensions);
        self.observer.note(
            &self.package,
            format!("*.{}", extensions.join(",")),
            listed_answer(&answer),
        );
        answer
    }

    fn display(&self, path: &str) -> String {
        self.files.display(path)
    }

    fn on_disk(&self, path: &str) -> bool {
        self.files.on_disk(path)
    }
}
