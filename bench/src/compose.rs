//! Composition: Lamplight, `wesl` and `naga_oil` over the same roots, flags and modules.
//!
//! Each tool is used as its documentation says, and checks nothing twice: `wesl` runs without its
//! own validation and source map, and `naga_oil` gets its modules once and runs without its inner
//! validation. For all of them the last step is naga's validator.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

use lamplight::compose::{Options, wesl as composer};
use lamplight::diagnostic::Diagnostics;
use lamplight::permute::{Setting, Settings};
use lamplight::resolve::{self, Packages, wesl::Graph};
use lamplight::source::{Memory, Package, SourceSet};
use naga_oil::compose::{
    ComposableModuleDescriptor, Composer, NagaModuleDescriptor, ShaderDefValue,
};

use crate::Outcome;
use crate::corpus::{self, Dialect, FLAGS, MODULES, ROOTS};
use crate::{library, packages};

/// Permutations of each root.
const PERMUTATIONS: usize = 8;
const JOBS: usize = ROOTS * PERMUTATIONS;

/// Prints every figure. The last line has the two ratios.
pub fn run() -> Outcome {
    let lines = corpus::lines(Dialect::Wesl);
    println!(
        "corpus: {MODULES} modules, {lines} lines, {ROOTS} roots, {PERMUTATIONS} permutations of {FLAGS} flags each"
    );
    let files = files();
    println!("lamplight: all modules loaded and indexed in {}", millis(loading(&files)?));
    let graphs = timed(|| load(&files));
    println!(
        "lamplight: {ROOTS} roots loaded, each with what it reaches, in {}",
        millis(graphs.elapsed)
    );
    let ours = compose(&graphs.value?)?;
    println!(
        "lamplight: {} lines of text a permutation",
        ours.value.iter().map(|text| text.lines().count()).sum::<usize>() / JOBS
    );
    let theirs = wesl_texts()?;
    println!("to text: lamplight {}, wesl {}", ours.rate(), theirs.rate());
    let naga = parse(&ours.value)?;
    let share = 100.0 * ours.elapsed.as_secs_f64() / naga.parse.as_secs_f64();
    println!(
        "composition adds {share:.1} % to naga's parsing ({} to {})",
        millis(ours.elapsed),
        millis(naga.parse)
    );
    let oil = naga_oil_modules()?;
    let whole = Timed { value: (), elapsed: ours.elapsed + naga.parse + naga.validate, jobs: JOBS };
    println!("to a validated module: lamplight {}, naga_oil {}", whole.rate(), oil.rate());
    library::run()?;
    packages::run()?;
    println!(
        "compose: {:.1}x wesl, {:.2}x naga_oil",
        ours.times_faster(&theirs),
        whole.times_faster(&oil)
    );
    Ok(())
}

/// A peer that needs longer than this is measured over what it made until then.
const LONGEST: Duration = Duration::from_secs(90);

/// What was made, in how many jobs, and how long that took.
struct Timed<T> {
    value: T,
    elapsed: Duration,
    jobs: usize,
}

impl<T> Timed<T> {
    fn rate(&self) -> String {
        format!("{:.1}/s", self.a_second())
    }

    fn a_second(&self) -> f64 {
        self.jobs as f64 / self.elapsed.as_secs_f64()
    }

    fn times_faster<U>(&self, other: &Timed<U>) -> f64 {
        self.a_second() / other.a_second()
    }
}

fn timed<T>(make: impl FnOnce() -> T) -> Timed<T> {
    let start = Instant::now();
    let value = make();
    Timed { value, elapsed: start.elapsed(), jobs: JOBS }
}

fn files() -> BTreeMap<String, String> {
    let modules = (0..MODULES).map(|module| {
        (format!("{}.wesl", corpus::path(module).join("/")), corpus::module(module, Dialect::Wesl))
    });
    let roots =
        (0..ROOTS).map(|root| (format!("root_{root}.wesl"), corpus::root(root, Dialect::Wesl)));
    modules.chain(roots).chain([("everything.wesl".to_owned(), corpus::everything())]).collect()
}

fn packages(files: &BTreeMap<String, String>) -> Packages {
    let files = Box::new(Memory(files.clone()));
    Packages::new(Package { name: "package".to_owned(), files }, Vec::new())
}

/// The best of several runs, since the first one touches memory for the first time.
fn loading(files: &BTreeMap<String, String>) -> Result<Duration, String> {
    let packages = packages(files);
    let mut best = Duration::MAX;
    for _ in 0..5 {
        let loaded =
            timed(|| resolve::wesl::load(&mut SourceSet::default(), &packages, "everything.wesl"));
        loaded.value.map_err(message_of)?;
        best = best.min(loaded.elapsed);
    }
    Ok(best)
}

fn load(files: &BTreeMap<String, String>) -> Result<Vec<Graph>, String> {
    let packages = packages(files);
    let load = |root| {
        resolve::wesl::load(&mut SourceSet::default(), &packages, &format!("root_{root}.wesl"))
            .map_err(message_of)
    };
    (0..ROOTS).map(load).collect()
}

fn message_of(diagnostics: Diagnostics) -> String {
    format!("{diagnostics:?}")
}

/// How often all texts are composed. One pass takes some 30 ms, which differs by half from run to
/// run, so the mean is reported. The other tools take seconds.
const RUNS: u32 = 20;

fn compose(graphs: &[Graph]) -> Result<Timed<Vec<String>>, String> {
    let settings: Vec<Settings> = (0..PERMUTATIONS).map(settings).collect();
    let options = Options::default();
    let jobs =
        || graphs.iter().flat_map(|graph| settings.iter().map(move |settings| (graph, settings)));
    let run = || {
        jobs()
            .map(|(graph, settings)| Ok(composer::compose(graph, settings, &options)?.text))
            .collect::<Result<_, _>>()
    };
    let mut texts = timed(run);
    for _ in 1..RUNS {
        let next = timed(run);
        texts = Timed { elapsed: texts.elapsed + next.elapsed, ..next };
    }
    Ok(Timed { value: texts.value.map_err(message_of)?, elapsed: texts.elapsed / RUNS, jobs: JOBS })
}

fn settings(permutation: usize) -> Settings {
    let values = (0..FLAGS).map(|flag| {
        (corpus::flag_name(flag, Dialect::Wesl), Setting::Bool(corpus::flag(permutation, flag)))
    });
    Settings { values: values.collect(), ..Settings::default() }
}

fn wesl_texts() -> Result<Timed<()>, Box<dyn Error>> {
    let mut resolver = wesl::VirtualResolver::new();
    let module_path =
        |segments| wesl::ModulePath::new(wesl::syntax::PathOrigin::Absolute, segments);
    for module in 0..MODULES {
        resolver.add_module(
            module_path(corpus::path(module)),
            Cow::Owned(corpus::module(module, Dialect::Wesl)),
        );
    }
    for root in 0..ROOTS {
        resolver.add_module(
            module_path(vec![format!("root_{root}")]),
            Cow::Owned(corpus::root(root, Dialect::Wesl)),
        );
    }
    let mut compiler = wesl::Wesl::new_barebones().set_custom_resolver(resolver);
    compiler
        .set_options(wesl::CompileOptions { validate: false, ..wesl::CompileOptions::default() });
    let start = Instant::now();
    for root in 0..ROOTS {
        for permutation in 0..PERMUTATIONS {
            for flag in 0..FLAGS {
                compiler.set_feature(
                    &corpus::flag_name(flag, Dialect::Wesl),
                    corpus::flag(permutation, flag),
                );
            }
            let path = module_path(vec![format!("root_{root}")]);
            black_box(compiler.compile(&path)?.to_string());
        }
    }
    Ok(Timed { value: (), elapsed: start.elapsed(), jobs: JOBS })
}

struct Naga {
    parse: Duration,
    validate: Duration,
}

fn parse(texts: &[String]) -> Result<Naga, String> {
    let parse = |text: &String| {
        naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))
    };
    let parsed = timed(|| texts.iter().map(parse).collect::<Result<Vec<_>, _>>());
    let modules = parsed.value?;
    let validate = |module: &naga::Module| {
        validator().validate(module).map(drop).map_err(|error| error.to_string())
    };
    let validated = timed(|| modules.iter().try_for_each(validate));
    validated.value?;
    Ok(Naga { parse: parsed.elapsed, validate: validated.elapsed })
}

fn validator() -> naga::valid::Validator {
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::default(),
    )
}

/// Modules are added once. Each permutation then makes a module and validates it.
fn naga_oil_modules() -> Result<Timed<()>, Box<dyn Error>> {
    let mut composer = Composer::non_validating();
    let added = timed(|| {
        (0..MODULES).try_for_each(|module| {
            let (source, path) =
                (corpus::module(module, Dialect::NagaOil), corpus::path(module).join("/"));
            let descriptor = ComposableModuleDescriptor {
                source: &source,
                file_path: &path,
                ..Default::default()
            };
            composer.add_composable_module(descriptor).map(drop).map_err(Box::new)
        })
    });
    added.value?;
    println!("naga_oil: modules added in {}", millis(added.elapsed));
    let roots: Vec<String> = (0..ROOTS).map(|root| corpus::root(root, Dialect::NagaOil)).collect();
    let (start, mut jobs) = (Instant::now(), 0);
    // Roots of one permutation share the modules that were built for it.
    for (permutation, source) in (0..PERMUTATIONS)
        .flat_map(|permutation| roots.iter().map(move |source| (permutation, source)))
    {
        let shader_defs = naga_oil_defs(permutation);
        let module = composer.make_naga_module(NagaModuleDescriptor {
            source,
            file_path: "root.wgsl",
            shader_defs,
            ..Default::default()
        })?;
        validator().validate(&module)?;
        jobs += 1;
        if start.elapsed() > LONGEST {
            break;
        }
    }
    println!("naga_oil: {jobs} of {JOBS} modules made in {}", millis(start.elapsed()));
    Ok(Timed { value: (), elapsed: start.elapsed(), jobs })
}

fn naga_oil_defs(permutation: usize) -> HashMap<String, ShaderDefValue> {
    let on = (0..FLAGS).filter(|flag| corpus::flag(permutation, *flag));
    on.map(|flag| (corpus::flag_name(flag, Dialect::NagaOil), ShaderDefValue::Bool(true))).collect()
}

fn millis(duration: Duration) -> String {
    format!("{:.1} ms", duration.as_secs_f64() * 1e3)
}
