//! Costs that a package has recorded.

use std::fs;

use serde_json::{Value, json};

use super::session::{MAIN, Session};
use super::{Outcome, expect};

/// Hover of an axis tells its recorded cost, and nothing of costs where none are recorded.
pub fn recorded() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let text = |found: &Value| found["contents"]["value"].as_str().unwrap_or_default().to_owned();
    let without = text(&session.at("textDocument/hover", MAIN, "cone ==", json!({}))?);
    expect(!without.contains("navi21"), &without)?;
    let row = |axis: &str, value: &str, figure: i64| {
        format!(
            "{{ program = \"lamp\", axis = \"{axis}\", value = \"{value}\", stage = \"fragment\", \
             pairs = 2, instructions = [{figure}, {figure}, {figure}], vgprs = 0, waves = [32, 32], \
             inverse_throughput = 0 }}"
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
