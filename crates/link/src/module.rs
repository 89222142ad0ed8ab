//! Compiles modules that were built in memory, such as a kernel around a function. The module is
//! written as a text, which is then compiled as every other text is.

use super::{Linker, TextForms, compile};
use lamplight_bundle::{Artifact, Language, Target};
use lamplight_compose::resolve::{Packages, load};
use lamplight_compose::{Keep, Options, compose, lean};
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_emit::emit;
use lamplight_permute::Settings;
use lamplight_validate::Validated;

const FILE: &str = "module.wgsl";

/// The output of a module's entry point, as a bundle would hold it. `linker` must be one for this
/// target alone. It can be used again, so that functions which modules share are translated once.
///
/// # Errors
/// Those of [`compile()`]; places are in the WGSL text that the module is written as.
pub fn module_linked(
    validated: &Validated,
    entry: &str,
    target: Target,
    linker: &Linker<'_>,
) -> Result<Artifact, Diagnostics> {
    let wgsl = emit(validated, entry, Target::WGSL).map_err(|error| vec![error])?;
    let wgsl = String::from_utf8_lossy(&wgsl.bytes).into_owned();
    let packages = Packages::of_text(FILE, wgsl);
    let graph = load(&mut SourceSet::default(), &packages, FILE, Language::Wesl)?;
    let keep = Keep::Items(vec![entry.to_owned()]);
    let options = Options { keep, ..Options::default() };
    let composed = compose(&graph, &Settings::default(), &options)?;
    let text = TextForms { composed: &composed, lean: &lean(&composed) };
    let made = compile(&text, entry, &[target], linker)?;
    let missing = || vec![Diagnostic::error(codes::EMIT_FAILED, format!("no output for {target}"))];
    made.unit.targets.into_values().next().ok_or_else(missing)
}
