//! Ten times the input takes about ten times the steps, or one of our limits ends it. If a loop took
//! quadratic time, a small file could occupy the tool for hours. The loops count their steps
//! (`lamplight::limits::steps_taken`). These do not depend on the speed of the machine, as times
//! would.

use lamplight::bundle::Language;
use lamplight::compose::{self, Options};
use lamplight::diagnostic::{Diagnostics, codes};
use lamplight::limits;
use lamplight::permute::{Settings, manifest};
use lamplight::project;
use lamplight::resolve::{self, Packages};
use lamplight::source::{Memory, Package, SourceSet};
use libtest_mimic::Trial;

use super::Outcome;

/// Paths and texts of files. The first is the root.
type Files = Vec<(String, String)>;

struct Case {
    name: &'static str,
    /// The smaller of the two sizes.
    size: usize,
    files: fn(usize) -> Files,
}

const WESL: &str = "m.wesl";
const GLSL: &str = "m.frag.glsl";
const MANIFEST: &str = "lamplight.toml";
const POINT: &str = "@fragment fn m() -> @location(0) vec4f { return vec4f(1.0); }\n";

pub fn tests() -> Vec<Trial> {
    let rows = CASES
        .iter()
        .map(|case| Trial::test(format!("hostile::linear_{}", case.name), || is_linear(case)));
    let names = Trial::test("hostile::names_with_many_meanings", many_meanings);
    rows.chain([names]).collect()
}

/// How many percent more than ten times the steps are allowed for ten times the input.
const SLACK: u64 = 20;

fn is_linear(case: &Case) -> Outcome {
    let [one, ten] = [case.size, 10 * case.size].map(|size| steps(&(case.files)(size)));
    let most = 10 * one + 10 * one * SLACK / 100;
    match (one as usize > case.size / 2, ten <= most) {
        (true, true) => Ok(()),
        (false, _) => {
            let what = format!("only {one} steps are counted for {} parts", case.size);
            Err(format!("{what}: a loop of this input counts no steps").into())
        }
        (_, false) => {
            let what = format!("{one} steps for {} parts, {ten} for ten times as many", case.size);
            Err(format!("{what}, expected at most {most}").into())
        }
    }
}

/// The steps of reading and composing the first file, whether that succeeds or not.
fn steps(files: &Files) -> u64 {
    let before = limits::steps_taken();
    let _ = outcome(files);
    limits::steps_taken() - before
}

fn outcome(files: &Files) -> Result<(), Diagnostics> {
    let mut sources = SourceSet::default();
    let root = &files[0].0;
    if root == MANIFEST {
        let id = sources.add(MANIFEST, files[0].1.clone());
        return manifest::parse(&sources, id).map(|_| ());
    }
    let language = if root == WESL { Language::Wesl } else { Language::Glsl };
    let memory = Memory(files.iter().cloned().collect());
    let own = Package { name: "package".to_owned(), files: Box::new(memory) };
    let library = project::library_package();
    let packages = Packages::new(own, vec![library]);
    let graph = resolve::load(&mut sources, &packages, root, language)?;
    compose::compose(&graph, &Settings::default(), &Options::default()).map(|_| ())
}

fn lines(count: usize, one: impl Fn(usize) -> String) -> String {
    (0..count).map(one).collect()
}

fn alone(path: &str, text: String) -> Files {
    vec![(path.to_owned(), text)]
}

fn body(text: String) -> String {
    format!("@fragment fn m() {{ {text} }}\n")
}

fn program(rest: String) -> Files {
    let head = "[program.p]\nwesl = \"s.wesl\"\n";
    alone(MANIFEST, format!("{head}{rest}"))
}

const CASES: &[Case] = &[
    Case {
        name: "names",
        size: 1000,
        files: |n| {
            let functions = lines(n, |i| format!("fn f{i}() {{}}\n"));
            alone(WESL, functions + &body(lines(n, |i| format!("f{i}();"))))
        },
    },
    Case {
        name: "chain_of_functions",
        size: 1000,
        files: |n| {
            let functions = lines(n, |i| format!("fn f{}() {{ f{i}(); }}\n", i + 1));
            alone(WESL, format!("fn f0() {{}}\n{functions}") + &body(format!("f{n}();")))
        },
    },
    Case {
        name: "imports_of_one_item",
        size: 500,
        files: |n| {
            let one = |i| format!("import lamplight::math::safe::safe_normalize as s{i};\n");
            alone(WESL, lines(n, one) + POINT)
        },
    },
    Case {
        name: "imports_without_a_package",
        size: 500,
        files: |n| alone(WESL, lines(n, |i| format!("import none{i}::a as a{i};\n")) + POINT),
    },
    Case {
        name: "imports_of_files",
        size: 100,
        files: |n| {
            let imports = lines(n, |i| format!("import package::a{i}::f as f{i};\n"));
            let uses = body(lines(n, |i| format!("f{i}();")));
            let others = (0..n).map(|i| (format!("a{i}.wesl"), "fn f() {}\n".to_owned()));
            alone(WESL, imports + &uses).into_iter().chain(others).collect()
        },
    },
    Case {
        name: "chain_of_files",
        size: 100,
        files: |n| {
            let link = |i: usize| {
                let text = format!("import package::a{}::f;\n", i + 1);
                (format!("a{i}.wesl"), text)
            };
            let root = "import package::a0::f;\n".to_owned() + &body("f();".to_owned());
            alone(WESL, root).into_iter().chain((0..n).map(link)).collect()
        },
    },
    Case {
        name: "constants_from_outside",
        size: 1000,
        files: |n| alone(WESL, body(lines(n, |i| format!("let x{i} = constants::c{i};")))),
    },
    Case {
        name: "branches_of_a_condition",
        size: 1000,
        files: |n| {
            let branches = lines(n, |i| format!("@elif(x{i}) const a = {i};\n"));
            alone(WESL, format!("@if(x) const a = 0;\n{branches}") + &body("let y = a;".into()))
        },
    },
    Case {
        name: "declarations_under_conditions",
        size: 1000,
        files: |n| {
            let declared = lines(n, |i| format!("@if(a{i}) const c = {i};\n"));
            alone(WESL, declared + &body("let y = c;".repeat(n)))
        },
    },
    Case {
        name: "locals_under_conditions",
        size: 1000,
        files: |n| {
            let locals = "@if(false) let c = 1;".repeat(n);
            alone(WESL, "const c = 1;\n".to_owned() + &body(locals + &"let y = c;".repeat(n)))
        },
    },
    Case {
        name: "conditions_of_undefined_macros",
        size: 1000,
        files: |n| {
            let one = |i| format!("#if A{i}\nint a{i};\n#endif\n");
            alone(GLSL, lines(n, one) + "void main() {}\n")
        },
    },
    Case {
        name: "branches_of_a_directive",
        size: 1000,
        files: |n| {
            let one = |i| format!("#elif {i} == -1\nint a{i};\n");
            alone(GLSL, format!("#if 0\n{}#endif\nvoid main() {{}}\n", lines(n, one)))
        },
    },
    Case {
        name: "macros",
        size: 1000,
        files: |n| {
            let defined = lines(n, |i| format!("#define M{i} {i}\n"));
            let used = lines(n, |i| format!("int a{i} = M{i};"));
            alone(GLSL, format!("{defined}void main() {{ {used} }}\n"))
        },
    },
    Case {
        name: "extensions_and_pragmas",
        size: 1000,
        files: |n| {
            let one = |i| format!("#pragma x{i}\n#extension GL_x{i} : enable\n");
            alone(GLSL, lines(n, one) + "void main() {}\n")
        },
    },
    Case {
        name: "constraints",
        size: 100,
        files: |n| {
            let axes = lines(8, |i| format!("a{i} = {{ values = [0, 1, 2] }}\n"));
            let one = |i: usize| {
                let (a, b) = (i % 8, (i + 1) % 8);
                format!("[[program.p.constraint]]\nrequire = \"a{a} == 0 || a{b} != 1\"\n")
            };
            program(format!("[program.p.axis]\n{axes}{}", lines(n, one)))
        },
    },
    Case {
        name: "one_long_constraint",
        size: 1000,
        files: |n| {
            let terms: Vec<String> = (0..n).map(|i| format!("a == {}", i % 3)).collect();
            let axis = "[program.p.axis]\na = { values = [0, 1, 2, 3] }\n";
            let terms = terms.join(" || ");
            program(format!("{axis}[[program.p.constraint]]\nrequire = \"{terms}\"\n"))
        },
    },
    Case {
        name: "entries_of_only",
        size: 500,
        files: |n| {
            let entries: Vec<String> = (0..n).map(|i| format!("{{ a = {} }}", i % 4)).collect();
            let axis = "[program.p.axis]\na = { values = [0, 1, 2, 3] }\n";
            program(format!("only = [{}]\n{axis}", entries.join(", ")))
        },
    },
];

/// Each path in the shader leads through a chain of imports to a name with many meanings. That is
/// a small text with very many steps, so it must give the error of the limit, with a place.
fn many_meanings() -> Outcome {
    let chain = lines(60, |i| format!("import a{i}::b as a{};\n", i + 1));
    let last = lines(64, |i| format!("@if(f{i}) import a60::c{i} as z;\n"));
    let uses = body(lines(1_000, |i| format!("z::u{i}();")));
    let text = format!("import package::a as a0;\n{chain}{last}{uses}");
    match outcome(&alone(WESL, text)) {
        Err(errors) if errors.len() == 1 && errors[0].code == codes::LIMIT_EXCEEDED => {
            match errors[0].labels.is_empty() {
                true => Err("the error `limit-exceeded` has no place".into()),
                false => Ok(()),
            }
        }
        Err(errors) => {
            let found = format!("{} errors, the first is {:?}", errors.len(), errors.first());
            Err(format!("expected only `limit-exceeded`, found {found}").into())
        }
        Ok(()) => Err("the text was composed, expected `limit-exceeded`".into()),
    }
}
