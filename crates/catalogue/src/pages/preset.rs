//! The page of presets.

use std::fmt::Write as _;

use super::super::preset::Preset;
use super::super::probe::{ORDER, Probe};
use super::markdown::{escaped_prose, table_cell};
use lamplight_scenes::sets;

/// The page: presets, scenes, light probes.
pub fn preset_page(presets: &[Preset], probes: &[Probe]) -> String {
    let mut text = "# Presets\n\nEach published example is a preset. Its numbers are those that the source gives, under the names of the\n\
                    uniforms' fields. The scene chooses the values that the source leaves open: `lamplight show PRESET` lists these.\n"
        .to_owned();
    let mut work = "";
    for preset in presets {
        let (here, place) = work_and_place(preset);
        if here != work {
            let _ = write!(
                text,
                "\n## {}\n\n| preset | place | permutation | scene | numbers | |\n|---|---|---|---|---|---|\n",
                escaped_prose(here)
            );
            work = here;
        }
        write_row(&mut text, preset, place);
    }
    text.push_str("\n## Scenes\n\n| scene | what it is |\n|---|---|\n");
    for set in sets::ALL {
        let _ = writeln!(text, "| `{}` | {} |", set.name, set.about);
    }
    light_probes(&mut text, probes);
    text.push_str("\n---\n[Catalogue](README.md)\n");
    text
}

/// The work, and the place in it.
fn work_and_place(preset: &Preset) -> (&str, &str) {
    let source = preset.source.as_str();
    if !source.starts_with(preset.work()) {
        return (preset.work(), source);
    }
    let (here, place) = source
        .split_once(", example")
        .map_or((source, ""), |(here, _)| (here, &source[here.len() + 2..]));
    here.split_once(", chapter 4, ").unwrap_or((here, place))
}

fn write_row(text: &mut String, preset: &Preset, place: &str) {
    let passes = preset
        .passes
        .iter()
        .map(|pass| format!("`{}:{}`, then ", pass.program, pass.key))
        .collect::<String>();
    let numbers = preset.numbers.iter().flat_map(|(group, fields)| {
        fields.iter().map(move |(name, value)| format!("`{group}.{name}` = {value}"))
    });
    let probe = preset.probe.iter().map(|probe| format!("probe `{probe}`"));
    let numbers: Vec<String> = numbers.chain(probe).collect();
    let _ = writeln!(
        text,
        "| `{}` | {} | {passes}`{}:{}` | `{}` | {} | {} |",
        preset.name,
        table_cell(place),
        preset.program,
        preset.key,
        preset.scene,
        numbers.join("<br>"),
        table_cell(&preset_description(preset)),
    );
}

/// What a preset shows, and how that differs from the example.
fn preset_description(preset: &Preset) -> String {
    let deviations = preset.deviations.iter().map(String::as_str);
    let sentences: Vec<&str> = std::iter::once(preset.doc.as_str()).chain(deviations).collect();
    sentences.join(" ")
}

fn light_probes(text: &mut String, probes: &[Probe]) {
    let _ = write!(
        text,
        "\n## Light probes\n\nEach probe has nine coefficients in the order {}. In shaders, [`ambient::probes`](ambient/probes.md) has a function\n\
         for each probe. In Rust, `lamplight::catalogue::probe::library_probes(..)` returns them.\n\n| probe | place | L00 |\n|---|---|---|\n",
        ORDER.join(", ")
    );
    for probe in probes {
        let [r, g, b] = probe.coefficients[0];
        let _ =
            writeln!(text, "| `{}` | {} | {r}, {g}, {b} |", probe.name, table_cell(&probe.title));
    }
}
