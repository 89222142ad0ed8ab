//! Presets and light probes.

use serde_json::{Value, json};

use super::ShownItem;
use crate::catalogue::preset::{Preset, PresetPass, SAFE};
use crate::catalogue::probe::{ORDER, Probe};
use crate::cli::text::{rows_text, wrap_words};

/// A preset with its numbers.
pub fn show_preset(preset: &Preset) -> ShownItem {
    let mut facts = vec![vec!["source".to_owned(), preset.source.clone()]];
    facts.extend(preset.passes.iter().map(|pass| vec!["first".to_owned(), permutation_text(pass)]));
    facts.push(vec!["program".to_owned(), preset.program.clone()]);
    facts.push(vec!["key".to_owned(), preset.key.replace(',', ", ")]);
    facts.extend(
        preset
            .safe
            .iter()
            .map(|key| vec!["safe form".to_owned(), format!("{SAFE} {}", key.replace(',', ", "))]),
    );
    let of_safe = preset.safe_light.iter();
    facts.extend(of_safe.map(|(name, value)| vec![String::new(), format!("light.{name} {value}")]));
    facts.push(vec!["scene".to_owned(), preset.scene.clone()]);
    facts.extend(preset.probe.iter().map(|probe| vec!["light probe".to_owned(), probe.clone()]));
    let about = format!("{} {}", preset.doc, preset.look);
    let mut text =
        format!("{}\n\n{}\n{}", preset.name, wrap_words(&about, 2), rows_text(&facts, 2));
    let numbers: Vec<Vec<String>> = preset
        .numbers
        .iter()
        .flat_map(|(group, fields)| {
            fields
                .iter()
                .map(move |(name, value)| vec![format!("{group}.{name}"), value.to_string()])
        })
        .collect();
    if !numbers.is_empty() {
        text += &format!("\nNumbers\n{}", rows_text(&numbers, 2));
    }
    if !preset.open.is_empty() {
        let open: Vec<&str> = preset.open.iter().map(String::as_str).collect();
        text += &format!("\nLeft open by the source\n{}", wrap_words(&open.join(", "), 2));
    }
    if !preset.deviations.is_empty() {
        let deviations = preset.deviations.iter().map(|deviation| wrap_words(deviation, 2));
        text += &format!("\nDifferences from the source\n{}", deviations.collect::<String>());
    }
    ShownItem { text, json: preset_json(preset) }
}

/// A preset as an object.
pub fn preset_json(preset: &Preset) -> Value {
    json!({
        "preset": preset.name,
        "summary": preset.doc,
        "look": preset.look,
        "source": preset.source,
        "program": preset.program,
        "key": preset.key,
        "safe": preset.safe,
        "safe_light": preset.safe_light,
        "scene": preset.scene,
        "probe": preset.probe,
        "passes": preset.passes,
        "numbers": preset.numbers,
        "open": preset.open,
        "deviations": preset.deviations,
    })
}

fn permutation_text(pass: &PresetPass) -> String {
    if pass.key == "default" {
        pass.program.clone()
    } else {
        format!("{} {}", pass.program, pass.key)
    }
}

/// A light probe with its coefficients.
pub fn show_probe(probe: &Probe) -> ShownItem {
    let number = |value: f64| format!("{value:>9}");
    let table: Vec<Vec<String>> = ORDER
        .iter()
        .zip(&probe.coefficients)
        .map(|(name, row)| {
            vec![(*name).to_owned(), number(row[0]), number(row[1]), row[2].to_string()]
        })
        .collect();
    let function = format!("ambient::probes::probe_{}", probe.name);
    let text = format!(
        "{}\n\n{}{}\n{}\n  {function}\n",
        probe.name,
        wrap_words(&probe.title, 2),
        wrap_words(&probe.source, 2),
        rows_text(&table, 2)
    );
    ShownItem { text, json: probe_json(probe) }
}

/// A light probe as an object.
pub fn probe_json(probe: &Probe) -> Value {
    let rows: serde_json::Map<String, Value> = ORDER
        .iter()
        .zip(&probe.coefficients)
        .map(|(name, row)| ((*name).to_owned(), json!(row)))
        .collect();
    json!({ "probe": probe.name, "title": probe.title, "source": probe.source, "coefficients": rows })
}
