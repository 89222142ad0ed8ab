//! The validators of the targets: what they refuse, what the user sees, and that refused outputs do
//! not replace a bundle.

mod lines;
mod placed;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output as ProcessOutput};

use lamplight::bundle::{Target, blob_files};
use lamplight::emit::targets;
use lamplight::validators::{self, Novelty, Output, SeenText};
use libtest_mimic::{Failed, Trial};

use lines::{lines_of_few_permutations, others_go_on, validated_once};
use placed::{
    glsl_means_something_else, matrices_of_halves, refusals_are_placed, writers_are_placed,
};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 15] = [
        ("every_validator_refuses", every_validator_refuses),
        ("one_of_many_is_found", one_of_many_is_found),
        ("numbers_of_names_are_not_new", numbers_of_names_are_not_new),
        ("later_versions", later_versions),
        ("refusals_are_placed", refusals_are_placed),
        ("writers_are_placed", writers_are_placed),
        ("glsl_means_something_else", glsl_means_something_else),
        ("matrices_of_halves", matrices_of_halves),
        ("what_passed_is_known", what_passed_is_known),
        ("missing_programs_are_reported", missing_programs_are_reported),
        ("lines_of_few_permutations", lines_of_few_permutations),
        ("others_go_on", others_go_on),
        ("validated_once", validated_once),
        ("tint", tint),
        ("arrays_of_zeros", arrays_of_zeros),
    ];
    cases.into_iter().map(|(name, case)| Trial::test(format!("validators::{name}"), case)).collect()
}

/// A shader with many kinds of declarations. Outputs keep the names of its functions.
const SHADER: &str = "
struct Lamp { color: vec3f, power: f32, weights: array<vec4f, 3> }
@group(0) @binding(0) var<uniform> lamp: Lamp;
@group(0) @binding(1) var image: texture_2d<f32>;
@group(0) @binding(2) var image_sampler: sampler;

fn powered(level: f32) -> f32 {
    let twice = level + level;
    return twice * lamp.power;
}

@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    var sums: array<vec3f, 9>;
    sums[1] = lamp.color;
    @if(number == one) { sums[2] *= 2.0; }
    @if(number == two) { sums[3] += sums[1]; }
    return textureSample(image, image_sampler, at) * powered(sums[2].x);
}
";

const MANIFEST: &str =
    "[program.one]\nwesl = \"one.wesl\"\naxis.number = { values = [\"none\", \"one\", \"two\"] }\n";

/// A package in a temporary folder.
pub struct Package(tempfile::TempDir);

impl Package {
    pub fn new(manifest: &str, shader: &str) -> Result<Self, Failed> {
        let package = Self(tempfile::tempdir()?);
        fs::write(package.path("lamplight.toml"), manifest)?;
        fs::write(package.path("one.wesl"), shader)?;
        Ok(package)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
        command.current_dir(self.0.path()).args(arguments);
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Result<ProcessOutput, Failed> {
        Ok(self.command(arguments).output()?)
    }

    /// Makes the package's bundle and gives its outputs.
    fn outputs(&self) -> Result<Vec<Output>, Failed> {
        let output = self.run(&["gen", "--no-cache"])?;
        if !output.status.success() {
            return Err(output_text(&output).into());
        }
        Ok(validators::outputs(blob_files(self.path("bundle"))?)?)
    }
}

fn output_text(output: &ProcessOutput) -> String {
    let all = [output.stdout.as_slice(), output.stderr.as_slice()].concat();
    String::from_utf8_lossy(&all).into_owned()
}

/// Fails, with the place of the call, unless a command ended with a code and printed all words.
#[track_caller]
pub fn expect(output: &ProcessOutput, code: i32, words: &[&str]) -> Outcome {
    let place = std::panic::Location::caller();
    let text = output_text(output);
    let lost = words.iter().find(|word| !text.contains(**word));
    match (output.status.code(), lost) {
        (Some(found), None) if found == code => Ok(()),
        (found, lost) => {
            let what = format!("exit code {found:?}, expected {code}; words not found: {lost:?}");
            Err(format!("{place}: {what}:\n{text}").into())
        }
    }
}

fn refusals_of(outputs: &[Output]) -> Result<Vec<validators::Refusal>, Failed> {
    Ok(validators::validate_outputs(outputs, None, &|_, _| ())?)
}

/// Breaks an output: a text uses a name in one line that is not declared, and SPIR-V has a wrong
/// instruction near its end. Gives the number of the line, for texts.
fn broken(output: &Output) -> Result<Option<u32>, Failed> {
    let mut bytes = fs::read(&output.file)?;
    if output.target == Target::SPIRV {
        let last = bytes.len() - 12;
        bytes[last..last + 4].copy_from_slice(&0x0002_00f8_u32.to_le_bytes());
        fs::write(&output.file, bytes)?;
        return Ok(None);
    }
    let text = String::from_utf8(bytes)?;
    let at = text.find("twice = ").ok_or("the text has no `twice`")?;
    let line = text[..at].matches('\n').count() as u32 + 1;
    fs::write(&output.file, text.replacen("twice = ", "twice = unheard_of + ", 1))?;
    Ok(Some(line))
}

/// The validator of each target accepts its sound output, and refuses the broken one at its line.
fn every_validator_refuses() -> Outcome {
    let package = Package::new(MANIFEST, SHADER)?;
    let outputs = package.outputs()?;
    if let Some(refusal) = refusals_of(&outputs)?.first() {
        return Err(format!("a sound output is refused: {refusal:?}").into());
    }
    let mut lines = Vec::new();
    for target in Target::ALL {
        let output = outputs.iter().find(|output| output.target == *target);
        let output = output.ok_or_else(|| format!("no output for {target}"))?;
        lines.push((*target, broken(output)?));
    }
    let refusals = refusals_of(&outputs)?;
    let mut found: Vec<(Target, Option<u32>)> =
        refusals.iter().map(|refusal| (refusal.output.target, refusal.line)).collect();
    found.sort();
    if found == lines {
        return Ok(());
    }
    Err(format!("refused at {found:?}, expected {lines:?}: {refusals:?}").into())
}

/// A wrong output is found among a hundred that are validated in one batch. Validators compile only
/// texts with new pairs of tokens one by one, and this one has no new pair, so only the batch can
/// find it.
fn one_of_many_is_found() -> Outcome {
    let package = Package::new(MANIFEST, SHADER)?;
    let outputs = package.outputs()?;
    let (mut many, mut wrong) = (Vec::new(), BTreeSet::new());
    for target in Target::ALL.iter().filter(|target| **target != Target::SPIRV) {
        let first = outputs.iter().find(|output| output.target == *target).ok_or("no output")?;
        let text = fs::read_to_string(&first.file)?;
        for copy in 0..100 {
            // Each pair of neighbouring tokens in this wrong text is also in other texts.
            let text = match copy {
                70 => text.replace("return twice *", "return level *").replace("level + level", ""),
                _ => text.clone(),
            };
            let file = package.path(&format!("{target}{copy}"));
            fs::write(&file, text)?;
            many.push(Output { file: file.clone(), ..first.clone() });
            if copy == 70 {
                wrong.insert(file);
            }
        }
    }
    let refusals = refusals_of(&many)?;
    let found: BTreeSet<PathBuf> =
        refusals.iter().map(|refusal| refusal.output.file.clone()).collect();
    match found == wrong {
        true => Ok(()),
        false => Err(format!("refused should be {wrong:?}, found {refusals:?}").into()),
    }
}

/// A line is new if it differs in more than the numbers of generated names: in a type, a literal's
/// kind, an operator or a name of the author.
fn numbers_of_names_are_not_new() -> Outcome {
    let line = "vec3 _e12 = color_3 * mat2x3[1].yzx - 0.5;";
    let mut seen = SeenText::default();
    if seen.add(line) != (Novelty { line: true, pair: true }) {
        return Err("the first text should be new".into());
    }
    for same in [
        line,
        "vec3 _e7 = color_41 * mat2x3[1].yzx - 0.5;",
        "  vec3 _e1 = color_0 * mat2x3[1].yzx - 0.5;",
    ] {
        if seen.add(same) != Novelty::default() {
            return Err(format!("`{same}` should not be new").into());
        }
    }
    for (from, to) in [
        ("vec3", "vec4"),
        ("mat2x3", "mat2x4"),
        ("_e12", "e12"),
        ("color_3", "color3"),
        ("-", "+"),
        ("yzx", "zyx"),
    ] {
        let other = line.replacen(from, to, 1);
        if seen.add(&other) != (Novelty { line: true, pair: true }) {
            return Err(format!("`{other}` should be new").into());
        }
    }
    // All numbers are one token, so that another number makes a new line without a new pair.
    match seen.add(&line.replace("0.5", "0.25")) {
        Novelty { line: true, pair: false } => Ok(()),
        other => Err(format!("another number should make a new line only: {other:?}").into()),
    }
}

/// GLSL ES is validated as version 3.10 too, and SPIR-V for Vulkan 1.0 too.
fn later_versions() -> Outcome {
    let package = Package::new(MANIFEST, SHADER)?;
    let outputs = package.outputs()?;
    let find = |target| outputs.iter().find(|output| output.target == target).ok_or("no output");
    // `buffer` is an ordinary name in 3.00, and a keyword in 3.10.
    let es = find(Target::ESSL300)?;
    let text = fs::read_to_string(&es.file)?;
    fs::write(&es.file, text.replace("twice", "buffer"))?;
    let spirv = find(Target::SPIRV)?;
    let mut bytes = fs::read(&spirv.file)?;
    bytes[4..8].copy_from_slice(&0x0001_0300_u32.to_le_bytes());
    fs::write(&spirv.file, bytes)?;
    let refusals = refusals_of(&[es.clone(), spirv.clone()])?;
    match refusals.as_slice() {
        [es, spirv] if es.message.contains("BUFFER") && spirv.message.contains("vulkan1.0") => {
            Ok(())
        }
        _ => Err(format!("expected BUFFER in GLSL ES, and vulkan1.0: {refusals:?}").into()),
    }
}

const COUNTED: &str = "
fn counted(value: u32) -> u32 {
    let twice = value + value;
    let ones = countOneBits(twice);
    return ones;
}
@group(0) @binding(0) var<uniform> u: vec4u;
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    var sum = at.x;
    @if(bits) { sum += f32(counted(u.x)); }
    return vec4f(sum);
}
";

const COUNTED_MANIFEST: &str = "[program.one]\nwesl = \"one.wesl\"\ntargets = [\"essl300\", \"hlsl\"]\naxis.bits = { values = [false, true] }\n";

/// An output that passed is not validated again. One that was refused is.
fn what_passed_is_known() -> Outcome {
    let manifest = COUNTED_MANIFEST.replace("\"essl300\", ", "");
    let package = Package::new(&manifest, COUNTED)?;
    let arguments = ["gen", "--validate", "--cache", "cache"];
    expect(&package.run(&arguments)?, 0, &["2 outputs validated, 0 known to pass"])?;
    expect(&package.run(&arguments)?, 0, &["0 outputs validated, 2 known to pass", "up to date"])?;
    fs::write(package.path("one.wesl"), COUNTED.replace("value + value", "value * 2u"))?;
    expect(&package.run(&arguments)?, 0, &["1 output validated, 1 known to pass"])?;
    fs::write(package.path("lamplight.toml"), COUNTED_MANIFEST)?;
    for _ in 0..2 {
        expect(&package.run(&arguments)?, 1, &["bitCount", "`essl300`"])?;
    }
    Ok(())
}

/// If a validator is not installed, the run writes the bundle, and ends with exit code 4 and the
/// command that installs the validator.
fn missing_programs_are_reported() -> Outcome {
    let nothing = tempfile::tempdir()?;
    let install_command = |name: &str| match name {
        "spirv_val" => Ok("apt-get install spirv-tools"),
        "glslang" => Ok("apt-get install glslang-tools"),
        "clang" => Ok("apt-get install clang"),
        "naga_tint" => Ok("apt-get install nodejs"),
        new => Err(format!("which package has the programs of `{new}`?")),
    };
    let package = Package::new(MANIFEST, SHADER)?;
    for entry in targets::ALL {
        let install = install_command(entry.validation.validator)?;
        let target = entry.target.name();
        let arguments = ["gen", "--validate", "--target", target, "-o", target];
        let mut command = package.command(&arguments);
        let validated = "not all outputs are validated";
        expect(&command.env("PATH", nothing.path()).output()?, 4, &[install, validated])?;
    }
    let arguments = ["gen", "--validate", "--target", "wgsl", "--cache", "cache/lamplight-cache"];
    let words = ["npm install", "cache/lamplight-tint webgpu@"];
    expect(&package.run(&arguments)?, 4, &words)?;
    match package.path("bundle/manifest.json").exists() {
        true => Ok(()),
        false => Err("no bundle was written although no validator refused an output".into()),
    }
}

/// Tint is run with a package that stands in for Dawn's. A refusal is reported with its place. A text
/// for which the package gives no verdict does not count as passed.
fn tint() -> Outcome {
    let package = Package::new(MANIFEST, SHADER)?;
    let folder = package.path("lamplight-tint/node_modules/webgpu");
    fs::create_dir_all(&folder)?;
    fs::write(
        folder.join("package.json"),
        r#"{ "name": "webgpu", "version": "0.6.2", "type": "module", "main": "index.js" }"#,
    )?;
    let dawn = |verdict: &str| {
        format!(
            "const message = {{ type: 'error', lineNum: 11, linePos: 5, message: 'not like this' }};
const getCompilationInfo = async () => ({{ messages: [{{ type: 'warning' }}, ...({verdict})] }});
let code;
const device = {{
  pushErrorScope() {{}},
  popErrorScope: async () => null,
  createShaderModule(found) {{ code = found.code; return {{ getCompilationInfo }}; }},
}};
export const create = () => ({{ requestAdapter: async () => ({{ requestDevice: async () => device }}) }});
"
        )
    };
    let arguments = ["gen", "--validate", "--target", "wgsl", "--cache", "lamplight-cache"];
    let write = |verdict: &str| fs::write(folder.join("index.js"), dawn(verdict));
    write("code.includes('sums[3]') ? [message] : []")?;
    let words =
        ["Tint refuses the output for `wgsl`", "11:5: error: not like this", "`number=two`"];
    expect(&package.run(&arguments)?, 1, &words)?;
    write("process.exit(0)")?;
    expect(&package.run(&arguments)?, 4, &["Tint validated not all of 1 texts"])?;
    write("[]")?;
    expect(&package.run(&arguments)?, 0, &["1 output validated, 2 known to pass"])
}

/// HLSL initialises arrays of zeros with a cast of a number, which glslang does not accept for all
/// types. Arrays of every type and depth must pass their validators.
fn arrays_of_zeros() -> Outcome {
    let shader = "
struct Lamp { color: vec3f, weights: array<f32, 4> }
var<private> kept: array<array<vec2f, 3>, 2>;
fn fresh() -> array<Lamp, 3> { return array<Lamp, 3>(); }
fn lamps(index: u32) -> f32 { var all: array<Lamp, 3>; all[1] = fresh()[index]; return all[index].weights[index]; }
fn small(index: u32) -> f32 { var matrices: array<mat2x3f, 2>; var flags: array<bool, 5>; return select(matrices[index][0].x, 1.0, flags[index]); }
fn given(values: array<i32, 2>) -> i32 { return values[0]; }
var<private> wide: array<array<f32, 40>, 50>;
fn many() -> array<array<vec3f, 40>, 50> { return array<array<vec3f, 40>, 50>(); }
fn long(index: u32) -> f32 { var found: array<i32, 3000>; found[index] = 1; wide[index][1] = many()[2][index].x; return f32(found[0]) + wide[1][index]; }
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    let index = u32(at.x);
    kept[1][2] = at;
    return vec4f(lamps(index), small(index), kept[index][1].x, f32(given(array<i32, 2>())) + long(index));
}
";
    // GLSL 3.30 and GLSL ES 3.00 have no arrays of arrays.
    let targets = ["spirv", "glsl450", "msl", "hlsl", "wgsl"];
    let manifest = format!("[program.one]\nwesl = \"one.wesl\"\ntargets = {targets:?}\n");
    let package = Package::new(&manifest, shader)?;
    let outputs = package.outputs()?;
    match refusals_of(&outputs)?.first() {
        Some(refusal) => Err(format!("{refusal:?}\n{}", text(&refusal.output.file)).into()),
        None if outputs.len() == targets.len() => Ok(()),
        None => {
            let (found, expected) = (outputs.len(), targets.len());
            Err(format!("found {found} outputs, expected {expected}").into())
        }
    }
}

fn text(file: &Path) -> String {
    String::from_utf8_lossy(&fs::read(file).unwrap_or_default()).into_owned()
}
