//! The page `#/speed` of the site, beside the same work in this process.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

use lamplight::browser::serve::{Files, Server};
use lamplight::browser::{Browser, Page};
use lamplight::bundle::{Conventions, Language, Target};
use lamplight::compose::{self, Options};
use lamplight::diagnostic::{Diagnostic, Diagnostics};
use lamplight::execute::executors;
use lamplight::generate::{Root, entry_points};
use lamplight::link::Linker;
use lamplight::permute::{Manifest, Quoted, Settings, key, manifest};
use lamplight::picture::frame::Programs;
use lamplight::picture::{self, Plan, Shot, Surroundings};
use lamplight::project::{self, LIBRARY, MANIFEST};
use lamplight::resolve::{self, Graph, Packages};
use lamplight::scene::environment;
use lamplight::source::{Embedded, Files as _, Memory, Package, SourceSet};
use serde_json::Value;

use crate::Outcome;

/// The permutations that the page switches between.
const KEYS: [&str; 5] = ["shadow=hard", "shadow=pcf_3x3", "specular=ggx", "diffuse=oren_nayar", ""];
const FORWARD: &str = "programs/forward.wesl";
const COUNT: usize = 15;
const PATIENCE: Duration = Duration::from_secs(300);

/// Prints the page's table.
pub fn run() -> Outcome {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/site");
    if !folder.join("index.html").is_file() {
        return Err("there is no site: run `cargo xtask site`".into());
    }
    let times = [keystroke(), permutation(), switched_axis()];
    let times: Vec<String> = times
        .into_iter()
        .map(|time| time.map(|time| format!("{:.2}", 1000.0 * time.as_secs_f64())))
        .collect::<Result<_, _>>()
        .map_err(|problems| words(&problems))?;
    let server = Server::start(Files::Folder(folder))?;
    let browser = Browser::start()?;
    let page = browser.open(&server.address(&format!("#/speed?native={}", times.join(","))))?;
    page.until("document.querySelector('main')?.dataset.done === '1'", PATIENCE)?;
    for row in rows(&page)? {
        println!("{}", row.join(" | "));
    }
    Ok(())
}

fn rows(page: &Page) -> Result<Vec<Vec<String>>, Box<dyn std::error::Error>> {
    let cells = "[...document.querySelectorAll('tr')].map((row) => [...row.cells].map((it) => it.textContent))";
    let found: Value = page.evaluate(cells, PATIENCE)?;
    Ok(serde_json::from_value(found)?)
}

fn words(problems: &[Diagnostic]) -> String {
    problems.iter().map(|problem| problem.message.clone()).collect::<Vec<_>>().join("\n")
}

/// The median time of a task, which runs once before.
fn median(mut run: impl FnMut(usize) -> Result<(), Diagnostics>) -> Result<Duration, Diagnostics> {
    run(COUNT)?;
    let mut times = Vec::new();
    for index in 0..COUNT {
        let start = Instant::now();
        run(index)?;
        times.push(start.elapsed());
    }
    times.sort();
    Ok(times[COUNT / 2])
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
    let root = Root { graph, settings, options: &options, conventions };
    root.compile_with(&entry_points(&composed)?, linker)?;
    linker.forget();
    Ok(())
}

/// From an edit of `forward`, in a package that imports the library, to its WGSL.
fn keystroke() -> Result<Duration, Diagnostics> {
    let text = Embedded.read(FORWARD).ok().flatten().ok_or_else(Diagnostics::new)?;
    let text = text.replace("import package::", "import lamplight::");
    let manifest = Embedded.read(MANIFEST).ok().flatten().ok_or_else(Diagnostics::new)?;
    let linker = Linker::with(&[Target::WGSL], Conventions::default());
    median(|index| {
        let edited = text.replace("fn fs_main", &format!("// {index}\nfn fs_main"));
        let files = BTreeMap::from([(FORWARD.to_owned(), edited)]);
        let packages = Packages {
            root: Package { name: "package".to_owned(), files: Box::new(Memory(files)) },
            dependencies: vec![Package { name: LIBRARY.to_owned(), files: Box::new(Embedded) }],
        };
        let mut sources = SourceSet::default();
        let id = sources.add(MANIFEST, manifest.clone());
        let settings = of_manifest(&manifest::parse(&sources, id)?, "")?;
        let graph = resolve::load(&mut sources, &packages, FORWARD, Language::Wesl)?;
        compile(&graph, &settings, &linker)
    })
}

/// From a key to WGSL; the graph of the library is read once.
fn permutation() -> Result<Duration, Diagnostics> {
    let packages = project::library();
    let graph = resolve::load(&mut SourceSet::default(), &packages, FORWARD, Language::Wesl)?;
    let linker = Linker::with(&[Target::WGSL], Conventions::default());
    let chosen = KEYS.map(settings).into_iter().collect::<Result<Vec<_>, _>>()?;
    median(|index| compile(&graph, &chosen[index % KEYS.len()], &linker))
}

/// From a key to the picture, which Vulkan draws.
fn switched_axis() -> Result<Duration, Diagnostics> {
    let programs = Programs::load().map_err(|(_, problems)| problems)?;
    let shot = Shot {
        size: [256; 2],
        samples: 1,
        exposure: 0.0,
        cascades: 1,
        language: Language::Wesl,
        surroundings: Surroundings::Formula(environment("studio").ok_or_else(Diagnostics::new)?),
    };
    let painter = executors::vulkan::EXECUTOR.start().map_err(|_| Diagnostics::new())?;
    median(|index| {
        let plan = Plan::of_key(&programs, "forward", KEYS[index % KEYS.len()])?;
        picture::render_plan(painter.as_ref(), &programs, &plan, &shot).map(drop)
    })
}
