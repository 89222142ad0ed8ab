//! WGSL: naga, which is part of this program, and Tint, the compiler of Chromium and Dawn. There
//! are no rules.


use crate::agreement::module_differences;
use crate::tint::TintMistake;
use crate::{
    Output, OutputGroup, Refusal, Tint, ValidatorEntry, ValidatorResult, ValidatorWork,
    divide_group,
};
use lamplight_tools::NODE;
use lamplight_validate::{guard, info_for_some, parse_wgsl};

/// The validator, for the table of all.
pub const VALIDATOR: ValidatorEntry = ValidatorEntry {
    name: "naga_tint",
    tools: &[NODE],
    lacks: Tint::missing,
    version: |tint| format!("naga {} tint {}", env!("LAMPLIGHT_NAGA"), tint.version()),
    validators,
    // naga is a part of this program.
    goes_on: true,
    plan,
};

/// How many texts naga gets at once, and how many each start of node.
const BATCH: usize = 64;
const TINT_BATCH: usize = 512;

fn plan<'w>(group: &OutputGroup<'w>) -> Result<Vec<ValidatorWork<'w>>, String> {
    let mut works = divide_group(group.outputs, BATCH, |outputs: &[&Output]| {
        let found = outputs.iter().map(|output| by_naga(output));
        Ok(found.collect::<Result<Vec<_>, String>>()?.into_iter().flatten().collect())
    });
    if let Some(tint) = group.tint {
        works.extend(divide_group(group.outputs, TINT_BATCH, move |outputs: &[&Output]| {
            by_tint(outputs, tint)
        }));
    }
    Ok(works)
}

fn validators(_: &[&str], tint: &Tint) -> Vec<String> {
    let naga = format!("naga {}", env!("LAMPLIGHT_NAGA"));
    let is_tint_there = NODE.path().is_some() && tint.missing().is_none();
    let tint = is_tint_there.then(|| format!("Tint {}", tint.version()));
    [naga].into_iter().chain(tint).collect()
}

fn by_naga(output: &Output) -> Result<Option<Refusal>, String> {
    let text = output.text()?;
    let validated = guard(&text, || {
        let at_line = |line: Option<u32>, message: String| (line, message);
        let module = parse_wgsl(&text).map_err(|error| {
            let line = error.location(&text).map(|place| place.line_number);
            at_line(line, error.emit_to_string(&text))
        })?;
        let info = info_for_some(&module).map_err(|error| {
            let line = error.location(&text).map(|place| place.line_number);
            at_line(line, error.emit_to_string(&text))
        })?;
        Ok(module_differences(module, info, output.described()))
    });
    let validated = validated.unwrap_or_else(|error| Err((None, error.message)));
    let refusal =
        |(line, message)| Refusal { output: output.clone(), validator: "naga", line, message };
    Ok(match validated {
        Ok(differences) => output.disagreement(&differences),
        Err(error) => Some(refusal(error)),
    })
}

fn by_tint(outputs: &[&Output], tint: &Tint) -> ValidatorResult {
    let files: Vec<_> = outputs.iter().map(|output| &*output.file).collect();
    let mistakes = tint.validate(&files)?;
    let one = |mistake: TintMistake| {
        let output =
            outputs.get(mistake.index).ok_or("Tint validated a text that it was not given")?;
        let message = format!("{}:{}: error: {}", mistake.line, mistake.column, mistake.message);
        Ok(Refusal {
            output: (*output).clone(),
            validator: "Tint",
            line: Some(mistake.line),
            message,
        })
    };
    mistakes.into_iter().map(one).collect()
}
