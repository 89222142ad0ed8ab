//! Reports flags in conditions that nothing declares.

use super::Request;
use lamplight_compose::resolve::Graph;
use lamplight_diagnostic::{Diagnostics, Severity};
use lamplight_permute::Settings;

/// An error for each flag of the package's own conditions that neither an axis nor an option gives
/// a value, unless a value for undeclared features was chosen.
pub fn undeclared_flags(graph: &Graph, request: &Request<'_>) -> Diagnostics {
    let mut known = request.settings.clone();
    for program in request.manifest.iter().flat_map(|manifest| &manifest.programs) {
        let Settings { values, undeclared, .. } =
            program.space.settings(&program.space.default_assignment());
        known.values.extend(values);
        known.undeclared = known.undeclared.or(undeclared);
    }
    let found = graph.undeclared(&known).into_iter().map(|mut error| {
        error.severity = Severity::Error;
        error.labels.iter_mut().for_each(|label| label.message = "asked for here".to_owned());
        error.note(
            "help: declare an axis in `lamplight.toml`, or say what such features are with \
             `--features-default` or the manifest's `features_default`",
        )
    });
    found.collect()
}
