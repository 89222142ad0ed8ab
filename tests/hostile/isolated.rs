//! Shaders that are within every limit and still end naga's process, or take it too long: each is
//! an error of its own, and nothing else is lost.

use std::fs;
use std::io::Write as _;
use std::process::{Command, Output, Stdio};

use libtest_mimic::{Failed, Trial};
use serde_json::json;

use super::{Outcome, fails, run, run_within};

type Case = (&'static str, fn() -> Outcome);

const CALM: &str = "@fragment fn calm() -> @location(0) vec4f { return vec4f(); }\n";

/// Address space of a run in which naga finds too little for an array of many values, in KiB.
const LITTLE_KIB: u64 = 700 << 10;

pub fn trials() -> Vec<Trial> {
    let cases: [Case; 4] = [
        ("naga_takes_too_long", too_long),
        ("naga_takes_too_much_memory", too_much),
        ("large_shaders_are_compiled", large),
        ("naga_keeps_its_stack", nested),
    ];
    let trial = |(name, case): Case| Trial::test(format!("hostile::{name}"), case);
    cases.into_iter().map(trial).collect()
}

/// Functions of thousands of statements, each with an index that naga's writers check.
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

/// An array of so many values.
fn values(count: usize) -> String {
    format!(
        "@fragment fn large(@location(0) @interpolate(flat) i: i32) -> @location(0) vec4f {{\n\
         var c = array<f32, {count}>({});\nreturn vec4f(c[i]); }}\n",
        vec!["1"; count].join(",")
    )
}

/// The error has a place in its file, and the other file is compiled.
fn refused(large: &str, kib: u64, words: &str) -> Outcome {
    let folder = tempfile::tempdir()?;
    fs::write(folder.path().join("large.wgsl"), large)?;
    fs::write(folder.path().join("calm.wgsl"), CALM)?;
    let arguments = ["compile", "large.wgsl", "calm.wgsl", "--target", "hlsl"];
    let output = run_within(kib, &folder, &[&arguments[..], &["--diagnostics", "short"]].concat())?;
    fails(&output, 1, "error[naga-exhausted]")?;
    fails(&output, 1, words)?;
    fails(&output, 1, "large.wgsl:")?;
    let alone = run_within(kib, &folder, &["compile", "calm.wgsl", "--target", "hlsl"])?;
    fails(&alone, 0, "SV_Target0")
}

/// Of time or of memory: which of the two ends first depends on the machine.
fn too_long() -> Outcome {
    refused(&indices(9, 8000), 4 << 20, "naga takes more")
}

fn too_much() -> Outcome {
    refused(&values(500_000), LITTLE_KIB, "naga takes more memory than it may have")
}

/// Texts that nest without end in every way that naga's readers recurse: a rehearsal has the same
/// limits as a run, so that none of them reaches naga's stack, and nothing dies.
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
        let output = rehearsed(&job.to_string())?;
        if !output.status.success() || !output.stderr.is_empty() {
            let words = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{}: {} {words}", &text[..60], output.status).into());
        }
    }
    Ok(())
}

/// The process of a rehearsal over a job.
fn rehearsed(job: &str) -> Result<Output, Failed> {
    let mut rehearsal = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(["rehearse", "naga"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()?;
    if let Some(mut input) = rehearsal.stdin.take() {
        input.write_all(job.as_bytes())?;
    }
    Ok(rehearsal.wait_with_output()?)
}

/// What is beyond the calm part of a limit and within reason is compiled, each time: what the
/// rehearsal's allocator reserves must not decide.
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
