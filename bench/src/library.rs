//! The shader library's own programs: ours compared with `wesl`, which only knows boolean
//! conditions.

use std::borrow::Cow;
use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

use lamplight::LIBRARY_FILES;
use lamplight::compose::{Keep, Options, wesl as composer};
use lamplight::permute::Settings;
use lamplight::resolve;
use lamplight::source::{Files, SourceSet};
use wesl::ModulePath;
use wesl::syntax::PathOrigin;

use crate::Outcome;

/// Modules that are composed by themselves: the root of each composition, kept whole.
const ROOTS: [&str; 6] = [
    "lighting/light",
    "lighting/classic",
    "brdf/specular",
    "shadow/compare",
    "shadow/moments",
    "surface/normal",
];
/// Programs without conditions.
const PROGRAMS: [&str; 1] = ["programs/depth"];
const ROUNDS: usize = 20;

/// Prints how often each tool composes the roots in a second.
pub fn run() -> Outcome {
    let (ours, theirs) = (ours()?, theirs()?);
    let rate = |elapsed: Duration| {
        (ROUNDS * (ROOTS.len() + PROGRAMS.len())) as f64 / elapsed.as_secs_f64()
    };
    println!(
        "the library's modules to text: lamplight {:.1}/s, wesl {:.1}/s",
        rate(ours),
        rate(theirs)
    );
    Ok(())
}

fn roots() -> impl Iterator<Item = &'static str> {
    ROOTS.into_iter().chain(PROGRAMS)
}

fn ours() -> Result<Duration, Box<dyn Error>> {
    let packages = lamplight::project::library_packages();
    let load = |root: &str| {
        resolve::wesl::load(&mut SourceSet::default(), &packages, &format!("{root}.wesl"))
    };
    let graphs: Result<Vec<_>, _> = roots().map(load).collect();
    let graphs = graphs.map_err(|problems| format!("{problems:?}"))?;
    let options = Options { keep: Keep::EntryPoints, ..Options::default() };
    let start = Instant::now();
    for _ in 0..ROUNDS {
        for graph in &graphs {
            let composed = composer::compose(graph, &Settings::default(), &options);
            black_box(composed.map_err(|problems| format!("{problems:?}"))?.text);
        }
    }
    Ok(start.elapsed())
}

fn theirs() -> Result<Duration, Box<dyn Error>> {
    let path = |file: &str| {
        ModulePath::new(PathOrigin::Absolute, file.split('/').map(str::to_owned).collect())
    };
    let mut resolver = wesl::VirtualResolver::new();
    for file in LIBRARY_FILES.list(&["wesl"]) {
        let text = LIBRARY_FILES.read(&file).ok().flatten().unwrap_or_default();
        resolver.add_module(path(file.trim_end_matches(".wesl")), Cow::Owned(text));
    }
    let mut compiler = wesl::Wesl::new_barebones().set_custom_resolver(resolver);
    let options = wesl::CompileOptions { validate: false, ..wesl::CompileOptions::default() };
    let start = Instant::now();
    for _ in 0..ROUNDS {
        for root in roots() {
            // A module without entry points is kept whole, as ours is.
            compiler.set_options(wesl::CompileOptions {
                keep_root: ROOTS.contains(&root),
                ..options.clone()
            });
            black_box(compiler.compile(&path(root))?.to_string());
        }
    }
    Ok(start.elapsed())
}
