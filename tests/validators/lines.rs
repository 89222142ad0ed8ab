//! `--validate lines`: outputs are validated so that each distinct line is in one of them, and what
//! was validated by the same validators is not validated again.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::PathBuf;

use libtest_mimic::Failed;

use super::{Outcome, Package, expect, output_text};

/// Two axes, each of which adds a line.
const SHADER: &str = "
struct Colors {
    @location(0) first: vec4f,
    @if(last) @location(LOCATION) last: vec4f,
}
@group(0) @binding(0) var<uniform> u: vec4f;
@fragment fn fs_main(@location(0) at: vec2f) -> Colors {
    var colors: Colors;
    colors.first = vec4f(at, 0.0, 1.0);
    @if(bright) { colors.first *= 2.0; }
    @if(warm) { colors.first += u; }
    return colors;
}
";

const MANIFEST: &str = "[program.one]
wesl = \"one.wesl\"
targets = [\"essl300\", \"spirv\"]
axis.bright = { values = [false, true] }
axis.warm = { values = [false, true] }
axis.last = { values = [false, true] }
";

/// A line that only some permutations have is refused at the author's line, and the older bundle
/// stays. Fewer outputs are validated than there are.
pub fn lines_of_few_permutations() -> Outcome {
    let sound = SHADER.replace("LOCATION", "1");
    let package = Package::new(MANIFEST, &sound)?;
    let arguments = ["gen", "--validate", "lines", "--no-cache"];
    let output = package.run(&arguments)?;
    expect(&output, 0, &["outputs validated, 0 known to pass"])?;
    let now = validated(&output_text(&output), "essl300")?;
    if now >= 8 {
        return Err(format!("{now} of 8 outputs are validated, for lines alone").into());
    }
    let before = fs::read(package.path("bundle/manifest.json"))?;
    fs::write(package.path("one.wesl"), SHADER.replace("LOCATION", "40"))?;
    let words = [
        "error[output-refused]: glslangValidator refuses the output for `essl300`",
        "one.wesl:",
        "location = 40",
        "last",
        "of one fs_main (wesl)",
    ];
    expect(&package.run(&arguments)?, 1, &words)?;
    match fs::read(package.path("bundle/manifest.json"))? == before {
        true => Ok(()),
        false => Err("the bundle was replaced although an output was refused".into()),
    }
}

/// How many outputs of a target a summary says were validated.
fn validated(summary: &str, target: &str) -> Result<usize, Failed> {
    let mut lines = summary.lines().filter(|line| line.starts_with(target));
    let found =
        lines.find_map(|line| line[target.len()..].split_once(" of ")?.0.trim().parse().ok());
    found.ok_or_else(|| format!("no output of `{target}` is validated:\n{summary}").into())
}

/// A `PATH` with all validators but one.
pub fn path_without(package: &Package, absent: &str) -> Result<PathBuf, Failed> {
    let folder = package.path(&format!("without-{absent}"));
    fs::create_dir(&folder)?;
    let path = std::env::var_os("PATH").unwrap_or_default();
    for program in ["spirv-val", "glslangValidator", "glslc", "clang++", "node"] {
        let mut places = std::env::split_paths(&path).map(|place| place.join(program));
        let place = places.find(|place| place.is_file()).filter(|_| program != absent);
        if let Some(place) = place {
            symlink(place, folder.join(program))?;
        }
    }
    Ok(folder)
}

/// If a validator is missing, it is named with its package. The other targets are validated, the
/// bundle is written, and the exit code is 4.
pub fn others_go_on() -> Outcome {
    for extent in ["lines", "all"] {
        let package = Package::new(MANIFEST, &SHADER.replace("LOCATION", "1"))?;
        let path = path_without(&package, "spirv-val")?;
        let run = || {
            let mut command = package.command(&["gen", "--validate", extent, "--cache", "cache"]);
            command.env("PATH", &path).output()
        };
        let missing = "not validated: `spirv-val` is not installed; \
                       install it with: apt-get install spirv-tools";
        let output = run()?;
        expect(&output, 4, &[missing, "not all outputs are validated", "by glslangValidator"])?;
        validated(&output_text(&output), "essl300")?;
        let again = [missing, "0 outputs validated, 8 known to pass", "up to date"];
        expect(&run()?, 4, &again)?;
        // Once it is there, it is asked.
        let output = package.run(&["gen", "--validate", extent, "--cache", "cache"])?;
        expect(&output, 0, &["by spirv-val"])?;
        validated(&output_text(&output), "spirv")?;
        if !package.path("bundle/manifest.json").exists() {
            return Err("no bundle is written although the other validators accept it".into());
        }
    }
    Ok(())
}

/// A validator that writes down each of its runs, and whose version is in a file.
const VALIDATOR: &str = "#!/bin/sh
folder=$(dirname \"$0\")
if [ \"$1\" = --version ]; then cat \"$folder/version\"; else echo run >> \"$folder/runs\"; fi
";

/// The same bundle is not validated again, also after its shaders changed and changed back. It is
/// validated again by another version of a validator.
pub fn validated_once() -> Outcome {
    let manifest = MANIFEST.replace("\"essl300\", ", "");
    let sound = SHADER.replace("LOCATION", "1");
    let package = Package::new(&manifest, &sound)?;
    let tools = package.path("tools");
    fs::create_dir(&tools)?;
    fs::write(tools.join("spirv-val"), VALIDATOR)?;
    fs::set_permissions(tools.join("spirv-val"), fs::Permissions::from_mode(0o755))?;
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path =
        std::env::join_paths([tools.clone()].into_iter().chain(std::env::split_paths(&path)))?;
    let runs = |version: &str, extent: &str| -> Result<usize, Failed> {
        fs::write(tools.join("version"), format!("SPIRV-Tools v{version} of a test"))?;
        fs::write(tools.join("runs"), "")?;
        let mut command = package.command(&["gen", "--validate", extent, "--cache", "cache"]);
        let output = command.env("PATH", &path).output()?;
        expect(&output, 0, &[&format!("spirv-val {version}")])?;
        Ok(fs::read_to_string(tools.join("runs"))?.lines().count())
    };
    // Each of the eight outputs is validated for two versions of Vulkan. Without texts beside them,
    // it is not known which lines they have.
    let mut found = vec![runs("1.1", "lines")?, runs("1.1", "lines")?, runs("1.2", "lines")?];
    found.extend([runs("1.2", "all")?, runs("1.2", "lines")?]);
    fs::write(package.path("one.wesl"), sound.replace("2.0", "3.0"))?;
    found.push(runs("1.2", "lines")?);
    fs::write(package.path("one.wesl"), &sound)?;
    found.push(runs("1.2", "lines")?);
    let expected = [16, 0, 16, 16, 0, 8, 0];
    match found == expected {
        true => Ok(()),
        false => Err(format!("spirv-val ran {found:?} times, expected {expected:?}").into()),
    }
}
