//! Composition: Lamplight, `wesl` and `naga_oil` over the same roots, flags and modules.

use std::borrow::Cow;
use std::collections::HashMap;
use std::hint::black_box;
use std::time::{Duration, Instant};

use lamplight::compose::{Options, wesl as composer};
use lamplight::permute::{Setting, Settings};
use lamplight::resolve::{self, Packages, wesl::Graph};
use lamplight::source::{Memory, Package, SourceSet};
use naga_oil::compose::{ComposableModuleDescriptor, Composer, NagaModuleDescriptor, ShaderDefValue};

use crate::Outcome;
use crate::corpus::{self, Dialect, FLAGS, MODULES, ROOTS};

/// Permutations of each root.
const PERMUTATIONS: usize = 8;

/// Prints every figure; the last line is the two ratios.
pub fn run() -> Outcome {
    println!(
        "corpus: {MODULES} modules, {} lines, {ROOTS} roots, {PERMUTATIONS} permutations of {FLAGS} flags each",
        corpus::lines(Dialect::Wesl)
    );
    let (graphs, loading) = load()?;
    println!("lamplight: corpus loaded and indexed, all roots: {}", millis(loading));
    let ours = compose(&graphs)?;
    let theirs = wesl_texts()?;
    let jobs = (ROOTS * PERMUTATIONS) as f64;
    let to_text = theirs.as_secs_f64() / ours.elapsed.as_secs_f64();
    println!("to text: lamplight {:.0}/s, wesl {:.1}/s", jobs / ours.elapsed.as_secs_f64(), jobs / theirs.as_secs_f64());
    let naga = parse(&ours.texts)?;
    println!(
        "composition adds {:.1} % to naga's parsing ({} over {})",
        100.0 * ours.elapsed.as_secs_f64() / naga.parse.as_secs_f64(),
        millis(ours.elapsed),
        millis(naga.parse)
    );
    let oil = naga_oil_modules()?;
    let whole = ours.elapsed + naga.parse + naga.validate;
    let to_module = oil.as_secs_f64() / whole.as_secs_f64();
    println!("to a validated module: lamplight {:.1}/s, naga_oil {:.1}/s", jobs / whole.as_secs_f64(), jobs / oil.as_secs_f64());
    println!("compose: {to_text:.1}x wesl, {to_module:.2}x naga_oil");
    Ok(())
}

fn load() -> Result<(Vec<Graph>, Duration), String> {
    let mut files = Memory::default();
    for module in 0..MODULES {
        files.0.insert(format!("{}.wesl", corpus::path(module).join("/")), corpus::module(module, Dialect::Wesl));
    }
    for root in 0..ROOTS {
        files.0.insert(format!("root_{root}.wesl"), corpus::root(root, Dialect::Wesl));
    }
    let packages = Packages { root: Package { name: "package".to_owned(), files: Box::new(files) }, dependencies: Vec::new() };
    let start = Instant::now();
    let graphs: Result<Vec<Graph>, _> =
        (0..ROOTS).map(|root| resolve::wesl::load(&mut SourceSet::default(), &packages, &format!("root_{root}.wesl"))).collect();
    let elapsed = start.elapsed();
    Ok((graphs.map_err(|diagnostics| format!("{diagnostics:?}"))?, elapsed))
}

struct Texts {
    texts: Vec<String>,
    elapsed: Duration,
}

fn compose(graphs: &[Graph]) -> Result<Texts, String> {
    let settings: Vec<Settings> = (0..PERMUTATIONS).map(settings).collect();
    let start = Instant::now();
    let mut texts = Vec::new();
    for graph in graphs {
        for settings in &settings {
            let composed = composer::compose(graph, settings, &Options::default()).map_err(|diagnostics| format!("{diagnostics:?}"))?;
            texts.push(composed.text);
        }
    }
    Ok(Texts { texts, elapsed: start.elapsed() })
}

fn settings(permutation: usize) -> Settings {
    let values = (0..FLAGS).map(|flag| (corpus::flag_name(flag, Dialect::Wesl), Setting::Bool(corpus::flag(permutation, flag))));
    Settings { values: values.collect(), ..Settings::default() }
}

fn wesl_texts() -> Result<Duration, Box<dyn std::error::Error>> {
    let mut resolver = wesl::VirtualResolver::new();
    let module_path = |segments| wesl::ModulePath::new(wesl::syntax::PathOrigin::Absolute, segments);
    for module in 0..MODULES {
        resolver.add_module(module_path(corpus::path(module)), Cow::Owned(corpus::module(module, Dialect::Wesl)));
    }
    for root in 0..ROOTS {
        resolver.add_module(module_path(vec![format!("root_{root}")]), Cow::Owned(corpus::root(root, Dialect::Wesl)));
    }
    let mut compiler = wesl::Wesl::new_barebones().set_custom_resolver(resolver);
    compiler.use_imports(true).use_condcomp(true).use_stripping(true);
    compiler.set_mangler(wesl::ManglerKind::None);
    let start = Instant::now();
    for root in 0..ROOTS {
        for permutation in 0..PERMUTATIONS {
            for flag in 0..FLAGS {
                compiler.set_feature(&corpus::flag_name(flag, Dialect::Wesl), corpus::flag(permutation, flag));
            }
            let path = module_path(vec![format!("root_{root}")]);
            black_box(compiler.compile(&path)?.to_string());
        }
    }
    Ok(start.elapsed())
}

struct Naga {
    parse: Duration,
    validate: Duration,
}

fn parse(texts: &[String]) -> Result<Naga, String> {
    let start = Instant::now();
    let modules: Result<Vec<_>, _> =
        texts.iter().map(|text| naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))).collect();
    let (modules, parse) = (modules?, start.elapsed());
    let start = Instant::now();
    for module in &modules {
        validator().validate(module).map_err(|error| error.to_string())?;
    }
    Ok(Naga { parse, validate: start.elapsed() })
}

fn validator() -> naga::valid::Validator {
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::default())
}

/// Modules are added once; each permutation then makes a module and validates it.
fn naga_oil_modules() -> Result<Duration, Box<dyn std::error::Error>> {
    let mut composer = Composer::default();
    for module in 0..MODULES {
        let source = corpus::module(module, Dialect::NagaOil);
        composer.add_composable_module(ComposableModuleDescriptor {
            source: &source,
            file_path: &corpus::path(module).join("/"),
            ..Default::default()
        })?;
    }
    let roots: Vec<String> = (0..ROOTS).map(|root| corpus::root(root, Dialect::NagaOil)).collect();
    let start = Instant::now();
    for source in &roots {
        for permutation in 0..PERMUTATIONS {
            let shader_defs = naga_oil_defs(permutation);
            let module =
                composer.make_naga_module(NagaModuleDescriptor { source, file_path: "root.wgsl", shader_defs, ..Default::default() })?;
            validator().validate(&module)?;
        }
    }
    Ok(start.elapsed())
}

fn naga_oil_defs(permutation: usize) -> HashMap<String, ShaderDefValue> {
    let on = (0..FLAGS).filter(|flag| corpus::flag(permutation, *flag));
    on.map(|flag| (corpus::flag_name(flag, Dialect::NagaOil), ShaderDefValue::Bool(true))).collect()
}

fn millis(duration: Duration) -> String {
    format!("{:.1} ms", duration.as_secs_f64() * 1e3)
}
