//! Validates shaders, emits them for every target, and has the targets' own validators read them.
//!
//! Shaders of `emit/valid/` must pass for every target, and a snapshot holds their reflection.
//! Those of `emit/invalid/` must be refused, and a snapshot holds the diagnostics. Their names end
//! in `.wgsl`, `.vert.glsl` or `.frag.glsl`.

use std::path::{Path, PathBuf};
use std::process::Command;

use lamplight::bundle::{Language, Stage, Target};
use lamplight::compose::Composed;
use lamplight::diagnostic::render::{Form, render};
use lamplight::emit::{self, Emitted};
use lamplight::source::SourceSet;
use lamplight::validate::{self, Validated, validate};
use lamplight::validators::agreement::output_differences;
use lamplight_testing::text::wrap;
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    let mut tests = vec![
        Trial::test("emit::hostile_texts_are_refused", hostile_texts),
        Trial::test("emit::accepted_depths_fit_the_stack", accepted_depths),
        Trial::test("emit::panics_become_diagnostics", panics),
    ];
    for (folder, check) in [("valid", valid as fn(&Path) -> Outcome), ("invalid", invalid)] {
        for path in cases(folder) {
            let name = format!("emit::{folder}::{}", path.file_name().unwrap().to_string_lossy());
            tests.push(Trial::test(name, move || check(&path)));
        }
    }
    tests
}

/// The shader is emitted for every target, gives the same bytes twice, and the external validators
/// accept it.
fn valid(path: &Path) -> Outcome {
    let (sources, composed) = read(path);
    let validated = validate(&composed).map_err(|errors| render(&sources, &errors, Form::Human))?;
    let mut summary = String::new();
    for point in &validated.module.entry_points {
        let alone = emit::isolate(&validated, &point.name)
            .map_err(|errors| render(&sources, &errors, Form::Human))?;
        let reflection = emit::reflect(&alone, &point.name).map_err(|error| error.message)?;
        summary += &format!("{}: {}\n", point.name, serde_json::to_string_pretty(&reflection)?);
        for target in Target::ALL {
            let emitted = emit::emit(&alone, &point.name, *target)
                .map_err(|error| render(&sources, &[error], Form::Human))?;
            same_from_the_whole(&validated, &point.name, *target, &emitted)?;
            accepted(&point.name, point.stage, *target, &emitted)?;
            let found = output_differences(*target, &emitted.bytes, &reflection, &emitted.native);
            if !found.is_empty() {
                return Err(format!("{} in {target}: {}", point.name, found.join("\n")).into());
            }
            summary +=
                &format!("{} {target}: {}\n", point.name, serde_json::to_string(&emitted.native)?);
        }
    }
    snapshot(path, summary);
    Ok(())
}

fn invalid(path: &Path) -> Outcome {
    let (sources, composed) = read(path);
    let Err(errors) = validate(&composed) else {
        return Err(format!("{} was accepted, expected diagnostics", path.display()).into());
    };
    snapshot(path, render(&sources, &errors, Form::Human));
    Ok(())
}

/// `isolate` derives the analysis of one entry point from that of the module, which is cheap. A
/// full validation of the isolated module must give the same output.
fn same_from_the_whole(
    validated: &Validated,
    entry: &str,
    target: Target,
    emitted: &Emitted,
) -> Outcome {
    let mut again = emit::isolate(validated, entry).map_err(|_| "isolate is not repeatable")?;
    again.info = naga_info(&again);
    let again = emit::emit(&again, entry, target).map_err(|error| error.message)?;
    if again == *emitted {
        Ok(())
    } else {
        Err(format!("{entry}: {target} differs after a full validation").into())
    }
}

fn naga_info(validated: &Validated) -> naga::valid::ModuleInfo {
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), validate::CAPABILITIES)
        .validate(&validated.module)
        .unwrap()
}

fn accepted(entry: &str, stage: naga::ShaderStage, target: Target, emitted: &Emitted) -> Outcome {
    let folder = tempfile::tempdir()?;
    let extension = if stage == naga::ShaderStage::Vertex { "vert" } else { "frag" };
    let file = folder.path().join(format!("out.{extension}"));
    std::fs::write(&file, &emitted.bytes)?;
    let found = emit::targets::find(target).ok_or("the target has no file")?;
    match found.validation.validator {
        "spirv_val" => {
            run(Command::new("spirv-val").args(["--target-env", "vulkan1.1"]).arg(&file))
        }
        "glslang" if found.glsl.is_some() => run(Command::new("glslangValidator").arg(&file)),
        "naga_tint" => {
            let text = String::from_utf8(emitted.bytes.clone())?;
            naga::front::wgsl::parse_str(&text)
                .map(|_| ())
                .map_err(|error| error.emit_to_string(&text).into())
        }
        _ if emitted.native.entry_name.is_empty() => {
            Err(format!("{target}: the reflection has no name for the entry point {entry}").into())
        }
        _ => Ok(()),
    }
}

fn run(command: &mut Command) -> Outcome {
    crate::examples::run(command).map(|_| ())
}

/// Texts that would exhaust naga's stack give the error `limit-exceeded` before naga sees them.
fn hostile_texts() -> Outcome {
    let texts = [
        format!("const a = {}1;", "1 + ".repeat(20_000)),
        format!("const a = {}1;", "-".repeat(20_000)),
        format!("const a = {}1{};", "(".repeat(20_000), ")".repeat(20_000)),
        format!("alias a = {}f32{};", "array<".repeat(20_000), ">".repeat(20_000)),
        format!("fn f() {}{}", "{".repeat(20_000), "}".repeat(20_000)),
        format!("fn f(x: i32) {{ if x == 0 {{}} {} }}", "else if x == 1 {}".repeat(20_000)),
        format!("fn f() {{ {} ; }}", "g(1 + ".repeat(200) + &"1 + ".repeat(4_000)),
        format!("const a = v{};", ".x".repeat(20_000)),
        "/".repeat(5 << 20),
    ];
    for text in texts {
        for language in [Language::Wesl, Language::Glsl] {
            let (_, composed) = wrap("hostile", text.clone(), language, Some(Stage::Fragment));
            let errors = validate(&composed).err().ok_or("a hostile text was accepted")?;
            if errors[0].code.name != "limit-exceeded" {
                let start: String = text.chars().take(40).collect();
                let found = format!("`{}`: {}", errors[0].code.name, errors[0].message);
                let what = format!("{language:?} text `{start}...`");
                return Err(format!("{what}: expected `limit-exceeded`, found {found}").into());
            }
        }
    }
    Ok(())
}

/// The deepest texts within the limits, and long chains of declarations, do not overflow the stack.
fn accepted_depths() -> Outcome {
    let chain: String =
        (0..20_000).map(|index| format!("const a{index} = a{};\n", index + 1)).collect();
    let calls: String =
        (0..20_000).map(|index| format!("fn f{index}() {{ f{}(); }}\n", index + 1)).collect();
    let structs: String =
        (0..5_000).map(|index| format!("struct S{index} {{ a: S{} }}\n", index + 1)).collect();
    let texts = [
        format!("const a = {}1;", "1 + ".repeat(4_000)),
        format!("fn f(x: f32) -> f32 {{ return {}x; }}", "-".repeat(4_000)),
        format!("const a = {}1{};", "(".repeat(250), ")".repeat(250)),
        format!("fn f() {}{}", "{".repeat(250), "}".repeat(250)),
        format!("fn f(x: i32) {{ if x == 0 {{}} {} }}", "else if x == 1 {}".repeat(700)),
        chain + "const a20000 = 1;",
        calls + "fn f20000() {}",
        structs + "struct S5000 { a: f32 }",
    ];
    for text in texts {
        let (_, composed) = wrap("deep", text, Language::Wesl, None);
        // Both results are right. The test fails by ending the process if the stack overflows.
        let _ = validate(&composed);
    }
    let glsl = [
        format!("#version 450\nvoid main() {{ float a = {}1.0; }}", "1.0 + ".repeat(4_000)),
        format!("#version 450\nvoid main() {{ int a; {} a = 1; }}", "if (true) ".repeat(2_000)),
        format!("#version 450\nvoid main() {{ int a; {} a = 1; }}", "a = 1, ".repeat(20_000)),
        format!("#version 450\nvoid main() {{ int a = {}1; }}", "true ? 1 : ".repeat(2_000)),
    ];
    for text in glsl {
        let (_, composed) = wrap("deep", text, Language::Glsl, Some(Stage::Fragment));
        let _ = validate(&composed);
    }
    Ok(())
}

/// A panic within naga becomes a diagnostic with the panic's message and what naga was given.
fn panics() -> Outcome {
    let result: Result<(), _> =
        validate::on_large_stack(|| validate::guard("the text", || panic!("on purpose")));
    let error = result.err().ok_or("a panic was lost")?;
    let is_reported = error.code.name == "naga-internal"
        && error.message.contains("on purpose")
        && error.notes[0].contains("the text");
    match is_reported {
        true => Ok(()),
        false => Err(format!("expected `naga-internal` with `on purpose`, found {error:?}").into()),
    }
}

fn cases(folder: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/emit").join(folder);
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(root).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

fn read(path: &Path) -> (SourceSet, Composed) {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let (language, stage) = match name.split('.').rev().collect::<Vec<_>>()[..] {
        ["glsl", "vert", ..] => (Language::Glsl, Some(Stage::Vertex)),
        ["glsl", ..] => (Language::Glsl, Some(Stage::Fragment)),
        _ => (Language::Wesl, None),
    };
    wrap(&name, std::fs::read_to_string(path).unwrap(), language, stage)
}

fn snapshot(path: &Path, text: String) {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let folder = path.parent().unwrap().file_name().unwrap().to_string_lossy().into_owned();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("snapshots/emit").join(folder);
    insta::with_settings!({ snapshot_path => root, prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!(name, text);
    });
}
