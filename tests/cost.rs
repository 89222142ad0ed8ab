//! What `lamplight cost` says of functions and permutations, for GPUs that this machine lacks.

mod budget;
mod cached;
mod files;
mod offline;

use std::path::Path;
use std::process::{Command, Output};

use lamplight_testing::commands::stderr_text;
use libtest_mimic::{Failed, Trial};
use serde_json::Value;

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("cost::more_work_costs_more", more_work),
        Trial::test("cost::every_function_on_every_generation", every_function),
        Trial::test("cost::parts_add_up", parts_add_up),
        Trial::test("cost::permutations_have_their_stages", permutations),
        Trial::test("cost::shaders_of_files", files),
        Trial::test("cost::axes_by_what_they_add", axes),
        Trial::test("cost::gpus_named_twice_are_one", gpus_named_twice),
        Trial::test("cost::a_rise_fails", a_rise_fails),
        Trial::test("cost::functions_keep_their_budget", budget::functions),
        Trial::test("cost::programs_keep_their_budget", budget::programs),
        Trial::test("cost::record_is_current", budget::record_is_current),
        Trial::test("cost::figures_are_kept", cached::figures_are_kept),
        Trial::test("cost::cache_in_its_usual_place", cached::usual_place),
        Trial::test("cost::taps_are_counted", offline::taps_are_counted),
        Trial::test("cost::constants_are_settled", offline::constants_are_settled),
        Trial::test("cost::missing_programs", offline::missing_programs),
        Trial::test("cost::mali_is_called", offline::mali_is_called),
        Trial::test("cost::bad_reports", offline::bad_reports),
        Trial::test("cost::more_lamps_cost_more", files::lamps),
        Trial::test("cost::guards_cost", files::guards),
        Trial::test("cost::iterations_of_unknown_loops", files::iterations),
        Trial::test("cost::modules_as_their_texts", files::modules),
        Trial::test("cost::foreign_modules", files::foreign_modules),
        Trial::test("cost::wrong_names", wrong_names),
        Trial::test("cost::without_a_driver", without_a_driver),
    ]
}

fn lamplight(arguments: &[&str]) -> Result<Output, Failed> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    command.args(["cost", "--no-cache"]).args(arguments).output().map_err(Failed::from)
}

/// The objects of `--json`.
fn objects(arguments: &[&str]) -> Result<Vec<Value>, Failed> {
    let output = lamplight(&[arguments, &["--json"]].concat())?;
    if output.status.code() != Some(0) {
        return Err(stderr_text(&output).into());
    }
    Ok(serde_json::from_slice(&output.stdout)?)
}

fn figure(object: &Value, form: &str, name: &str) -> Result<i64, Failed> {
    object[form][name].as_i64().ok_or_else(|| format!("no {form}.{name} in {object}").into())
}

/// Filters with more taps have more instructions, on each generation of GPUs. If they had not, the
/// figures would not be those of the function that was asked for.
fn more_work() -> Outcome {
    let filters = ["hard", "pcf_3x3", "pcf_5x5"].map(|name| format!("shadow::compare::{name}"));
    let names: Vec<&str> = filters.iter().map(String::as_str).collect();
    let found = objects(&names)?;
    let of = |name: &str, gpu: &str| {
        let object = found.iter().find(|object| object["name"] == *name && object["gpu"] == *gpu);
        figure(object.ok_or("a filter is missing")?, "net", "instructions")
    };
    for gpu in ["polaris10", "vega10", "navi10", "navi21", "gfx1100"] {
        let counts = [of(names[0], gpu)?, of(names[1], gpu)?, of(names[2], gpu)?];
        if counts[0] < 1 || !counts.is_sorted() || counts[1] == counts[2] {
            return Err(format!("{gpu}: {counts:?} instructions for 1, 9 and 25 taps").into());
        }
    }
    Ok(())
}

/// Every function of the library has figures that are possible, in both languages.
fn every_function() -> Outcome {
    let listed = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(["list", "functions", "--json"])
        .output()?;
    let listed: Vec<Value> = serde_json::from_slice(&listed.stdout)?;
    for language in ["wesl", "glsl"] {
        let found = objects(&["--lang", language, "--gpu", "navi21,gfx1100"])?;
        if found.len() != 2 * listed.len() {
            let text = format!("{} figures of {} functions", found.len(), listed.len());
            return Err(format!("{language}, two GPUs: {text}").into());
        }
        for object in &found {
            if figure(object, "figures", "instructions")? < 2
                || figure(object, "figures", "vgprs")? < 1
                || figure(object, "net", "instructions")? < 0
            {
                return Err(format!("{language}: impossible figures: {object}").into());
            }
        }
    }
    Ok(())
}

/// The net cost of a function is the cost of a stage with it, less that of an empty stage. So it is
/// above zero and below the cost of the whole stage.
fn parts_add_up() -> Outcome {
    for object in objects(&["brdf::fresnel", "--gpu", "navi21"])? {
        let [whole, net] =
            [figure(&object, "figures", "code_size")?, figure(&object, "net", "code_size")?];
        if net <= 0 || whole <= net {
            return Err(format!("net {net} of {whole} bytes is impossible: {object}").into());
        }
    }
    Ok(())
}

/// A permutation has figures for each of its stages, and PCSS costs much more than no shadow.
fn permutations() -> Outcome {
    let found = objects(&["lights=spot", "lights=spot,shadow=pcss", "--gpu", "navi21"])?;
    let stages: Vec<&str> = found.iter().filter_map(|object| object["stage"].as_str()).collect();
    if stages != ["fragment", "vertex", "fragment", "vertex"] {
        let expected = "expected a fragment and a vertex stage for each of two permutations";
        return Err(format!("{expected}, found {stages:?}").into());
    }
    let [plain, pcss] = [0, 2].map(|index| figure(&found[index], "figures", "instructions"));
    let (plain, pcss) = (plain?, pcss?);
    match pcss >= plain + 100 {
        true => Ok(()),
        false => Err(format!("{plain} instructions without shadow, {pcss} with PCSS").into()),
    }
}

const OWN_MANIFEST: &str = "[program.own]
wesl = \"own.wesl\"

[program.own.axis]
warm = { values = [false, true] }
loops = { values = [0, 9], mode = \"spec\" }
";

const OWN_SHADER: &str = "@fragment fn fs(@location(0) at: vec4f) -> @location(0) vec4f {
    var sum = at;
    @if(warm) { sum = sum * vec4f(1.2, 1.1, 0.9, 1.0) + at * at; }
    for (var i = 0; i < constants::loops; i++) { sum = sin(sum * at) + sqrt(sum); }
    return sum;
}
";

/// `variants --cost` shows what an axis adds, for a boolean axis and for one that a specialisation
/// constant chooses. `cost` of single permutations agrees with it. `cost` takes `warm` and `default`
/// for keys, although a path of the library could be written the same way.
fn axes() -> Outcome {
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("lamplight.toml"), OWN_MANIFEST)?;
    std::fs::write(folder.path().join("own.wesl"), OWN_SHADER)?;
    let run = |arguments: &[&str]| -> Result<Value, Failed> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
        let command = command.args(arguments).args(["--manifest", "lamplight.toml", "--json"]);
        let output = command.current_dir(folder.path()).output()?;
        let value = serde_json::from_slice(&output.stdout);
        value.map_err(|_| stderr_text(&output).into())
    };
    let variants = run(&["variants", "--cost", "--gpu", "navi21"])?;
    let changes = variants[0]["changes"].as_array().cloned().unwrap_or_default();
    let of = |axis: &str| -> Result<[i64; 3], Failed> {
        let found = changes.iter().find(|change| change["axis"] == axis);
        let found = found.ok_or_else(|| format!("no changes of `{axis}`: {variants}"))?;
        let instructions = &found["figures"]["instructions"];
        let numbers = [&found["pairs"], &instructions["least"], &instructions["most"]];
        let numbers = numbers.map(|number| number.as_i64().unwrap_or(-1));
        Ok(numbers)
    };
    let (warm, loops) = (of("warm")?, of("loops")?);
    if warm[0] != 2 || warm[1] < 1 || loops[0] != 2 || loops[1] < 20 {
        let what = format!("warm {warm:?}, loops {loops:?}");
        return Err(format!("too few pairs or instructions (pairs, least, most): {what}").into());
    }
    let keys = ["default", "warm", "loops=9"];
    let costs = run(&[&["cost"][..], &keys, &["--gpu", "navi21"]].concat())?;
    let counts: Vec<i64> = (0..3)
        .map(|index| figure(&costs[index], "figures", "instructions"))
        .collect::<Result<_, _>>()?;
    let rises = [counts[1] - counts[0], counts[2] - counts[0]];
    if rises[0] < warm[1] || rises[0] > warm[2] || rises[1] < loops[1] || rises[1] > loops[2] {
        let what = format!("`cost` counts {counts:?} for {keys:?}");
        return Err(format!("{what}, `variants` shows warm {warm:?}, loops {loops:?}").into());
    }
    let unused = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(["variants", "--gpu", "navi21"])
        .output()?;
    match unused.status.code() {
        Some(2) => Ok(()),
        code => Err(format!("`--gpu` without `--cost`: exit code {code:?}, expected 2").into()),
    }
}

fn gpus_named_twice() -> Outcome {
    let names = "navi21,vega10,navi21";
    let found = objects(&["brdf::fresnel::f_schlick_f82", "--gpu", names])?;
    let gpus: Vec<&str> = found.iter().filter_map(|object| object["gpu"].as_str()).collect();
    match gpus == ["vega10", "navi21"] {
        true => Ok(()),
        false => Err(format!("expected figures of vega10 and navi21, found {gpus:?}").into()),
    }
}

/// Shaders of files have figures: a vertex stage alone, both stages of one file, a compute shader.
/// A feature that adds work adds instructions.
fn files() -> Outcome {
    let folder = tempfile::tempdir()?;
    let vertex = "@vertex fn vs(@location(0) p: vec3f, @location(1) n: vec3f) -> Out {
    return Out(vec4f(p, 1.0), normalize(n), 3u);
}
struct Out { @builtin(position) p: vec4f, @location(0) n: vec3f, @location(1) @interpolate(flat) i: u32 }
";
    let fragment = "@fragment fn fs(in: Out) -> @location(0) vec4f {
    var sum = in.n * f32(in.i);
    @if(more) { for (var i = 0u; i < in.i; i++) { sum += sin(sum * f32(i)); } }
    return vec4f(sum, 1.0);
}
";
    let compute = "@group(0) @binding(0) var<storage, read_write> data: array<f32>;
@compute @workgroup_size(64) fn cs(@builtin(global_invocation_id) at: vec3u) {
    data[at.x] = sqrt(data[at.x]);
}
";
    let write = |name: &str, text: String| -> Result<String, Failed> {
        let path = folder.path().join(name);
        std::fs::write(&path, text)?;
        Ok(path.to_string_lossy().into_owned())
    };
    let alone = write("alone.wesl", vertex.to_owned())?;
    let both = write("both.wesl", format!("{vertex}{fragment}"))?;
    let counting = write("counting.wesl", compute.to_owned())?;
    let instructions = |file: &str, feature: &str| -> Result<Vec<(String, i64)>, Failed> {
        let options = ["--gpu", "navi21", "--feature", feature];
        let found =
            objects(&[&[file], &options[..if feature.is_empty() { 2 } else { 4 }]].concat())?;
        let one = |object: &Value| {
            let stage = object["stage"].as_str().unwrap_or_default().to_owned();
            Ok((stage, figure(object, "figures", "instructions")?))
        };
        found.iter().map(one).collect()
    };
    let stages = |found: &[(String, i64)]| {
        found.iter().map(|(stage, _)| stage.clone()).collect::<Vec<_>>().join(" ")
    };
    let (alone, counting) = (instructions(&alone, "")?, instructions(&counting, "")?);
    let (without, with) = (instructions(&both, "more=false")?, instructions(&both, "more")?);
    let found = [stages(&alone), stages(&counting), stages(&without)];
    if found != ["vertex", "compute", "vertex fragment"] {
        return Err(format!("found the stages {found:?}").into());
    }
    if alone[0].1 < 5 || counting[0].1 < 3 || with[1].1 < without[1].1 + 5 {
        return Err(format!("too few: {alone:?} {counting:?} {without:?} {with:?}").into());
    }
    Ok(())
}

/// `--baseline` records costs the first time, and then fails if a figure rose: exit code 3 names the
/// figure, 4 says that another driver is not comparable, 1 that the file is not a baseline.
fn a_rise_fails() -> Outcome {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("costs.json");
    let path = file.to_string_lossy().into_owned();
    let compare = |more: &[&str]| {
        lamplight(&[&["lighting::spot", "--gpu", "navi21", "--baseline", &path], more].concat())
    };
    let codes = |wanted: i32, output: Output| match output.status.code() {
        Some(code) if code == wanted => Ok(stderr_text(&output)),
        code => {
            let what = format!("exit code {code:?}, expected {wanted}");
            Err(Failed::from(format!("{what}: {}", stderr_text(&output))))
        }
    };
    codes(0, compare(&[])?)?;
    codes(0, compare(&[])?)?;
    let recorded = std::fs::read_to_string(&file)?;
    let lower = edit(&recorded, |driver, instructions| (driver, instructions - 1))?;
    std::fs::write(&file, &lower)?;
    let message = codes(3, compare(&[])?)?;
    if !message.contains("cone_smooth navi21 fragment: instructions") {
        return Err(format!("the message does not name the figure that rose: {message}").into());
    }
    codes(0, compare(&["--rise", "2"])?)?;
    let other = edit(&recorded, |_, instructions| ("Mesa 1.2.3".to_owned(), instructions))?;
    std::fs::write(&file, other)?;
    codes(4, compare(&[])?)?;
    codes(0, compare(&["--record"])?)?;
    if std::fs::read_to_string(&file)? != recorded {
        return Err("recording again on the same driver gives another file".into());
    }
    std::fs::write(&file, "{\"name\": \"somebody's\"}")?;
    codes(1, compare(&[])?)?;
    codes(1, compare(&["--record"])?)?;
    match std::fs::read_to_string(&file)?.contains("somebody's") {
        true => Ok(()),
        false => Err("a file that is not a baseline was replaced".into()),
    }
}

/// Changes the driver and the numbers of instructions of recorded costs.
fn edit(text: &str, change: impl Fn(String, i64) -> (String, i64)) -> Result<String, Failed> {
    let mut value: Value = serde_json::from_str(text)?;
    let driver = value["driver"].as_str().unwrap_or_default().to_owned();
    value["driver"] = change(driver, 0).0.into();
    for (_, figures) in value["costs"].as_object_mut().ok_or("there are no costs")? {
        let before = figures["instructions"].as_i64().ok_or("there are no instructions")?;
        figures["instructions"] = change(String::new(), before).1.into();
    }
    Ok(value.to_string())
}

fn wrong_names() -> Outcome {
    let cases: [(&[&str], i32, &str); 4] = [
        (&["lighting::spot::cone_smoth"], 1, "did you mean `lighting::spot::cone_smooth`"),
        (&["lights=spott"], 1, "spot"),
        (&["brdf", "--gpu", "navi12"], 2, "did you mean `navi"),
        (&["brdf", "--rise", "nan"], 2, "expected a number"),
    ];
    for (arguments, code, text) in cases {
        let output = lamplight(arguments)?;
        if output.status.code() != Some(code) || !stderr_text(&output).contains(text) {
            let found = format!("{:?}: {}", output.status, stderr_text(&output));
            let expected = format!("expected exit code {code} and `{text}`");
            return Err(format!("{arguments:?}: {expected}, found {found}").into());
        }
    }
    Ok(())
}

/// Without the driver's library, the command ends with exit code 4 and says what to install.
fn without_a_driver() -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    let output = command
        .args(["cost", "lighting::spot"])
        .env("LAMPLIGHT_RADV_MANIFEST", Path::new("/nowhere/radeon.json"))
        .output()?;
    match output.status.code() {
        Some(4) if stderr_text(&output).contains("apt-get install mesa-vulkan-drivers") => Ok(()),
        code => Err(format!("exit code {code:?}: {}", stderr_text(&output)).into()),
    }
}
