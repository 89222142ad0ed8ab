//! `lamplight export --form three` in Chromium, with three.js from npm: every function with either
//! backend against the numeric cases, and the materials of the guide.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;
use std::sync::{Arc, Mutex};

use lamplight::LIBRARY_FILES;
use lamplight::browser::serve::{HttpServer, ServedFiles};
use lamplight::browser::{Browser, BrowserPage, PATIENCE};
use lamplight::bundle::Language;
use lamplight::check::check::{self, CheckOptions, CheckedModule, OpenExecutor};
use lamplight::check::library::Library;
use lamplight::diagnostic::render::{Form, render};
use lamplight::diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight::execute::kernel::Kernel;
use lamplight::execute::{Session, on_thread};
use lamplight::source::SourceSet;
use libtest_mimic::{Failed, Trial};
use naga::{Handle, ScalarKind, Type, TypeInner, VectorSize};

use crate::{is_whole, npm};

type Outcome = Result<(), Failed>;

/// By day, the functions of every fourth case file.
const STEP: usize = 4;

/// Functions with cases that must have been run, at night and by day.
const LEAST: [usize; 2] = [240, 50];

/// The most that a channel may differ between the pictures of the guide's materials, of 255, and in
/// how many of their 4096 texels it may be more: those on the edge of the ball.
const MOST_DIFFERENCE: u8 = 2;
const MOST_EDGES: usize = 90;

pub fn tests() -> Vec<Trial> {
    let values = |backend: &'static str| {
        Trial::test(format!("three::values::{backend}"), move || {
            on_thread(move || values_agree(backend)).ok_or("a thread ended")?.map_err(Failed::from)
        })
    };
    vec![values("webgpu"), values("webgl"), Trial::test("three::materials", materials)]
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A page with three.js and the library's package, and what `export` says.
struct ThreePage {
    page: BrowserPage,
    summary: String,
    _server: HttpServer,
}

fn add_files(files: &mut BTreeMap<String, Vec<u8>>, folder: &Path, name: &str) -> Outcome {
    for file in std::fs::read_dir(folder)? {
        let file = file?;
        let name = format!("{name}{}", file.file_name().to_string_lossy());
        match file.file_type()?.is_dir() {
            true => add_files(files, &file.path(), &format!("{name}/"))?,
            false => drop(files.insert(name, std::fs::read(file.path())?)),
        }
    }
    Ok(())
}

/// The blocks of the guide's page that are files.
fn guide_files() -> Result<Vec<(String, Vec<u8>)>, Failed> {
    let text = std::fs::read_to_string(root().join("docs/guide/three.md"))?;
    let block = |part: &str| {
        let (name, rest) = part.split_once('\n')?;
        let (body, _) = rest.split_once("\n```")?;
        Some((name.to_owned(), body.as_bytes().to_vec()))
    };
    Ok(text.split("```js file=").skip(1).filter_map(block).collect())
}

fn open_page() -> Result<ThreePage, Failed> {
    let folder = tempfile::tempdir()?;
    let output = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(["export", "--form", "three"])
        .arg(folder.path())
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let packages = npm::installed(&root().join("tests/three"), "three")?;
    let mut files = BTreeMap::new();
    add_files(&mut files, &root().join("tests/three"), "")?;
    add_files(&mut files, &packages.join("three/build"), "three/")?;
    add_files(&mut files, &folder.path().join("lamplight_three"), "package/")?;
    files.extend(guide_files()?);
    let server = HttpServer::start(ServedFiles::Memory(files))?;
    let page = Browser::shared()?.open(&server.address(""))?;
    page.loaded(PATIENCE)?;
    let summary = String::from_utf8_lossy(&output.stdout).into_owned();
    Ok(ThreePage { page, summary, _server: server })
}

/// Calls functions by materials. The source of a kernel is the path of its module.
struct ThreeSession {
    page: Arc<Mutex<BrowserPage>>,
    adapter: String,
    left_out: BTreeSet<String>,
    /// Modules are loaded by the first calls.
    _server: HttpServer,
}

fn failed(message: impl ToString) -> Diagnostic {
    Diagnostic::error(codes::EXECUTOR_FAILED, message.to_string())
}

/// The name of a type in TSL.
fn type_name(inner: &TypeInner) -> Option<String> {
    let size = |size: VectorSize| size as u8;
    let scalar = |kind: ScalarKind| match kind {
        ScalarKind::Float => Some(("float", "")),
        ScalarKind::Sint => Some(("int", "i")),
        ScalarKind::Uint => Some(("uint", "u")),
        ScalarKind::Bool => Some(("bool", "b")),
        ScalarKind::AbstractInt | ScalarKind::AbstractFloat => None,
    };
    match *inner {
        TypeInner::Scalar(found) => Some(scalar(found.kind)?.0.to_owned()),
        TypeInner::Vector { size: found, scalar: of } => {
            Some(format!("{}vec{}", scalar(of.kind)?.1, size(found)))
        }
        TypeInner::Matrix { columns, .. } => Some(format!("mat{}", size(columns))),
        _ => None,
    }
}

impl Session for ThreeSession {
    fn adapter(&self) -> String {
        self.adapter.clone()
    }

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        let path = kernel.source.as_deref().unwrap_or_default();
        let full = format!("{}::{}", path.replace('/', "::"), kernel.name);
        if self.left_out.contains(&full) {
            let message = format!("`{full}` is left out");
            return Err(Diagnostic::error(codes::EXECUTOR_LACKS, message));
        }
        let function = &kernel.module.functions[kernel.function];
        let name_of =
            |ty: Handle<Type>| type_name(&kernel.module.types[ty].inner).ok_or("no name of a type");
        let parameters: Result<Vec<String>, _> =
            function.arguments.iter().map(|argument| name_of(argument.ty)).collect();
        let result = function.result.as_ref().ok_or("no result").map_err(failed)?;
        let call = serde_json::json!([
            path,
            kernel.name,
            parameters.map_err(failed)?,
            name_of(result.ty).map_err(failed)?,
            inputs
        ]);
        let script = format!("import('./run.mjs').then(({{ run }}) => run(...{call}))");
        let page = self.page.lock().map_err(failed)?;
        let words = page.evaluate(&script, PATIENCE * 4).map_err(failed)?;
        serde_json::from_value(words).map_err(failed)
    }
}

/// The functions that `export` leaves out.
fn names_left_out(summary: &str) -> BTreeSet<String> {
    let names =
        summary.lines().filter_map(|line| line.strip_prefix("left out: ")?.split_once(": "));
    names.map(|(name, _)| name.to_owned()).collect()
}

fn open_session(backend: &str) -> Result<ThreeSession, String> {
    let ThreePage { page, summary, _server } =
        open_page().map_err(|failed| format!("{failed:?}"))?;
    let script = format!("import('./run.mjs').then(({{ open }}) => open('{backend}'))");
    let revision = page.evaluate(&script, PATIENCE).map_err(|problem| problem.to_string())?;
    Ok(ThreeSession {
        page: Arc::new(Mutex::new(page)),
        adapter: format!("three.js {revision}, {backend}"),
        left_out: names_left_out(&summary),
        _server,
    })
}

fn values_agree(backend: &'static str) -> Result<(), String> {
    let session = open_session(backend)?;
    let left_out = session.left_out.clone();
    let library = Library::shipped(LIBRARY_FILES);
    let sources = Mutex::new(SourceSet::default());
    let rendered = |problems: Diagnostics| {
        render(&sources.lock().unwrap_or_else(|held| held.into_inner()), &problems, Form::Human)
    };
    let only = std::env::var("LAMPLIGHT_CASES").unwrap_or_default();
    let is_all = is_whole() || !only.is_empty();
    let paths = library.case_files().into_iter().filter(|path| path.contains(&only));
    let paths: Vec<String> = paths.step_by(if is_all { 1 } else { STEP }).collect();
    let cases = library.read(&sources, &paths).map_err(rendered)?;
    let subjects = |module: &str, language: Language, functions: &[String]| {
        let found = library.module(&sources, module, language, functions)?;
        let mut checked = CheckedModule::without_text(found);
        checked.source = Some(module.replace("::", "/").into());
        Ok(checked)
    };
    let mut open = [OpenExecutor { executor: "three", session: Box::new(session) }];
    let options = CheckOptions { references: true, ..CheckOptions::default() };
    let report = check::check_with(&cases, &[Language::Wesl], &subjects, &mut open, &options)
        .map_err(rendered)?;
    let (mut failures, mut functions) = (Vec::new(), BTreeSet::new());
    for outcome in &report.outcomes {
        let is_left_out = left_out.contains(&outcome.path());
        match &outcome.verdict {
            Err(error) if is_left_out && error.code.name == codes::EXECUTOR_LACKS.name => {}
            Err(error) => failures.push(format!("{}: {}", outcome.path(), error.message)),
            Ok(_) if !outcome.passed() => failures.push(format!("{}: fails", outcome.path())),
            Ok(_) => drop(functions.insert(outcome.path())),
        }
    }
    println!("{}: {} functions", open[0].session.adapter(), functions.len());
    if functions.len() < LEAST[usize::from(!is_all)] && only.is_empty() {
        failures.push(format!("only {} functions were run", functions.len()));
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
}

/// The guide's two materials draw the same ball on every backend.
fn materials() -> Outcome {
    let mut opened = open_page()?;
    let drawn = |call: &str| -> Result<Vec<u8>, Failed> {
        let script = format!("import('./materials.mjs').then(({{ nodes, chunks }}) => {call})");
        Ok(serde_json::from_value(opened.page.evaluate(&script, PATIENCE * 2)?)?)
    };
    let wanted = drawn("nodes('webgpu')")?;
    let colors: BTreeSet<&[u8]> = wanted.chunks(4).collect();
    if colors.len() < 200 {
        return Err(format!("{} colours are no lit ball", colors.len()).into());
    }
    for call in ["nodes('webgl')", "chunks()"] {
        let found = drawn(call)?;
        let differs = |(one, other): (&[u8], &[u8])| {
            one.iter().zip(other).any(|(one, other)| one.abs_diff(*other) > MOST_DIFFERENCE)
        };
        let count = wanted.chunks(4).zip(found.chunks(4)).filter(|pair| differs(*pair)).count();
        println!("{call}: {count} texels differ");
        if found.len() != wanted.len() || count > MOST_EDGES {
            return Err(format!("{call}: {count} texels differ").into());
        }
    }
    match opened.page.errors() {
        [] => Ok(()),
        errors => Err(format!("{errors:?}").into()),
    }
}
