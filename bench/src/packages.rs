//! Packages that import one another, with blocks under conditions: ours compared with `wesl`.
//!
//! `wesl` knows no blocks of declarations, and a package that two others import is two packages to
//! it. So it gets the same modules with a condition at each declaration, in folders of one package.

mod corpus;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::error::Error;
use std::time::{Duration, Instant};

use lamplight::compose::{Options, wesl as composer};
use lamplight::diagnostic::Diagnostic;
use lamplight::permute::{Setting, Settings};
use lamplight::resolve::{self, Packages};
use lamplight::source::{Memory, Package, SourceSet};
use wesl::ModulePath;
use wesl::syntax::PathOrigin;

use crate::{Outcome, alike};
use corpus::{FEATURES, FILES, PACKAGES, ROOTS, Style};

/// Permutations of each root.
const PERMUTATIONS: usize = 4;

/// How often our texts are composed. One pass takes a few milliseconds, which differs by half from
/// run to run, so the mean is reported. `wesl` takes about a second.
const RUNS: u32 = 20;

/// Prints how often each tool composes the roots in a second.
pub fn run() -> Outcome {
    println!(
        "packages: {FILES} modules in {PACKAGES} packages, {} lines, {FEATURES} features, {ROOTS} roots, {PERMUTATIONS} permutations each",
        corpus::lines()
    );
    println!(
        "packages: wesl reads the blocks as a condition at each declaration, and packages as folders"
    );
    let ((ours, elapsed), (theirs, longer)) = (ours()?, theirs()?);
    for (ours, theirs) in ours.iter().zip(&theirs) {
        if declarations(ours)? != declarations(theirs)? {
            return Err("both tools compose a root, but not the same declarations".into());
        }
    }
    let rate = |elapsed: Duration| (ROOTS * PERMUTATIONS) as f64 / elapsed.as_secs_f64();
    println!(
        "packages to text: lamplight {:.1}/s, wesl {:.1}/s, {:.1}x; the same declarations in each of the {} texts",
        rate(elapsed),
        rate(longer),
        longer.as_secs_f64() / elapsed.as_secs_f64(),
        ours.len()
    );
    Ok(())
}

/// The declarations that naga reads in a text, in any order. `wesl` keeps the braces of blocks in
/// functions, which then are blocks of WGSL.
fn declarations(text: &str) -> Result<std::collections::BTreeSet<String>, String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    let flat = |declaration: String| {
        let lines = declaration.lines().map(str::trim).filter(|line| !["{", "}"].contains(line));
        lines.collect::<Vec<_>>().join("\n")
    };
    Ok(alike::normalised(module, &[]).into_iter().map(flat).collect())
}

type Texts = (Vec<String>, Duration);

fn ours() -> Result<Texts, Box<dyn Error>> {
    let packages = packages();
    let load = |root: usize| {
        resolve::wesl::load(&mut SourceSet::default(), &packages, &format!("root_{root}.wesl"))
    };
    let graphs: Result<Vec<_>, _> = (0..ROOTS).map(load).collect();
    let graphs = graphs.map_err(|problems| format!("{problems:?}"))?;
    let settings: Vec<Settings> = (0..PERMUTATIONS).map(settings).collect();
    let options = Options::default();
    let compose = || {
        let jobs =
            graphs.iter().flat_map(|graph| settings.iter().map(move |settings| (graph, settings)));
        jobs.map(|(graph, settings)| Ok(composer::compose(graph, settings, &options)?.text))
            .collect::<Result<Vec<_>, Vec<Diagnostic>>>()
    };
    let mut elapsed = Duration::ZERO;
    let mut texts = Vec::new();
    for _ in 0..RUNS {
        let start = Instant::now();
        let composed = compose();
        elapsed += start.elapsed();
        texts = composed.map_err(|problems| format!("{problems:?}"))?;
    }
    Ok((texts, elapsed / RUNS))
}

fn packages() -> Packages {
    let mut files = vec![BTreeMap::new(); PACKAGES];
    for module in 0..FILES {
        let (package, names) = corpus::place(module);
        let path = format!("{}.wesl", names.join("/"));
        files[package].insert(path, corpus::module(module, Style::Blocks));
    }
    let package =
        |(index, files)| Package { name: corpus::package(index), files: Box::new(Memory(files)) };
    let roots = (0..ROOTS)
        .map(|root| (format!("root_{root}.wesl"), corpus::root(root, Style::Blocks)))
        .collect();
    let root = Package { name: "package".to_owned(), files: Box::new(Memory(roots)) };
    Packages::new(root, files.into_iter().enumerate().map(package).collect())
}

fn settings(permutation: usize) -> Settings {
    let value = |index| (corpus::feature(index), Setting::Bool(corpus::is_on(permutation, index)));
    Settings { values: (0..FEATURES).map(value).collect(), ..Settings::default() }
}

fn theirs() -> Result<Texts, Box<dyn Error>> {
    let path = |names: Vec<String>| ModulePath::new(PathOrigin::Absolute, names);
    let mut resolver = wesl::VirtualResolver::new();
    for module in 0..FILES {
        let (package, names) = corpus::place(module);
        let names = [corpus::package(package)].into_iter().chain(names).collect();
        resolver.add_module(path(names), Cow::Owned(corpus::module(module, Style::Each)));
    }
    let root_path = |root: usize| path(vec![format!("root_{root}")]);
    for root in 0..ROOTS {
        resolver.add_module(root_path(root), Cow::Owned(corpus::root(root, Style::Each)));
    }
    let mut compiler = wesl::Wesl::new_barebones().set_custom_resolver(resolver);
    compiler
        .set_options(wesl::CompileOptions { validate: false, ..wesl::CompileOptions::default() });
    let mut texts = Vec::new();
    let start = Instant::now();
    for root in 0..ROOTS {
        for permutation in 0..PERMUTATIONS {
            for index in 0..FEATURES {
                compiler.set_feature(&corpus::feature(index), corpus::is_on(permutation, index));
            }
            texts.push(compiler.compile(&root_path(root))?.to_string());
        }
    }
    Ok((texts, start.elapsed()))
}
