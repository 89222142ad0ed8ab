//! `lamplight render` as scripts see it: files, exit codes and messages.

use std::process::{Command, Output};

use libtest_mimic::{Failed, Trial};

use super::read;

/// Wrong arguments, the exit code, and a part of the message on standard error.
const WRONG: &[(&[&str], i32, &str)] = &[
    (&["oglpg_7_99"], 1, "did you mean `oglpg_7_1`?"),
    (&["hpg_4_spot", "--scene", "flor"], 1, "did you mean `floor`?"),
    (&["--set", "shadow=har"], 1, "shadow"),
    (&["--set", "lights=none,shadow=hard"], 1, "break this constraint"),
    (&["--program", "blur"], 1, "contact_shadows, deferred, depth_view, forward, gtao, prefilter"),
    (&["hpg_4_spot", "--environment", "nowhere.hdr"], 1, "nowhere.hdr"),
    (
        &["hpg_4_spot", "--executor", "eval", "--size", "8x8", "-o", "/proc/no/such.png"],
        4,
        "/proc/no/such.png",
    ),
    (&[], 2, "preset"),
    (&["hpg_4_spot", "--executor", "spirv"], 2, "eval"),
    (&["hpg_4_spot", "--size", "0x8"], 2, "4096"),
    (&["hpg_4_spot", "--all"], 2, "--all"),
    (&["tech_ggx", "--beside"], 1, "`tech_ggx` has no safe form"),
    (&["shadow_filters", "--beside"], 1, "there is no preset `shadow_filters`"),
    (&["oglpg_7_6", "--beside", "--camera", "0"], 2, "--camera"),
];

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("render/command/wrong", wrong),
        Trial::test("render/command/missing_driver", missing_driver),
        Trial::test("render/command/file", file),
    ]
}

fn lamplight(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    command.arg("render").args(arguments);
    command
}

fn ends_with(output: &Output, code: i32, part: &str) -> Result<(), String> {
    let stderr = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(code) && stderr.contains(part) {
        Ok(())
    } else {
        Err(format!("expected exit code {code} and `{part}`, {}: {stderr}", output.status))
    }
}

fn wrong() -> Result<(), Failed> {
    for (arguments, code, part) in WRONG {
        let output = lamplight(arguments).output()?;
        ends_with(&output, *code, part).map_err(|error| format!("{arguments:?}: {error}"))?;
    }
    Ok(())
}

/// Without a Vulkan driver, the command ends with exit code 4 and says what to install.
fn missing_driver() -> Result<(), Failed> {
    let output = lamplight(&["hpg_4_spot", "--size", "8x8"])
        .env("VK_DRIVER_FILES", "/nowhere.json")
        .output()?;
    Ok(ends_with(&output, 4, "apt-get install mesa-vulkan-drivers")?)
}

/// A picture has the size that was asked for, is the same each time, and differs with other settings.
fn file() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let draw = |name: &str, more: &[&str]| -> Result<_, String> {
        let path = folder.path().join(name);
        let text = path.to_string_lossy();
        let arguments = [
            &[
                "hpg_5_shadow",
                "--executor",
                "eval",
                "--size",
                "48x32",
                "--samples",
                "1",
                "-o",
                &*text,
            ],
            more,
        ]
        .concat();
        let output = lamplight(&arguments).output().map_err(|error| error.to_string())?;
        ends_with(&output, 0, "")?;
        read(&path)
    };
    let (first, again, other) =
        (draw("a.png", &[])?, draw("b.png", &[])?, draw("c.png", &["--set", "shadow=none"])?);
    let size = (first.width, first.height) == (48, 32);
    if size && first == again && first != other {
        Ok(())
    } else {
        let what = format!("of the size 48 x 32: {size}, same twice: {}", first == again);
        Err(format!("{what}, differs without a shadow: {}", first != other).into())
    }
}
