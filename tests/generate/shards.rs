//! A bundle that several processes make in shards, and that `merge` puts together.

use std::fs;
use std::process::{Command, Stdio};

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
