//! Reads case files. They say which inputs to try with a function, which results to expect, and how
//! far results may be off.
//!
//! A file `NAME.toml` beside `NAME.wesl` and `NAME.glsl` holds the cases of that module:
//!
//! ```toml
//! [fixture.step]                           # textures and samplers, by name
//! kind = "depth_2d"                        # depth_2d, depth_cube, color_2d, color_cube, sampler
//! size = [8, 8]
//! pattern = "half_plane"                   # constant, gradient, checker, half_plane, box; or `texels`
//! low = 0.25
//! high = 1.0
//!
//! [[case]]
//! function = "cone_exponent"
//! where = "c >= -1 && c <= 1"              # rows that are kept
//! near = "c - cutoff"                      # within `margin` of 0, either branch is right ...
//! margin = 1e-6
//! ambiguous = 0.05                         # ... for at most this share of the rows
//! tolerance = { ulp = 4, pow = { base = "c", exponent = "e" } }
//! laws = [{ range = [0, 1] }, { rising = "c" }]
//! fixtures = { map = "step" }              # texture parameters: fixture by name
//!
//! [case.inputs]                            # every combination; with `mode = "zip"`, side by side
//! c = [{ grid = [-1, 1], count = 33 }, { around = 0.8, ulps = 4 }]
//! cutoff = [0.5, 0.8]
//! e = { log = [1, 128], count = 8 }
//! ```
//!
//! Domains: a number; `values` (a list, vectors as lists); `grid`, `log` (`[low, high]` with
//! `count`); `random` (also `seed`); `unit = COUNT` (the axes first); `hemisphere = "n"` (unit, on
//! the side of the parameter `n`), `grazing = "n"` (unit, nearly at right angles to it), both with
//! `count`; `same = "n"`; `around = VALUE` with `ulps`; `special = "plain" | "small" | "all"`; and
//! arrays of these, in which an array lists values: `n = [{ unit = 8 }, [[0, 0, 0], [0, 0, 1]]]`.
//! Fields of structs are named by path (`light.kind = 3`); those not named are 0.
//!
//! Oracles, of which only the first needs Rust:
//!
//! | given | expected is |
//! |---|---|
//! | `oracle = "reference"` | the f64 reference of `crates/check/src/references/` with the function's path |
//! | `formula = "max(dot(n, l), 0)"` | the formula's value (see [`super::formula`]) |
//! | `rows` instead of `inputs` | a table of `{ c = 0.9, ..., expect = [...] }` |
//! | `oracle = "eval"` | what the code itself gives in f64; what rounding to f32 may add to it is allowed |
//! | `oracle = "none"` | nothing: laws alone |
//!
//! Without any of them, the reference is the oracle if there is one, else `eval`.
//!
//! Error terms are listed in [`super::tolerance`], laws in [`super::laws`].

mod domain;
mod fixtures;
mod law;
mod reader;
mod rows;
mod values;

pub use domain::{Domain, word_of};
pub use rows::{Rows, case_rows, spend_steps, words_to_numbers};
pub use values::Random;

use std::collections::BTreeMap;
use std::sync::Arc;

use super::formula::{Formula, Mistake, Scope};
use super::laws::{self, Law};
use super::tolerance::{self, Term};
use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::fixture::Fixture;
use lamplight_files::limits::CASES;
use reader::CaseNode;

const CASE_KEYS: &[&str] = &[
    "function",
    "inputs",
    "mode",
    "oracle",
    "formula",
    "rows",
    "tolerance",
    "where",
    "near",
    "margin",
    "ambiguous",
    "laws",
    "fixtures",
];

/// Cases of one module.
#[derive(Debug)]
pub struct CaseFile {
    pub cases: Vec<Case>,
}

impl CaseFile {
    /// Adds the law that values are finite to the first case of each function that has it in no
    /// case.
    pub fn promise_finite(&mut self) {
        let Some(kind) = laws::find_kind(laws::FINITE) else { return };
        let mut done: Vec<String> = Vec::new();
        let has_law = |case: &Case| case.laws.iter().any(|law| law.kind.name == laws::FINITE);
        let given: Vec<String> = self
            .cases
            .iter()
            .filter(|case| has_law(case))
            .map(|case| case.function.clone())
            .collect();
        for case in &mut self.cases {
            if !given.contains(&case.function) && !done.contains(&case.function) {
                case.laws.push(Law::finite(kind, laws::finite::UP_TO, case.span));
                done.push(case.function.clone());
            }
        }
    }
}

/// One function with inputs and expectations. Formulas are kept as texts until the function's
/// parameters are known.
#[derive(Debug)]
pub struct Case {
    pub function: String,
    /// Where the function is named.
    pub span: Span,
    /// The path of a parameter or a field, its values, and the place in the file.
    inputs: Vec<(String, Domain, Span)>,
    zip: bool,
    pub oracle: Oracle,
    pub tolerance: Vec<Term<FormulaText>>,
    filter: Option<FormulaText>,
    pub near: Option<(FormulaText, f64)>,
    /// The largest share of rows that may be ambiguous.
    pub ambiguous: f64,
    pub laws: Vec<Law>,
    pub fixtures: BTreeMap<String, Arc<Fixture>>,
    /// For each texture or sampler, the name of its fixture in the file.
    pub fixture_names: Vec<(String, String)>,
}

/// Where the expected value comes from.
#[derive(Debug)]
pub enum Oracle {
    /// The reference if there is one, else [`Oracle::Eval`].
    Default,
    Reference,
    /// The code's own value in f64.
    Eval,
    Formula(FormulaText),
    Table(Vec<TableRow>),
    None,
}

/// A row of a table: values by path, and what the function must return for them.
#[derive(Debug)]
pub struct TableRow {
    pub values: Vec<(String, Vec<f64>)>,
    pub expect: Vec<f64>,
    pub span: Span,
}

#[derive(Debug, Clone)]
pub struct FormulaText {
    pub text: String,
    pub span: Span,
}

impl Case {
    /// The formula that says which rows are kept.
    pub fn filter(&self) -> Option<&FormulaText> {
        self.filter.as_ref()
    }
}

impl FormulaText {
    /// Parses the formula. `scope` has the parameters of the function.
    pub fn bind(&self, scope: &Scope<'_>) -> Result<Formula, Diagnostic> {
        Formula::parse(&self.text, scope).map_err(|Mistake { range, message, note }| {
            // The span includes the quotation marks. A text with escapes is longer in the file than
            // its value.
            let exact = (self.span.end - self.span.start) as usize == self.text.len() + 2;
            let start = self.span.start as usize + 1;
            let span = if exact {
                Span::new(self.span.source, start + range.start..start + range.end)
            } else {
                self.span
            };
            let error = Diagnostic::error(codes::CASE_INVALID, message).at(span, "in this formula");
            note.into_iter().fold(error, Diagnostic::note)
        })
    }

    fn read(node: &CaseNode) -> Result<Self, Diagnostic> {
        Ok(Self { text: node.text()?.to_owned(), span: node.span })
    }
}

pub fn parse_cases(sources: &SourceSet, id: SourceId) -> Result<CaseFile, Diagnostics> {
    let root = reader::read_toml(&sources.get(id).text, id).map_err(|error| vec![error])?;
    root.only(&["case", "fixture"])?;
    let fixtures = named_fixtures(&root)?;
    let nodes =
        root.get("case").map_or(Ok(&[][..]), CaseNode::elements).map_err(|error| vec![error])?;
    if let Some(node) = nodes.get(CASES) {
        return Err(vec![node.error(format!("a file may have {CASES} cases"))]);
    }
    let (mut cases, mut errors) = (Vec::new(), Vec::new());
    for node in nodes {
        match read_case(node, &fixtures) {
            Ok(case) => cases.push(case),
            Err(found) => errors.extend(found),
        }
    }
    if errors.is_empty() { Ok(CaseFile { cases }) } else { Err(errors) }
}

fn named_fixtures(root: &CaseNode) -> Result<BTreeMap<String, Arc<Fixture>>, Diagnostics> {
    let Some(node) = root.get("fixture") else { return Ok(BTreeMap::new()) };
    let entries = node.entries().map_err(|error| vec![error])?;
    entries
        .iter()
        .map(|(key, node)| Ok((key.name.clone(), Arc::new(fixtures::read_fixture(node)?))))
        .collect()
}

fn read_case(
    node: &CaseNode,
    fixtures: &BTreeMap<String, Arc<Fixture>>,
) -> Result<Case, Diagnostics> {
    node.only(CASE_KEYS)?;
    let mut inputs = Vec::new();
    if let Some(table) = node.get("inputs") {
        for (key, inner) in table.entries().map_err(|error| vec![error])? {
            domain::read_domains(&key.name, inner, &mut inputs)?;
        }
    }
    let inputs = inputs.into_iter().map(|(path, domain, node)| (path, domain, node.span)).collect();
    read_simple(node, fixtures, inputs).map_err(|error| vec![error])
}

fn read_simple(
    node: &CaseNode,
    fixtures: &BTreeMap<String, Arc<Fixture>>,
    inputs: Vec<(String, Domain, Span)>,
) -> Result<Case, Diagnostic> {
    let function = node.required("function")?;
    let text = |name: &str| node.get(name).map(FormulaText::read).transpose();
    let number = |name: &str, default: f64| node.get(name).map_or(Ok(default), CaseNode::number);
    let margin = number("margin", 1e-6)?;
    Ok(Case {
        function: function.text()?.to_owned(),
        span: function.span,
        inputs,
        zip: node
            .get("mode")
            .map_or(Ok(false), |node| node.choice(&[("product", false), ("zip", true)]))?,
        oracle: read_oracle(node)?,
        tolerance: node.get("tolerance").map_or(Ok(Vec::new()), tolerance_terms)?,
        filter: text("where")?,
        near: text("near")?.map(|near| (near, margin)),
        ambiguous: number("ambiguous", 0.02)?,
        laws: node.get("laws").map_or(Ok(Vec::new()), |laws| {
            laws.one_or_more().iter().map(law::read_law).collect()
        })?,
        fixtures: chosen_fixtures(node, fixtures)?,
        fixture_names: fixture_names(node)?,
    })
}

fn chosen_fixtures(
    node: &CaseNode,
    fixtures: &BTreeMap<String, Arc<Fixture>>,
) -> Result<BTreeMap<String, Arc<Fixture>>, Diagnostic> {
    let Some(table) = node.get("fixtures") else { return Ok(BTreeMap::new()) };
    let chosen = table.entries()?.iter().map(|(parameter, name)| {
        let wanted = name.text()?;
        let found = fixtures.get(wanted).ok_or_else(|| {
            name.error(format!("there is no fixture `{wanted}`"))
                .suggest(wanted, fixtures.keys().map(String::as_str))
        })?;
        Ok((parameter.name.clone(), found.clone()))
    });
    chosen.collect()
}

fn fixture_names(node: &CaseNode) -> Result<Vec<(String, String)>, Diagnostic> {
    let Some(table) = node.get("fixtures") else { return Ok(Vec::new()) };
    table
        .entries()?
        .iter()
        .map(|(parameter, name)| Ok((parameter.name.clone(), name.text()?.to_owned())))
        .collect()
}

/// The name of an oracle that needs nothing else, and the oracle.
type NamedOracle = (&'static str, fn() -> Oracle);

const ORACLES: &[NamedOracle] =
    &[("reference", || Oracle::Reference), ("eval", || Oracle::Eval), ("none", || Oracle::None)];

fn read_oracle(node: &CaseNode) -> Result<Oracle, Diagnostic> {
    if let Some(formula) = node.get("formula") {
        return FormulaText::read(formula).map(Oracle::Formula);
    }
    if let Some(rows) = node.get("rows") {
        return rows.elements()?.iter().map(table_row).collect::<Result<_, _>>().map(Oracle::Table);
    }
    node.get("oracle").map_or(Ok(Oracle::Default), |node| Ok(node.choice(ORACLES)?()))
}

fn table_row(node: &CaseNode) -> Result<TableRow, Diagnostic> {
    let expect = node.required("expect")?.numbers()?;
    Ok(TableRow { values: values_by_path("", node, &["expect"])?, expect, span: node.span })
}

/// The values of a table by path. Tables within it are fields.
fn values_by_path(
    prefix: &str,
    node: &CaseNode,
    skipped: &[&str],
) -> Result<Vec<(String, Vec<f64>)>, Diagnostic> {
    let mut values = Vec::new();
    for (key, inner) in
        node.entries()?.iter().filter(|(key, _)| !skipped.contains(&key.name.as_str()))
    {
        let path = format!("{prefix}{}", key.name);
        match inner.value {
            reader::CaseValue::Table(_) => {
                values.extend(values_by_path(&format!("{path}."), inner, &[])?)
            }
            _ => values.push((path, inner.numbers()?)),
        }
    }
    Ok(values)
}

fn tolerance_terms(node: &CaseNode) -> Result<Vec<Term<FormulaText>>, Diagnostic> {
    let mut terms = Vec::new();
    for table in node.one_or_more() {
        let only = table.get("for").map(|node| node.text().map(str::to_owned)).transpose()?;
        for (key, value) in table.entries()?.iter().filter(|(key, _)| key.name != "for") {
            let kind = tolerance::find_kind(&key.name).ok_or_else(|| {
                let error = Diagnostic::error(
                    codes::CASE_INVALID,
                    format!("unknown error term `{}`", key.name),
                )
                .at(key.span, "not known");
                error.suggest(&key.name, tolerance::TERMS.iter().map(|kind| kind.name))
            })?;
            for one in value.one_or_more() {
                let (coefficient, formulas) = term_parts(kind, one)?;
                terms.push(Term { kind, coefficient, formulas, only: only.clone() });
            }
        }
    }
    Ok(terms)
}

/// The coefficient and the formulas of a term. A term without formulas is a plain number, which is
/// its coefficient.
fn term_parts(
    kind: &tolerance::TermKind,
    node: &CaseNode,
) -> Result<(f64, Vec<FormulaText>), Diagnostic> {
    if kind.formulas.is_empty() {
        return Ok((node.number()?, Vec::new()));
    }
    let known: Vec<_> = kind.formulas.iter().copied().chain(["ulp"]).collect();
    node.only(&known).map_err(|mut errors| errors.remove(0))?;
    let coefficient = node.get("ulp").map_or(Ok(kind.default), CaseNode::number)?;
    Ok((
        coefficient,
        kind.formulas
            .iter()
            .map(|name| FormulaText::read(node.required(name)?))
            .collect::<Result<_, _>>()?,
    ))
}
