//! Large packages: the work grows with the package and not with its square, and reduced modules hide
//! no mistake.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_compose::resolve::Packages;
use lamplight_diagnostic::source::{Memory, Package, SourceSet};
use lamplight_files::limits;
use lamplight_lint::{Linted, Request, lint_within};
use lamplight_permute::Settings;
use lamplight_testing::random::Random;
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("lint::a_chain_is_linear", || grows_linearly(chain)),
        Trial::test("lint::a_hub_is_linear", || grows_linearly(hub)),
        Trial::test("lint::a_chain_of_types_is_linear", || grows_linearly(types)),
        Trial::test("lint::each_module_of_a_chain_is_checked", mistakes_in_a_chain),
        Trial::test("lint::modules_that_differ_in_case", alike),
        Trial::test("lint::reduced_modules_hide_no_mistake", random_packages),
    ]
}

type Files = BTreeMap<String, String>;

/// Checks every file of a package. From `whole` files on, what is far is reduced.
fn linted(files: &Files, whole: u64) -> (SourceSet, Linted) {
    let memory = Box::new(Memory(files.clone()));
    let packages = Packages::new(Package { name: "package".to_owned(), files: memory }, Vec::new());
    let paths: Vec<String> = files.keys().cloned().collect();
    let settings = Settings::default();
    let mut sources = SourceSet::default();
    let request =
        Request { packages: &packages, manifest: None, settings: &settings, paths: &paths };
    let found = lint_within(&mut sources, &request, whole);
    (sources, found)
}

/// Every diagnostic as text.
fn diagnostic_texts(files: &Files, whole: u64) -> BTreeSet<String> {
    let (sources, found) = linted(files, whole);
    let one = |diagnostic: &lamplight_diagnostic::Diagnostic| {
        let place = diagnostic.labels.first().map(|label| {
            (&sources.get(label.span.source).path, label.span.start, sources.text(label.span))
        });
        format!("{} {} {place:?}", diagnostic.code.name, diagnostic.message)
    };
    found.diagnostics.iter().map(one).collect()
}

fn module(index: usize) -> String {
    format!("m{index:05}.wesl")
}

/// Each module uses a function of the next.
fn chain(count: usize) -> Files {
    let one = |index: usize| {
        let next = index + 1;
        let text = format!(
            "import package::m{next:05}::g{next};\n\
             fn g{index}(x: f32) -> f32 {{ return g{next}(x) * 2.0; }}\n"
        );
        (module(index), text)
    };
    let last = (module(count), format!("fn g{count}(x: f32) -> f32 {{ return x; }}\n"));
    (0..count).map(one).chain([last]).collect()
}

/// Each module uses a function of one that uses all others.
fn hub(count: usize) -> Files {
    let imports = |index: usize| format!("import package::m{index:05}::g{index};\n");
    let calls: String = (0..count).map(|index| format!("    g{index}();\n")).collect();
    let hub = (0..count).map(imports).collect::<String>() + &format!("fn all() {{\n{calls}}}\n");
    let one = |index: usize| {
        let text =
            format!("import package::hub::all;\nfn g{index}() {{ }}\nfn h{index}() {{ all(); }}\n");
        (module(index), text)
    };
    (0..count).map(one).chain([("hub.wesl".to_owned(), hub)]).collect()
}

/// As [`chain`], with a type of a module that all share.
fn types(count: usize) -> Files {
    let mut files = chain(count);
    for (index, text) in files.values_mut().enumerate() {
        *text = format!(
            "import package::light::Light;\n{text}fn h{index}(light: Light) -> Light {{ return light; }}\n"
        );
    }
    files.insert("light.wesl".to_owned(), "struct Light { at: vec3f, power: f32 }\n".to_owned());
    files
}

fn grows_linearly(files: fn(usize) -> Files) -> Outcome {
    let mut taken = [60, 600].into_iter().map(|count| {
        let before = limits::steps_taken();
        let (_, found) = linted(&files(count), 0);
        match found.diagnostics.first() {
            None => Ok(limits::steps_taken() - before),
            Some(error) => Err(format!("{count} modules: {}", error.message)),
        }
    });
    let (Some(one), Some(ten)) = (taken.next().transpose()?, taken.next().transpose()?) else {
        return Err("nothing was counted".into());
    };
    match one > 60 && ten <= 12 * one {
        true => Ok(()),
        false => Err(format!("{one} steps for 60 modules, {ten} for 600").into()),
    }
}

/// A mistake in any module of a long chain is found, and nothing else.
fn mistakes_in_a_chain() -> Outcome {
    let clean = chain(100);
    for broken in [0, 1, 11, 12, 13, 50, 99, 100] {
        let mut files = clean.clone();
        let text = files.get_mut(&module(broken)).ok_or("no such module")?;
        *text += "fn wrong() -> f32 { return 1u; }\n";
        let (whole, reduced) = (diagnostic_texts(&files, u64::MAX), diagnostic_texts(&files, 0));
        if whole.len() != 1 || whole != reduced {
            return Err(format!("module {broken}: {whole:?} became {reduced:?}").into());
        }
    }
    Ok(())
}

/// Modules whose names differ only in case have a warning.
fn alike() -> Outcome {
    let names = ["a.wesl", "b.wesl", "A.wesl", "c/Ab.wesl", "C/aB.wesl"];
    let files =
        names.iter().map(|name| ((*name).to_owned(), "const c = 1;\n".to_owned())).collect();
    let found = diagnostic_texts(&files, u64::MAX);
    match found.len() == 2 && found.iter().all(|found| found.contains("differ only in case")) {
        true => Ok(()),
        false => Err(format!("{found:?}").into()),
    }
}

/// What is wrong in a module, each for one kind of reader.
const MISTAKES: [&str; 6] = [
    "fn wrong() -> f32 { return 1u; }\n",
    "fn wrong() -> f32 { let x: u32 = 1.5; return 1.0; }\n",
    "fn wrong() -> Nothing { return Nothing(); }\n",
    "fn wrong() -> f32 { return nothing(); }\n",
    "struct Wrong { a: f32, a: f32 }\n",
    "const wrong: u32 = -1;\n",
];

/// A module that uses some of the modules after it, in all ways that there are.
fn random_module(random: &mut Random, index: usize, count: usize) -> String {
    let mut imports = String::new();
    let mut body = String::from("    var sum = x;\n");
    let mut heads = String::new();
    for used in 0..random.below(4) {
        let other = index + 1 + random.below(3);
        if other >= count {
            continue;
        }
        match random.below(6) {
            0 => {
                imports += &format!("import package::m{other:05}::g{other} as a{used};\n");
                body += &format!("    sum += a{used}(x);\n");
            }
            1 => body += &format!("    sum += package::m{other:05}::g{other}(x);\n"),
            2 => {
                imports += &format!(
                    "import super::m{other:05}::{{S{other} as T{used}, c{other} as d{used}}};\n"
                );
                heads += &format!("fn u{used}(s: T{used}) -> T{used} {{ return s; }}\n");
                body += &format!("    sum += u{used}(T{used}(x)).value + d{used};\n");
            }
            3 => {
                imports += &format!("import package::m{other:05} as n{used};\n");
                body += &format!("    sum += n{used}::g{other}(x) + n{used}::array{other}()[1];\n");
            }
            4 => {
                imports += &format!("@if(fog) import package::m{other:05}::g{other} as b{used};\n");
                body += &format!("    @if(fog) sum += b{used}(x);\n");
            }
            _ => {
                imports += &format!("import package::m{other:05}::c{other} as e{used};\n");
                heads += &format!("const f{used}x = e{used} * 2.0;\n");
                body += &format!("    sum += f{used}x;\n");
            }
        }
    }
    format!(
        "{imports}{heads}struct S{index} {{ value: f32 }}\nconst c{index} = {index}.0;\n\
         fn array{index}() -> array<f32, 3> {{ return array<f32, 3>(); }}\n\
         /* {{ */ fn g{index}(x: f32) -> f32 {{\n{body}    return sum;\n}}\n"
    )
}

/// With one mistake or none, both ways find the same. With several, the reduced way finds every
/// one: checking whole modules leaves out what depends on a mistake.
fn random_packages() -> Outcome {
    let mut random = Random(0x5eed);
    let (mut many, mut found) = (0, 0);
    for round in 0..30 {
        let count = 20 + random.below(40);
        let mut files: Files = (0..count)
            .map(|index| (module(index), random_module(&mut random, index, count)))
            .collect();
        let mistakes = random.below(4);
        for _ in 0..mistakes {
            let text = files.get_mut(&module(random.below(count))).ok_or("no such module")?;
            if !text.contains("rong") {
                *text += MISTAKES[random.below(MISTAKES.len())];
            }
        }
        let (whole, reduced) = (diagnostic_texts(&files, u64::MAX), diagnostic_texts(&files, 0));
        let same = if mistakes < 2 { whole == reduced } else { whole.is_subset(&reduced) };
        if !same {
            return Err(format!("round {round}: {whole:#?} became {reduced:#?}").into());
        }
        (many, found) = (many + mistakes, found + reduced.len());
    }
    match found > many / 2 {
        true => Ok(()),
        false => Err(format!("{many} mistakes were made, and {found} found").into()),
    }
}
