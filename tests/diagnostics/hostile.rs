//! Hostile inputs: the command ends with an ordinary exit code, within a time limit, and prints a
//! bounded amount of text.

use std::fs;
use std::time::{Duration, Instant};

use libtest_mimic::{Failed, Trial};

use super::run;

/// Name, file and text.
type Case = (&'static str, &'static str, String);

pub fn tests() -> impl Iterator<Item = Trial> {
    let kinds = [nesting, conditions, imports, floods, glsl, manifests, packages];
    kinds.into_iter().flat_map(|cases| cases()).map(|(name, file, text)| {
        Trial::test(format!("diagnostics::hostile::{name}"), move || survives(file, &text))
    })
}

/// The longest time that a hostile input may take, with room for a slow machine.
const PATIENCE: Duration = Duration::from_secs(20);
/// The most bytes that the command may print about it.
const MOST_BYTES: usize = 64 << 10;

/// The command accepts or refuses the input. It does not panic, and is neither slow nor verbose.
fn survives(file: &str, text: &str) -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    fs::write(folder.path().join(file), text)?;
    fs::write(folder.path().join("a.wesl"), "@fragment fn f() {}\n")?;
    let line = match file {
        "m.toml" => "variants --manifest m.toml".to_owned(),
        "wesl.toml" => "compose a.wesl".to_owned(),
        file => format!("compile {file} --target wgsl --feature a -o out"),
    };
    let start = Instant::now();
    let output = run(folder.path(), &line)?;
    let code = output.status.code().ok_or("killed by a signal")?;
    let stderr = String::from_utf8_lossy(&output.stderr);
    if code > 1 || stderr.contains("panicked") {
        return Err(format!(
            "{line}: exit code {code}: {}",
            stderr.chars().take(2000).collect::<String>()
        )
        .into());
    }
    if stderr.len() > MOST_BYTES || start.elapsed() > PATIENCE {
        let (bytes, took) = (stderr.len(), start.elapsed());
        let bounds = format!("at most {MOST_BYTES} bytes in {PATIENCE:?}");
        return Err(format!("{line}: printed {bytes} bytes in {took:?}, expected {bounds}").into());
    }
    Ok(())
}

fn numbered(count: usize, form: impl Fn(usize) -> String) -> String {
    (0..count).map(form).collect()
}

/// Expressions, types and blocks that are nested deeply.
fn nesting() -> Vec<Case> {
    vec![
        ("blocks", "x.wesl", format!("fn a() {}{}", "{".repeat(100_000), "}".repeat(100_000))),
        (
            "brackets",
            "x.wesl",
            format!("const a = {}1{};", "(".repeat(100_000), ")".repeat(100_000)),
        ),
        ("terms", "x.wesl", format!("const a = {}1;", "1 + ".repeat(20_000))),
        ("comparisons", "x.wesl", format!("fn f() {{ let a = {}b; }}", "a <".repeat(50_000))),
        (
            "templates",
            "x.wesl",
            format!("fn f() {{ let a: {}f32{}; }}", "array<".repeat(50_000), ">".repeat(50_000)),
        ),
    ]
}

/// Conditions with very many terms or branches.
fn conditions() -> Vec<Case> {
    vec![
        ("attributes", "x.wesl", format!("fn f() {{{}}}", "@if(a) ".repeat(50_000))),
        ("negations", "x.wesl", format!("@if({}a) fn f() {{}}", "!".repeat(100_000))),
        (
            "condition brackets",
            "x.wesl",
            format!("@if({}a{}) fn f() {{}}", "(".repeat(100_000), ")".repeat(100_000)),
        ),
        ("conjunctions", "x.wesl", format!("@if(a{}) fn f() {{}}", " && a".repeat(100_000))),
        (
            "branches",
            "x.wesl",
            format!("@if(a) fn f() {{}}\n{}", "@elif(a) fn f() {}\n".repeat(20_000)),
        ),
    ]
}

fn imports() -> Vec<Case> {
    vec![
        (
            "import braces",
            "x.wesl",
            format!("import package::{}b{};", "{a::".repeat(50_000), "}".repeat(50_000)),
        ),
        (
            "imports",
            "x.wesl",
            format!(
                "import package::{{{}}};\nfn f() {{ x(); }}",
                numbered(20_000, |i| format!("m{i}::x,"))
            ),
        ),
        (
            "a long path",
            "x.wesl",
            format!("import package::{}b; fn f() {{ b(); }}", "a::".repeat(50_000)),
        ),
        (
            "a long name",
            "x.wesl",
            format!("import package::{}; fn f() {{ }}", "a".repeat(1_000_000)),
        ),
        ("supers", "x.wesl", format!("import {}b; fn f() {{ b(); }}", "super::".repeat(50_000))),
    ]
}

/// The same thing repeated very often.
fn floods() -> Vec<Case> {
    vec![
        ("one long line", "x.wesl", format!("fn f() {{ let x = {}a; }}", "a + ".repeat(150_000))),
        ("large", "x.wesl", "// x\n".repeat((4 << 20) / 5)),
        ("too large", "x.wesl", "/".repeat(5 << 20)),
        ("open comments", "x.wesl", "/*".repeat(500_000)),
        ("errors", "x.wesl", "fn f( { }\n".repeat(20_000)),
        ("unknown flags", "x.wesl", numbered(20_000, |i| format!("@if(x{i}) fn f{i}() {{}}\n"))),
        (
            "calls",
            "x.wesl",
            numbered(20_000, |i| format!("fn f{i}() {{ f{}(); }}\n", i + 1))
                + "fn f20000() {}\n@fragment fn m() { f0(); }",
        ),
        (
            "constants",
            "x.wesl",
            numbered(20_000, |i| format!("const c{i} = c{};\n", (i + 1) % 20_000)),
        ),
        ("zeros", "x.wesl", "\0".repeat(100_000)),
    ]
}

fn glsl() -> Vec<Case> {
    vec![
        ("glsl includes itself", "x.frag.glsl", "#include \"x.frag.glsl\"\n".repeat(1000)),
        ("glsl bomb", "x.frag.glsl", bomb()),
        ("glsl nesting", "x.frag.glsl", "#if 1\n".repeat(50_000)),
        ("glsl condition", "x.frag.glsl", format!("#if {}1\n#endif\n", "(".repeat(100_000))),
        (
            "glsl terms",
            "x.frag.glsl",
            format!("void main() {{ float a = {}1.0; }}", "1.0 + ".repeat(20_000)),
        ),
        ("glsl missing", "x.frag.glsl", numbered(20_000, |i| format!("#include \"m{i}\"\n"))),
        ("glsl errors", "x.frag.glsl", "#error no\n".repeat(20_000)),
    ]
}

fn manifests() -> Vec<Case> {
    let axis = "[program.f]\nwesl = \"a.wesl\"\n[program.f.axis]\n";
    vec![
        (
            "manifest values",
            "m.toml",
            format!("{axis}n = {{ values = [{}] }}\n", numbered(400_000, |i| format!("{i},"))),
        ),
        (
            "manifest axes",
            "m.toml",
            axis.to_owned() + &numbered(128, |i| format!("x{i} = {{ values = [false, true] }}\n")),
        ),
        ("manifest nesting", "m.toml", format!("a={}{}", "[".repeat(50_000), "]".repeat(50_000))),
        ("manifest dots", "m.toml", format!("a{} = 1\n", ".a".repeat(50_000))),
        ("manifest keys", "m.toml", numbered(50_000, |i| format!("a{i} = 1\n"))),
        (
            "manifest constraint",
            "m.toml",
            format!(
                "{axis}x = {{ values = [false, true] }}\n[[program.f.constraint]]\nrequire = \"{}x\"\n",
                "(".repeat(50_000)
            ),
        ),
        (
            "manifest noise",
            "m.toml",
            numbered(100_000, |i| char::from((i * 7919 % 94 + 33) as u8).to_string()),
        ),
    ]
}

fn packages() -> Vec<Case> {
    vec![
        (
            "wesl.toml nesting",
            "wesl.toml",
            format!("a={}{}", "[".repeat(50_000), "]".repeat(50_000)),
        ),
        (
            "wesl.toml dependencies",
            "wesl.toml",
            "[package]\nroot = \".\"\n[dependencies]\n".to_owned()
                + &numbered(20_000, |i| format!("d{i} = {{ path = \"d{i}\" }}\n")),
        ),
    ]
}

/// Each macro expands to the previous one twice, which makes 2^39 tokens.
fn bomb() -> String {
    let doubled: String =
        (1..40).map(|i| format!("#define M{i} M{} M{}\n", i - 1, i - 1)).collect();
    format!("#define M0 x\n{doubled}void main() {{ M39 }}\n")
}
