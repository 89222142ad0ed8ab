//! MSL: clang, with headers of our own.

use std::sync::Arc;

use super::{Found, Output, Refusal, Work, divide_group};
use crate::metal::{Clang, judge_batch};

const BATCH: usize = 64;

pub fn plan_msl<'w>(group: &'w [&'w Output]) -> Result<Vec<Work<'w>>, String> {
    let clang = Arc::new(Clang::open().map_err(|missing| missing.reason)?);
    Ok(divide_group(group, BATCH, move |outputs| judge_msl(&clang, outputs)))
}

fn judge_msl(clang: &Clang, outputs: &[&Output]) -> Found {
    let texts = outputs.iter().map(|output| output.text()).collect::<Result<Vec<_>, _>>()?;
    let texts: Vec<(usize, &str)> = texts.iter().map(String::as_str).enumerate().collect();
    let refused = judge_batch(clang, &texts).map_err(|missing| missing.reason)?;
    let one = |refused: crate::metal::Refusal| Refusal {
        output: outputs[refused.index].clone(),
        judge: "clang",
        line: refused.errors.split(':').next().and_then(|line| line.parse().ok()),
        words: refused.errors,
    };
    Ok(refused.into_iter().map(one).collect())
}
