//! The validators' verdicts on a run's outputs, as a part of its summary.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::summary::counted_words;

/// What was validated. No output was refused, since a refusal ends a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Validation {
    /// The value of `--validate`.
    pub extent: String,
    /// By name of the target.
    pub targets: Vec<TargetValidation>,
}

/// What was validated of one target.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TargetValidation {
    /// Name of the target.
    pub target: String,
    /// The validators that were asked, each with its version.
    pub validators: Vec<String>,
    /// What is not installed, with the command that installs it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub missing: Option<String>,
    /// Distinct outputs of the bundle.
    pub outputs: usize,
    /// Outputs that were validated in this run.
    pub now: usize,
    /// Outputs that an earlier run validated, or whose lines it did.
    pub before: usize,
    /// Distinct lines of the outputs that this run looked at, if lines decide what is validated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lines: Option<usize>,
    /// The time that the validators took, added over all cores.
    pub seconds: f64,
}

impl Validation {
    /// The messages about what is not installed, each once.
    pub fn missing(&self) -> Vec<&str> {
        let mut missing: Vec<&str> =
            self.targets.iter().filter_map(|target| target.missing.as_deref()).collect();
        missing.sort_unstable();
        missing.dedup();
        missing
    }

    /// The same for a later run that had nothing to validate.
    #[must_use]
    pub fn earlier(mut self) -> Self {
        for target in &mut self.targets {
            if !target.validators.is_empty() {
                (target.now, target.before) = (0, target.outputs);
            }
            target.seconds = 0.0;
        }
        self
    }
}

impl fmt::Display for Validation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.targets.iter().try_for_each(|target| write!(f, "{target}"))?;
        let sum = |count: fn(&TargetValidation) -> usize| self.targets.iter().map(count).sum();
        let now: usize = sum(|target| target.now);
        let before: usize = sum(|target| target.before);
        writeln!(f, "{} validated, {before} known to pass", counted_words(now, "output"))
    }
}

impl fmt::Display for TargetValidation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { target, validators, missing, outputs, now, before, lines, seconds } = self;
        if let Some(missing) = missing {
            let what = if validators.is_empty() { "not validated" } else { "not all validated" };
            writeln!(f, "{target:8} {what}: {missing}")?;
        }
        if validators.is_empty() {
            return Ok(());
        }
        let by = validators.join(", ");
        match (lines, before == outputs) {
            (_, true) => writeln!(f, "{target:8} {outputs:6} known to pass, by {by}"),
            (Some(lines), false) => {
                let of = format!("{now} of {outputs} validated, for {lines} distinct lines");
                writeln!(f, "{target:8} {of}, by {by} in {seconds:.1} s")
            }
            (None, false) => {
                writeln!(f, "{target:8} {now} of {outputs} validated, by {by} in {seconds:.1} s")
            }
        }
    }
}
