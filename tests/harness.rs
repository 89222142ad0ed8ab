//! The numeric harness: executors, kernels, expressions and cases.

mod refused;
mod visibility;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use lamplight::LIBRARY_FILES;
use lamplight::bundle::Language;
use lamplight::check::check;
use lamplight::check::expression::CompiledExpression;
use lamplight::check::library::Library;
use lamplight::execute::executors::ExecutorEntry;
use lamplight::execute::frame::{Buffers, DrawItem, Drawing, EntryPoint, Mesh, PipelineState};
use lamplight::execute::{self, Session, executors, kernel};
use lamplight::source::{Files as _, Memory, SourceSet};
use libtest_mimic::{Failed, Trial};

use refused::{case_errors, expression_errors, wrong_function};

type Run = fn() -> Result<(), Failed>;

/// One test for each property of the harness and each executor.
pub fn tests() -> Vec<Trial> {
    let executors = executors::ALL.iter().filter(|entry| !entry.reads_glsl);
    let executors = executors.map(|executor| {
        Trial::test(format!("harness::executor::{}", executor.name), move || {
            execute::on_thread(|| {
                runs(executor).map_err(|failed| failed.message().unwrap_or_default().to_owned())
            })
            .ok_or("panicked")?
            .map_err(Failed::from)
        })
    });
    let others: [(&str, Run); 11] = [
        ("library", library),
        ("library_sources", library_sources),
        ("browsers", browsers),
        ("expressions", expressions),
        ("expression_errors", expression_errors),
        ("case_errors", case_errors),
        ("wrong_function", wrong_function),
        ("every_function_has_cases", every_function_has_cases),
        ("vectors", vectors),
        ("lacking", lacking),
        ("many_modules", many_modules),
    ];
    executors
        .chain(others.map(|(name, run)| Trial::test(format!("harness::{name}"), run)))
        .collect()
}

/// Executors in a browser. Their data goes to another process and back, which is slow. So they run
/// only a part of the cases here, and all of them with `lamplight check --executor webgpu --executor
/// webgl2`.
const BROWSERS: [&str; 2] = ["webgl2", "webgpu"];
/// They run the cases of every fourth file.
const PART: usize = 4;

/// Runs a function with every executor open, on a thread that ends before the test does.
fn opened<T: Send>(
    run: impl FnOnce(&mut [check::OpenExecutor]) -> Result<T, Failed> + Send,
) -> Result<T, Failed> {
    opened_of(|entry| !entry.reads_glsl, run)
}

/// Runs a function with some executors open.
fn opened_of<T: Send>(
    wanted: fn(&ExecutorEntry) -> bool,
    run: impl FnOnce(&mut [check::OpenExecutor]) -> Result<T, Failed> + Send,
) -> Result<T, Failed> {
    let outcome = execute::on_thread(|| {
        let mut open = Vec::new();
        for entry in executors::ALL.iter().copied().filter(|entry| wanted(entry)) {
            open.push(check::OpenExecutor { executor: entry.name, session: entry.start()? });
        }
        run(&mut open).map_err(|failed| failed.message().unwrap_or_default().to_owned())
    });
    outcome.ok_or("panicked")?.map_err(Failed::from)
}

/// Executors that run the cases of every module in both languages. Of the others, each runs by day
/// those of every second module in WESL, half of the executors those of even ones, and of every
/// eighth in GLSL, which is translated from WESL. The nightly tests run all.
const OF_BOTH: [&str; 3] = ["eval", "gl", "vulkan"];

/// The library's cases pass on every executor that is not in a browser.
fn library() -> Result<(), Failed> {
    let wanted = |entry: &ExecutorEntry| !BROWSERS.contains(&entry.name) && !entry.reads_glsl;
    if crate::is_whole() {
        return library_on(wanted, &[Language::Wesl, Language::Glsl], (0, 1));
    }
    let is_one = |entry: &ExecutorEntry| OF_BOTH.contains(&entry.name);
    library_on(is_one, &[Language::Wesl, Language::Glsl], (0, 1))?;
    library_on(|entry| turn(entry) == Some(0), &[Language::Wesl], (0, 2))?;
    library_on(|entry| turn(entry) == Some(1), &[Language::Wesl], (1, 2))?;
    library_on(|entry| turn(entry).is_some(), &[Language::Glsl], (0, 2 * PART))
}

/// Which half of the modules an executor runs by day; `None` for those that run all, or none here.
fn turn(entry: &ExecutorEntry) -> Option<usize> {
    let is_other = |one: &ExecutorEntry| {
        !BROWSERS.contains(&one.name) && !one.reads_glsl && !OF_BOTH.contains(&one.name)
    };
    let mut others = executors::ALL.iter().copied().filter(|one| is_other(one));
    others.position(|one| one.name == entry.name).map(|position| position % 2)
}

/// The GLSL modules pass as they are written, compiled by a driver's own front end.
fn library_sources() -> Result<(), Failed> {
    library_on(|entry| entry.reads_glsl, &[Language::Glsl], (0, 1))
}

/// A part of the library's cases passes on the executors in a browser.
fn browsers() -> Result<(), Failed> {
    let wanted = |entry: &ExecutorEntry| BROWSERS.contains(&entry.name);
    library_on(wanted, &[Language::Wesl, Language::Glsl], (0, PART))
}

fn library_on(
    wanted: fn(&ExecutorEntry) -> bool,
    languages: &[Language],
    (first, part): (usize, usize),
) -> Result<(), Failed> {
    opened_of(wanted, |open| {
        let library = Library::shipped(LIBRARY_FILES);
        let sources = Mutex::new(SourceSet::default());
        let only = std::env::var("LAMPLIGHT_CASES").unwrap_or_default();
        let paths: Vec<_> = library
            .case_files()
            .into_iter()
            .filter(|path| path.contains(&only))
            .skip(if only.is_empty() { first } else { 0 })
            .step_by(if only.is_empty() { part } else { 1 })
            .collect();
        let report = library
            .check(&sources, &paths, languages, open)
            .map_err(|errors| render(&sources, &errors))?;
        if std::env::var_os("LAMPLIGHT_TABLE").is_some() {
            println!("{}", check::report_table(&report));
        }
        // If the environment's filter matches no file, the test must fail, since it proved nothing.
        if report.outcomes.is_empty() {
            return Err(format!("no case file has `{only}` in its path").into());
        }
        match (failed(&report) + &check::lacking_text(&report)).as_str() {
            "" => Ok(()),
            text => Err(text.to_owned().into()),
        }
    })
}

/// Checking many modules does not overflow a stack. A thread of the pool that waits for a part of
/// its job starts another job on the same stack, so the depth could grow with the modules.
fn many_modules() -> Result<(), Failed> {
    const MODULES: usize = 400;
    let file = |index: usize| {
        let name = format!("m{index}");
        let cases = format!(
            "[[case]]\nfunction = \"{name}\"\nformula = \"x + {index}\"\n\
             inputs = {{ x = {{ random = [0, 1], count = 64 }} }}\n"
        );
        let text = format!("fn {name}(x: f32) -> f32 {{ return x + {index}.0; }}\n");
        [(format!("{name}.wesl"), text), (format!("{name}.toml"), cases)]
    };
    let files = (0..MODULES).flat_map(file).collect();
    let library = Library::new("mine", Arc::new(Memory(files)), Vec::new());
    let paths: Vec<_> = (0..MODULES).map(|index| format!("m{index}.toml")).collect();
    let sources = Mutex::new(SourceSet::default());
    let report = library
        .check(&sources, &paths, &[Language::Wesl], &mut [])
        .map_err(|errors| render(&sources, &errors))?;
    match report.outcomes.is_empty() {
        true => Ok(()),
        false => Err("without executors, no case should have a result".into()),
    }
}

/// A library of one module in memory.
fn library_of_texts(module: &str, cases: &str) -> Library {
    let files = [("mine.wesl", module), ("mine.toml", cases)]
        .map(|(path, text)| (path.to_owned(), text.to_owned()));
    Library::new("mine", Arc::new(Memory(files.into())), Vec::new())
}

/// A function that a target cannot express is reported as lacking, with the reason, and not as a
/// failure. GLSL ES 3.00 has no arrays of arrays, and GLSL 3.30 has them only with an extension.
fn lacking() -> Result<(), Failed> {
    let module = "fn pick(i: u32) -> f32 {
    var table = array<array<f32, 2>, 2>(array<f32, 2>(1.0, 2.0), array<f32, 2>(3.0, 4.0));
    return table[i / 2u][i % 2u];
}";
    let cases =
        "[[case]]\nfunction = \"pick\"\nformula = \"i + 1\"\ninputs = { i = [0, 1, 2, 3] }\n";
    let library = library_of_texts(module, cases);
    opened(|open| {
        let sources = Mutex::new(SourceSet::default());
        let report = library
            .check(&sources, &["mine.toml".to_owned()], &[Language::Wesl], open)
            .map_err(|errors| render(&sources, &errors))?;
        let lacking = check::lacking_text(&report);
        let prefixes = ["essl300", "webgl2"]
            .map(|one| format!("mine::pick (case 1, wesl on {one}): target `essl300`: "));
        let ran = |outcome: &&check::Outcome| outcome.passed();
        let counted = report.outcomes.iter().filter(ran).count() + lacking.lines().count();
        // Versions of GLSL before 4.30 lack them too.
        let is_essl = |line: &&str| prefixes.iter().any(|prefix| line.starts_with(prefix));
        let mut rest = lacking.lines().filter(|line| !is_essl(line));
        let is_alike = rest.all(|line| line.contains("array of arrays"));
        let is_listed = lacking.lines().filter(is_essl).count() == prefixes.len() && is_alike;
        if report.passed() && is_listed && counted == report.outcomes.len() {
            Ok(())
        } else {
            let what = "expected essl300 and webgl2 to lack arrays of arrays, and no failure";
            Err(format!("{what}; lacking:\n{lacking}\nfailures:\n{}", failed(&report)).into())
        }
    })
}

/// Every function of every module has a numeric case beside it.
fn every_function_has_cases() -> Result<(), Failed> {
    let mut missing = Vec::new();
    for path in LIBRARY_FILES.list(&["wesl"]).iter().filter(|path| !path.starts_with("programs/")) {
        let read = |path: &str| LIBRARY_FILES.read(path).ok().flatten().unwrap_or_default();
        let (module, cases) = (read(path), read(&path.replace(".wesl", ".toml")));
        let names =
            module.lines().filter_map(|line| Some(line.strip_prefix("fn ")?.split_once('(')?.0));
        let tried =
            |name: &&str| cases.lines().any(|line| line == format!("function = \"{name}\""));
        let module = path.trim_end_matches(".wesl").replace('/', "::");
        missing.extend(names.filter(|name| !tried(name)).map(|name| format!("{module}::{name}")));
    }
    if missing.is_empty() {
        Ok(())
    } else {
        Err(format!("these functions have no case:\n{}", missing.join("\n")).into())
    }
}

/// For a vector parameter, a list within a list holds vectors: two here, not six numbers.
fn vectors() -> Result<(), Failed> {
    let module = "fn length_of(v: vec3f) -> f32 { return length(v); }";
    let cases = "[[case]]\nfunction = \"length_of\"\nformula = \"length(v)\"\ntolerance = { ulp = 4 }\nlaws = { reaches = [0, 5] }\ninputs = { v = [[[0, 0, 0], [3, 0, 4]]] }\n";
    let library = library_of_texts(module, cases);
    opened(|open| {
        let sources = Mutex::new(SourceSet::default());
        let report = library
            .check(&sources, &["mine.toml".to_owned()], &[Language::Wesl], open)
            .map_err(|errors| render(&sources, &errors))?;
        let inputs: Vec<_> = report
            .outcomes
            .iter()
            .map(|outcome| outcome.verdict.as_ref().map_or(0, |verdict| verdict.inputs))
            .collect();
        if report.passed() && inputs.iter().all(|count| *count == 2) {
            Ok(())
        } else {
            Err(format!("expected 2 inputs each, found {inputs:?}\n{}", failed(&report)).into())
        }
    })
}

/// Expressions with their values, which must be the same in both languages and on every executor.
const EXPRESSIONS: &[(&str, &str)] = &[
    ("lighting::spot::cone_exponent(0.5, 0.25, 2.0)", "0.25"),
    ("lamplight::lighting::spot::cone_hard(0.5, 0.75) + 1f", "1"),
    ("vec3f(1, 2, 3).zyx * 0.5", "1.5 1 0.5"),
    ("mat2x2<f32>(1.0, 2.0, 3.0, 4.0)", "1 2 3 4"),
    ("math::safe::is_nan_bits(1.0)", "false"),
    ("lighting::material::material_index(3, false)", "7"),
    (
        "ambient::sh::sh4_irradiance(vec3f(0.0), array<vec3f, 4>(vec3f(1.0), vec3f(), vec3f(0.0), vec3<f32>(0.0)))",
        "0.886227 0.886227 0.886227",
    ),
    ("brdf::diffuse::lambert(vec3f(0.0, 1.0, 0.0), vec3f(0.0, 1.0, 0.0))", "1"),
    ("shadow::coord::project(vec4f(0.0, 0.0, 0.5, 1.0), 0.0)", "0.5 0.5 0.5 true"),
];

fn expressions() -> Result<(), Failed> {
    let (library, sources) = (Library::shipped(LIBRARY_FILES), Mutex::new(SourceSet::default()));
    let mut compiled = Vec::new();
    for (text, expected) in EXPRESSIONS {
        for language in [Language::Wesl, Language::Glsl] {
            let one = CompiledExpression::new(&library, &sources, text, language)
                .map_err(|errors| render(&sources, &errors))?;
            compiled.push((*text, language, *expected, one));
        }
    }
    opened(|open| {
        let mut wrong = String::new();
        for open in open.iter_mut() {
            let kernels: Vec<_> = compiled.iter().map(|(.., one)| &one.kernel).collect();
            open.session.prepare(&kernels);
            for (text, language, expected, one) in &compiled {
                let found = match one.value(open.session.as_mut()) {
                    Ok(value) => value.to_string(),
                    Err(errors) => {
                        render(&sources, &errors).message().unwrap_or_default().to_owned()
                    }
                };
                if found != *expected {
                    wrong += &format!(
                        "{text} in {language:?} on {}: found {found}, expected {expected}\n",
                        open.executor
                    );
                }
            }
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
    })
}

/// The failures of a report, as text.
fn failed(report: &check::CheckReport) -> String {
    check::failures_as_text(&check::report_failures(report))
}

fn render(sources: &Mutex<SourceSet>, errors: &[lamplight::diagnostic::Diagnostic]) -> Failed {
    lamplight::diagnostic::render::render(&sources.lock().unwrap(), errors, Default::default())
        .into()
}

const SHAPES: &str = "
struct Inner { flag: bool, pair: vec2f }
struct Outer { inner: array<Inner, 2>, m: mat3x2f, i: i32 }
fn shapes(a: f32, o: Outer, u: vec3u) -> Outer {
    var r = o;
    r.inner[1].flag = !o.inner[1].flag;
    r.m[1].y = a * 2.0;
    r.i = o.i - i32(u.z);
    return r;
}";

/// An executor runs a kernel with structs, matrices, booleans and integers, with more rows than one
/// dispatch has, and gives the exact words.
fn runs(executor: &'static executors::ExecutorEntry) -> Result<(), Failed> {
    let module = naga::front::wgsl::parse_str(SHAPES)?;
    let kernel = kernel::build_kernel(&module, "shapes", &BTreeMap::new())
        .map_err(|error| format!("{error:?}"))?;
    assert_eq!((kernel.input_words(), kernel.result_words()), (17, 13));
    let mut session = executor.start()?;
    let count = 70_000u32;
    let inputs: Vec<u32> = (0..count).flat_map(shapes_input).collect();
    let results = session.run(&kernel, &inputs).map_err(|error| format!("{error:?}"))?;
    for (i, found) in results.chunks(13).enumerate() {
        assert_eq!(found, shapes_expected(i as u32), "invocation {i} on {}", session.adapter());
    }
    assert_eq!(results.len(), count as usize * 13);
    draws_as_listed(executor, session.as_ref())?;
    if executor.samples.is_some() {
        visibility::holds(session.as_ref())?;
    }
    Ok(())
}

/// An executor draws frames exactly if its entry says so.
fn draws_as_listed(
    executor: &executors::ExecutorEntry,
    session: &dyn Session,
) -> Result<(), Failed> {
    let text = "@vertex fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
        return vec4f(f32(index & 1u), f32(index >> 1u), 0.5, 1.0);
    }";
    let module = naga::front::wgsl::parse_str(text)?;
    let (mesh, none, state) = (Mesh::default(), Buffers::new(), PipelineState::default());
    let drawing = Drawing {
        vertex: EntryPoint { module: &module, entry: "corner" },
        fragment: None,
        targets: 0,
        items: &[DrawItem { mesh: &mesh, buffers: &none }],
        views: &[Buffers::new()],
        buffers: &none,
        plain: &[],
        fixtures: &BTreeMap::new(),
        levels: &BTreeMap::new(),
        size: [8, 8],
        state: PipelineState { depth_test: true, keep_depth: true, ..state },
    };
    match (session.draw_frames(&drawing), executor.samples) {
        (Ok(frames), Some(_)) => {
            let covered = frames[0].depth.iter().filter(|depth| **depth == 0.5).count();
            assert!((4..16).contains(&covered), "a triangle over 8 of 64 pixels covers {covered}");
            Ok(())
        }
        (Err(_), None) => Ok(()),
        (Err(problem), Some(_)) => Err(problem.message.into()),
        (Ok(_), None) => {
            Err(format!("`{}` draws frames, but its entry says that it does not", executor.name)
                .into())
        }
    }
}

fn shapes_input(i: u32) -> [u32; 17] {
    let f = |x: u32| ((i + x) as f32).to_bits();
    [f(0), 1, f(1), f(2), i & 1, f(3), f(4), f(5), f(6), f(7), f(8), f(9), f(10), i, 0, 0, 7]
}

fn shapes_expected(i: u32) -> [u32; 13] {
    let f = |x: u32| ((i + x) as f32).to_bits();
    let doubled = (i as f32 * 2.0).to_bits();
    [
        1,
        f(1),
        f(2),
        1 - (i & 1),
        f(3),
        f(4),
        f(5),
        f(6),
        f(7),
        doubled,
        f(9),
        f(10),
        i.wrapping_sub(7),
    ]
}
