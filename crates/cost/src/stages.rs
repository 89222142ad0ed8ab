//! The SPIR-V of what is measured, for compilers that are programs of their own.

use std::collections::HashMap;

use rayon::prelude::*;

use super::CostSubject;
use super::pipeline::{Pipeline, SpirvStage};
use lamplight_bundle::Stage;
use lamplight_emit::spirv::{self, op};

/// What a compiler says of one stage.
pub struct StageReport<'s, T> {
    pub subject: &'s CostSubject,
    pub stage: Stage,
    pub whole: T,
    /// For a function, the same of the stage without it.
    pub empty: Option<T>,
}

/// Asks a compiler about the stages of all subjects, in their order. Equal stages are asked once.
///
/// # Errors
/// The compiler's message where it refuses a stage, with the subject's name.
pub fn ask_stages<'s, T: Clone + Send>(
    subjects: &'s [CostSubject],
    ask: impl Fn(&SpirvStage) -> Result<T, String> + Sync,
) -> Result<Vec<StageReport<'s, T>>, String> {
    let mut places: HashMap<&SpirvStage, usize> = HashMap::new();
    let mut distinct: Vec<(&SpirvStage, &str)> = Vec::new();
    for subject in subjects {
        for words in subject.stages.iter().flat_map(|stage| words_of(subject, *stage)) {
            if *places.entry(words).or_insert(distinct.len()) == distinct.len() {
                distinct.push((words, &subject.name));
            }
        }
    }
    let results = distinct
        .par_iter()
        .map(|(words, name)| ask(words).map_err(|reason| format!("`{name}`: {reason}")));
    let answers = results.collect::<Result<Vec<T>, String>>()?;
    let mut found = Vec::new();
    for subject in subjects {
        for stage in subject.stages.iter().copied() {
            let mut of = words_of(subject, stage)
                .filter_map(|words| answers.get(places.get(words).copied()?).cloned());
            let whole = of.next().ok_or_else(|| no_stage(subject, stage))?;
            found.push(StageReport { subject, stage, whole, empty: of.next() });
        }
    }
    Ok(found)
}

/// The SPIR-V of a subject's stage, and then that of the stage without the function.
fn words_of(subject: &CostSubject, stage: Stage) -> impl Iterator<Item = &SpirvStage> {
    let pipelines = std::iter::once(&subject.pipeline).chain(subject.empty.as_ref());
    let of = move |pipeline: &'_ Pipeline| pipeline.stages.iter().position(|it| it.stage == stage);
    pipelines.filter_map(move |pipeline| pipeline.stages.get(of(pipeline)?))
}

fn no_stage(subject: &CostSubject, stage: Stage) -> String {
    format!("`{}` has no {} stage", subject.name, stage.name())
}

/// The decoration that numbers a specialisation constant.
const SPEC_ID: u32 = 1;

/// The module with the chosen values of specialisation constants as their defaults.
pub fn settled_words(stage: &SpirvStage) -> Vec<u32> {
    let mut values: HashMap<u32, u32> = HashMap::new();
    for instruction in spirv::instructions(&stage.words) {
        if let (op::DECORATE, [_, id, SPEC_ID, number]) = (instruction.op, instruction.words) {
            let chosen = stage.constants.iter().find(|(chosen, _)| chosen == number);
            values.extend(chosen.map(|(_, value)| (*id, *value)));
        }
    }
    let mut settled = stage.words.iter().take(spirv::HEADER_WORDS).copied().collect::<Vec<u32>>();
    for instruction in spirv::instructions(&stage.words) {
        let start = settled.len();
        settled.extend(instruction.words);
        let value = instruction.words.get(2).and_then(|id| values.get(id)).copied();
        match (instruction.op, value) {
            (op::SPEC_CONSTANT_TRUE | op::SPEC_CONSTANT_FALSE, Some(value)) => {
                let truth = [op::SPEC_CONSTANT_FALSE, op::SPEC_CONSTANT_TRUE];
                let truth = truth[usize::from(value != 0)];
                settled[start] = spirv::first_word(truth, instruction.words.len());
            }
            (op::SPEC_CONSTANT, Some(value)) if instruction.words.len() == 4 => {
                settled[start + 3] = value;
            }
            _ => {}
        }
    }
    settled
}
