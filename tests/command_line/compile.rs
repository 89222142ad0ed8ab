//! What users expect of `compose` and `compile`: files, pipes, entry points, depfiles, features.

use std::fs;

use super::package::{Package, equal};
use super::{Case, Outcome};

pub const CASES: &[Case] = &[
    ("stages_have_files_of_their_own", stages),
    ("targets_that_can", targets_that_can),
    ("compile_without_a_target", without_target),
    ("both_stages_of_a_program", both_stages),
    ("include_folders_and_definitions", include_folders),
    ("wrapped_shaders", wrapped),
    ("several_inputs", several_inputs),
    ("entry_points_by_name", entry_points),
    ("reflection_of_a_shader", reflection),
    ("depfile", depfile),
    ("depfile_names", depfile_names),
    ("standard_input", standard_input),
    ("pipes", pipes),
    #[cfg(target_os = "linux")]
    ("a_full_disk_is_an_error", full),
    #[cfg(unix)]
    ("arguments_of_any_bytes", bytes),
    ("features_default", features_default),
    ("features_default_of_the_manifest", manifest_features),
];

const FRAG: &str =
    "#version 450\nlayout(location = 0) out vec4 c;\nvoid main() { c = vec4(1.0); }\n";
const VERT: &str = "#version 450\nvoid main() { gl_Position = vec4(1.0); }\n";
const BOTH: &str = "import package::half::half;
@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(half(1.0)); }
@fragment fn fs_main() -> @location(0) vec4f { return vec4f(half(2.0)); }\n";
const HALF: &str = "fn half(x: f32) -> f32 { return 0.5 * x; }\n";

/// `compile FILE` checks the file and prints it as WGSL.
fn without_target() -> Outcome {
    let package = Package::new(&[("lit.frag", FRAG), ("wrong.frag", "void main() { x; }\n")])?;
    let run = package.run("compile lit.frag")?.ends(0)?;
    equal(run.out.contains("@fragment") && run.out.contains("fn main()"), true)?;
    package.run("compile wrong.frag")?.ends(1)?.says(&["wrong.frag:1:"])?;
    Ok(())
}

/// Two stages of one name are written to different files, in every target.
fn stages() -> Outcome {
    let package = Package::new(&[("lit.frag", FRAG), ("lit.vert", VERT)])?;
    package.run("compile lit.frag --target all -o out")?.ends(0)?;
    package.run("compile lit.vert --target all -o out")?.ends(0)?;
    equal(fs::read_dir(package.path("out"))?.flatten().filter(is_output).count(), 14)?;
    for name in ["lit.main.frag.spv", "lit.main.vert.spv", "lit.main.essl300.frag"] {
        fs::metadata(package.path("out").join(name)).map_err(|_| format!("no {name}"))?;
    }
    Ok(())
}

/// `--target all` leaves out what a target lacks. A target by name, or `--strict`, does not.
fn targets_that_can() -> Outcome {
    const HALF: &str = "enable f16;
@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f { return vec4f(vec4<f16>(f16(x))); }
";
    let package = Package::new(&[("half.wesl", HALF)])?;
    let done = package.run("compile half.wesl --target all -o out")?;
    done.ends(0)?.says(&[
        "target `hlsl` does not have the type `f16`",
        "no output for target `glsl330` is written",
    ])?;
    let mut found: Vec<String> = fs::read_dir(package.path("out"))?
        .map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()))
        .collect::<Result<_, std::io::Error>>()?;
    found.sort();
    let wanted = ["half.fs_main.frag.metal", "half.fs_main.frag.spv", "half.fs_main.frag.wgsl"];
    found.retain(|name| name.starts_with("half"));
    equal(found, wanted.map(str::to_owned).to_vec())?;
    package.run("compile half.wesl --target all --strict -o out")?.ends(1)?;
    package.run("compile half.wesl --target all,hlsl -o out")?.ends(1)?;
    package.run("compile half.wesl --target msl -o out --force")?.ends(0)?;
    Ok(())
}

/// What goes from one stage to the next has one location, however the files order it. The manifest
/// and `--with` say the same.
fn both_stages() -> Outcome {
    let vertex = "#version 330
in vec3 at; out vec2 uv; out vec3 normal; uniform mat4 model;
void main() { uv = at.xy; normal = at; gl_Position = model * vec4(at, 1.0); }
";
    let fragment = "#version 330
in vec3 normal;
#if GREY
in float grey;
#endif
in vec2 uv; out vec4 color; uniform float level;
void main() { color = vec4(normal * level, uv.x); }
";
    let manifest = "[program.lit]
glsl = { vertex = \"lit.vert\", fragment = \"lit.frag\" }
targets = [\"wgsl\"]
axis.grey = { values = [false, true] }
";
    let files = [("lit.vert", vertex), ("lit.frag", fragment)];
    let alone = Package::new(&files)?;
    let declared = Package::new(&[&files[..], &[("lamplight.toml", manifest)]].concat())?;
    let with_partner = [
        alone.run("compile lit.vert --with lit.frag --feature grey --target wgsl")?,
        alone.run("compile lit.frag --with lit.vert --feature grey --target wgsl")?,
    ];
    for (name, compiled) in ["lit.vert", "lit.frag"].into_iter().zip(&with_partner) {
        equal((name, compiled.code), (name, 0))?;
        let text = &compiled.out;
        for wanted in ["@location(0) uv: vec2<f32>", "@location(1) normal: vec3<f32>"] {
            equal((wanted, text.contains(wanted)), (wanted, true))?;
        }
        let of_manifest = declared.run(&format!("compile {name} --feature grey --target wgsl"))?;
        equal(&of_manifest.ends(0)?.out, text)?;
    }
    // The loose uniforms of both stages are one block, which the host writes once.
    for compiled in &with_partner {
        let bindings = compiled.out.lines().filter(|line| line.contains("@binding")).count();
        equal((bindings, compiled.out.contains("@group(0) @binding(0) ")), (1, true))?;
        for member in ["model: mat4x4<f32>", "level: f32"] {
            equal((member, compiled.out.contains(member)), (member, true))?;
        }
    }
    declared.run("gen -o bundle")?.ends(0)?;
    alone
        .run("compile lit.frag --with lit.frag --target wgsl")?
        .ends(1)?
        .says(&["the same stage"])?;
    Ok(())
}

/// `-I` and `-D`, in each command that reads shaders.
fn include_folders() -> Outcome {
    let shader = "#version 450
#include \"tint.glsl\"
layout(location = 0) out vec4 c;
#ifdef DARK
void main() { c = tint() * 0.25; }
#else
void main() { c = tint(); }
#endif
";
    let tint = "vec4 tint() { return vec4(RED, 0.0, 0.0, 1.0); }\n";
    let package = Package::new(&[("in/a.frag", shader), ("common/tint.glsl", tint)])?;
    package.run("compile in/a.frag --target wgsl")?.ends(1)?.says(&["cannot find `tint.glsl`"])?;
    let compiled = package.run("compile in/a.frag -I common -D RED=0.5 -D DARK --target wgsl")?;
    let compiled = compiled.ends(0)?.out;
    for wanted in ["vec4<f32>(0.5f, 0f, 0f, 1f)", "* 0.25f"] {
        equal((wanted, compiled.contains(wanted)), (wanted, true))?;
    }
    package.run("lint in/a.frag -I common -D RED=0.5")?.ends(0)?;
    package.run("compose in/a.frag -I common -DRED=0.5")?.ends(0)?;
    package.run("lint in/a.frag -I common")?.ends(1)?.says(&["`RED`"])?;
    package
        .run("compile in/a.frag -I nowhere --target wgsl")?
        .ends(1)?
        .says(&["cannot read `nowhere`"])?;
    Ok(())
}

/// What a site's visitors write is part of a shader only.
fn wrapped() -> Outcome {
    let shader = "void mainImage(out vec4 color, in vec2 at) {
    color = vec4(at / iResolution.xy, sin(iTime), 1.0) * texture(iChannel1, at);
}
";
    let package = Package::new(&[("toy.glsl", shader)])?;
    package.run("compile toy.glsl --target all -o out")?.ends(1)?.says(&["--stage"])?;
    let all = package.run("compile toy.glsl --wrap shadertoy --target all -o out")?;
    all.ends(0)?;
    let is_toy = |entry: &fs::DirEntry| entry.file_name().to_string_lossy().starts_with("toy.");
    equal(fs::read_dir(package.path("out"))?.flatten().filter(is_toy).count(), 7)?;
    let text = package.run("compile toy.glsl --wrap shadertoy --target wgsl")?.out;
    for (word, is_there) in [("iTime", true), ("iChannel1", true), ("iMouse", false)] {
        equal((word, text.contains(word)), (word, is_there))?;
    }
    Ok(())
}

fn is_output(entry: &fs::DirEntry) -> bool {
    entry.file_name().to_string_lossy().starts_with("lit.")
}

/// What cannot be printed is an error, also if it is help.
#[cfg(target_os = "linux")]
fn full() -> Outcome {
    let package = Package::new(&[("lit.frag", FRAG)])?;
    for arguments in
        ["--help", "--version", "compile --help", "list", "compile lit.frag --target wgsl"]
    {
        let mut command = package.command("", arguments);
        let output = command.stdout(fs::File::create("/dev/full")?).output()?;
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        equal((arguments, output.status.code()), (arguments, Some(4)))?;
        equal(message.contains("No space left on device"), true)?;
    }
    Ok(())
}

/// Several files are compiled in one run. Errors in one do not hide those in the next, and then
/// nothing is written.
fn several_inputs() -> Outcome {
    let package = Package::new(&[
        ("lit.frag", FRAG),
        ("lit.vert", VERT),
        ("other/lit.frag", FRAG),
        ("a.wesl", "fn f() { let x = ; }\n@fragment fn m() { f(); }\n"),
        ("b.wesl", "@fragment fn m() -> @location(0) vec4f { return nothing; }\n"),
    ])?;
    let run = package.run("compile lit.frag lit.vert --target spirv -o out")?.ends(0)?;
    equal(run.out, "out/lit.main.frag.spv\nout/lit.main.vert.spv\n".to_owned())?;
    let run = package.run("compile lit.frag other/lit.frag --target spirv -o two")?.ends(2)?;
    run.says(&["two shaders would both be `lit.main.frag.spv`"])?;
    let run = package.run("compile a.wesl lit.frag b.wesl --target spirv -o wrong")?.ends(1)?;
    run.says(&["a.wesl:1:", "b.wesl:1:"])?;
    equal(package.path("wrong").exists(), false)
}

/// `--entry` selects an entry point, and an unknown one is refused with the names that exist.
fn entry_points() -> Outcome {
    let package = Package::new(&[("both.wesl", BOTH), ("half.wesl", HALF)])?;
    let all = package.run("compile both.wesl --target wgsl -o out")?.ends(0)?;
    equal(all.out, "out/both.vs_main.vert.wgsl\nout/both.fs_main.frag.wgsl\n".to_owned())?;
    let one = package.run("compile both.wesl --target wgsl --entry fs_main")?.ends(0)?;
    one.says(&["fs_main"])?.is_silent_of(&["vs_main"])?;
    let none = package.run("compile both.wesl --target wgsl --entry fs_mian")?.ends(1)?;
    none.says(&["error[unknown-entry-point]", "did you mean `fs_main`?", "vs_main, fs_main"])?;
    Ok(())
}

/// `--reflection` gives what an engine needs as JSON, with or without a target.
fn reflection() -> Outcome {
    let package = Package::new(&[("both.wesl", BOTH), ("half.wesl", HALF)])?;
    let run = package.run("compile both.wesl --reflection --entry vs_main")?.ends(0)?;
    let json: serde_json::Value = serde_json::from_str(&run.out)?;
    equal(json["reflection"]["stage"].as_str(), Some("vertex"))?;
    package.run("compile both.wesl --reflection --target msl -o out")?.ends(0)?;
    let text = fs::read_to_string(package.path("out/both.fs_main.frag.json"))?;
    let json: serde_json::Value = serde_json::from_str(&text)?;
    equal(json["targets"]["msl"]["entry_name"].is_string(), true)
}

/// The rule of `--depfile` names every output and every file that was read, in the syntax of make.
fn depfile() -> Outcome {
    let package = Package::new(&[
        ("my both.wesl", BOTH),
        ("half.wesl", HALF),
        ("wesl.toml", "root = \".\"\n"),
    ])?;
    let mut command = package.command("", "compile");
    command.args(["my both.wesl", "--target", "wgsl", "-o", "out", "--depfile", "rule.d"]);
    equal(command.status()?.code(), Some(0))?;
    let rule = fs::read_to_string(package.path("rule.d"))?;
    let expected = "out/my\\ both.vs_main.vert.wgsl out/my\\ both.fs_main.frag.wgsl: \\\n  half.wesl \\\n  my\\ both.wesl \\\n  wesl.toml\n";
    equal(rule.as_str(), expected)?;
    // A second run replaces the rule that the first wrote, but not a file that it did not write.
    equal(command.status()?.code(), Some(0))?;
    package.write("rule.d", "all: clean\n")?;
    equal(command.status()?.code(), Some(1))
}

/// Letters that mean something in a rule, or in a pattern of file names.
const NAMES: [&str; 14] = [
    "a b", "a:b", "a;b", "a%b", "a*b", "a?b", "a[b]c", "a#b", "a$b", "a\\b", "a\\ b", "a\\:b",
    "a~b", "a,b",
];

/// Make, and ninja where it is installed, read each name of `--depfile` as it is.
fn depfile_names() -> Outcome {
    for name in NAMES {
        let file = format!("{name}.wesl");
        let package = Package::new(&[
            (&file, FRAGMENT_ONLY),
            // What a pattern would find instead.
            ("aXb.wesl", FRAGMENT_ONLY),
            ("wesl.toml", "root = \".\"\n"),
        ])?;
        let mut command = package.command("", "compile");
        command.args([&file, "--target", "wgsl", "-o", name, "--depfile", "rule.d"]);
        let output = command.output()?;
        // Make has no form for an output with a semicolon.
        if name.contains(';') {
            equal((name, output.status.code()), (name, Some(1)))?;
            continue;
        }
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        if output.status.code() != Some(0) {
            return Err(format!("`{name}`: {stderr}").into());
        }
        read_by_make(&package, name, &file)?;
        read_by_ninja(&package, name)?;
        // The rule of another output, in a file that this command wrote.
        let mut other = package.command("", "compile");
        other.args(["aXb.wesl", "--target", "wgsl", "-o", "other", "--depfile", "rule.d"]);
        equal(other.status()?.code(), Some(0))?;
    }
    Ok(())
}

const FRAGMENT_ONLY: &str = "@fragment fn m() -> @location(0) vec4f { return vec4f(1.0); }\n";

/// Make has a rule for the output, and finds exactly the files that were read.
fn read_by_make(package: &Package, name: &str, file: &str) -> Outcome {
    package.write("Makefile", ".SUFFIXES:\nfirst:\ninclude rule.d\n")?;
    let output = format!("{name}/{name}.m.frag.wgsl");
    let run = |folder: &std::path::Path, arguments: &[&str]| {
        std::process::Command::new("make").args(arguments).current_dir(folder).output()
    };
    let folder = package.path("");
    let made = run(&folder, &["-d", &output])?;
    let stdout = String::from_utf8_lossy(&made.stdout).into_owned();
    for expected in [&output, file, "wesl.toml"] {
        let considered = stdout.contains(&format!("Considering target file '{expected}'"));
        equal((name, expected, considered), (name, expected, true))?;
    }
    equal((name, stdout.contains("aXb")), (name, false))?;
    equal((name, made.status.success()), (name, true))
}

/// Ninja has no form for some names; `docs/guide/package.md` says which.
fn read_by_ninja(package: &Package, name: &str) -> Outcome {
    let is_there = std::process::Command::new("ninja").arg("--version").output().is_ok();
    if !is_there || name.contains([';', '?', '%', ':']) {
        return Ok(());
    }
    let escaped = name.replace('$', "$$").replace(' ', "$ ");
    let output = format!("{escaped}/{escaped}.m.frag.wgsl");
    package.write(
        "build.ninja",
        &format!("rule keep\n  command = true\n  depfile = rule.d\nbuild {output}: keep\n"),
    )?;
    let ran = std::process::Command::new("ninja").current_dir(package.path("")).output()?;
    let stdout = String::from_utf8_lossy(&ran.stdout).into_owned();
    equal((name, ran.status.success(), stdout.contains("error")), (name, true, false))
}

/// `-` reads the shader from standard input. The language, and for GLSL the stage, must be given.
fn standard_input() -> Outcome {
    let package = Package::new(&[("half.wesl", HALF)])?;
    let run = package.fed("compile - --lang wesl --target wgsl -o out", BOTH)?.ends(0)?;
    equal(run.out, "out/stdin.vs_main.vert.wgsl\nout/stdin.fs_main.frag.wgsl\n".to_owned())?;
    package.fed("compose - --lang wesl", BOTH)?.ends(0)?.says(&["fn half(x: f32)"])?;
    package.fed("compile - --stage fragment --target wgsl", FRAG)?.ends(0)?.says(&["@fragment"])?;
    let wrong = package
        .fed("compose - --lang wesl", "import package::hafl::half;\nfn f() { half(1.0); }\n")?;
    wrong.ends(1)?.says(&["<standard input>:1:8", "did you mean `package::half`"])?;
    package.fed("compose -", BOTH)?.ends(2)?.says(&["add `--lang`"])?;
    package.fed("compile - --lang glsl --target wgsl", FRAG)?.ends(1)?.says(&["--stage"])?;
    Ok(())
}

/// A pipe with a path is read like standard input.
fn pipes() -> Outcome {
    let package = Package::new(&[("half.wesl", HALF)])?;
    package.fed("compose /dev/stdin --lang wesl", BOTH)?.ends(0)?.says(&["fn half(x: f32)"])?;
    if cfg!(unix) {
        // Nobody writes to this one, so reading it would never end.
        let pipe = package.path("pipe.wesl");
        equal(std::process::Command::new("mkfifo").arg(pipe).status()?.success(), true)?;
        for command in ["compose pipe.wesl", "compile pipe.wesl --target wgsl"] {
            package.run(command)?.ends(1)?.says(&["pipe.wesl", "is a pipe or a device"])?;
        }
        package.run("compose /dev/zero --lang wesl")?.ends(1)?.says(&["is a pipe or a device"])?;
    }
    Ok(())
}

/// Arguments that are not UTF-8 name files as others do.
#[cfg(unix)]
fn bytes() -> Outcome {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let package = Package::new(&[("half.wesl", HALF)])?;
    let odd = OsStr::from_bytes(b"odd\xff.wesl");
    let run = |arguments: &[&OsStr]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_lamplight"));
        let output = command.args(arguments).current_dir(package.path("")).output()?;
        Ok::<_, libtest_mimic::Failed>(super::package::Run::from(output))
    };
    run(&["compose".as_ref(), odd])?.ends(1)?.says(&["there is no file or folder"])?;
    run(&["compose".as_ref(), "half.wesl".as_ref(), odd])?
        .ends(2)?
        .says(&["unexpected argument"])?;
    let text = "@fragment fn m() -> @location(0) vec4f { return vec4f(1); }\n";
    fs::write(package.path("").join(odd), text)?;
    package.write("a.wesl", text)?;
    let out = OsStr::from_bytes(b"out\xff");
    let whole: Vec<&OsStr> =
        ["compile", "a.wesl", "--target", "wgsl", "-o"].map(OsStr::new).into_iter().collect();
    run(&[&whole[..], &[out]].concat())?.ends(0)?;
    equal(package.path("").join(out).join("a.m.frag.wgsl").is_file(), true)
}

const FLAG: &str = "@fragment fn m() -> @location(0) vec4f {
    @if(fog) { return vec4f(0.5); }
    return vec4f(1.0);
}\n";
const MACRO: &str = "#version 450\nlayout(location = 0) out vec4 c;\nvoid main() {\n#if FOG\nc = vec4(0.5);\n#else\nc = vec4(1.0);\n#endif\n}\n";

/// `--features-default` says what an undeclared feature is, in both languages. Without it, and
/// without a value for the feature, the feature is an error.
fn features_default() -> Outcome {
    let package = Package::new(&[("a.wesl", FLAG), ("b.frag", MACRO)])?;
    for file in ["a.wesl", "b.frag"] {
        for (choice, inside) in [("on", "0.5"), ("off", "1f")] {
            let choice = format!("--features-default {choice}");
            package.run(&format!("compose {file} {choice}"))?.ends(0)?;
            let run = package.run(&format!("compile {file} --target wgsl {choice}"))?.ends(0)?;
            run.says(&[inside])?;
        }
        let off = package.run(&format!("compile {file} --target wgsl --features-default off"))?;
        off.is_silent_of(&["0.5"])?;
        package.run(&format!("compose {file} --features-default error"))?.ends(1)?;
        package.run(&format!("compose {file}"))?.ends(1)?;
    }
    // A value that is given for a feature overrides the default.
    let run =
        package.run("compile a.wesl --target wgsl --features-default on --feature fog=false")?;
    run.ends(0)?.is_silent_of(&["0.5"])?;
    Ok(())
}

/// The manifest's key `features_default` does the same. The option overrides the key.
fn manifest_features() -> Outcome {
    let manifest =
        "[program.p]\nwesl = \"a.wesl\"\ntargets = [\"wgsl\"]\nfeatures_default = \"off\"\n";
    let package = Package::new(&[("a.wesl", FLAG), ("lamplight.toml", manifest)])?;
    package.run("gen --no-cache")?.ends(0)?;
    let get = "bundle get bundle p m default --target wgsl";
    package.run(get)?.ends(0)?.is_silent_of(&["0.5"])?;
    package.run("compile a.wesl --target wgsl")?.ends(0)?.is_silent_of(&["0.5"])?;
    package.run("compile a.wesl --target wgsl --features-default on")?.ends(0)?.says(&["0.5"])?;
    package.run("compile a.wesl --target wgsl --features-default error")?.ends(1)?;
    package.write("lamplight.toml", &manifest.replace("off", "of"))?;
    package
        .run("gen --no-cache")?
        .ends(1)?
        .says(&["did you mean `off`?", "lamplight.toml:4:20"])?;
    Ok(())
}
