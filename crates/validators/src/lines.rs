//! Chooses outputs so that each distinct line is in one of them.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use lamplight_bundle::{Hash, Stage, Target};
use lamplight_generate::cache::hash_parts;
use memchr::memmem;

use crate::Output;
use crate::novel::without_numbers;

/// The lines of the outputs of one target, with what earlier runs validated. The same line in
/// another stage is another line, since stages have different rules.
#[derive(Debug, Default)]
pub struct SeenLines {
    /// A hash of each line with its stage, with 0 for the numbers of generated names.
    pub hashes: BTreeSet<u64>,
    /// How many lines were new.
    pub new: usize,
    /// Hashes of the parts of all texts so far, with their stages. Most parts of a text also occur in
    /// other texts, so few lines are looked at.
    parts: HashSet<Hash>,
}

impl SeenLines {
    /// Lines that outputs validated before had.
    pub fn before(hashes: BTreeSet<u64>) -> Self {
        Self { hashes, ..Self::default() }
    }

    /// Adds a text, and says whether it has a line that none before it had.
    fn add(&mut self, stage: Stage, text: &str) -> bool {
        let before = self.new;
        for part in text_parts(text) {
            if !self.parts.insert(hash_parts(&[stage.suffix(), part])) {
                continue;
            }
            for line in part.lines().map(str::trim) {
                let [a, b, c, d, e, f, g, h, ..] =
                    hash_parts(&[stage.suffix(), &without_numbers(line)]);
                let hash = u64::from_le_bytes([a, b, c, d, e, f, g, h]);
                self.new += usize::from(self.hashes.insert(hash));
            }
        }
        self.new > before
    }
}

/// A text, divided behind each function: behind the lines that consist of a closing brace.
fn text_parts(text: &str) -> impl Iterator<Item = &str> {
    const END: &[u8] = b"\n}\n";
    let mut start = 0;
    let ends = memmem::find_iter(text.as_bytes(), END).map(|at| at + END.len());
    ends.chain([text.len()]).map(move |end| {
        let part = &text[start..end];
        start = end;
        part
    })
}

/// The texts that stand for outputs of SPIR-V, which have no lines: those of the same unit in a
/// target that has, where there is one.
pub fn texts_of_units(outputs: &[Output]) -> BTreeMap<Hash, &Output> {
    let mut texts = BTreeMap::new();
    let ranked = [Target::GLSL450].into_iter().chain(Target::ALL.iter().copied());
    for target in ranked.filter(|target| *target != Target::SPIRV) {
        for output in outputs.iter().filter(|output| output.target == target) {
            texts.entry(output.unit).or_insert(output);
        }
    }
    texts
}

/// The outputs of one target with a line that no output before them has.
///
/// An output of SPIR-V whose unit has no text is always one of them.
pub fn with_new_lines<'o>(
    outputs: &[&'o Output],
    texts: &BTreeMap<Hash, &Output>,
    seen: &mut SeenLines,
) -> Result<Vec<&'o Output>, String> {
    let mut sorted = outputs.to_vec();
    // Not by the whole path, so that the place of a bundle does not matter.
    sorted.sort_by_cached_key(|output| (output.stage, output.name()));
    let mut chosen = Vec::new();
    for output in sorted {
        let text = match output.target {
            Target::SPIRV => texts.get(&output.unit).copied(),
            _ => Some(output),
        };
        let is_new = match text {
            Some(text) => seen.add(output.stage, &text.text()?),
            None => true,
        };
        if is_new {
            chosen.push(output);
        }
    }
    Ok(chosen)
}
