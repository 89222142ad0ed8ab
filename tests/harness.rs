//! The numeric harness: executors, kernels, cases.

use std::collections::BTreeMap;

use lamplight::compose::Language;
use lamplight::harness::{cases, check, executors, kernel};
use lamplight::source::{Embedded, Files, SourceSet};
use libtest_mimic::{Failed, Trial};

/// One trial for each property of the harness and each executor.
pub fn trials() -> Vec<Trial> {
    let executors = executors::ALL.iter().map(|executor| Trial::test(format!("harness::executor::{}", executor.name), move || runs(executor)));
    executors.chain([Trial::test("harness::library", library)]).collect()
}

/// The library's own cases, in both languages, on every executor.
fn library() -> Result<(), Failed> {
    let mut sources = SourceSet::default();
    let mut files = Vec::new();
    let only = std::env::var("ONLY").unwrap_or_default();
    for path in Embedded.list(&["toml"]) {
        let module = path.trim_end_matches(".toml").replace('/', "::");
        if !module.contains("::") || !module.contains(&only) {
            continue;
        }
        let id = sources.add(path.as_str(), Embedded.read(&path).ok().flatten().unwrap_or_default());
        files.push((module, cases::parse(&sources, id).map_err(|errors| render(&sources, &errors))?));
    }
    let mut open = Vec::new();
    for entry in executors::ALL {
        open.push(check::Open { executor: entry.name, session: (entry.open)().map_err(|error| entry.missing(&error))? });
    }
    let start = std::time::Instant::now();
    let report = check::check(&files, &[Language::Wesl, Language::Glsl], &flat, &mut open).map_err(|errors| render(&sources, &errors))?;
    println!("{}{}{:?}", check::table(&report), check::failures(&report), start.elapsed());
    if report.passed() { Ok(()) } else { Err("numbers are off".into()) }
}

fn render(sources: &SourceSet, errors: &[lamplight::diagnostic::Diagnostic]) -> Failed {
    lamplight::diagnostic::render::render(sources, errors, Default::default()).into()
}

fn flat(module: &str, language: Language, _: &[String]) -> Result<std::sync::Arc<naga::Module>, Vec<lamplight::diagnostic::Diagnostic>> {
    let path = module.replace("::", "/");
    let mut text = String::new();
    let error = |e: String| vec![lamplight::diagnostic::Diagnostic::error(lamplight::diagnostic::codes::WGSL_ERROR, e)];
    let extension = if language == Language::Wesl { "wesl" } else { "glsl" };
    include(&path, extension, &mut Vec::new(), &mut text);
    if language == Language::Wesl {
        return naga::front::wgsl::parse_str(&text).map(Into::into).map_err(|e| error(e.emit_to_string(&text)));
    }
    let text = format!("#version 450\n{text}\nvoid main() {{}}\n");
    let options = naga::front::glsl::Options::from(naga::ShaderStage::Fragment);
    naga::front::glsl::Frontend::default().parse(&options, &text).map(Into::into).map_err(|e| error(e.emit_to_string(&text)))
}

fn include(path: &str, extension: &str, seen: &mut Vec<String>, text: &mut String) {
    if seen.iter().any(|known| known == path) {
        return;
    }
    seen.push(path.to_owned());
    let own = Embedded.read(&format!("{path}.{extension}")).ok().flatten().unwrap_or_default();
    for line in own.lines() {
        if let Some(rest) = line.strip_prefix("import package::") {
            let parts: Vec<_> = rest.split("::").collect();
            include(&format!("{}/{}", parts[0], parts[1]), extension, seen, text);
        } else if let Some(rest) = line.strip_prefix("#include \"") {
            let folder = path.split('/').next().unwrap();
            let rest = rest.trim_end_matches('"').trim_end_matches(".glsl");
            let inner = rest.strip_prefix("../").map_or(format!("{folder}/{rest}"), str::to_owned);
            include(&inner, extension, seen, text);
        }
    }
    for line in own.lines().filter(|line| !line.starts_with("import ") && !line.starts_with("#include")) {
        text.push_str(line);
        text.push('\n');
    }
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

fn runs(executor: &executors::Entry) -> Result<(), Failed> {
    let module = naga::front::wgsl::parse_str(SHAPES)?;
    let kernel = kernel::build(&module, "shapes", &BTreeMap::new()).map_err(|error| format!("{error:?}"))?;
    assert_eq!((kernel.input_words(), kernel.result_words()), (17, 13));
    let mut session = (executor.open)().map_err(|error| executor.missing(&error))?;
    let count = 70_000u32;
    let inputs: Vec<u32> = (0..count).flat_map(shapes_input).collect();
    let results = session.run(&kernel, &inputs).map_err(|error| format!("{error:?}"))?;
    for (i, found) in results.chunks(13).enumerate() {
        assert_eq!(found, shapes_expected(i as u32), "invocation {i} on {}", session.adapter());
    }
    assert_eq!(results.len(), count as usize * 13);
    Ok(())
}

fn shapes_input(i: u32) -> [u32; 17] {
    let f = |x: u32| ((i + x) as f32).to_bits();
    [f(0), 1, f(1), f(2), i & 1, f(3), f(4), f(5), f(6), f(7), f(8), f(9), f(10), i, 0, 0, 7]
}

fn shapes_expected(i: u32) -> [u32; 13] {
    let f = |x: u32| ((i + x) as f32).to_bits();
    let doubled = (i as f32 * 2.0).to_bits();
    [1, f(1), f(2), 1 - (i & 1), f(3), f(4), f(5), f(6), f(7), doubled, f(9), f(10), i.wrapping_sub(7)]
}
