//! `watch` follows edits of the sources.

use std::fs;
use std::process::Stdio;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::{Outcome, Package, TINT, ensure, equal};

/// `watch` brings the bundle up to date after each edit, also after an edit with an error.
pub fn watch() -> Outcome {
    let package = Package::new()?;
    package.generate(&[])?;
    let arguments = ["watch", "--cache", "cache", "--program", "small", "--key", "tint=green"];
    let mut child =
        package.command(&arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
    let outcome = followed(&package);
    child.kill()?;
    child.wait()?;
    outcome?;
    equal(&package.generate(&[])?["up_to_date"], &Value::Bool(true))
}

fn followed(package: &Package) -> Outcome {
    let manifest = || fs::read(package.path().join("bundle/manifest.json"));
    for text in ["0.0, 0.5, 0.0", "nonsense", "0.0, 0.25, 0.0"] {
        let before = manifest()?;
        package.write("tint.wesl", &TINT.replace("0.0, 1.0, 0.0", text))?;
        if text == "nonsense" {
            // This text has an error. The next edit shows that `watch` still runs.
            std::thread::sleep(Duration::from_millis(300));
            continue;
        }
        let start = Instant::now();
        while manifest()? == before || package.generate(&["--check"]).is_err() {
            let what = format!("20 s after the edit `{text}`, the bundle is not up to date");
            ensure(start.elapsed() < Duration::from_secs(20), what)?;
            std::thread::sleep(Duration::from_millis(50));
        }
    }
    Ok(())
}

/// A run that was stopped never ends its turn. Others wait as long as `--wait` says, and name its
/// process.
pub fn stopped() -> Outcome {
    let package = Package::new()?;
    package.generate(&[])?;
    let turn = fs::File::open(package.path().join("bundle"))?;
    turn.lock()?;
    package.write("tint.wesl", &TINT.replace("0.0, 1.0, 0.0", "0.0, 0.75, 0.0"))?;
    let start = Instant::now();
    let output = package.run(&["gen", "--wait", "1"])?;
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    equal(output.status.code(), Some(4))?;
    ensure(start.elapsed() < Duration::from_secs(30), "the run waited too long")?;
    let who = match cfg!(target_os = "linux") {
        true => format!("process {} writes there", std::process::id()),
        false => "another process writes there".to_owned(),
    };
    ensure(stderr.contains(&who) && stderr.contains("within 1 s"), &stderr)?;
    drop(turn);
    equal(package.run(&["gen", "--wait", "1"])?.status.code(), Some(0))
}
