//! Runs the toolchain that is compiled to WebAssembly, in Node through its npm package. Its answers
//! must have the same bytes as those of the native tool. `cargo xtask test` builds the package first.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use lamplight::LIBRARY_FILES;
use lamplight::bundle::{Language, Target};
use lamplight::check::expression::evaluate_expression;
use lamplight::check::library::Library;
use lamplight::check::references;
use lamplight::compose::{Options, compose};
use lamplight::diagnostic::render::{Form, render};
use lamplight::diagnostic::{Diagnostics, Severity};
use lamplight::execute::executors::eval::EXECUTOR;
use lamplight::generate::{Root, entry_points};
use lamplight::link::Linker;
use lamplight::permute::{Program, Quoted, Setting, Settings, cover, key};
use lamplight::project::{self, library_manifest};
use lamplight::resolve::{self, Packages};
use lamplight::source::{Files as _, Memory, Package, SourceSet};
use lamplight::{catalogue, lint};
use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

/// At most this many permutations of each program are compared, by day and at night. They are the
/// first of its covering set, so each has pairs of values that none before it has.
const PERMUTATIONS: [usize; 2] = [16, 64];

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("toolchain::same_bytes", same_bytes)]
}

/// The requests to the package, and the answers of the native tool, which are expected of it.
struct Requests {
    linker: Linker<'static>,
    shaders: Vec<Value>,
    expressions: Vec<Value>,
    mistakes: Vec<Value>,
    references: Vec<Value>,
    expected: Vec<(String, Vec<u8>)>,
}

fn same_bytes() -> Result<(), Failed> {
    let package = package()?;
    let mut requests = Requests {
        linker: Linker::new(Target::ALL),
        shaders: Vec::new(),
        expressions: Vec::new(),
        mistakes: Vec::new(),
        references: Vec::new(),
        expected: Vec::new(),
    };
    lamplight::validate::on_large_stack(|| {
        permutations(&mut requests)?;
        examples(&mut requests)?;
        expressions(&mut requests)?;
        mistakes(&mut requests)?;
        formulas(&mut requests)
    })?;
    let hostile = [
        format!("fn f() -> f32 {{ return {}1{}; }}", "(".repeat(100_000), ")".repeat(100_000)),
        format!(
            "@fragment fn f() -> @location(0) vec4f {{ return vec4f(1.0{}); }}",
            "+1.0".repeat(50_000)
        ),
        "struct A { a: array<array<array<A, 9>, 9>, 9> } @fragment fn f(a: A) {}".to_owned(),
    ];
    let hostile: Vec<Value> = hostile.iter().map(|text| json!({ "a.wesl": text })).collect();
    for index in 0..hostile.len() {
        // After each hostile text the script asks for `1.0 + 2.0`, which must still be answered.
        requests.expected.push((format!("after hostile text {index}"), b"3".to_vec()));
    }
    let scratch = tempfile::tempdir()?;
    let (requests_file, answers) =
        (scratch.path().join("requests"), scratch.path().join("answers"));
    let Requests { shaders, expressions, mistakes, references, expected, .. } = requests;
    let all = json!({
        "shaders": shaders, "expressions": expressions, "mistakes": mistakes,
        "references": references, "hostile": hostile,
    });
    std::fs::write(&requests_file, all.to_string())?;
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/toolchain/answer.mjs");
    let output =
        Command::new("node").arg(script).args([&package, &requests_file, &answers]).output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    compare(&std::fs::read(&answers)?, &expected)
}

/// The folder of the npm package.
fn package() -> Result<PathBuf, Failed> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/toolchain");
    match folder.join("toolchain_bg.wasm").is_file() {
        true => Ok(folder),
        false => Err("there is no npm package: run `cargo xtask site --toolchain --quick`".into()),
    }
}

/// Fails unless the answers of the package are the expected ones, in their order. Each begins with
/// its length in four bytes.
fn compare(answers: &[u8], expected: &[(String, Vec<u8>)]) -> Result<(), Failed> {
    let mut rest = answers;
    for (name, wanted) in expected {
        let short = || format!("the package's answers end before that to `{name}`");
        let (length, after) = rest.split_first_chunk::<4>().ok_or_else(short)?;
        let (found, after) =
            after.split_at_checked(u32::from_le_bytes(*length) as usize).ok_or_else(short)?;
        rest = after;
        if found != wanted {
            let [found, wanted] = [found, wanted].map(String::from_utf8_lossy);
            let what = format!("the package answers\n{found}\nand the native tool\n{wanted}");
            return Err(format!("{name}: {what}").into());
        }
    }
    match rest.len() {
        0 => Ok(()),
        left => Err(format!("{left} bytes follow the answer to the last request").into()),
    }
}

/// Asks for permutations of every program of the library, every second one in GLSL, and for the
/// permutations of the published examples.
fn permutations(requests: &mut Requests) -> Result<(), Failed> {
    let (mut sources, manifest) = library_manifest().map_err(|_| "the library's manifest")?;
    for program in &manifest.programs {
        let points = cover::pairwise(&program.space).points;
        let taken = PERMUTATIONS[usize::from(crate::is_whole())];
        for (index, point) in points.iter().take(taken).enumerate() {
            let key = program.space.key(point).to_string();
            permutation(requests, program, &key, index % 2 == 1)?;
        }
    }
    let (presets, _) =
        catalogue::library_examples(LIBRARY_FILES, &mut sources, &manifest).map_err(message_of)?;
    let mut seen = BTreeSet::new();
    for preset in &presets {
        let missing = || format!("an example names the unknown program `{}`", preset.program);
        let program = manifest.program(&preset.program).ok_or_else(missing)?;
        if seen.insert((preset.program.clone(), preset.key.clone())) {
            permutation(requests, program, &preset.key, false)?;
        }
    }
    Ok(())
}

/// Asks for the roots of a permutation in one language.
fn permutation(
    requests: &mut Requests,
    program: &Program,
    text: &str,
    is_glsl: bool,
) -> Result<(), Failed> {
    let mut sources = SourceSet::default();
    let id = sources.add("key", text.to_owned());
    let point = key::parse(&program.space, &Quoted::whole(&sources, id)).map_err(message_of)?;
    let glsl = program.glsl.iter().flat_map(|glsl| [&glsl.vertex, &glsl.fragment]).flatten();
    let roots: Vec<_> = if is_glsl { glsl.collect() } else { program.wesl.iter().collect() };
    let axes = program.space.axes().iter().enumerate();
    let settings: BTreeMap<&str, Value> = axes
        .map(|(axis, known)| (known.name.as_str(), value(program.space.value(axis, &point))))
        .collect();
    for root in roots {
        let request = json!({ "root": root.path, "settings": settings, "targets": targets() });
        requests.shaders.push(request);
        let settings = program.space.settings(&point);
        let name = format!("{} of {}", text, root.path);
        shader(requests, &name, &project::library_packages(), &root.path, &settings)?;
    }
    Ok(())
}

/// The value of a setting in a request.
fn value(setting: &Setting) -> Value {
    match setting {
        Setting::Bool(value) => json!(value),
        Setting::Int(value) => json!(value),
        other => json!(other.to_string()),
    }
}

fn targets() -> Vec<&'static str> {
    Target::ALL.iter().map(|target| target.name()).collect()
}

/// Expects what the native tool makes of a root file: the composed text, and for each entry point its
/// name, its reflection and its text in every target.
fn shader(
    requests: &mut Requests,
    name: &str,
    packages: &Packages,
    root: &str,
    settings: &Settings,
) -> Result<(), Failed> {
    let language = lint::language(root).unwrap_or(Language::Wesl);
    let mut sources = SourceSet::default();
    let graph = resolve::load(&mut sources, packages, root, language).map_err(message_of)?;
    let options = Options::default();
    let composed = compose(&graph, settings, &options).map_err(message_of)?;
    let root = Root {
        graph: &graph,
        settings,
        options: &options,
        conventions: Default::default(),
        optimiser: None,
        numbers: "",
    };
    let entries = entry_points(&composed).map_err(message_of)?;
    let shaders = root.compile_with(&entries, &requests.linker).map_err(message_of)?;
    let mut expect = |what: String, bytes: Vec<u8>| {
        requests.expected.push((format!("{name}, {what}"), bytes));
    };
    expect("text".to_owned(), composed.text.into_bytes());
    for shader in shaders {
        let unit = &shader.made.unit;
        expect("entry point".to_owned(), shader.entry.into_bytes());
        expect("reflection".to_owned(), serde_json::to_vec(&*unit.reflection)?);
        for target in Target::ALL {
            let artifact = unit.targets.get(target.name()).ok_or("a target is missing")?;
            expect(target.name().to_owned(), artifact.bytes.to_vec());
            expect(format!("{target}'s names"), serde_json::to_vec(&*artifact.native)?);
        }
    }
    Ok(())
}

/// A package of the files in memory, which can import the library.
fn own(files: &BTreeMap<String, String>) -> Packages {
    let library = project::library_package();
    let files = Box::new(Memory(files.clone()));
    Packages::new(Package { name: "package".to_owned(), files }, vec![library])
}

/// Asks for the packages in `examples/`: one with a manifest, in all its permutations, and one
/// without a manifest.
fn examples(requests: &mut Requests) -> Result<(), Failed> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let read = |path: &str| std::fs::read_to_string(folder.join(path));
    let declared = ["lamp.wesl", project::MANIFEST]
        .map(|name| Ok((name.to_owned(), read(&format!("build_script/shaders/{name}"))?)));
    let files = declared.into_iter().collect::<std::io::Result<BTreeMap<_, _>>>()?;
    let mut sources = SourceSet::default();
    let id = sources.add(project::MANIFEST, files[project::MANIFEST].clone());
    let manifest = lamplight::permute::manifest::parse(&sources, id).map_err(message_of)?;
    let program = manifest.program("lamp").ok_or("the example has no `lamp`")?;
    for point in program.space.enumerate() {
        let settings = program.space.settings(&point);
        example(requests, &files, "lamp.wesl", &settings)?;
    }
    let text = read("wesl_crate/shaders/spot.wesl")?;
    let files = BTreeMap::from([("spot.wesl".to_owned(), text)]);
    example(requests, &files, "spot.wesl", &Settings::default())?;
    Ok(())
}

fn example(
    requests: &mut Requests,
    files: &BTreeMap<String, String>,
    name: &str,
    settings: &Settings,
) -> Result<(), Failed> {
    let given: BTreeMap<&String, Value> =
        settings.values.iter().map(|(name, setting)| (name, value(setting))).collect();
    requests.shaders.push(json!({
        "files": files, "root": name, "settings": given, "targets": targets(),
    }));
    shader(requests, name, &own(files), name, settings)
}

/// Asks for the values of the expressions that the library's plots draw, at three places of each
/// plot. At the second place the expression is read as GLSL, elsewhere as WESL.
fn expressions(requests: &mut Requests) -> Result<(), Failed> {
    let (library, mut session) =
        (Library::shipped(LIBRARY_FILES), EXECUTOR.start().map_err(|_| "no evaluator")?);
    for module in catalogue::library_modules(LIBRARY_FILES) {
        let path = catalogue::plot::plot_path(&module.path);
        let Some(text) = LIBRARY_FILES.read(&path).ok().flatten() else { continue };
        let mut sources = SourceSet::default();
        let id = sources.add(path, text);
        for (name, plot) in catalogue::plot::parse_plots(&sources, id).map_err(message_of)? {
            let second = plot.curves.as_ref().and_then(|curves| curves.values.first().copied());
            let parameter = plot.curves.as_ref().map_or("unused", |curves| &curves.name);
            for (index, share) in [0.25, 0.6, 0.85].into_iter().enumerate() {
                let x = plot.x.from + share * (plot.x.to - plot.x.from);
                let path = format!("{}::{name}", module.path);
                let text = substituted(&plot.value, &name, &path, (x, parameter, second));
                let language = if index == 1 { Language::Glsl } else { Language::Wesl };
                let texts = Mutex::new(SourceSet::default());
                let Ok(value) =
                    evaluate_expression(&library, &texts, &text, language, session.as_mut())
                else {
                    continue;
                };
                requests.expressions.push(json!({ "expression": text, "glsl": index == 1 }));
                requests.expected.push((text, value.to_string().into_bytes()));
            }
        }
    }
    match requests.expressions.len() {
        300.. => Ok(()),
        few => Err(format!("{few} expressions have a value, expected 300 or more").into()),
    }
}

/// A plot's expression with numbers in place of its variables, and with the whole path in place of
/// the function's name.
fn substituted(
    text: &str,
    name: &str,
    path: &str,
    (x, parameter, second): (f64, &str, Option<f64>),
) -> String {
    let mut made = String::new();
    let mut word = String::new();
    for letter in text.chars().chain(['\n']) {
        if letter == '_' || letter == '.' || letter.is_alphanumeric() || letter == ':' {
            word.push(letter);
            continue;
        }
        match word.as_str() {
            "x" => made.push_str(&format!("({x:?})")),
            found if found == parameter => {
                made.push_str(&format!("({:?})", second.unwrap_or_default()));
            }
            found if found == name => made.push_str(path),
            found => made.push_str(found),
        }
        word.clear();
        made.push(letter);
    }
    made.trim_end().to_owned()
}

/// Asks for the compilation of texts with mistakes. The package must report the same messages at the
/// same places as the native tool.
fn mistakes(requests: &mut Requests) -> Result<(), Failed> {
    let texts = [
        "import lamplight::brdf::diffuse::lambrt;\n@fragment fn f() -> @location(0) vec4f { return vec4f(lambrt()); }",
        "@fragment fn f() -> @location(0) vec4f {\n    let ä = 1.0; return vec4f(ä, undefined_name, 1);\n}",
        "@fragment fn f( {",
    ];
    for text in texts {
        let files = BTreeMap::from([("a.wesl".to_owned(), text.to_owned())]);
        requests.mistakes.push(json!({ "files": files, "root": "a.wesl" }));
        let mut sources = SourceSet::default();
        let found = problems(&mut sources, &own(&files));
        if !found.iter().any(|one| one.severity == Severity::Error) {
            return Err(format!("the native tool finds no error in\n{text}").into());
        }
        let rendered: String = found
            .iter()
            .map(|one| render(&sources, std::slice::from_ref(one), Form::Human))
            .collect();
        requests.expected.push((text.to_owned(), rendered.into_bytes()));
    }
    Ok(())
}

/// The diagnostics of the native tool for `a.wesl`.
fn problems(sources: &mut SourceSet, packages: &Packages) -> Diagnostics {
    let settings = Default::default();
    let options = Options::default();
    let graph = match resolve::load(sources, packages, "a.wesl", Language::Wesl) {
        Ok(graph) => graph,
        Err(errors) => return errors,
    };
    let made = compose(&graph, &settings, &options).and_then(|composed| {
        let root = Root {
            graph: &graph,
            settings: &settings,
            options: &options,
            conventions: Default::default(),
            optimiser: None,
            numbers: "",
        };
        let entries = entry_points(&composed)?;
        root.compile(&entries, &[Target::WGSL])
    });
    made.map_or_else(|errors| graph.traced(errors), |_| Diagnostics::new())
}

/// Asks for the values of two published formulas in f64. They have the same bits on both sides, since
/// only operations whose rounding IEEE 754 prescribes are in them.
fn formulas(requests: &mut Requests) -> Result<(), Failed> {
    let calls = [
        ("brdf::diffuse", "lambert", vec![0.0, 0.6, 0.8, 0.0, 0.0, 1.0]),
        ("brdf::specular", "f_schlick", vec![0.25, 0.04, 1.0]),
    ];
    for (module, function, words) in calls {
        let missing = || format!("`{module}` has no reference for `{function}`");
        let formula = references::find_reference(module, function).ok_or_else(missing)?;
        let value = formula(&mut references::CallArguments::new(&words, &[])).value;
        let path = format!("{module}::{function}");
        let mut call = vec![json!(path)];
        call.extend(words.iter().map(|word| json!(word)));
        requests.references.push(Value::from(call));
        let numbers: Vec<String> = value.iter().map(f64::to_string).collect();
        requests.expected.push((path, numbers.join(" ").into_bytes()));
    }
    Ok(())
}

/// The first message as a failure.
fn message_of(problems: Diagnostics) -> Failed {
    format!("{:?}", problems.first().map(|one| &one.message)).into()
}
