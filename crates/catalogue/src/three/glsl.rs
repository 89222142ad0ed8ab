//! The declarations in GLSL ES 3.00.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_bundle::{Language, Stage};
use lamplight_compose::resolve::{self, Packages};
use lamplight_compose::{Keep, Options, PartKind, compose};
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_permute::Settings;
use lamplight_syntax::words::{LexemeKind, pieces};
use lamplight_translate::print::{Dialect, Style};
use lamplight_translate::{SourceModule, translate_wesl};

use super::declarations::{Declarations, code_of};
use super::{Exported, LeftOut, MADE, path_of, without_places};

/// Functions of GLSL 4.50 that GLSL ES 3.00 lacks, of those that translations have.
const LACKING: &[&str] = &[
    "bitCount",
    "bitfieldExtract",
    "bitfieldInsert",
    "bitfieldReverse",
    "dFdxCoarse",
    "dFdxFine",
    "dFdyCoarse",
    "dFdyFine",
    "findLSB",
    "findMSB",
    "fma",
    "frexp",
    "fwidthCoarse",
    "fwidthFine",
    "ldexp",
    "packSnorm4x8",
    "packUnorm4x8",
    "unpackSnorm4x8",
    "unpackUnorm4x8",
];

/// A declaration in both languages.
pub(super) struct Part {
    pub name: String,
    /// The module that it is of; empty for what only the translation has.
    pub module: String,
    pub is_function: bool,
    /// Empty where only GLSL needs it.
    pub wgsl: String,
    /// Empty where there is none.
    pub glsl: String,
    /// The names of the parts that it needs, in either language.
    pub needs: BTreeSet<String>,
}

/// All that is written.
pub(super) struct Parts<'a> {
    /// In the order of the text: what a part needs is before it.
    pub parts: Vec<Part>,
    pub exported: Vec<Exported<'a>>,
}

impl Parts<'_> {
    /// The part of a function.
    pub(super) fn part_of(&self, one: &Exported<'_>) -> Option<&Part> {
        self.parts.iter().find(|part| part.name == one.name)
    }
}

/// Translates what is exported. A function that cannot be translated is left out with all that need it.
pub(super) fn translated_parts<'a>(
    declarations: &Declarations,
    mut exported: Vec<Exported<'a>>,
    left_out: &mut Vec<LeftOut>,
) -> Result<Parts<'a>, Diagnostics> {
    const STYLE: Style<'static> =
        Style { dialect: Dialect::Glsl, command: None, guard: "", sampling: None, prefix: None };
    loop {
        let wanted: BTreeSet<usize> =
            exported.iter().flat_map(|one| declarations.reached(one.declaration)).collect();
        let (text, starts) = joined_text(declarations, &wanted);
        let module = SourceModule { path: vec!["three".to_owned()], source: MADE, text: &text };
        let problems = match translate_wesl(&[module], &[], &STYLE) {
            Ok(files) => {
                let glsl = files.into_iter().map(|file| file.text).collect::<String>();
                return paired_parts(declarations, &wanted, &glsl, exported, left_out);
            }
            Err(problems) => problems,
        };
        let before = exported.len();
        for problem in &problems {
            let wrong = declaration_at(&starts, problem);
            let is_right = |one: &Exported<'_>| {
                wrong.is_none_or(|wrong| !declarations.reached(one.declaration).contains(&wrong))
            };
            let (right, others) = exported.into_iter().partition(is_right);
            exported = right;
            left_out
                .extend(without_functions(others, &format!("GLSL lacks it: {}", problem.message)));
        }
        if exported.len() == before {
            return Err(without_places(problems));
        }
    }
}

fn without_functions<'a>(
    functions: Vec<Exported<'a>>,
    reason: &str,
) -> impl Iterator<Item = LeftOut> + use<'a> {
    let reason = reason.to_owned();
    functions
        .into_iter()
        .map(move |one| LeftOut { path: path_of(one.item), reason: reason.clone() })
}

/// The text of some declarations, and where each starts.
fn joined_text(
    declarations: &Declarations,
    wanted: &BTreeSet<usize>,
) -> (String, Vec<(usize, usize)>) {
    let (mut text, mut starts) = (String::new(), Vec::new());
    for index in wanted {
        starts.push((text.len(), *index));
        text += &declarations.all[*index].text;
        text.push('\n');
    }
    (text, starts)
}

/// The declaration that a problem is in.
fn declaration_at(starts: &[(usize, usize)], problem: &Diagnostic) -> Option<usize> {
    let at = problem.labels.first()?.span.start as usize;
    starts.iter().rev().find(|(start, _)| *start <= at).map(|(_, index)| *index)
}

/// The parts of both texts.
fn paired_parts<'a>(
    declarations: &Declarations,
    wanted: &BTreeSet<usize>,
    glsl: &str,
    exported: Vec<Exported<'a>>,
    left_out: &mut Vec<LeftOut>,
) -> Result<Parts<'a>, Diagnostics> {
    let mut parts: Vec<Part> = Vec::new();
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    for index in wanted {
        let declaration = &declarations.all[*index];
        let needs = declaration.uses.iter().map(|used| declarations.all[*used].name.clone());
        places.insert(declaration.name.clone(), parts.len());
        parts.push(Part {
            name: declaration.name.clone(),
            module: declaration.module.clone(),
            is_function: declaration.kind == PartKind::Function,
            wgsl: declaration.text.clone(),
            glsl: String::new(),
            needs: needs.collect(),
        });
    }
    for found in parts_of(glsl).map_err(without_places)? {
        let place = *places.entry(found.name.clone()).or_insert(parts.len());
        match parts.get_mut(place) {
            Some(part) => {
                part.glsl = found.glsl;
                part.needs.extend(found.needs);
            }
            None => parts.push(found),
        }
    }
    let missing = drop_lacking(&mut parts);
    for one in &exported {
        if let Some(reason) = missing.get(&one.name) {
            left_out.push(LeftOut { path: path_of(one.item), reason: reason.clone() });
        }
    }
    Ok(Parts { parts, exported })
}

/// The declarations of a text in GLSL.
fn parts_of(glsl: &str) -> Result<Vec<Part>, Diagnostics> {
    const PATH: &str = "three.frag.glsl";
    let packages = Packages::of_text(PATH, format!("#version 450\n{glsl}\nvoid main() {{}}\n"));
    let graph = resolve::load(&mut SourceSet::default(), &packages, PATH, Language::Glsl)?;
    let options = Options { keep: Keep::All, stage: Some(Stage::Fragment), ..Options::default() };
    let composed = compose(&graph, &Settings::default(), &options)?;
    let mut parts = Vec::new();
    for part in &composed.parts {
        let Some(name) = part.names.first().filter(|name| *name != "main") else { continue };
        let used = part.uses.iter().filter_map(|index| composed.parts.get(*index as usize));
        let needs = used.filter_map(|used| used.names.first().cloned());
        parts.push(Part {
            name: name.clone(),
            module: String::new(),
            is_function: part.kind == PartKind::Function,
            wgsl: String::new(),
            glsl: code_of(composed.text.get(part.range.clone()).unwrap_or_default()),
            needs: needs.filter(|needed| needed != name).collect(),
        });
    }
    Ok(parts)
}

/// Takes away the GLSL of parts that GLSL ES 3.00 does not have, or that need one of those. Gives the
/// reason for each.
fn drop_lacking(parts: &mut [Part]) -> BTreeMap<String, String> {
    let mut missing: BTreeMap<String, String> = BTreeMap::new();
    loop {
        let before = missing.len();
        for part in parts.iter_mut() {
            let word = pieces(&part.glsl)
                .find(|piece| piece.kind == LexemeKind::Word && LACKING.contains(&piece.text));
            let reason = match word {
                Some(word) => Some(format!("only for WebGPU: GLSL ES 3.00 lacks `{}`", word.text)),
                None => part.needs.iter().find_map(|needed| missing.get(needed).cloned()),
            };
            if let (Some(reason), false) = (reason, missing.contains_key(&part.name)) {
                part.glsl.clear();
                missing.insert(part.name.clone(), reason);
            }
        }
        if missing.len() == before {
            return missing;
        }
    }
}
