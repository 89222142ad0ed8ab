//! A file belongs to the same package for every command, in whichever folder the command is run.

use super::package::{Package, equal};
use super::{Case, Outcome};

pub const CASES: &[Case] = &[
    ("root_from_inside", from_inside),
    ("root_beside_the_manifest", beside_the_manifest),
    ("root_without_wesl_toml", without_wesl_toml),
    ("root_outside_of_wesl_toml", outside),
    ("nearest_manifest", nearest_manifest),
    ("own_package_in_expressions", own_package_in_expressions),
    ("names_of_files", names_of_files),
    ("folders_and_macros_of_glsl", folders_and_macros),
];

const WESL_TOML: &str = "[package]\nname = \"p\"\nedition = \"2026_pre\"\nroot = \"shaders\"\n";
const MANIFEST: &str = "[program.surface]\nwesl = \"shaders/surface.wesl\"\ntargets = [\"wgsl\"]\n\
    [program.surface.axis]\nfalloff = { values = [\"none\", \"square\"] }\n";
const SURFACE: &str = "import package::common::half;
@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f {
    @if(falloff == square) { return vec4f(half(x) * x); }
    @else { return vec4f(half(x)); }
}\n";
const COMMON: &str = "fn half(x: f32) -> f32 { return 0.5 * x; }\n";
const CASE: &str = "[[case]]\nfunction = \"twice\"\nformula = \"0.5*x\"\ntolerance = { abs = 1e-6 }\n\
    [case.inputs]\nx = [0, 1, 2]\n";

fn package(more: &[(&str, &str)]) -> Result<Package, libtest_mimic::Failed> {
    let files = [
        ("wesl.toml", WESL_TOML),
        ("lamplight.toml", MANIFEST),
        ("shaders/surface.wesl", SURFACE),
        ("shaders/common.wesl", COMMON),
        (
            "shaders/light/one.wesl",
            "import package::common::half;\nfn twice(x: f32) -> f32 { return half(x); }\n",
        ),
        ("shaders/light/one.toml", CASE),
    ];
    Package::new(&[&files, more].concat())
}

/// Errors of expressions call the package of a user's what these call it.
fn own_package_in_expressions() -> Outcome {
    let package = package(&[])?;
    package.run("eval package::common::half(3.0)")?.ends(0)?;
    let missing = package.run("eval package::comon::half(3.0)")?;
    missing.ends(1)?.says(&["there is no module `package::comon`", "`package::common`"])?;
    let item = package.run("eval package::common::halve(3.0)")?;
    item.ends(1)?.says(&["`package::common` has no item `halve`"]).map(drop)
}

/// The table `glsl` of the manifest counts for every command, and what it names is read again when it
/// changes.
fn folders_and_macros() -> Outcome {
    let manifest = "[glsl]\ninclude = [\"../common\"]\ndefine = { LIGHTS = 4, SCALE = \"(0.25)\" }\n\
                    [program.lit]\nglsl = { fragment = \"lit.frag\" }\ntargets = [\"wgsl\"]\n";
    let light = "vec3 lit(vec3 n) { return n * LIGHTS * SCALE; }\n";
    let fragment = "#version 450\n#include \"light.glsl\"\nlayout(location = 0) in vec3 n;\n\
                    layout(location = 0) out vec4 color;\nvoid main() { color = vec4(lit(n), 1); }\n";
    let package = Package::new(&[
        ("pkg/lamplight.toml", manifest),
        ("pkg/lit.frag", fragment),
        ("common/light.glsl", light),
    ])?;
    package.run_in("pkg", "lint .")?.ends(0)?.says(&["0 errors"])?;
    package.run_in("pkg", "compile lit.frag --target wgsl -o out")?.ends(0)?;
    package.run_in("pkg", "gen -o b --depfile b.d")?.ends(0)?;
    let rule = std::fs::read_to_string(package.path("pkg/b.d"))?;
    let first =
        package.run_in("pkg", "bundle get b lit fragment default --target wgsl")?.ends(0)?.out;
    package.write("common/light.glsl", &light.replace("LIGHTS", "(LIGHTS + 1)"))?;
    package.run_in("pkg", "gen --check -o b")?.ends(3)?;
    package.run_in("pkg", "gen -o b")?.ends(0)?;
    let second =
        package.run_in("pkg", "bundle get b lit fragment default --target wgsl")?.ends(0)?.out;
    package.write("pkg/lamplight.toml", &manifest.replace("../common", "../nothing"))?;
    let lost = package.run_in("pkg", "gen -o b --diagnostics short")?.ends(1)?;
    lost.says(&[
        "lamplight.toml:2:12: error[unreadable]: there is no file or folder `../nothing`",
    ])?;
    match (rule.contains("../common/light.glsl"), first == second) {
        (true, false) => Ok(()),
        found => Err(format!("{found:?}\n{rule}\n{first}\n{second}").into()),
    }
}

/// The package is found from a folder below its root, and messages name files without `..`.
fn from_inside() -> Outcome {
    let package = package(&[])?;
    let composed = package.run_in("shaders/light", "compose one.wesl")?.ends(0)?;
    equal(composed.out, package.run("compose shaders/light/one.wesl")?.ends(0)?.out)?;
    package.run_in("shaders/light", "check one.toml")?.ends(0)?.says(&["1 of 1 pass"])?;
    package.run_in("shaders/light", "check .")?.ends(0)?.says(&["1 of 1 pass"])?;
    package.run_in("shaders", "compile ./surface.wesl --target wgsl")?.ends(0)?;
    package
        .write("shaders/light/one.wesl", "import package::comon::half;\nfn f() { half(1.0); }\n")?;
    let wrong = package.run_in("shaders/light", "compose one.wesl --diagnostics short")?.ends(1)?;
    wrong.says(&["one.wesl:1:8: error[missing-module]"])?.is_silent_of(&[".."])?;
    Ok(())
}

/// `gen` uses the root that `wesl.toml` declares beside the manifest, and `compile` uses the axes of
/// that manifest. So both give the same text.
fn beside_the_manifest() -> Outcome {
    let package = package(&[])?;
    package.run("gen --no-cache")?.ends(0)?.says(&["surface: 2 permutations"])?;
    let shipped = package.run("bundle get bundle surface fs_main falloff=square --target wgsl")?;
    let alone = package.run("compile shaders/surface.wesl --set falloff=square --target wgsl")?;
    equal(shipped.ends(0)?.out, alone.ends(0)?.out)?;
    package.run_in("shaders", "gen --no-cache -o ../other")?.ends(0)?;
    Ok(())
}

/// Without `wesl.toml` the folder of the manifest is the root, for every command.
fn without_wesl_toml() -> Outcome {
    let package = Package::new(&[
        ("lamplight.toml", MANIFEST),
        ("shaders/surface.wesl", &SURFACE.replace("package::common", "package::shaders::common")),
        ("shaders/common.wesl", COMMON),
    ])?;
    package.run("gen --no-cache")?.ends(0)?;
    let shipped = package.run("bundle get bundle surface fs_main falloff=square --target wgsl")?;
    let alone =
        package.run_in("shaders", "compile surface.wesl --set falloff=square --target wgsl")?;
    equal(shipped.ends(0)?.out, alone.ends(0)?.out)
}

/// A manifest cannot name a file outside of the root folder that `wesl.toml` declares.
fn outside() -> Outcome {
    let package = package(&[("lamplight.toml", &MANIFEST.replace("shaders/", ""))])?;
    let run = package.run("gen --no-cache")?.ends(1)?;
    run.says(&["error[outside-root]", "lamplight.toml:2:8", "`shaders/main.wesl`"])?;
    Ok(())
}

/// Commands that need a manifest take the nearest one of the user's, and not the library's own.
fn nearest_manifest() -> Outcome {
    let package = package(&[])?;
    for command in ["variants", "keys --lang rust", "gen --no-cache -o /dev/null/no"] {
        for folder in ["", "shaders/light"] {
            let run = package.run_in(folder, command)?;
            run.is_silent_of(&["forward", "there is no manifest"])?;
        }
    }
    package.run_in("shaders/light", "variants")?.ends(0)?.says(&["surface"])?;
    let empty = Package::new(&[])?;
    empty.run("gen")?.ends(1)?.says(&["there is no manifest `lamplight.toml`"])?;
    Ok(())
}

/// Messages name files, also those of dependencies, by paths that an editor can open.
fn names_of_files() -> Outcome {
    let package = Package::new(&[
        (
            "app/wesl.toml",
            "[package]\nname=\"app\"\nedition=\"2026_pre\"\nroot=\".\"\n[dependencies]\ndep = { path = \"../dep\" }\n",
        ),
        (
            "app/main.wesl",
            "import dep::light::f;\n@fragment fn m() -> @location(0) vec4f { return vec4f(f()); }\n",
        ),
        ("dep/wesl.toml", "[package]\nname=\"dep\"\nedition=\"2026_pre\"\nroot=\".\"\n"),
        ("dep/light.wesl", "fn f() -> f32 { let a = ; return 1.0; }\n"),
    ])?;
    let words = ["dep/light.wesl:1:25"];
    package
        .run("compile app/main.wesl --target wgsl")?
        .ends(1)?
        .says(&words)?
        .is_silent_of(&["/./"])?;
    package.write("dep/wesl.toml", "[package]\nname=\"dep\"\nroot=1\n")?;
    let run = package.run("compile app/main.wesl --target wgsl")?.ends(1)?;
    run.says(&["dep/wesl.toml:3:1"])?;
    Ok(())
}
