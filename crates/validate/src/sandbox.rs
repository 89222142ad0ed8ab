//! A sandbox for large texts: naga could exhaust the memory or stack of the process on them, so they
//! are tried in another process first.

use serde::{Deserialize, Serialize};

use super::limits;
use lamplight_compose::{Composed, lean};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_files::sandbox;

/// The stage of [`sandbox::try_in_sandbox`] that runs naga.
pub const STAGE: &str = "naga";

/// What the other process does: it validates a text and, if asked to, writes it.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename = "Job")]
pub struct SandboxJob {
    /// The text in WGSL, without comments and layout.
    pub text: String,
    /// What is written from it.
    pub outputs: Option<SandboxOutputs>,
}

/// An entry point, the targets to write it for, and conventions, by their names.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename = "Outputs")]
pub struct SandboxOutputs {
    /// Name of the entry point.
    pub entry: String,
    /// Names of the targets.
    pub targets: Vec<String>,
    /// Name of the clip space.
    pub clip: String,
    /// Name of the checks of indices and loops.
    pub bounds: String,
}

/// Tries a text in WGSL in another process if it is not small. Errors have the places of `placed`, whose
/// lean form the text may be.
///
/// # Errors
/// `limit-exceeded` where it exceeds a limit, `naga-exhausted` where the other process died.
pub fn try_in_sandbox(
    composed: &Composed,
    placed: &Composed,
    outputs: impl FnOnce() -> Option<SandboxOutputs>,
) -> Result<(), Diagnostic> {
    if limits::check_limits(composed)?.is_none() {
        return Ok(());
    }
    // A text and its lean form share one run in the sandbox.
    let text = lean(composed).text;
    let job = SandboxJob { text, outputs: outputs() };
    let Ok(job) = serde_json::to_vec(&job) else { return Ok(()) };
    sandbox::try_in_sandbox(STAGE, &job).map_err(|how| exhausted_process(placed, &how))
}

fn exhausted_process(composed: &Composed, how: &sandbox::SandboxFailure) -> Diagnostic {
    let error = Diagnostic::error(codes::NAGA_EXHAUSTED, format!("naga {how} over this shader"));
    let error = match limits::check_limits(composed) {
        Ok(Some(large)) => {
            let words = format!("more than {} {}", large.limit, large.what);
            limits::place_excess(composed, error, &large, &words)
        }
        _ => error,
    };
    error.note(
        "help: shorten the marked code, or split the shader: naga's time and memory may grow with \
         the square of it, or faster",
    )
}
