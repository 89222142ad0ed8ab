//! What the validators of all targets say of a bundle's outputs.

use std::collections::BTreeMap;

use lamplight_bundle::{Hash, Target};
use lamplight_generate::cache::Cache;
use lamplight_generate::{TargetValidation, Validation};
use lamplight_validate::on_large_stack;
use rayon::prelude::*;

use crate::agreement::sample_of_lines;
use crate::known::KnownOutputs;
use crate::lines::{SeenLines, texts_of_units, with_new_lines};
use crate::{
    Extent, Output, Refusal, Tint, ValidatorProgress, missing, validate_timed, validator_of,
    validator_versions,
};

/// The result of validating outputs.
#[derive(Debug, Default)]
pub struct Verdict {
    /// What was validated, and what is missing.
    pub validation: Validation,
    /// What was refused.
    pub refusals: Vec<Refusal>,
}

/// What is validated of one target.
struct TargetPlan<'o> {
    target: Target,
    chosen: Vec<&'o Output>,
    /// What is only read again.
    sample: Vec<&'o Output>,
    all: &'o [Output],
    known: KnownOutputs,
    report: TargetValidation,
}

/// Validates outputs that are not known to pass, on all cores. Those that pass are remembered in
/// the cache by their content, and by the versions of their validators. If a validator is missing,
/// the verdict says so, and the others are asked.
///
/// # Errors
/// A message, if a validator cannot be run.
pub fn verdict(
    mut outputs: Vec<Output>,
    extent: Extent,
    cache: Option<&Cache>,
    tint: &Tint,
    progress: ValidatorProgress<'_>,
) -> Result<Verdict, String> {
    let extent_name = extent.name().to_owned();
    let validation = Validation { extent: extent_name, targets: Vec::new() };
    let mut verdict = Verdict { validation, ..Verdict::default() };
    if extent == Extent::Nothing {
        return Ok(verdict);
    }
    outputs.sort();
    outputs.dedup_by(|one, other| {
        (&one.file, one.target, &one.description) == (&other.file, other.target, &other.description)
    });
    let found = on_large_stack(|| {
        let texts = match extent {
            Extent::Lines => texts_of_units(&outputs),
            Extent::All | Extent::Nothing => BTreeMap::new(),
        };
        let alike: Vec<&[Output]> =
            outputs.chunk_by(|one, other| one.target == other.target).collect();
        let plans = alike.par_iter().map(|all| plan_target(all, extent, &texts, cache, tint));
        let plans = plans.collect::<Result<Vec<TargetPlan<'_>>, String>>()?;
        let chosen: Vec<&Output> = plans.iter().flat_map(|plan| plan.chosen.clone()).collect();
        // A part of the validators of WGSL can go on without Tint.
        let is_tint_there = missing(Target::WGSL, tint).is_none();
        let sample: Vec<&Output> = plans.iter().flat_map(|plan| plan.sample.clone()).collect();
        let validated = validate_timed(&chosen, &sample, is_tint_there.then_some(tint), progress)?;
        Ok::<_, String>((plans, validated))
    });
    let (plans, (refusals, seconds)) = found?;
    for mut plan in plans {
        plan.report.seconds = seconds.get(&plan.target).copied().unwrap_or_default();
        plan.remember(&refusals, extent, cache);
        verdict.validation.targets.push(plan.report);
    }
    verdict.refusals = refusals;
    Ok(verdict)
}

/// Chooses what is validated of one target.
fn plan_target<'o>(
    all: &'o [Output],
    extent: Extent,
    texts: &BTreeMap<Hash, &Output>,
    cache: Option<&Cache>,
    tint: &Tint,
) -> Result<TargetPlan<'o>, String> {
    let target = all[0].target;
    let versions = validator_versions(target, tint);
    let mut known = KnownOutputs::load(cache, target, extent, &versions);
    let (validator, named) =
        validator_of(target).ok_or_else(|| format!("no validator of `{target}`"))?;
    let lacks = missing(target, tint);
    let mut report = TargetValidation {
        target: target.name().to_owned(),
        missing: lacks.as_ref().map(ToString::to_string),
        outputs: all.len(),
        ..TargetValidation::default()
    };
    if lacks.is_some() && !validator.goes_on {
        return Ok(TargetPlan {
            target,
            chosen: Vec::new(),
            sample: Vec::new(),
            all: &[],
            known,
            report,
        });
    }
    report.validators = (validator.validators)(named.rules, tint);
    let (old, fresh): (Vec<&Output>, Vec<&Output>) =
        all.iter().partition(|output| known.names.contains(&output.name()));
    report.before = old.len();
    let mut sample = Vec::new();
    let chosen = match extent {
        Extent::Lines => {
            let mut seen = SeenLines::before(std::mem::take(&mut known.lines));
            let chosen = with_new_lines(&fresh, texts, &mut seen)?;
            report.lines = Some(seen.new);
            known.lines = seen.hashes;
            sample = sample_of_lines(&fresh, &chosen);
            chosen
        }
        Extent::All | Extent::Nothing => fresh,
    };
    report.now = chosen.len();
    Ok(TargetPlan { target, chosen, sample, all, known, report })
}

impl TargetPlan<'_> {
    /// Stores what passed. If a line is refused, it is not known which other lines passed, so none
    /// is stored.
    fn remember(&mut self, refusals: &[Refusal], extent: Extent, cache: Option<&Cache>) {
        let mut refused =
            refusals.iter().filter(|refusal| refusal.output.target == self.target).peekable();
        if extent == Extent::Lines && refused.peek().is_some() {
            return;
        }
        self.known.names.extend(self.all.iter().map(Output::name));
        for refusal in refused {
            self.known.names.remove(&refusal.output.name());
        }
        self.known.keep(cache);
    }
}
