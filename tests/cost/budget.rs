//! Recorded costs: what the library may cost, and what the catalogue shows.

use std::collections::BTreeSet;

use lamplight::LIBRARY_FILES;
use lamplight::catalogue::cost;
use lamplight::project;
use lamplight::source::SourceSet;
use lamplight_testing::commands::stderr_text;
use serde_json::Value;

use super::{Outcome, lamplight, objects};

/// No function of the library became more expensive by more than 2 %. `cargo xtask record _budget`
/// records the costs again. With another version of Mesa nothing is compared, and the test says so.
pub fn functions() -> Outcome {
    keep_budget("functions", &["--gpu", "navi21,gfx1100"])
}

/// The same for a covering set of the permutations of every program, on one GPU.
pub fn programs() -> Outcome {
    keep_budget("programs", &["--cover", "--gpu", "navi21"])
}

fn keep_budget(name: &str, subjects: &[&str]) -> Outcome {
    let recorded = crate::snapshot::root().join(format!("snapshots/costs/{name}.json"));
    let path = recorded.to_string_lossy().into_owned();
    let records = std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always");
    let record = if records { &["--record"][..] } else { &[] };
    // Where nothing is recorded yet, the command would record instead of comparing.
    if !records && !recorded.exists() {
        return Err(format!("{path} is missing: run `cargo xtask record _budget`").into());
    }
    let common = ["--json", "--baseline", &path];
    let output = lamplight(&[subjects, &common[..], record].concat())?;
    match output.status.code() {
        Some(0) => all_are_recorded(&output.stdout, &std::fs::read(&recorded)?),
        Some(4) if stderr_text(&output).contains("not comparable") => {
            eprintln!("not compared: {}", stderr_text(&output));
            Ok(())
        }
        code => Err(format!("exit code {code:?}: {}", stderr_text(&output)).into()),
    }
}

/// What is measured is what is recorded. Otherwise something new would have no budget.
fn all_are_recorded(measured: &[u8], recorded: &[u8]) -> Outcome {
    let recorded: Value = serde_json::from_slice(recorded)?;
    let recorded = recorded["costs"].as_object().ok_or("no costs are recorded")?;
    let recorded: BTreeSet<String> = recorded.keys().cloned().collect();
    let measured: Vec<Value> = serde_json::from_slice(measured)?;
    let key = |object: &Value| {
        let parts = ["name", "gpu", "stage"].map(|part| object[part].as_str().unwrap_or_default());
        parts.join(" ").to_lowercase()
    };
    let measured: BTreeSet<String> = measured.iter().map(key).collect();
    let differing: Vec<&String> = measured.symmetric_difference(&recorded).collect();
    match differing.is_empty() {
        true => Ok(()),
        false => {
            let what = "these are either measured or recorded, but not both";
            Err(format!("{what}: {differing:#?}: run `cargo xtask record _budget`").into())
        }
    }
}

/// The recorded costs, which the catalogue shows, are what is measured now. They are compared only
/// if this machine has the driver that was recorded. Every recorded axis and value exists.
pub fn record_is_current() -> Outcome {
    let mut sources = SourceSet::default();
    let library = cost::library_costs(LIBRARY_FILES, &mut sources);
    let recorded = library.map_err(|problems| format!("{problems:?}"))?;
    let (_, manifest) =
        project::library_manifest().map_err(|(_, problems)| format!("{problems:?}"))?;
    for row in &recorded.axes {
        let program = manifest.programs.iter().find(|program| program.name == row.program);
        let mut axes = program.iter().flat_map(|program| program.space.axes());
        let axis = axes.find(|axis| axis.name == row.axis);
        if !axis.is_some_and(|axis| axis.value_names().contains(&row.value)) {
            let what = format!("no axis of the library has this recorded value: {row:?}");
            return Err(format!("{what}: run `cargo xtask docs --costs`").into());
        }
    }
    let found = objects(&[])?;
    let measured_by = found.first().map_or(&Value::Null, |object| &object["driver"]);
    if *measured_by != recorded.driver.as_str() {
        eprintln!("not compared: `{}` was recorded, this is {measured_by}", recorded.driver);
        return Ok(());
    }
    if found.len() != recorded.functions.len() * recorded.gpus.len() {
        let (functions, gpus) = (recorded.functions.len(), recorded.gpus.len());
        let what = format!("recorded {functions} functions on {gpus} GPUs");
        let what = format!("{what}, measured {} rows", found.len());
        return Err(format!("{what}: run `cargo xtask docs --costs`").into());
    }
    for object in &found {
        let (name, gpu) = (object["name"].as_str(), object["gpu"].as_str());
        let at = recorded.gpus.iter().position(|chip| Some(chip.name.as_str()) == gpu);
        let row = at.and_then(|at| recorded.functions.get(name?)?.get(at));
        let keys = [
            "cycles",
            "least_cycles",
            "transcendental",
            "texture",
            "vgprs",
            "instructions",
            "open_loops",
        ];
        let keys = keys.map(|key| object["net"][key].as_i64());
        if row.map(|row| row.map(Some)) != Some(keys) {
            let text = format!("{name:?} on {gpu:?}: recorded {row:?}, measured {keys:?}");
            return Err(format!("{text}: run `cargo xtask docs --costs`").into());
        }
    }
    Ok(())
}
