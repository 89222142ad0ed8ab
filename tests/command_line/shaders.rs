//! Mistakes that shader authors make: in conditions, versions and names, and marks that editors
//! put at the start of files.

use super::package::Package;
use super::{Case, Outcome};

pub const CASES: &[Case] = &[
    ("settings_are_always_defined", always_defined),
    ("defaults_for_other_compilers", defaults),
    ("shaders_without_a_version", versions),
    ("byte_order_marks", marks),
    ("conversions_from_the_other_end", conversions),
    ("names_of_packages", packages),
    ("spec_axes_that_are_read", spec_axes),
    ("conditions_that_lists_settle", settled),
];

const HEAD: &str = "#version 450\nlayout(location = 0) out vec4 c;\nvoid main() {\n";
const GLSL: &str = "[program.p]\nglsl = { fragment = \"p.frag.glsl\" }\ntargets = [\"wgsl\"]\n\
    [program.p.axis]\nfog = { values = [false, true] }\n\
    shadow = { values = [\"none\", \"hard\"] }\n";

fn shader(condition: &str) -> String {
    format!("{HEAD}{condition}\nc = vec4(0.5);\n#else\nc = vec4(1.0);\n#endif\n}}\n")
}

/// `#ifdef FOG` holds in every permutation, since a setting that is off is defined as 0. A warning
/// says so and shows the condition that was meant.
fn always_defined() -> Outcome {
    let package = Package::new(&[("lamplight.toml", GLSL)])?;
    let conditions = [
        ("#ifdef FOG", "always holds", "`#if FOG`"),
        ("#ifndef FOG", "never holds", "`#if !FOG`"),
        ("#if defined(FOG)", "always holds", "`#if FOG`"),
        ("#if !defined FOG", "never holds", "`#if !FOG`"),
        ("#ifdef SHADOW", "always holds", "`#if SHADOW`"),
    ];
    for (condition, label, help) in conditions {
        package.write("p.frag.glsl", &shader(condition))?;
        for command in ["gen --no-cache --force", "lint"] {
            let run = package.run(command)?.ends(0)?;
            run.says(&["warning[always-defined]", "p.frag.glsl:4:1", label, help])?;
        }
    }
    package.write("alone.frag", &shader("#ifdef SPECULAR"))?;
    let off = package.run("compile alone.frag --feature SPECULAR=false --target wgsl")?.ends(0)?;
    off.says(&["warning[always-defined]"])?;
    let on = package.run("compile alone.frag --feature SPECULAR --target wgsl")?.ends(0)?;
    on.says(&["0.5"])?.is_silent_of(&["warning"])?;
    Ok(())
}

/// A file may define a default for compilers that do not know the setting, and may ask for the
/// setting's value. Neither gives a warning.
fn defaults() -> Outcome {
    let conditions =
        ["#ifndef FOG\n#define FOG 0\n#endif\n#if FOG", "#if FOG", "#if defined(FOG) && FOG"];
    let manifest = GLSL.replace("shadow = { values = [\"none\", \"hard\"] }\n", "");
    let package = Package::new(&[("lamplight.toml", &manifest)])?;
    for condition in conditions {
        package.write("p.frag.glsl", &shader(condition))?;
        package.run("gen --no-cache --force")?.ends(0)?.is_silent_of(&["warning"])?;
    }
    Ok(())
}

/// A shader without `#version` gives a warning, since other compilers take it for GLSL 1.10. An
/// included file does not need one.
fn versions() -> Outcome {
    let package = Package::new(&[
        ("p.frag", "layout(location = 0) out vec4 c;\nvoid main() { c = vec4(1.0); }\n"),
        ("part.glsl", "float half_of(float x) { return 0.5 * x; }\n"),
    ])?;
    let run = package.run("compile p.frag --target wgsl")?.ends(0)?;
    run.says(&["warning[missing-version]", "p.frag:1:1", "begin the file with `#version 450`"])?;
    package.run("lint part.glsl")?.ends(0)?.is_silent_of(&["warning["])?;
    Ok(())
}

/// Editors on Windows put a byte order mark before the text. It is accepted in both languages and in
/// manifests, and does not move the places of messages.
fn marks() -> Outcome {
    let wesl = "\u{feff}@fragment fn m() -> @location(0) vec4f { return vec4f(nothing); }\n";
    let manifest = format!("\u{feff}{GLSL}");
    let package = Package::new(&[
        ("p.frag.glsl", &format!("\u{feff}{}", shader("#if FOG || SHADOW == SHADOW_HARD"))),
        ("w.wesl", wesl),
        ("lamplight.toml", &manifest),
    ])?;
    package.run("gen --no-cache")?.ends(0)?.is_silent_of(&["warning", "error"])?;
    let run = package.run("compile w.wesl --target wgsl --diagnostics short")?.ends(1)?;
    run.says(&["w.wesl:1:55: error"])?;
    Ok(())
}

/// The library names conversions `RESULT_from_SOURCE`. For `linear_to_srgb`, the suggestion is
/// `srgb_from_linear`, although the inverse function has the more similar name.
fn conversions() -> Outcome {
    let text = "import lamplight::color::transfer::linear_to_srgb;
@fragment fn m() -> @location(0) vec4f { return vec4f(linear_to_srgb(0.5)); }\n";
    let run = Package::new(&[("a.wesl", text)])?.run("compose a.wesl")?.ends(1)?;
    run.says(&["did you mean `srgb_from_linear`?", "a.wesl:1:36"])?;
    Ok(())
}

/// A misspelt package or module is reported once, at its path, although two names are imported from
/// it.
fn packages() -> Outcome {
    let use_it = "@fragment fn m() -> @location(0) vec4f { return vec4f(a() + b()); }\n";
    let wrong = [
        ("import lamplite::brdf::{a, b};\n", "a.wesl:1:8: error[unknown-package]", "`lamplight`"),
        ("import pakage::brdf::{a, b};\n", "a.wesl:1:8: error[unknown-package]", "`package`"),
        (
            "import lamplight::brdf::specluar::{a, b};\n",
            "a.wesl:1:8: error[missing-module]",
            "`lamplight::brdf::specular`",
        ),
    ];
    for (import, place, meant) in wrong {
        let package = Package::new(&[("a.wesl", &format!("{import}{use_it}"))])?;
        let run =
            package.run("compose a.wesl --diagnostics short")?.ends(1)?.says(&[place, meant])?;
        if run.err.lines().count() != 1 {
            return Err(format!("`{import}`: expected one line, found:\n{}", run.err).into());
        }
    }
    Ok(())
}

const WESL: &str = "[program.p]\nwesl = \"p.wesl\"\ntargets = [\"wgsl\"]\n";

/// A `spec` axis that the shader reads as a constant does not give the warning that nothing reads
/// it.
fn spec_axes() -> Outcome {
    let package = Package::new(&[
        (
            "lamplight.toml",
            &format!(
                "{WESL}[program.p.axis]\nwrap = {{ values = [false, true], mode = \"spec\" }}\n"
            ),
        ),
        (
            "p.wesl",
            "import constants::wrap;\n@fragment fn m(@location(0) x: f32) -> @location(0) vec4f {\n    if wrap { return vec4f(fract(x)); }\n    return vec4f(x);\n}\n",
        ),
    ])?;
    package.run("gen --no-cache")?.ends(0)?.is_silent_of(&["warning"])?;
    Ok(())
}

/// If only the manifest's lists make a condition constant, there is no warning about it: the
/// condition matters as soon as the lists name more permutations.
fn settled() -> Outcome {
    let text = "@fragment fn m(@location(0) x: f32) -> @location(0) vec4f {\n    @if(wrap) { return vec4f(fract(x)); }\n    return vec4f(x);\n}\n";
    let axis = "[program.p.axis]\nwrap = { values = [false, true] }\n";
    let package = Package::new(&[("p.wesl", text), ("asked.txt", "p wrap\n")])?;
    for list in
        ["only = [{ wrap = true }]", "exclude = [{ wrap = false }]", "usage = \"asked.txt\""]
    {
        package.write("lamplight.toml", &format!("{WESL}{list}\n{axis}"))?;
        let run = package.run("gen --no-cache --force")?.ends(0)?;
        run.says(&["1 permutation"])?.is_silent_of(&["constant-condition"])?;
    }
    Ok(())
}
