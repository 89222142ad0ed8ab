//! Light probes: published environments as nine spherical harmonics, and the modules that are made
//! from them.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Deserialize;

use super::reader;
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Embedded, SourceSet, Span};

/// Path of the data below the library's root.
pub const PATH: &str = "data/sh9_probes.toml";

/// The coefficients' names, in the order of the library's arrays.
pub const ORDER: [&str; 9] = ["L00", "L1m1", "L10", "L11", "L2m2", "L2m1", "L20", "L21", "L22"];

/// Radiance around a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// As in `probe_NAME`.
    pub name: String,
    /// The place, in words.
    pub title: String,
    /// Where the numbers were published.
    pub source: String,
    /// Linear RGB of each coefficient, in [`ORDER`].
    pub coefficients: [[f64; 3]; 9],
}

#[derive(Deserialize)]
#[serde(rename = "Entry")]
struct ProbeEntry {
    title: String,
    source: String,
    #[serde(flatten)]
    rows: BTreeMap<String, [f64; 3]>,
}

/// The library's light probes, by name.
pub fn library_probes(
    library: Embedded,
    sources: &mut SourceSet,
) -> Result<Vec<Probe>, Diagnostics> {
    let id = reader::add_own(library, sources, PATH)?;
    let entries: BTreeMap<toml::Spanned<String>, ProbeEntry> = reader::read_data(sources, id)?;
    let mut problems = Vec::new();
    let probes = entries.into_iter().filter_map(|(name, entry)| {
        let span = Span::new(id, name.span());
        let found = make_probe(name.into_inner(), &entry);
        if found.is_none() {
            problems.push(reader::invalid_data(
                span,
                format!("a light probe has the rows {}", ORDER.join(", ")),
            ));
        }
        found
    });
    let probes: Vec<Probe> = probes.collect();
    if problems.is_empty() { Ok(probes) } else { Err(problems) }
}

fn make_probe(name: String, entry: &ProbeEntry) -> Option<Probe> {
    let mut coefficients = [[0.0; 3]; 9];
    for (place, row) in coefficients.iter_mut().zip(ORDER) {
        *place = *entry.rows.get(row)?;
    }
    (entry.rows.len() == ORDER.len()).then(|| Probe {
        name,
        title: entry.title.clone(),
        source: entry.source.clone(),
        coefficients,
    })
}

/// First lines of the module.
const HEAD: &str = "\
//! Published light probes: radiance around ten places as nine spherical harmonics, for
//! `ambient::sh`.
//!
//! Made from `data/sh9_probes.toml` by `cargo xtask docs`: edit that file, not this one.
";

/// The module `ambient::probes` in WESL.
pub fn wesl_module(probes: &[Probe]) -> String {
    let mut text = HEAD.to_owned();
    for probe in probes {
        let _ = write!(
            text,
            "\n{}fn probe_{}() -> array<vec3f, 9> {{\n    return array<vec3f, 9>(\n",
            probe_doc(probe),
            probe.name
        );
        for row in &probe.coefficients {
            let _ = writeln!(text, "        vec3f({}),", joined_numbers(row));
        }
        text.push_str("    );\n}\n");
    }
    text
}

/// Numeric cases of the module: every coefficient as published.
pub fn numeric_cases(probes: &[Probe]) -> String {
    let mut text = CASES.to_owned();
    for probe in probes {
        let all: Vec<String> = probe.coefficients.iter().map(joined_numbers).collect();
        let _ = write!(text, "\n[[case]]\nfunction = \"probe_{}\"\n", probe.name);
        let _ = write!(
            text,
            "tolerance = {{ ulp = 0.5 }}\nrows = [{{ expect = [\n    {},\n] }}]\n",
            all.join(",\n    ")
        );
    }
    text
}

/// First lines of the cases.
const CASES: &str = "\
# The published digits, as f32 holds them.
#
# Made from `data/sh9_probes.toml` by `cargo xtask docs`: edit that file, not this one.
";

fn probe_doc(probe: &Probe) -> String {
    format!(
        "/// {}\n///\n/// Parameters: none.\n/// Returns: nine linear RGB coefficients of the radiance, ordered {}.\n/// Source: {}.\n\
         /// Edges: none.\n/// Error model: exact: the published digits.\n",
        probe_summary(probe),
        ORDER.join(", "),
        probe.source,
    )
}

fn probe_summary(probe: &Probe) -> String {
    format!("The light around a point: {}.", probe.title)
}

fn joined_numbers(row: &[f64; 3]) -> String {
    let number = |value: &f64| {
        let value = if *value == 0.0 { 0.0 } else { *value };
        if value.fract() == 0.0 { format!("{value:.1}") } else { value.to_string() }
    };
    row.iter().map(number).collect::<Vec<_>>().join(", ")
}
