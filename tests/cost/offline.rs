//! Compilers that are programs of their own: `--spirv` asks `spirv-opt`, `--mali` asks `malioc`.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

use lamplight_testing::commands::stderr_text;
use libtest_mimic::Failed;
use serde_json::Value;

use super::{OWN_MANIFEST, OWN_SHADER, Outcome, lamplight, objects};

fn count(object: &Value, form: &str, kind: &str) -> Result<i64, Failed> {
    let number = object[form][kind].as_i64();
    number.ok_or_else(|| format!("no {form}.{kind} in {object}").into())
}

/// Filters without loops are counted with their taps: each is a SampledImage and a sample, and those
/// with several ask for the size of the texture. The kinds add up to the total, and the table knows
/// every instruction that the library's modules have.
pub fn taps_are_counted() -> Outcome {
    for (name, textures) in
        [("hard", 2), ("pcf_castano_3", 2 * 4 + 1), ("pcf_castano_5", 2 * 9 + 1)]
    {
        let found = objects(&[&format!("shadow::compare::{name}"), "--spirv"])?;
        let object = found.first().ok_or("there is nothing")?;
        if !object["optimiser"].as_str().is_some_and(|version| version.contains("SPIRV-Tools")) {
            return Err(format!("the version of the optimiser is not reported: {object}").into());
        }
        if count(object, "net", "textures")? != textures {
            return Err(format!("{name}: expected {textures} of textures: {object}").into());
        }
    }
    for object in objects(&["shadow", "brdf::microfacet", "--spirv"])? {
        for form in ["counts", "net"] {
            let kinds = object[form].as_object().ok_or("no counts")?;
            let sum: i64 = kinds.values().filter_map(Value::as_i64).sum();
            if sum != 2 * count(&object, form, "total")? || count(&object, form, "other")? != 0 {
                return Err(format!("the kinds do not add up to the total: {object}").into());
            }
        }
    }
    Ok(())
}

/// The specialisation constants get the values of the key before the optimiser sees the module.
pub fn constants_are_settled() -> Outcome {
    let folder = tempfile::tempdir()?;
    fs::write(folder.path().join("lamplight.toml"), OWN_MANIFEST)?;
    fs::write(folder.path().join("own.wesl"), OWN_SHADER)?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    let options = ["--spirv", "--json", "--manifest", "lamplight.toml"];
    let command = command.args(["cost", "default", "loops=9", "warm"]).args(options);
    let output = command.current_dir(folder.path()).output()?;
    let found: Vec<Value> =
        serde_json::from_slice(&output.stdout).map_err(|_| stderr_text(&output))?;
    let of = |index: usize, kind: &str| count(&found[index], "counts", kind);
    // The loop has a sine and a root. With no iterations, the optimiser removes it.
    if of(0, "functions")? != 0 || of(1, "functions")? < 2 {
        return Err(format!("`loops` is not settled: {found:#?}").into());
    }
    match of(2, "arithmetic")? > of(0, "arithmetic")? {
        true => Ok(()),
        false => Err(format!("`warm` adds no arithmetic: {found:#?}").into()),
    }
}

/// Without the programs, the exit code is 4, and the message says how to get them.
pub fn missing_programs() -> Outcome {
    let cases = [
        (&["--spirv"][..], "apt-get install spirv-tools"),
        (&["--mali", "Mali-G78"], "Arm Performance Studio"),
    ];
    for (options, hint) in cases {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
        let command = command.args(["cost", "lighting::spot"]).args(options);
        let output = command.env("PATH", "/nowhere").output()?;
        if output.status.code() != Some(4) || !stderr_text(&output).contains(hint) {
            let found = format!("{:?}: {}", output.status, stderr_text(&output));
            return Err(format!("{options:?}: expected exit code 4 and `{hint}`, {found}").into());
        }
    }
    let both = lamplight(&["lighting::spot", "--spirv", "--gpu", "navi21"])?;
    match both.status.code() {
        Some(2) => Ok(()),
        code => Err(format!("`--spirv --gpu`: exit code {code:?}, expected 2").into()),
    }
}

/// A report in the form of malioc 8, of a fragment stage with a loop of unknown length.
const REPORT: &str = r#"{
  "producer": { "name": "Mali Offline Compiler", "version": [8, 5, 0], "build": "1a2b3c" },
  "schema": { "name": "performance", "version": 0 },
  "shaders": [{
    "filename": "0.frag.spv",
    "driver": "r51p0-00rel0",
    "hardware": { "architecture": "Valhall", "core": "Mali-G78", "revision": "r1p1" },
    "shader": { "api": "Vulkan", "type": "Fragment" },
    "notes": [], "warnings": [],
    "properties": [{ "name": "has_side_effects", "value": false }],
    "variants": [{
      "name": "Main",
      "performance": {
        "pipelines": ["arith_total", "arith_fma", "load_store", "varying", "texture"],
        "total_cycles": { "bound_pipelines": ["texture"], "cycle_count": [0.5, 0.25, 0, 0.75, 1.5] },
        "shortest_path_cycles": { "bound_pipelines": ["varying"], "cycle_count": [0.4, 0.2, 0, 0.75, 0] },
        "longest_path_cycles": { "bound_pipelines": [null], "cycle_count": [null, null, null, null, null] }
      },
      "properties": [
        { "name": "work_registers_used", "value": 19 },
        { "name": "uniform_registers_used", "value": 4 },
        { "name": "thread_occupancy", "value": 100 },
        { "name": "has_stack_spilling", "value": false }
      ]
    }]
  }]
}"#;

/// A stand-in for malioc in a folder: it notes how it was called and what its file began with, and
/// prints the report that lies beside it.
fn stand_in(folder: &Path, report: &str) -> Result<(), Failed> {
    let script = "#!/bin/sh\nhere=$(dirname \"$0\")\necho \"$@\" >> \"$here/calls\"\n\
                  for file; do :; done\nhead -c 4 \"$file\" > \"$here/head\"\n\
                  cat \"$here/report.json\"\n";
    let program = folder.join("malioc");
    fs::write(&program, script)?;
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755))?;
    Ok(fs::write(folder.join("report.json"), report)?)
}

fn ask_mali(folder: &Path, options: &[&str]) -> Result<Output, Failed> {
    let path = std::env::var("PATH").unwrap_or_default();
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    let command = command.args(["cost", "lighting::spot::cone_hard", "--mali", "Mali-G78"]);
    let command = command.args(options).env("PATH", format!("{}:{path}", folder.display()));
    command.output().map_err(Failed::from)
}

/// malioc's report is read, and figures that it leaves open are `null`. The program was given a
/// SPIR-V module in a file whose name ends with the stage.
pub fn mali_is_called() -> Outcome {
    let folder = tempfile::tempdir()?;
    stand_in(folder.path(), REPORT)?;
    let output = ask_mali(folder.path(), &["--json"])?;
    let found: Value = serde_json::from_slice(&output.stdout).map_err(|_| stderr_text(&output))?;
    let variant = &found[0]["variants"][0];
    let found = [
        (&variant["core"], Value::from("Mali-G78")),
        (&variant["total"]["cycles"][4], Value::from(1.5)),
        (&variant["total"]["bound"][0], Value::from("texture")),
        (&variant["longest"]["cycles"][0], Value::Null),
        (&variant["work_registers"], Value::from(19.0)),
        (&variant["spilled_bytes"], Value::Null),
    ];
    if let Some((found, expected)) = found.iter().find(|(found, expected)| *found != expected) {
        return Err(format!("expected {expected}, found {found} in {found:#}").into());
    }
    let calls = fs::read_to_string(folder.path().join("calls"))?;
    let call = calls.lines().next().unwrap_or_default();
    if !call.starts_with("--vulkan --core Mali-G78 --name ") || !call.ends_with(".frag.spv") {
        return Err(format!("the program was called with `{call}`").into());
    }
    if fs::read(folder.path().join("head"))? != 0x0723_0203_u32.to_le_bytes() {
        return Err("the file does not begin as SPIR-V does".into());
    }
    let table = ask_mali(folder.path(), &[])?;
    let table = String::from_utf8_lossy(&table.stdout).into_owned();
    let row =
        "Mali-G78  fragment  Main     1.5    0.75      ?        texture   19    4        100 %";
    match table.contains(row) {
        true => Ok(()),
        false => Err(format!("no `{row}` in\n{table}").into()),
    }
}

/// Errors of a report's form are reported, and so are the compiler's errors about a shader.
pub fn bad_reports() -> Outcome {
    let refused = r#"{ "schema": { "name": "error", "version": 0 },
        "shaders": [{ "filename": "a", "errors": ["no such core"], "warnings": [] }] }"#;
    let lopsided = REPORT.replace("\"arith_fma\", ", "");
    let cases = [
        ("Usage: malioc", "the report of `malioc` for Mali-G78 could not be read"),
        (r#"{ "shaders": [] }"#, "it has 0 shaders instead of one"),
        (refused, "`malioc` refuses the shader for Mali-G78: no such core"),
        (&lopsided, "`Main` has 5 counts for 4 units"),
    ];
    for (report, expected) in cases {
        let folder = tempfile::tempdir()?;
        stand_in(folder.path(), report)?;
        let output = ask_mali(folder.path(), &[])?;
        if output.status.code() != Some(1) || !stderr_text(&output).contains(expected) {
            let found = format!("{:?}: {}", output.status, stderr_text(&output));
            return Err(format!("expected exit code 1 and `{expected}`, found {found}").into());
        }
    }
    Ok(())
}
