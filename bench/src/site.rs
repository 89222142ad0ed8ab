//! The page `#/speed` of the site, beside the same work in this process.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use lamplight::LIBRARY_FILES;
use lamplight::browser::serve::{HttpServer, ServedFiles};
use lamplight::browser::{Browser, BrowserPage};
use lamplight::bundle::{Conventions, Language, Target};
use lamplight::check::expression::evaluate_expression;
use lamplight::check::library::Library as ProofLibrary;
use lamplight::compose::{self, Options};
use lamplight::diagnostic::{Diagnostic, Diagnostics};
use lamplight::execute::executors;
use lamplight::generate::{Root, entry_points};
use lamplight::link::Linker;
use lamplight::permute::{Manifest, Quoted, Settings, key, manifest};
use lamplight::picture::frame::Programs;
use lamplight::picture::{self, Plan, Shot, Surroundings};
use lamplight::project::{self, LIBRARY, MANIFEST};
use lamplight::resolve::wesl::{self, KeptModules};
use lamplight::resolve::{self, Graph, Packages};
use lamplight::scene::environment;
use lamplight::source::{Files as _, Memory, Package, SourceSet};
use serde_json::Value;

use crate::Outcome;

/// The permutations that the page switches between.
const KEYS: [&str; 5] = ["shadow=hard", "shadow=pcf_3x3", "specular=ggx", "diffuse=oren_nayar", ""];
const FORWARD: &str = "programs/forward.wesl";
const COUNT: usize = 31;
const PATIENCE: Duration = Duration::from_secs(300);

/// The expression that the page evaluates.
const EXPRESSION: &str = "brdf::specular::d_ggx(0.9, 0.19, 0.3)";

/// Prints the page's table.
pub fn run() -> Outcome {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/site");
    if !folder.join("index.html").is_file() {
        return Err("there is no site: run `cargo xtask site`".into());
    }
    let times = [
        keystroke(),
        composing(),
        emitting(&[Target::WGSL]),
        emitting(Target::ALL),
        evaluating(),
        switched_axis(COUNT, &KEYS.map(str::to_owned)),
        switched_axis(9, &new_keys()),
    ];
    let times: Vec<String> = times
        .into_iter()
        .map(|time| time.map(|time| format!("{:.2}", 1000.0 * time.as_secs_f64())))
        .collect::<Result<_, _>>()
        .map_err(|problems| words(&problems))?;
    let server = HttpServer::start(ServedFiles::Folder(folder))?;
    let browser = Browser::start()?;
    let page = browser.open(&server.address(&format!("#/speed?native={}", times.join(","))))?;
    page.until("document.querySelector('main')?.dataset.done === '1'", PATIENCE)?;
    for row in rows(&page)? {
        println!("{}", row.join(" | "));
    }
    Ok(())
}

fn rows(page: &BrowserPage) -> Result<Vec<Vec<String>>, Box<dyn std::error::Error>> {
    let cells = "[...document.querySelectorAll('tr')].map((row) => [...row.cells].map((it) => it.textContent))";
    let found: Value = page.evaluate(cells, PATIENCE)?;
    Ok(serde_json::from_value(found)?)
}

fn words(problems: &[Diagnostic]) -> String {
    problems.iter().map(|problem| problem.message.clone()).collect::<Vec<_>>().join("\n")
}

/// The median time of a task, after one run to warm up.
fn median(run: impl FnMut(usize) -> Result<(), Diagnostics>) -> Result<Duration, Diagnostics> {
    median_of(COUNT, run)
}

fn median_of(
    count: usize,
    mut run: impl FnMut(usize) -> Result<(), Diagnostics>,
) -> Result<Duration, Diagnostics> {
    run(count)?;
    let mut times = Vec::new();
    for index in 0..count {
        let start = Instant::now();
        run(index)?;
        times.push(start.elapsed());
    }
    times.sort();
    Ok(times[count / 2])
}

/// The settings of a permutation of `forward`.
fn settings(of: &str) -> Result<Settings, Diagnostics> {
    let (_, manifest) = project::library_manifest().map_err(|(_, problems)| problems)?;
    of_manifest(&manifest, of)
}

fn of_manifest(manifest: &Manifest, of: &str) -> Result<Settings, Diagnostics> {
    let space = &manifest.program("forward").ok_or_else(Diagnostics::new)?.space;
    let mut texts = SourceSet::default();
    let id = texts.add("key", of.to_owned());
    Ok(space.settings(&key::parse(space, &Quoted::whole(&texts, id))?))
}

fn compile(graph: &Graph, settings: &Settings, linker: &Linker<'_>) -> Result<(), Diagnostics> {
    let (options, conventions) = (Options::default(), Conventions::default());
    let composed = compose::compose(graph, settings, &options)?;
    let root =
        Root { graph, settings, options: &options, conventions, optimiser: None, numbers: "" };
    root.compile_with(&entry_points(&composed)?, linker)?;
    linker.forget();
    Ok(())
}

/// From an edit of `forward`, in a package that imports the library, to its WGSL.
fn keystroke() -> Result<Duration, Diagnostics> {
    let text = LIBRARY_FILES.read(FORWARD).ok().flatten().ok_or_else(Diagnostics::new)?;
    let text = text.replace("import package::", "import lamplight::");
    let manifest = LIBRARY_FILES.read(MANIFEST).ok().flatten().ok_or_else(Diagnostics::new)?;
    let linker = Linker::with(&[Target::WGSL], Conventions::default());
    // The parsed manifest and the parsed texts are kept, as the page keeps them.
    let mut read = SourceSet::default();
    let id = read.add(MANIFEST, manifest);
    let manifest = manifest::parse(&read, id)?;
    let mut kept = KeptModules::default();
    median(|index| {
        let edited = text.replace("fn fs_main", &format!("// {index}\nfn fs_main"));
        let files = BTreeMap::from([(FORWARD.to_owned(), edited)]);
        let packages = Packages::new(
            Package { name: "package".to_owned(), files: Box::new(Memory(files)) },
            vec![Package { name: LIBRARY.to_owned(), files: Box::new(LIBRARY_FILES) }],
        );
        let mut sources = read.clone();
        let settings = of_manifest(&manifest, "")?;
        let graph = wesl::load_kept(&mut sources, &packages, FORWARD, &mut kept)?;
        compile(&Graph::Wesl(graph), &settings, &linker)
    })
}

/// The graph of `forward`, and the settings of the keys.
fn chosen() -> Result<(Graph, Vec<Settings>), Diagnostics> {
    let packages = project::library_packages();
    let graph = resolve::load(&mut SourceSet::default(), &packages, FORWARD, Language::Wesl)?;
    Ok((graph, KEYS.map(settings).into_iter().collect::<Result<_, _>>()?))
}

/// From a key to the composed text.
fn composing() -> Result<Duration, Diagnostics> {
    let (graph, chosen) = chosen()?;
    let options = Options::default();
    median(|index| compose::compose(&graph, &chosen[index % KEYS.len()], &options).map(drop))
}

/// From a key to the outputs of some targets.
fn emitting(targets: &[Target]) -> Result<Duration, Diagnostics> {
    let (graph, chosen) = chosen()?;
    let linker = Linker::with(targets, Conventions::default());
    median(|index| compile(&graph, &chosen[index % KEYS.len()], &linker))
}

/// The value of the expression.
fn evaluating() -> Result<Duration, Diagnostics> {
    let sources = Mutex::new(SourceSet::default());
    median(|_| {
        let mut session = executors::eval::EXECUTOR.start().map_err(|_| Diagnostics::new())?;
        let library = ProofLibrary::shipped(LIBRARY_FILES);
        let session = session.as_mut();
        evaluate_expression(&library, &sources, EXPRESSION, Language::Wesl, session).map(drop)
    })
}

/// Keys of permutations that were not drawn before: the same keys as on the page.
fn new_keys() -> Vec<String> {
    let diffuse = ["half_lambert", "wrap", "oren_nayar"];
    let specular = ["phong", "blinn_phong_normalized", "ggx"];
    let key = |d: &str, s: &str| format!("diffuse={d},specular={s}");
    diffuse.iter().flat_map(|d| specular.iter().map(move |s| key(d, s))).collect()
}

/// From a key to the picture, which Vulkan draws. With as many keys as runs, each permutation is
/// drawn for the first time.
fn switched_axis(count: usize, keys: &[String]) -> Result<Duration, Diagnostics> {
    let programs = Programs::load(LIBRARY_FILES).map_err(|(_, problems)| problems)?;
    let shot = Shot {
        size: [256; 2],
        samples: 1,
        exposure: 0.0,
        cascades: 1,
        language: Language::Wesl,
        surroundings: Surroundings::Formula(environment("studio").ok_or_else(Diagnostics::new)?),
    };
    let painter = executors::vulkan::EXECUTOR.start().map_err(|_| Diagnostics::new())?;
    median_of(count, |index| {
        // The run that warms up draws the default.
        let key = if index == count { "" } else { &keys[index % keys.len()] };
        let plan = Plan::of_key(&programs, "forward", key)?;
        picture::render_plan(painter.as_ref(), &programs, &plan, &shot).map(drop)
    })
}
