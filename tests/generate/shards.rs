//! A bundle that several processes make in shards, and that `merge` puts together.

use std::fs;
use std::process::{Command, Stdio};

use lamplight::bundle::{Bundle, write_directory};

use super::{Outcome, Package, TINT, ensure, equal};

/// Shards merge to the same bytes as one run, in whatever order they are named.
pub fn shards() -> Outcome {
    let package = Package::new()?;
    package.generate(&["-o", "whole"])?;
    // Each shard is made by a process of its own, as under GNU parallel or in an array of jobs.
    let names: Vec<(String, String)> =
        (1..=5).map(|index| (format!("{index}/5"), format!("shard-{index}"))).collect();
    let children = names.iter().map(|(shard, out)| {
        package
            .command(&["gen", "--no-cache", "--shard", shard, "-o", out])
            .stdout(Stdio::null())
            .spawn()
    });
    for mut child in children.collect::<Result<Vec<_>, _>>()? {
        ensure(child.wait()?.success(), "the process of a shard failed")?;
    }
    for order in [[1, 2, 3, 4, 5], [4, 1, 5, 3, 2]] {
        let shards: Vec<String> = order.iter().map(|index| format!("shard-{index}")).collect();
        let arguments: Vec<&str> =
            ["merge", "merged"].into_iter().chain(shards.iter().map(String::as_str)).collect();
        let output =
            package.run(&[arguments.as_slice(), &["--manifest", "lamplight.toml"]].concat())?;
        ensure(output.status.success(), String::from_utf8_lossy(&output.stderr))?;
        equal(package.files("merged")?, package.files("whole")?)?;
    }
    Ok(())
}

/// The command line that the documentation shows for GNU parallel gives the same bytes as one run.
pub fn parallel() -> Outcome {
    let package = Package::new()?;
    package.generate(&["-o", "whole"])?;
    let run = |line: &str| -> Outcome {
        let mut command = Command::new("sh");
        command
            .args(["-c", line])
            .current_dir(package.path())
            .env("LAMPLIGHT", env!("CARGO_BIN_EXE_lamplight"));
        let output = command.env("HOME", package.path()).output()?;
        ensure(
            output.status.success(),
            format!("`{line}`: {}", String::from_utf8_lossy(&output.stderr)),
        )
    };
    let found = run("parallel --version | grep -q GNU");
    found.map_err(
        |_| "GNU parallel is not installed: `apt-get install parallel`, as `cargo xtask test` does",
    )?;
    run(
        "parallel --will-cite --jobs 2 --halt now,fail=1 $LAMPLIGHT gen --no-cache --shard {}/4 --out shards/{} ::: $(seq 4)",
    )?;
    run("$LAMPLIGHT merge merged shards/* --manifest lamplight.toml")?;
    equal(package.files("merged")?, package.files("whole")?)
}

/// `merge` refuses shards that are incomplete, belong to other sources, or are damaged.
pub fn wrong_shards() -> Outcome {
    let package = Package::new()?;
    for (shard, out) in [("1/2", "one"), ("2/2", "two")] {
        package.generate(&["--shard", shard, "-o", out])?;
    }
    equal(
        package.run(&["merge", "merged", "one", "--manifest", "lamplight.toml"])?.status.code(),
        Some(3),
    )?;
    package.write("tint.wesl", &TINT.replace("1.0, 0.0, 0.0", "0.5, 0.0, 0.0"))?;
    package.generate(&["--shard", "1/1", "-o", "other"])?;
    equal(package.run(&["merge", "merged", "one", "other"])?.status.code(), Some(3))?;
    let blob = fs::read_dir(package.path().join("two/blobs"))?.next().ok_or("no blob")??.path();
    fs::write(blob, "something else")?;
    equal(package.run(&["merge", "merged", "one", "two"])?.status.code(), Some(3))?;
    equal(package.run(&["gen", "--shard", "3/2"])?.status.code(), Some(2))
}

/// `merge` refuses shards that were not made of the same, and says what differs. Some shards of a
/// bundle are merged if the user says so, and the others can be added later.
pub fn mixed_shards() -> Outcome {
    let package = Package::new()?;
    package.generate(&["-o", "whole"])?;
    let shards = [("1/3", "one"), ("2/3", "two"), ("3/3", "three")];
    for (shard, out) in shards {
        package.generate(&["--shard", shard, "-o", out])?;
    }
    package.run(&["bundle", "pack", "two", "-o", "two.lamplight"])?;
    package.generate(&["--shard", "2/3", "--target", "wgsl", "-o", "settings"])?;
    package.generate(&["--shard", "2/4", "-o", "divided"])?;
    package.write("tint.wesl", &TINT.replace("1.0, 0.0, 0.0", "0.5, 0.0, 0.0"))?;
    package.generate(&["--shard", "2/3", "-o", "sources"])?;
    package.write("tint.wesl", TINT)?;
    package.write("lamplight.toml", &format!("{}# A comment\n", super::MANIFEST))?;
    package.generate(&["--shard", "2/3", "-o", "manifest"])?;
    let mut of_another_tool = Bundle::open(package.path().join("two"))?.contents()?;
    let origin = of_another_tool.shard.as_mut().ok_or("a shard without an origin")?;
    origin.tool.insert(0, '9');
    write_directory(&of_another_tool, package.path().join("tool"))?;
    for (other, reason) in [
        ("settings", "different settings"),
        ("divided", "divided differently"),
        ("sources", "different sources"),
        ("manifest", "different sources"),
        ("tool", "different versions of Lamplight"),
        ("whole", "only one of them is a shard"),
    ] {
        for out in ["merged", "merged.lamplight"] {
            let output = package.run(&["merge", out, "one", other, "three"])?;
            let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
            equal(output.status.code(), Some(3))?;
            let is_reported =
                stderr.contains(reason) && stderr.contains("`one`") && stderr.contains(other);
            ensure(is_reported, format!("{other}: {stderr}"))?;
            ensure(!package.path().join(out).exists(), format!("`{out}` was written"))?;
        }
    }
    let missing = package.run(&["merge", "merged", "one", "three"])?;
    equal(missing.status.code(), Some(3))?;
    let stderr = String::from_utf8_lossy(&missing.stderr).into_owned();
    ensure(stderr.contains("part 2 of 3 is missing"), stderr)?;
    equal(package.run(&["merge", "part", "one", "three", "--partial"])?.status.code(), Some(0))?;
    equal(package.run(&["merge", "merged", "part", "two.lamplight"])?.status.code(), Some(0))?;
    equal(package.files("merged")?, package.files("whole")?)
}

/// A bundle of a newer format is replaced only with `--force`.
pub fn newer() -> Outcome {
    let package = Package::new()?;
    package.generate(&[])?;
    package.generate(&["-o", "bundle.lamplight"])?;
    let manifest = fs::read_to_string(package.path().join("bundle/manifest.json"))?;
    let manifest = manifest.replace("\"version\": 3", "\"version\": 4");
    package.write("bundle/manifest.json", &manifest)?;
    let path = package.path().join("bundle.lamplight");
    let mut bytes = fs::read(&path)?;
    bytes[8] = 4;
    fs::write(&path, &bytes)?;
    for out in ["bundle", "bundle.lamplight"] {
        let output = package.run(&["gen", "--cache", "cache", "-o", out])?;
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        equal(output.status.code(), Some(1))?;
        ensure(stderr.contains("format version 4") && stderr.contains("--force"), stderr)?;
    }
    equal(fs::read_to_string(package.path().join("bundle/manifest.json"))?, manifest)?;
    equal(fs::read(&path)?, bytes)?;
    for out in ["bundle", "bundle.lamplight"] {
        package.generate(&["--force", "-o", out])?;
        equal(package.run(&["bundle", "verify", out])?.status.code(), Some(0))?;
    }
    Ok(())
}
