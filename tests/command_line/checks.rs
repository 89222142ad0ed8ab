//! What `check` says of a function with wrong results, of wrong cases, and of functions without a
//! case.

use std::fs;

use super::package::{Package, equal};
use super::{Case, Outcome};

pub const CASES: &[Case] = &[
    ("failures_have_a_place", places),
    ("broken_laws_have_messages", laws),
    ("worst_error_is_the_largest", worst_error),
    ("failures_are_first_on_the_page", page),
    ("vectors_are_not_taken_for_numbers", vectors),
    ("formulas_have_the_functions_of_wgsl", formulas),
    ("functions_without_a_case", untested),
    ("stores_to_matrices_of_two_rows", narrow_matrices),
    ("names_of_modules", names_of_modules),
];

const MODULE: &str = "fn half(x: f32) -> f32 { return 0.5 * x + 1e-3; }
fn steep(x: f32) -> f32 { return 3.0 * x; }\n";
const CASE: &str = "[[case]]\nfunction = \"half\"\nformula = \"0.5*x\"\ntolerance = { abs = 1e-6 }\n\
    inputs = { x = { grid = [0, 1], count = 11 } }\n";
const LAW: &str = "[[case]]\nfunction = \"steep\"\noracle = \"none\"\nlaws = [{ range = [0, 1] }]\n\
    inputs = { x = { grid = [0, 1], count = 11 } }\n";

fn package(cases: &[&str]) -> Result<Package, libtest_mimic::Failed> {
    Package::new(&[("below/light.wesl", MODULE), ("below/light.toml", &cases.concat())])
}

/// A failure has the file and line of its case, a code, and a message of one line. This holds for
/// every form of diagnostics and every report, so that editors and CI can show the place.
fn places() -> Outcome {
    let package = package(&[LAW, CASE])?;
    let human = package.run("check below/light.toml --report out")?.ends(3)?;
    human.says(&["error[check-failed]", "below/light.toml:7:12", "11 of 11 inputs are off"])?;
    let short = package.run("check below/light.toml --diagnostics short")?.ends(3)?;
    let lines: Vec<&str> = short.err.lines().collect();
    equal(lines.len(), 3)?;
    equal(lines.iter().all(|line| line.starts_with("below/light.toml:")), true)?;
    let json = package.run("check below/light.toml --diagnostics json")?.ends(3)?;
    for line in json.err.lines() {
        let failure: serde_json::Value = serde_json::from_str(line)?;
        equal(failure["code"].as_str(), Some("check-failed"))?;
        equal(failure["labels"][0]["file"].as_str(), Some("below/light.toml"))?;
        equal(failure["message"].as_str().is_some_and(|message| !message.contains('\n')), true)?;
    }
    let report: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(package.path("out/report.json"))?)?;
    equal(report["outcomes"][1]["line"].as_u64(), Some(7))?;
    let junit = fs::read_to_string(package.path("out/junit.xml"))?;
    equal(junit.contains("file=\"below/light.toml\" line=\"7\""), true)
}

/// A broken law is reported with the input and the result, as numbers and not in the debug form of
/// Rust's types.
fn laws() -> Outcome {
    let run = package(&[LAW])?.run("check below/light.toml")?.ends(3)?;
    let words = ["the law `range` is broken 7 times: x = 0.4000000059604645 gives 1.2"];
    run.says(&words)?.is_silent_of(&["Some(", "None", "0 of 11", "0e0"])?;
    Ok(())
}

/// The report has the largest error as well as the error that is worst against its tolerance. They
/// belong to different inputs here, since the tolerance grows with x.
fn worst_error() -> Outcome {
    let module = "fn off(x: f32) -> f32 { return x + select(1e-6, 1e-4, x > 50.0); }\n";
    let case = "[[case]]\nfunction = \"off\"\nformula = \"x\"\ntolerance = { scaled = { by = \"x*x\", ulp = 4 }, abs = 1e-5 }\n\
        inputs = { x = [0.5, 100] }\n";
    let package = Package::new(&[("off.wesl", module), ("off.toml", case)])?;
    let run = package.run("check off.toml --report out")?;
    let report: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(package.path("out/report.json"))?)?;
    let verdict = &report["outcomes"][0]["verdict"];
    let (largest, nearest) =
        (verdict["largest_error"].as_f64(), verdict["worst"]["error"].as_f64());
    equal(largest > Some(9e-5) && nearest.is_some_and(|one| one < 2e-6), true)?;
    run.says(&["9."])?;
    Ok(())
}

/// Failures come first on the page of a report, whatever the names of the functions.
fn page() -> Outcome {
    let more = "[[case]]\nfunction = \"a_fine_one\"\noracle = \"eval\"\ninputs = { x = 1 }\n";
    let package = Package::new(&[
        ("light.wesl", &format!("fn a_fine_one(x: f32) -> f32 {{ return x; }}\n{MODULE}")),
        ("light.toml", &[more, CASE].concat()),
    ])?;
    package.run("check light.toml --report out")?.ends(3)?;
    let page = fs::read_to_string(package.path("out/index.html"))?;
    let at = |text: &str| page.find(text).ok_or_else(|| format!("the page has no `{text}`"));
    let order = [
        "<b class=\"bad\">fails</b> <a href=\"#light::half\">",
        "<section id=\"light::half\">",
        "<section id=\"light::a_fine_one\">",
        "<section id=\"columns\">",
    ];
    let found = order.iter().map(|text| at(text)).collect::<Result<Vec<_>, _>>()?;
    equal(found.is_sorted(), true)?;
    at("lamplight 0.")?;
    at("<code>lamplight check light.toml --report out</code>")?;
    at("case 2, light.toml:6")?;
    at("<th title=\"the executor that ran the function\">executor</th>")?;
    Ok(())
}

/// A list of numbers gives a vector parameter one vector for each number, with equal components.
/// `[[1, 2]]` is ambiguous, since its author means one vector of two components. It is refused with
/// both ways to write it.
fn vectors() -> Outcome {
    let module = "fn sum(v: vec2f) -> f32 { return v.x + v.y; }\n";
    let case = |domain: &str| {
        format!(
            "[[case]]\nfunction = \"sum\"\nformula = \"v.x + v.y\"\ntolerance = {{ ulp = 1 }}\ninputs = {{ v = {domain} }}\n"
        )
    };
    let package = Package::new(&[("sum.wesl", module)])?;
    for (domain, inputs) in [
        ("{ values = [[1, 2]] }", "1"),
        ("{ values = [1, 2] }", "2"),
        ("[1, 2, 3]", "3"),
        ("[0.5]", "1"),
    ] {
        package.write("sum.toml", &case(domain))?;
        let run = package.run("check sum.toml --report out --force")?.ends(0)?;
        let cells: Vec<&str> =
            run.out.lines().nth(1).unwrap_or_default().split_whitespace().collect();
        equal(cells.get(3).copied(), Some(inputs))?;
    }
    for domain in ["[[1, 2]]", "[1, 2]"] {
        package.write("sum.toml", &case(domain))?;
        let run = package.run("check sum.toml")?.ends(1)?;
        run.says(&["sum.toml:5:16", "`{ values = [[1.0, 2.0]] }`", "`{ values = [1.0, 2.0] }`"])?;
    }
    Ok(())
}

/// Each function that formulas share with WGSL gives the same results as WGSL.
fn formulas() -> Outcome {
    let functions = [
        ("acos(x)", "acos(x)"),
        ("asin(x)", "asin(x)"),
        ("atan(x)", "atan(x)"),
        ("atan2(x, y)", "atan2(x, y)"),
        ("ceil(3.0 * x)", "ceil(3 * x)"),
        ("cos(x)", "cos(x)"),
        ("cosh(x)", "cosh(x)"),
        ("degrees(x)", "degrees(x)"),
        ("distance(vec2f(x, y), vec2f(y, 1.0))", "distance(vec(x, y), vec(y, 1))"),
        ("exp(x)", "exp(x)"),
        ("fract(5.0 * x)", "fract(5 * x)"),
        ("inverseSqrt(x)", "inverseSqrt(x)"),
        ("log(x)", "log(x)"),
        ("mix(x, y, 0.25)", "mix(x, y, 0.25)"),
        ("radians(x)", "radians(x)"),
        (
            "reflect(vec2f(x, y), vec2f(1.0, 0.0)).x",
            "dot(reflect(vec(x, y), vec(1, 0)), vec(1, 0))",
        ),
        ("round(2.0 * y)", "round(2 * y)"),
        ("saturate(y - x)", "saturate(y - x)"),
        ("sign(x - y)", "sign(x - y)"),
        ("sin(x)", "sin(x)"),
        ("sinh(x)", "sinh(x)"),
        ("smoothstep(0.2, 0.9, x)", "smoothstep(0.2, 0.9, x)"),
        ("step(x, 0.5)", "step(x, 0.5)"),
        ("tan(x)", "tan(x)"),
        ("tanh(x)", "tanh(x)"),
        ("trunc(-3.0 * x)", "trunc(-3 * x)"),
    ];
    let (mut module, mut cases) = (String::new(), String::new());
    for (index, (code, formula)) in functions.iter().enumerate() {
        module += &format!("fn f{index}(x: f32, y: f32) -> f32 {{ return {code}; }}\n");
        cases += &format!(
            "[[case]]\nfunction = \"f{index}\"\nformula = \"{formula}\"\ntolerance = {{ abs = 1e-5, ulp = 8 }}\ninputs = {{ x = [0.1, 0.37, 0.8], y = [0.6, 1.25] }}\n"
        );
    }
    let package = Package::new(&[("f.wesl", &module), ("f.toml", &cases)])?;
    package.run("check f.toml")?.ends(0)?.says(&["26 of 26 pass"])?;
    package.write("f.toml", &cases.replace("sinh(x)", "sinhh(x)"))?;
    let run = package.run("check f.toml")?.ends(1)?;
    run.says(&["there is no function `sinhh`; did you mean `sinh`?", "functions are abs, acos,"])?;
    Ok(())
}

/// `check` names functions that no case runs. A helper that a checked function calls is not named,
/// since the case runs it too.
fn untested() -> Outcome {
    let module = "fn inner(x: f32) -> f32 { return 2.0 * x; }
fn outer(x: f32) -> f32 { return inner(x); }
fn haze(x: f32) -> f32 { return x; }
@fragment fn main() -> @location(0) vec4f { return vec4f(haze(1.0)); }\n";
    let case = "[[case]]\nfunction = \"outer\"\nformula = \"2*x\"\ntolerance = { ulp = 1 }\ninputs = { x = [1, 2] }\n";
    let package = Package::new(&[("fog.wesl", module), ("fog.toml", case)])?;
    let run = package.run("check fog.toml")?.ends(0)?;
    run.says(&["1 function has no case: fog::haze\n", "1 of 1 pass"])?;
    let more = case.replace("outer", "haze").replace("2*x", "x");
    package.write("fog.toml", &[case, &more].concat())?;
    package.run("check fog.toml")?.ends(0)?.is_silent_of(&["no case"])?;
    let glsl = "#define TWICE(x) (2.0 * (x))
float inner(float x);
float outer(float x) { return inner(x); }
#ifdef HAZE
float haze(float x) { { return x; } }
#else
float haze(float x) { return x + 0.0; }
#endif
float inner(float x) { return TWICE(x); }\n";
    package.write("mist.glsl", glsl)?;
    package.write("mist.toml", case)?;
    let run = package.run("check mist.toml")?.ends(0)?;
    run.says(&["1 function has no case: mist::haze\n", "1 of 1 pass"])?;
    Ok(())
}

/// A misspelt module gives the nearest name.
fn names_of_modules() -> Outcome {
    let run = Package::new(&[])?.run("check lighting::spto")?.ends(1)?;
    run.says(&["did you mean `lighting::spot`?"])?;
    Ok(())
}

/// A store to a matrix of two rows within a structure is not lost in any target's text, whether the
/// whole matrix, a column or one number is stored. HLSL has no such matrices in structures, so naga
/// writes them as separate columns.
fn narrow_matrices() -> Outcome {
    let module = "struct Held { before: f32, narrow: mat3x2f, after: f32 }
fn held(x: f32) -> Held { var h: Held; h.before = x; h.after = x; return h; }
fn whole(x: f32) -> f32 {
    var h = held(x);
    h.narrow = mat3x2f(vec2f(1.0), vec2f(2.0), vec2f(x));
    return h.narrow[2].y;
}
fn column(x: f32) -> f32 {
    var h = held(x);
    h.narrow[u32(x) % 3u] = vec2f(x, 4.0);
    return h.narrow[u32(x) % 3u].x;
}
fn number(x: f32) -> f32 {
    var h = held(x);
    h.narrow[1][u32(x) % 2u] = x;
    return h.narrow[1][u32(x) % 2u];
}\n";
    let case = |name| {
        format!(
            "[[case]]\nfunction = \"{name}\"\nformula = \"x\"\ntolerance = {{ ulp = 0 }}\ninputs = {{ x = [1, 2, 3] }}\n"
        )
    };
    let cases = ["whole", "column", "number"].map(case).concat();
    let package = Package::new(&[("narrow.wesl", module), ("narrow.toml", &cases)])?;
    for executor in ["eval", "spirv", "glsl", "glsl330", "essl300", "hlsl", "msl"] {
        let run = package.run(&format!("check narrow.toml --executor {executor}"))?;
        run.ends(0)?.says(&["3 of 3 pass"])?;
    }
    Ok(())
}
