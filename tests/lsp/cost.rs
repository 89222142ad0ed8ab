//! Costs that a package has recorded.

use std::fs;
use std::process::Command;

use serde_json::{Value, json};

use super::session::{MAIN, Session};
use super::{Outcome, expect};

/// Hover of an axis shows its recorded cost, and nothing of costs where none are recorded.
pub fn recorded() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let text = |found: &Value| found["contents"]["value"].as_str().unwrap_or_default().to_owned();
    let without = text(&session.at("textDocument/hover", MAIN, "cone ==", json!({}))?);
    expect(!without.contains("navi21"), &without)?;
    let row = |axis: &str, value: &str, figure: i64| {
        format!(
            "{{ program = \"lamp\", axis = \"{axis}\", value = \"{value}\", stage = \"fragment\", \
             pairs = 2, cycles = [{figure}, {figure}, {figure}], texture = 0, \
             instructions = {figure}, vgprs = 0, waves = [32, 32] }}"
        )
    };
    let record = format!(
        "driver = \"Mesa 22\"\ngpus = [{{ name = \"navi21\", generation = \"RDNA 2\" }}]\n\
         axes = [{}, {}]\n[functions]\n",
        row("cone", "soft", 7),
        row("fog", "true", 0)
    );
    fs::write(session.folder.path().join("costs.toml"), record)?;
    let cone = text(&session.at("textDocument/hover", MAIN, "cone ==", json!({}))?);
    expect(cone.contains("| `cone=soft` | fragment | 2 | +7 |"), &cone)?;
    let fog = text(&session.at("textDocument/hover", MAIN, "fog)", json!({}))?);
    expect(fog.contains("cost nothing on `navi21`"), &fog)?;
    fs::write(session.folder.path().join("costs.toml"), "driver = 3")?;
    let broken = text(&session.at("textDocument/hover", MAIN, "cone ==", json!({}))?);
    expect(broken.contains("`hard`, `soft`") && !broken.contains("navi21"), &broken)
}

/// What `lamplight variants --cost --record` writes is what hover shows.
pub fn written() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let valid = MAIN.replace("@if(TINT) sum = half(sum);", "").replace("half(sum)", "half(sum.x)");
    let valid = valid
        .replace("sum = half(sum.x)", "sum = vec3f(half(sum.x))")
        .replace("var sum = lambert(n, up);", "var sum = vec3f(lambert(n, up));")
        .replace("sum = fade(sum)", "sum = vec3f(fade(sum.x))")
        .replace("vec4f(sum)", "vec4f(sum, 1.0)");
    fs::write(session.folder.path().join("main.wesl"), &valid)?;
    let util = "fn half(x: f32) -> f32 {\n    return sqrt(abs(x)) * 0.5;\n}\n";
    fs::write(session.folder.path().join("util.wesl"), util)?;
    let variants = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
        command.args(["variants", "--cost"]).args(arguments).current_dir(session.folder.path());
        command.output()
    };
    let other = variants(&["--gpu", "navi10", "--record"])?;
    let stderr = String::from_utf8_lossy(&other.stderr).into_owned();
    expect(other.status.code() == Some(2) && stderr.contains("add it to `--gpu`"), &stderr)?;
    let done = variants(&["--gpu", "navi21", "--record"])?;
    expect(done.status.success(), &String::from_utf8_lossy(&done.stderr))?;
    let record = fs::read_to_string(session.folder.path().join("costs.toml"))?;
    expect(record.contains("axis = \"cone\", value = \"soft\""), &record)?;
    let hover = session.at("textDocument/hover", MAIN, "cone ==", json!({}))?;
    let text = hover["contents"]["value"].as_str().unwrap_or_default();
    expect(text.contains("| `cone=soft` | fragment | 2 |"), &hover)
}
