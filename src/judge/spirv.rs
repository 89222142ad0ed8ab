//! SPIR-V: spirv-val, which takes one file at a time.

use super::{Found, Output, Refusal, Work, parts};
use crate::tools::{SPIRV_VAL, words};

const BATCH: usize = 16;

pub fn plan<'w>(group: &'w [&'w Output], environments: &'static [&'static str]) -> Vec<Work<'w>> {
    parts(group, BATCH, move |outputs| {
        let mut refusals = Vec::new();
        for output in outputs {
            refusals.extend(refusal(output, environments)?);
        }
        Ok(refusals)
    })
}

/// The refusal of the first environment that does not accept it.
fn refusal(output: &Output, environments: &[&str]) -> Found {
    for environment in environments {
        let said = SPIRV_VAL.run(&["--target-env", environment], [&output.file]);
        let said = said.map_err(|error| error.to_string())?;
        if !said.status.success() {
            let words = format!("for {environment}: {}", words(&said));
            // Its line numbers count instructions, so they say nothing about the author's text.
            return Ok(vec![Refusal {
                output: output.clone(),
                judge: "spirv-val",
                line: None,
                words,
            }]);
        }
    }
    Ok(Vec::new())
}
