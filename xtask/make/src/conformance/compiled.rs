//! Texts of other people, composed and compiled as the commands do it.

use lamplight::bundle::{Language, Stage, Target};
use lamplight::compose::{self, Composed, Keep, Options};
use lamplight::diagnostic::{Code, Diagnostic, Diagnostics, codes};
use lamplight::link::{CompiledUnit, Linker, TextForms, compile};
use lamplight::permute::Settings;
use lamplight::resolve::{self, Packages};
use lamplight::source::SourceSet;

/// Errors that say what a target lacks, rather than what is wrong with a text.
const LACKS: [&Code; 4] = [
    codes::EMIT_FAILED,
    codes::NOT_PORTABLE,
    codes::NON_UNIFORM_BARRIER,
    codes::OVERRIDE_WITHOUT_VALUE,
];

/// A text in WGSL.
pub fn composed_wgsl(text: &str, keep: Keep) -> Result<Composed, Diagnostics> {
    composed("shader.wgsl", text, Language::Wesl, keep)
}

/// The whole of a text in GLSL, preprocessed: the command leaves out what no entry point reaches.
pub fn composed_glsl(text: &str, stage: Stage) -> Result<Composed, Diagnostics> {
    composed(&format!("case.{}", stage.suffix()), text, Language::Glsl, Keep::All)
}

fn composed(
    path: &str,
    text: &str,
    language: Language,
    keep: Keep,
) -> Result<Composed, Diagnostics> {
    let packages = Packages::of_text(path, text.to_owned());
    let graph = resolve::load(&mut SourceSet::default(), &packages, path, language)?;
    compose::compose(&graph, &Settings::default(), &Options { keep, ..Options::default() })
}

/// Compiles an entry point for every target that has what it needs. The error is the author's, or what
/// some target lacks if there is none that has it.
pub fn for_targets_that_can(composed: &Composed, entry: &str) -> Result<CompiledUnit, Diagnostic> {
    let text = TextForms { composed, lean: composed };
    let made = |targets: &[Target]| compile(&text, entry, targets, &Linker::new(targets));
    let all = match made(Target::ALL) {
        Ok(unit) => return Ok(unit),
        Err(errors) => first(errors),
    };
    let mut some: Option<CompiledUnit> = None;
    for target in Target::ALL {
        match (made(&[*target]).map_err(first), &mut some) {
            (Ok(unit), Some(some)) => some.unit.targets.extend(unit.unit.targets),
            (Ok(unit), None) => some = Some(unit),
            (Err(error), _) if is_lack(&error) => {}
            (Err(error), _) => return Err(error),
        }
    }
    some.ok_or(all)
}

/// Whether an error says what a target lacks.
pub fn is_lack(error: &Diagnostic) -> bool {
    LACKS.contains(&error.code)
}

/// The first error.
pub fn first(errors: Diagnostics) -> Diagnostic {
    let none = || Diagnostic::error(codes::GLSL_ERROR, "refused without an error");
    errors.into_iter().next().unwrap_or_else(none)
}
