//! MSL: clang, with headers of our own in the place of Metal's. It has no rules.

use std::sync::Arc;

use crate::judge::{Entry, Found, Group, Output, Refusal, Work, divide_group};
use crate::metal::{Clang, judge_batch, shim_hash};
use crate::tools::CLANG;

/// The judge, for the table of all.
pub const JUDGE: Entry =
    Entry { name: "clang", tools: &[CLANG], lacks: |_| None, version: |_| shim_hash(), plan };

const BATCH: usize = 64;

fn plan<'w>(group: &Group<'w>) -> Result<Vec<Work<'w>>, String> {
    let clang = Arc::new(Clang::open().map_err(|missing| missing.reason)?);
    Ok(divide_group(group.outputs, BATCH, move |outputs| judge_msl(&clang, outputs)))
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
