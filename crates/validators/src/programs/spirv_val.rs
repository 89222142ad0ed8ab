//! SPIR-V: spirv-val, which takes one file at a time. A rule is an environment, such as
//! `vulkan1.0`.

use crate::{
    Output, OutputGroup, Refusal, ValidatorEntry, ValidatorResult, ValidatorWork, divide_group,
};
use lamplight_tools::{SPIRV_VAL, output_text};

/// The validator, for the table of all.
pub const VALIDATOR: ValidatorEntry = ValidatorEntry {
    name: "spirv_val",
    tools: &[SPIRV_VAL],
    lacks: |_| None,
    version: |_| String::new(),
    validators: |_, _| vec![SPIRV_VAL.described()],
    goes_on: false,
    plan,
};

const BATCH: usize = 16;

fn plan<'w>(group: &OutputGroup<'w>) -> Result<Vec<ValidatorWork<'w>>, String> {
    let environments = group.rules;
    Ok(divide_group(group.outputs, BATCH, move |outputs| {
        let mut refusals = Vec::new();
        for output in outputs {
            refusals.extend(first_refusal(output, environments)?);
        }
        Ok(refusals)
    }))
}

/// The refusal of the first environment that does not accept it.
fn first_refusal(output: &Output, environments: &[&str]) -> ValidatorResult {
    for environment in environments {
        let result = SPIRV_VAL.run(&["--target-env", environment], [&output.file]);
        let result = result.map_err(|error| error.to_string())?;
        if !result.status.success() {
            let message = format!("for {environment}: {}", output_text(&result));
            // Its line numbers count instructions, so they say nothing about the author's text.
            return Ok(vec![Refusal {
                output: output.clone(),
                validator: "spirv-val",
                line: None,
                message,
            }]);
        }
    }
    Ok(Vec::new())
}
