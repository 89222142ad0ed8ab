//! Things that users must know of are reported, even if the command succeeds.

use super::package::Package;
use super::{Case, Outcome};

pub const CASES: &[Case] = &[
    ("warnings_of_the_manifest", manifest_warnings),
    ("empty_programs", empty_programs),
    ("usage_of_unknown_programs", unknown_usage),
];

const MAIN: &str = "@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f {
    @if(wrap) { return vec4f(fract(x)); }
    return vec4f(x);
}\n";

fn manifest(more: &str) -> String {
    format!(
        "[program.surface]\nwesl = \"main.wesl\"\ntargets = [\"wgsl\"]\n{more}\n\
         [program.surface.axis]\nwrap = {{ values = [false, true] }}\n"
    )
}

/// `gen` reports the lints of the manifest, also in a second run that has nothing to do.
fn manifest_warnings() -> Outcome {
    let always = manifest("") + "[[program.surface.constraint]]\nrequire = \"wrap || !wrap\"\n";
    let package = Package::new(&[("lamplight.toml", &always), ("main.wesl", MAIN)])?;
    for _ in 0..2 {
        package.run("gen --cache c")?.ends(0)?.says(&["warning[constraint-always-true]"])?;
    }
    Ok(())
}

/// A program without permutations is an error. Lints that only follow from its being empty are
/// not reported.
fn empty_programs() -> Outcome {
    let never = manifest("") + "[[program.surface.constraint]]\nrequire = \"wrap && !wrap\"\n";
    let package = Package::new(&[("lamplight.toml", &never), ("main.wesl", MAIN)])?;
    for command in ["gen --no-cache", "variants", "lint"] {
        let run = package.run(command)?.ends(1)?;
        run.says(&["error[constraint-always-false]", "so the program has no permutation"])?;
    }
    let run = package.run("gen --no-cache")?.ends(1)?;
    run.says(&["error[constraint-always-false]", "so the program has no permutation"])?
        .is_silent_of(&["unread-axis", "constant-condition"])?;
    package.write("lamplight.toml", &manifest("exclude = [{ wrap = \"*\" }]"))?;
    let run = package.run("gen --no-cache --force")?.ends(1)?;
    run.says(&["error[no-permutation]", "ships empty", "this is excluded"])?
        .is_silent_of(&["unread-axis", "constant-condition"])?;
    package.write("asked.txt", "# none\n")?;
    package.write("lamplight.toml", &manifest("usage = \"asked.txt\""))?;
    package.run("gen --no-cache --force")?.ends(1)?.says(&["error[no-permutation]"])?;
    Ok(())
}

/// A usage list that names a program which the manifest does not have gives one warning.
fn unknown_usage() -> Outcome {
    let list = "surface wrap\nsurfaces wrap\nsurfaces default\n";
    let package = Package::new(&[
        ("lamplight.toml", &manifest("usage = \"asked.txt\"")),
        ("main.wesl", MAIN),
        ("asked.txt", list),
    ])?;
    for command in ["gen --no-cache", "variants"] {
        let run = package.run(command)?.ends(0)?;
        let words = ["warning[unknown-program]", "asked.txt:2:1", "did you mean `surface`?"];
        let run = run.says(&words)?;
        if run.err.matches("unknown-program").count() != 1 {
            return Err(format!("{command}: expected one warning, found:\n{}", run.err).into());
        }
    }
    Ok(())
}
