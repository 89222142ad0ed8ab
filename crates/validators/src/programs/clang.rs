//! MSL: clang, with headers of our own in the place of Metal's. It has no rules.

use std::sync::Arc;

use crate::{
    Output, OutputGroup, Refusal, ValidatorEntry, ValidatorResult, ValidatorWork, divide_group,
};
use lamplight_tools::CLANG;
use lamplight_tools::metal::{Clang, shim_hash, validate_batch};

/// The validator, for the table of all.
pub const VALIDATOR: ValidatorEntry = ValidatorEntry {
    name: "clang",
    tools: &[CLANG],
    lacks: |_| None,
    version: |_| shim_hash(),
    validators: |_, _| vec![CLANG.described()],
    goes_on: false,
    plan,
};

const BATCH: usize = 64;

fn plan<'w>(group: &OutputGroup<'w>) -> Result<Vec<ValidatorWork<'w>>, String> {
    let clang = Arc::new(Clang::open().map_err(|missing| missing.reason)?);
    Ok(divide_group(group.outputs, BATCH, move |outputs| validate_msl(&clang, outputs)))
}

fn validate_msl(clang: &Clang, outputs: &[&Output]) -> ValidatorResult {
    let texts = outputs.iter().map(|output| output.text()).collect::<Result<Vec<_>, _>>()?;
    let texts: Vec<(usize, &str)> = texts.iter().map(String::as_str).enumerate().collect();
    let refused = validate_batch(clang, &texts).map_err(|missing| missing.reason)?;
    let one = |refused: lamplight_tools::metal::MslRefusal| Refusal {
        output: outputs[refused.index].clone(),
        validator: "clang",
        line: refused.errors.split(':').next().and_then(|line| line.parse().ok()),
        message: refused.errors,
    };
    Ok(refused.into_iter().map(one).collect())
}
