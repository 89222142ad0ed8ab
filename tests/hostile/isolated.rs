//! Shaders that are within every limit and still exhaust naga: it takes too long or too much memory.
//! naga runs in a process of its own for them. Each gives an error.

use std::fs;
use std::io::Write as _;
use std::process::{Command, Output, Stdio};

use libtest_mimic::{Failed, Trial};
use serde_json::json;

use super::{Outcome, fails, run, run_within};

type Case = (&'static str, fn() -> Outcome);

const SMALL: &str = "@fragment fn small() -> @location(0) vec4f { return vec4f(); }\n";

/// An address space in which naga has too little memory for an array of many values, in KiB.
const LITTLE_KIB: u64 = 700 << 10;

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 4] = [
        ("naga_takes_too_long", too_long),
        ("naga_takes_too_much_memory", too_much),
        ("large_shaders_are_compiled", large),
        ("naga_keeps_its_stack", nested),
    ];
    let test = |(name, case): Case| Trial::test(format!("hostile::{name}"), case);
    cases.into_iter().map(test).collect()
}

/// Functions with thousands of statements. Each has an index for which naga's writers add a check.
fn indices(functions: usize, statements: usize) -> String {
    let body: String = (0..statements).map(|i| format!("s += m[i][{}];\n", i % 4)).collect();
    let function = |f| format!("fn g{f}(i: i32) -> f32 {{ var s = 0.0;\n{body}return s; }}\n");
    let calls: Vec<String> = (0..functions).map(|f| format!("g{f}(i)")).collect();
    let all: String = (0..functions).map(function).collect();
    format!(
        "var<private> m: mat4x4f;\n{all}\
         @fragment fn large(@location(0) @interpolate(flat) i: i32) -> @location(0) vec4f {{ \
         return vec4f({}); }}\n",
        calls.join(" + ")
    )
}

/// A shader with an array of `count` values.
fn values(count: usize) -> String {
    format!(
        "@fragment fn large(@location(0) @interpolate(flat) i: i32) -> @location(0) vec4f {{\n\
         var c = array<f32, {count}>({});\nreturn vec4f(c[i]); }}\n",
        vec!["1"; count].join(",")
    )
}

/// The error has a place in its file. The other file alone compiles within the same limit.
fn refused(large: &str, kib: u64, words: &str) -> Outcome {
    let folder = tempfile::tempdir()?;
    fs::write(folder.path().join("large.wgsl"), large)?;
    fs::write(folder.path().join("small.wgsl"), SMALL)?;
    let arguments = ["compile", "large.wgsl", "small.wgsl", "--target", "hlsl"];
    let output = run_within(kib, &folder, &[&arguments[..], &["--diagnostics", "short"]].concat())?;
    fails(&output, 1, "error[naga-exhausted]")?;
    fails(&output, 1, words)?;
    fails(&output, 1, "large.wgsl:")?;
    let alone = run_within(kib, &folder, &["compile", "small.wgsl", "--target", "hlsl"])?;
    fails(&alone, 0, "SV_Target0")
}

/// naga takes more time or memory than it may have. Which of the two depends on the machine.
fn too_long() -> Outcome {
    refused(&indices(9, 8000), 4 << 20, "naga takes more")
}

/// naga takes more memory than it may have.
fn too_much() -> Outcome {
    refused(&values(500_000), LITTLE_KIB, "naga takes more memory than it may have")
}

/// Texts nest deeply in every way in which naga's parsers recurse. The process in which naga is tried
/// has the same limits as an ordinary run, so it refuses them and its stack does not overflow.
fn nested() -> Outcome {
    const DEPTH: usize = 100_000;
    let around = |before: &str, open: &str, inner: &str, close: &str, after: &str| {
        format!("{before}{}{inner}{}{after}", open.repeat(DEPTH), close.repeat(DEPTH))
    };
    let texts = [
        ("wesl", around("const deep = ", "(", "1", ")", ";")),
        ("wesl", around("const deep = ", "!", "true", "", ";")),
        ("wesl", around("alias Deep = ", "array<", "f32", ", 2>", ";")),
        ("wesl", around("fn f(a: f32) -> f32 { return ", "a + ", "a", "", "; }")),
        ("wesl", around("fn f(a: i32) { ", "if a == 1 {} else ", "{}", "", " }")),
        ("wesl", around("fn f(a: i32) { ", "{", "", "}", " }")),
        ("wesl", around("fn f(a: i32) -> i32 { return ", "f(", "a", ")", "; }")),
        ("glsl", around("void main() { float a = ", "(", "1.0", ")", "; }")),
        ("glsl", around("void main() { float b = 1.0; float a = ", "- ", "b", "", "; }")),
        ("glsl", around("void main() { float b = 1.0; float a = ", "b + ", "b", "", "; }")),
        ("glsl", around("void main() { ", "{", "", "}", " }")),
    ];
    for (language, text) in texts {
        let stage = (language == "glsl").then_some("fragment");
        let job = json!({ "language": language, "stage": stage, "text": text, "outputs": null });
        let output = sandboxed(&job.to_string())?;
        if !output.status.success() || !output.stderr.is_empty() {
            let words = String::from_utf8_lossy(&output.stderr);
            let start = &text[..60];
            return Err(
                format!("`{start}...`: expected success, {}: {words}", output.status).into()
            );
        }
    }
    Ok(())
}

/// Runs the process in which naga is tried, with a job on its standard input. It is started as the
/// program starts it: its allocator reserves no address space in advance.
fn sandboxed(job: &str) -> Result<Output, Failed> {
    let mut sandbox = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(["sandbox", "naga"])
        .env("RAYON_NUM_THREADS", "1")
        .env("MIMALLOC_ARENA_RESERVE", "0")
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()?;
    if let Some(mut input) = sandbox.stdin.take() {
        // A process that ends before it has read everything tells why by its status.
        let _ = input.write_all(job.as_bytes());
    }
    Ok(sandbox.wait_with_output()?)
}

/// A large text that is tried in another process first, and that naga can compile, is compiled each
/// time. What the allocator of that process reserves must not decide.
fn large() -> Outcome {
    const TIMES: usize = 12;
    let folder = tempfile::tempdir()?;
    fs::write(folder.path().join("large.wgsl"), indices(1, 1100))?;
    for _ in 0..TIMES {
        let output = run(&folder, &["compile", "large.wgsl", "--target", "hlsl"])?;
        fails(&output, 0, "SV_Target0")?;
    }
    Ok(())
}
