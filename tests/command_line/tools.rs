//! Commands that do not compile: `init`, `lint`, help, `list`, `show`, `export`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::package::{Package, Run, equal};
use super::{Case, Outcome};

pub const CASES: &[Case] = &[
    ("init_passes_everything", init),
    ("init_replaces_nothing", init_twice),
    ("lint_sees_what_nothing_reaches", lint_unreached),
    ("lint_of_flags", lint_flags),
    ("lint_of_permutations", lint_permutations),
    ("lint_of_glsl", lint_glsl),
    ("examples_of_help", examples),
    ("completions_and_manual", completions),
    ("colours", colors),
    ("own_functions", own),
    ("checks_under_settings", settings),
    ("checks_without_macros_of_others", macros_of_others),
    ("search", search),
    ("keys_as_json", keys_as_json),
    ("errors_of_all_programs", all_programs),
    ("drivers_without_a_window", without_window),
    ("types_before_import", npm_exports),
    ("stores_of_this_build", stores),
];

/// The package that `init` writes passes `lint`, `check` and `gen` without a warning.
fn init() -> Outcome {
    let package = Package::new(&[])?;
    package.run("init lamps")?.ends(0)?.says(&["lamps/lamplight.toml", "cd lamps"])?;
    let complaints = ["warning[", "error["];
    let lint = package.run_in("lamps", "lint")?.ends(0)?;
    lint.says(&["2 modules, 0 errors, 0 warnings"])?.is_silent_of(&complaints)?;
    package.run_in("lamps", "check")?.ends(0)?.says(&["1 of 1 pass"])?;
    let made = package.run_in("lamps", "gen --no-cache")?.ends(0)?;
    made.says(&["lamp: 2 permutations"])?.is_silent_of(&complaints)?;
    let wesl = fs::read_to_string(package.path("lamps/wesl.toml"))?;
    equal(wesl.contains("name = \"lamps\""), true)
}

/// `init` writes nothing if one of its files exists already.
fn init_twice() -> Outcome {
    let package = Package::new(&[("shaders/lamp.wesl", "// mine\n")])?;
    package.run("init")?.ends(1)?.says(&["`./shaders/lamp.wesl` is there already"])?;
    equal(package.path("lamplight.toml").exists(), false)?;
    equal(fs::read_to_string(package.path("shaders/lamp.wesl"))?, "// mine\n".to_owned())
}

const ROOT: &str = "[package]\nname = \"p\"\nedition = \"2026_pre\"\nroot = \".\"\n";

/// `lint` reports several mistakes in one run, also in modules and functions that nothing uses.
fn lint_unreached() -> Outcome {
    let broken = "fn one() -> f32 { return nonsense; }
fn two() -> f32 { return vec3f(1.0) + 2i; }
fn three() { let x = 1; }
fn twice() {}
fn twice() {}\n";
    let package = Package::new(&[
        ("wesl.toml", ROOT),
        (
            "main.wesl",
            "@fragment fn m() -> @location(0) vec4f { return vec4f(1.0); }\nfn unused() { let a = ; }\n",
        ),
        ("below/broken.wesl", broken),
        ("fine.wesl", "fn half(x: f32) -> f32 { return 0.5 * x; }\n"),
        ("wrong.wesl", "import package::fien::half;\nfn f() -> f32 { return half(1.0); }\n"),
    ])?;
    let run = package.run("lint --diagnostics short")?.ends(1)?;
    let places = [
        "main.wesl:2:23",
        "below/broken.wesl:1:",
        "below/broken.wesl:2:",
        "below/broken.wesl:5:4",
        "wrong.wesl:1:8",
    ];
    let run = run.says(&places)?.says(&["4 modules"])?.is_silent_of(&["fine.wesl:"])?;
    equal(run.err.lines().count() >= 5, true)?;
    // `lint` of one module, of one folder, and of the package from a folder within it.
    package.run("lint fine.wesl")?.ends(0)?.says(&["1 module, 0 errors"])?;
    package.run("lint below --diagnostics short")?.ends(1)?.is_silent_of(&["main.wesl"])?;
    package.run_in("below", "lint --diagnostics short")?.ends(1)?.says(&["main.wesl:2:23"])?;
    package.run("lint nowhere")?.ends(1)?.says(&["there is no file or folder `nowhere`"])?;
    Package::new(&[])?.run("lint")?.ends(2)?.says(&["there is no package here"])?;
    Ok(())
}

/// A flag that nothing declares is an error, even in a function that no entry point calls.
fn lint_flags() -> Outcome {
    let text = "fn f() -> f32 { @if(fgo) { return 1.0; } return 0.0; }\n";
    let package = Package::new(&[("wesl.toml", ROOT), ("a.wesl", text)])?;
    package.run("lint")?.ends(1)?.says(&["error[undeclared-flag]", "`fgo`", "a.wesl:1:21"])?;
    package.run("lint --features-default off")?.ends(0)?;
    package.run("lint --feature fgo")?.ends(0)?;
    let manifest =
        "[program.p]\nwesl = \"m.wesl\"\n[program.p.axis]\nfog = { values = [false, true] }\n";
    package.write("lamplight.toml", manifest)?;
    package.write("m.wesl", "@fragment fn m() { @if(fog) { discard; } }\n")?;
    package.run("lint")?.ends(1)?.says(&["did you mean `fog`?"])?;
    Ok(())
}

/// `lint` checks types in permutations that cover every pair of values that a module asks for. The
/// mistake here exists only for one pair.
fn lint_permutations() -> Outcome {
    let manifest = "[program.p]\nwesl = \"m.wesl\"\n[program.p.axis]\n\
        fog = { values = [false, true] }\nkind = { values = [\"none\", \"soft\"] }\n";
    let module = "fn f() -> f32 { @if(fog && kind == soft) { return vec2f(1.0); } return 0.0; }\n";
    let package = Package::new(&[
        ("lamplight.toml", manifest),
        ("m.wesl", "@fragment fn m() { @if(fog) { discard; } }\n"),
        ("part.wesl", module),
    ])?;
    package.run("lint --diagnostics short")?.ends(1)?.says(&["part.wesl:1:"])?;
    package.write("part.wesl", &module.replace("vec2f(1.0)", "1.0"))?;
    package.run("lint")?.ends(0)?;
    Ok(())
}

/// A file that others include is checked where it is included, with the macros that the including
/// file defines.
fn lint_glsl() -> Outcome {
    let package = Package::new(&[
        ("wesl.toml", ROOT),
        (
            "lit.frag",
            "#version 450\n#define SCALE 2.0\n#include \"part.glsl\"\nlayout(location = 0) out vec4 c;\nvoid main() { c = vec4(1.0); }\n",
        ),
        ("part.glsl", "float twice(float x) { return SCALE * x; }\n"),
    ])?;
    package.run("lint")?.ends(0)?.says(&["2 modules, 0 errors"])?;
    package.write("part.glsl", "float twice(float x) { return SCALE * nothing; }\n")?;
    package.run("lint --diagnostics short")?.ends(1)?.says(&["part.glsl:1:"])?;
    Ok(())
}

/// Every example of every `--help` works in the package that `init` writes.
fn examples() -> Outcome {
    let package = Package::new(&[])?;
    package.run("init .")?.ends(0)?;
    package.run("gen --no-cache")?.ends(0)?;
    std::fs::create_dir(package.path("old"))?;
    std::fs::write(package.path("old/light.wgsl"), "#ifdef A\nconst A = 1;\n#endif\n")?;
    let lamp =
        "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n";
    std::fs::write(package.path("lamp.frag"), lamp)?;
    let function = "fn fade(d: f32) -> f32 {\n    return 1.0 / (1.0 + d * d);\n}\n";
    std::fs::write(package.path("lamp.wesl"), function)?;
    let help = package.run("--help")?.ends(0)?.out;
    let commands: Vec<&str> = help
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        // Lines that are indented further continue a description.
        .filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect();
    for command in commands {
        let help = package.run(&format!("{command} --help"))?.ends(0)?.out;
        let examples: Vec<&str> = help
            .lines()
            .skip_while(|line| *line != "Examples:")
            .skip(1)
            .map_while(|line| line.strip_prefix("  "))
            .collect();
        if examples.is_empty() {
            return Err(format!("`lamplight {command} --help` has no example").into());
        }
        for example in examples.iter().filter(|example| !is_slow(example)) {
            works(&package, example)?;
        }
    }
    Ok(())
}

/// Whether an example does not end, takes too long for this test, or needs a driver.
fn is_slow(example: &str) -> bool {
    ["watch", "catalogue", "render", "cost"].iter().any(|slow| example.contains(slow))
}

fn works(package: &Package, example: &str) -> Outcome {
    let folder = std::path::Path::new(env!("CARGO_BIN_EXE_lamplight")).parent();
    let path = format!(
        "{}:{}",
        folder.unwrap_or(std::path::Path::new("")).display(),
        std::env::var("PATH").unwrap_or_default()
    );
    let mut command = Command::new("sh");
    command.args(["-c", example]).current_dir(package.path("")).env("PATH", path);
    let output = command.env("XDG_CACHE_HOME", package.path(".cache")).output()?;
    if output.status.success() {
        return Ok(());
    }
    Err(format!("`{example}`: {}", String::from_utf8_lossy(&output.stderr)).into())
}

/// There are completions for five shells. `man` prints manual pages, and writes them with `-o`.
fn completions() -> Outcome {
    let package = Package::new(&[])?;
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = package.run(&format!("completions {shell}"))?.ends(0)?;
        script.says(&["lamplight", "features-default"])?;
    }
    package.run("completions tcsh")?.ends(2)?;
    package.run("man gen")?.ends(0)?.says(&[".TH", "\\-\\-shard", "Guide: "])?;
    package.run("man")?.ends(0)?.says(&[".TH", "completions"])?;
    package.run("man -o pages")?.ends(0)?;
    equal(package.path("pages/lamplight-lint.1").exists(), true)?;
    package.run("man gne")?.ends(2)?.says(&["did you mean `gen`?"])?;
    Ok(())
}

/// Colours are printed if they are asked for, and otherwise not to a file or a pipe.
fn colors() -> Outcome {
    let package = Package::new(&[("a.wesl", "fn f() { let a = ; }\n")])?;
    let escape = "\u{1b}[";
    for plain in ["", "--color never", "--color auto", "--diagnostics json --color always"] {
        package.run(&format!("compose a.wesl --set x=1 {plain}"))?.is_silent_of(&[escape])?;
        package
            .run(&format!("compile a.wesl --target wgsl {plain}"))?
            .ends(1)?
            .is_silent_of(&[escape])?;
    }
    package.run("compile a.wesl --target wgsl --color always")?.ends(1)?.says(&[escape])?;
    package.run("compile nowhere.x --target wgsl --color always")?.ends(2)?.says(&[escape])?;
    package.run("gen --color always --help")?.ends(0)?.says(&[escape])?;
    package.run("gen --color never --wrong")?.ends(2)?.is_silent_of(&[escape])?;
    Ok(())
}

/// `eval`, `list` and `show` know the user's own package as well as the library.
fn own() -> Outcome {
    let package = Package::new(&[])?;
    package.run("init .")?.ends(0)?;
    package.write("shaders/falloff.glsl", "float falloff(float d, float radius) { float x = clamp(1.0 - d / radius, 0.0, 1.0); return x * x; }\n")?;
    for call in ["package::falloff::falloff(1.0,2.0)", "falloff::falloff(1.0,2.0)"] {
        for lang in ["wesl", "glsl"] {
            let run = package.run(&format!("eval --lang {lang} {call}"))?.ends(0)?;
            equal(run.out, "0.25\n".to_owned())?;
        }
    }
    let both = "lighting::spot::cone_hard(0.9,0.8)+lamplight::lighting::spot::cone_hard(0.9,0.8)";
    equal(package.run(&format!("eval {both}"))?.ends(0)?.out, "2\n".to_owned())?;
    package
        .run("list")?
        .ends(0)?
        .says(&["package::falloff::falloff", "lighting::spot::cone_hard"])?;
    package.run("list modules")?.ends(0)?.says(&["package::falloff "])?;
    package.run("list axes")?.ends(0)?.says(&["lamp ", "forward "])?;
    package.run("show package::falloff::falloff")?.ends(0)?.says(&[
        "import package::falloff::falloff;",
        "#include \"falloff.glsl\"",
        "d       f32",
    ])?;
    package.run("show lamp.fog")?.ends(0)?.says(&["Distant surfaces fade to grey."])?;
    let elsewhere = Package::new(&[])?;
    elsewhere.run("list")?.ends(0)?.is_silent_of(&["package::"])?;
    let root = package.path("shaders").display().to_string();
    elsewhere.run(&format!("eval --root {root} falloff::falloff(1.0,2.0)"))?.ends(0)?;
    Ok(())
}

/// A function with conditions is checked with the features that the command line chooses.
fn settings() -> Outcome {
    let case = "[[case]]\nfunction = \"f\"\nformula = \"2*x\"\ntolerance = { abs = 1e-6 }\n[case.inputs]\nx = [0, 1, 2]\n";
    let text = "fn f(x: f32) -> f32 {\n@if(double) { return 2.0 * x; }\n@else { return x; }\n}\n";
    let package = Package::new(&[("wesl.toml", ROOT), ("a.wesl", text), ("a.toml", case)])?;
    package.run("check")?.ends(1)?.says(&["error[unknown-feature]"])?;
    package.run("check --feature double")?.ends(0)?.says(&["1 of 1 pass"])?;
    package.run("check --features-default on")?.ends(0)?;
    package.run("check --features-default off")?.ends(3)?;
    Ok(())
}

/// An axis of a program defines macros for that program alone. A module that does not ask for the
/// axis may declare their names.
fn macros_of_others() -> Outcome {
    let manifest = "[program.p]\nwesl = \"p.wesl\"\ntargets = [\"wgsl\"]\n\
                    [program.p.axis]\nlight = { values = [\"off\", \"point\"] }\n";
    let program = "@fragment fn main() -> @location(0) vec4f {\n\
                   @if(light == point) { return vec4f(1.0); }\n@else { return vec4f(); }\n}\n";
    let wesl = "const LIGHT_POINT = 2u;\nfn f(x: f32) -> f32 { return x * f32(LIGHT_POINT); }\n";
    let glsl = "const uint LIGHT_POINT = 2u;\n\
                float f(float x) { return x * float(LIGHT_POINT); }\n";
    let case = "[[case]]\nfunction = \"f\"\nformula = \"2*x\"\ntolerance = { abs = 1e-6 }\n\
                [case.inputs]\nx = [0, 1, 2]\n";
    let files = [("wesl.toml", ROOT), ("lamplight.toml", manifest), ("p.wesl", program)];
    let module = [("a.wesl", wesl), ("a.glsl", glsl), ("a.toml", case)];
    let package = Package::new(&[files, module].concat())?;
    package.run("check a.toml")?.ends(0)?.says(&["2 of 2 pass"])?;
    package.run("gen --no-cache")?.ends(0)?.says(&["p: 2 permutations"])?;
    Ok(())
}

/// `show` searches if its argument is not a path.
fn search() -> Outcome {
    let package = Package::new(&[])?;
    let words = ["brdf::fresnel::f_schlick", "function", "module"];
    package.run("show fresnel")?.ends(0)?.says(&words)?;
    let json = package.run("show fresnel --json")?.ends(0)?;
    let json: serde_json::Value = serde_json::from_str(&json.out)?;
    equal(json["matches"].as_array().is_some_and(|found| found.len() > 3), true)?;
    package.run("show no_such_thing_at_all")?.ends(1)?;
    Ok(())
}

/// `variants --keys --json` prints JSON.
fn keys_as_json() -> Outcome {
    let package = Package::new(&[])?;
    package.run("init .")?.ends(0)?;
    let run = package.run("variants --keys lamp --json")?.ends(0)?;
    let json: serde_json::Value = serde_json::from_str(&run.out)?;
    equal(json, serde_json::json!(["default", "fog"]))
}

/// Errors in one program do not hide those in another, and errors in one function do not hide those
/// in the next.
fn all_programs() -> Outcome {
    let manifest = "[program.a]\nwesl = \"a.wesl\"\n[program.b]\nwesl = \"b.wesl\"\n";
    let package = Package::new(&[
        ("lamplight.toml", manifest),
        (
            "a.wesl",
            "fn f() -> f32 { return nothing; }\nfn g() -> f32 { return missing; }\n@fragment fn m() -> @location(0) vec4f { return vec4f(f() + g()); }\n",
        ),
        ("b.wesl", "@fragment fn m() -> @location(0) vec4f { return 1.0; }\n"),
    ])?;
    let run = package.run("gen --no-cache --diagnostics short")?.ends(1)?;
    run.says(&["a.wesl:1:", "a.wesl:2:", "b.wesl:1:"])?;
    let run = package.run("compile a.wesl --target wgsl --diagnostics short")?.ends(1)?;
    run.says(&["a.wesl:1:", "a.wesl:2:"])?;
    Ok(())
}

/// Without a window system, checks on drivers pass and print nothing on standard error, and pictures are
/// drawn without a word of it. Mesa's layers look for Wayland, and would print errors of their own.
fn without_window() -> Outcome {
    let package = Package::new(&[
        ("half.wesl", "fn half(x: f32) -> f32 { return 0.5 * x; }\n"),
        (
            "half.toml",
            "[[case]]\nfunction = \"half\"\nformula = \"0.5*x\"\ntolerance = { ulp = 1 }\ninputs = { x = [1, 2] }\n",
        ),
        ("red.wgsl", "@fragment fn main() -> @location(0) vec4f { return vec4f(1, 0, 0, 1); }\n"),
    ])?;
    let without = |arguments: &str, folder: Option<&str>| {
        let mut command = package.command("", arguments);
        command.env_remove("WAYLAND_DISPLAY").env_remove("DISPLAY").env_remove("XDG_RUNTIME_DIR");
        folder.map(|folder| command.env("XDG_RUNTIME_DIR", folder));
        command.output()
    };
    for folder in [None, Some("")] {
        for executor in ["vulkan", "gl"] {
            let run = without(&format!("check half.toml --executor {executor}"), folder)?;
            let run = Run::from(run).ends(0)?.says(&["1 of 1 pass"])?;
            equal(run.err.as_str(), "")?;
        }
        let run = Run::from(without("render red.wgsl --size 8x8 --force", folder)?).ends(0)?;
        equal(run.err.contains("XDG_RUNTIME_DIR"), false)?;
    }
    Ok(())
}

/// In an npm package, tools take the first condition of `exports` that they know. So `types` must be
/// before `import`, or TypeScript finds no types. What is exported has its licence and version.
fn npm_exports() -> Outcome {
    let package = Package::new(&[])?;
    package.run("export --form npm out")?.ends(0)?;
    let text = fs::read_to_string(package.path("out/lamplight/package.json"))?;
    let place = |word: &str| text.find(word).ok_or(format!("`{word}` is not in {text}"));
    equal(place("\"types\":")? < place("\"import\":")?, true)?;
    place("\"license\":")?;
    place(&format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION")))?;
    package.run("export --form files files")?.ends(0)?;
    let files = walk(&package.path("files"))?;
    for file in ["LICENSE-MIT", "LICENSE-APACHE"] {
        equal((file, files.iter().any(|path| path.ends_with(file))), (file, true))?;
    }
    Ok(())
}

/// Every file below a folder.
fn walk(folder: &Path) -> Result<Vec<PathBuf>, libtest_mimic::Failed> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() { files.extend(walk(&path)?) } else { files.push(path) }
    }
    Ok(files)
}

/// The help names the stores that this build has, and no others.
fn stores() -> Outcome {
    let package = Package::new(&[])?;
    package.run("gen --help")?.ends(0)?.says(&[lamplight::store::HELP])?;
    let absent = include_str!("../../crates/generate/src/store/absent.rs");
    let help = absent.lines().find(|line| line.contains("const HELP")).ok_or("no help")?;
    equal((help.contains("fs:/path"), help.contains("redis")), (true, false))?;
    let present = package.run("gen --store redis://127.0.0.1:1 --root none")?;
    present.is_silent_of(&["this build supports only"])?;
    Ok(())
}
