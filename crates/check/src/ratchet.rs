//! The `driver` tier: the share of each function's stated tolerance that a pinned software driver
//! was measured to need. It is kept in a file that may only become stricter.
//!
//! ```toml
//! [adapter]                            # what was measured on; another driver is not compared
//! vulkan = "llvmpipe, llvmpipe, Mesa 22.3.6"
//!
//! [share."lighting::spot::cone_hard"]  # error over stated tolerance, worst of all inputs
//! eval = 0.5
//! vulkan = 0.5
//!
//! [share."lighting::spot::cone_hard#2"]  # of the function's second case
//! eval = 0.1
//!
//! [[waiver]]                           # a driver that needs more than is stated, and why
//! function = "color::transfer::fog_exp"
//! executor = "gl"
//! share = 1.5
//! reason = "exp2 of this driver is 5 % worse than WGSL allows"
//! ```
//!
//! A run fails where it needs more than [`SLACK`] times what is recorded.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::check::CheckReport;
use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, codes};
use toml::{Table, Value};

/// File name below a package's root.
pub const FILE: &str = "tolerances.toml";
/// A run may need this many times what is recorded, since processors differ in fused operations and
/// rounding.
pub const SLACK: f64 = 2.0;
/// The smallest share that is recorded, so that an exact result does not become a bound of 0.
const LEAST: f64 = 0.001;

const HEADER: &str = "# The driver tier: error over stated tolerance, worst of all inputs, as measured on the adapters
# below. A check fails where it needs more than twice as much. `lamplight check --bless` lowers
# the shares to what it measures; `--force` may also raise them. A waiver needs a reason.
";

/// The content of the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ratchet {
    /// The adapter of each executor, without what is in parentheses.
    pub adapters: BTreeMap<String, String>,
    /// The shares by case ([`Outcome::record`](super::check::Outcome::record)) and executor.
    pub shares: BTreeMap<String, BTreeMap<String, f64>>,
    pub waivers: Vec<Waiver>,
}

/// An executor that may need more than a function's stated tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct Waiver {
    pub function: String,
    pub executor: String,
    /// Largest error over stated tolerance.
    pub share: f64,
    pub reason: String,
}

impl Ratchet {
    /// Reads the file.
    pub fn parse(text: &str, id: SourceId) -> Result<Self, Diagnostic> {
        let table: Table = toml::from_str(text).map_err(|error| {
            let span = Span::new(id, error.span().unwrap_or(0..0));
            Diagnostic::error(codes::CASE_SYNTAX, error.message().to_owned()).at(span, "here")
        })?;
        let wrong = |what: String| {
            Diagnostic::error(codes::CASE_INVALID, what).at(Span::new(id, 0..0), "in this file")
        };
        let texts = |value: &Value| value.as_str().map(str::to_owned);
        let adapters = table_entries(&table, "adapter")
            .filter_map(|(name, value)| Some((name.clone(), texts(value)?)))
            .collect();
        let shares = |value: &Value| -> BTreeMap<String, f64> {
            value
                .as_table()
                .into_iter()
                .flatten()
                .filter_map(|(name, value)| Some((name.clone(), number_of(value)?)))
                .collect()
        };
        let shares = table_entries(&table, "share")
            .map(|(name, value)| (name.clone(), shares(value)))
            .collect();
        let waivers = table.get("waiver").and_then(Value::as_array).into_iter().flatten();
        let waivers = waivers.map(|value| {
            read_waiver(value).ok_or_else(|| {
                wrong(
                    "a waiver has a `function`, an `executor`, a `share` and a `reason`".to_owned(),
                )
            })
        });
        Ok(Self { adapters, shares, waivers: waivers.collect::<Result<_, _>>()? })
    }

    /// The file's text.
    pub fn text(&self) -> String {
        let mut text = format!("{HEADER}\n[adapter]\n");
        for (executor, adapter) in &self.adapters {
            let _ = writeln!(text, "{executor} = {adapter:?}");
        }
        for (function, shares) in &self.shares {
            let _ = writeln!(text, "\n[share.{function:?}]");
            for (executor, share) in shares {
                let _ = writeln!(text, "{executor} = {share:?}");
            }
        }
        for Waiver { function, executor, share, reason } in &self.waivers {
            let _ = write!(
                text,
                "\n[[waiver]]\nfunction = {function:?}\nexecutor = {executor:?}\nshare = {share:?}\nreason = {reason:?}\n"
            );
        }
        text
    }

    /// The waivers without any adapters and shares, so that everything is measured again.
    pub fn waivers_only(&self) -> Self {
        Self { waivers: self.waivers.clone(), ..Self::default() }
    }

    /// The recorded share of a case on an executor, if it was measured on that adapter.
    pub fn share(&self, record: &str, executor: &str, adapter: &str) -> Option<f64> {
        self.adapters.get(executor).filter(|known| **known == pinned_adapter(adapter))?;
        self.shares.get(record)?.get(executor).copied()
    }

    /// The waiver of a function on an executor.
    pub fn waiver(&self, function: &str, executor: &str) -> Option<&Waiver> {
        self.waivers
            .iter()
            .find(|waiver| waiver.function == function && waiver.executor == executor)
    }

    /// Lowers the shares to what a report measured. They are raised only by force. Shares from
    /// another adapter are measured again. What fails is not recorded.
    pub fn bless(&mut self, report: &CheckReport, force: bool) {
        for (executor, adapter) in report
            .outcomes
            .iter()
            .map(|outcome| (outcome.executor, pinned_adapter(&outcome.adapter)))
        {
            if self.adapters.get(executor) != Some(&adapter) {
                self.shares
                    .values_mut()
                    .for_each(|shares| shares.retain(|known, _| known != executor));
                self.adapters.insert(executor.to_owned(), adapter);
            }
        }
        for ((record, executor), measured) in measured_shares(report) {
            let shares = self.shares.entry(record).or_default();
            let known = shares.get(executor).copied().filter(|_| !force).unwrap_or(f64::INFINITY);
            shares.insert(executor.to_owned(), known.min(measured));
        }
    }
}

/// The worst share of each case and executor that passes, rounded up.
fn measured_shares(report: &CheckReport) -> BTreeMap<(String, &'static str), f64> {
    let mut found = BTreeMap::new();
    for outcome in report.outcomes.iter().filter(|outcome| outcome.is_within()) {
        let Ok(verdict) = &outcome.verdict else { continue };
        let share = verdict.worst.map_or(0.0, |worst| worst.share());
        if share.is_finite() {
            let share = ((share / LEAST).ceil() * LEAST * 1e6).round() / 1e6;
            let known: &mut f64 =
                found.entry((outcome.record.clone(), outcome.executor)).or_insert(LEAST);
            *known = known.max(share);
        }
    }
    found
}

/// An adapter's name without what is in parentheses, such as the width of vectors, which differs
/// between processors.
pub fn pinned_adapter(adapter: &str) -> String {
    let mut depth = 0;
    let mut kept = String::new();
    for letter in adapter.chars() {
        depth += i32::from(letter == '(');
        if depth == 0 {
            kept.push(letter);
        }
        depth -= i32::from(letter == ')');
    }
    kept.split_whitespace().collect::<Vec<_>>().join(" ").replace(" ,", ",")
}

fn table_entries<'t>(
    table: &'t Table,
    name: &str,
) -> impl Iterator<Item = (&'t String, &'t Value)> {
    table.get(name).and_then(Value::as_table).into_iter().flatten()
}

fn number_of(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|number| number as f64))
}

fn read_waiver(value: &Value) -> Option<Waiver> {
    let text =
        |name: &str| value.get(name)?.as_str().filter(|text| !text.is_empty()).map(str::to_owned);
    Some(Waiver {
        function: text("function")?,
        executor: text("executor")?,
        share: number_of(value.get("share")?)?,
        reason: text("reason")?,
    })
}
