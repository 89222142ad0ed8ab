//! Chooses the settings with which a module is checked.

use super::Request;
use lamplight_compose::resolve::Graph;
use lamplight_permute::axis::Mode;
use lamplight_permute::space::{SliceLists, Space};
use lamplight_permute::{Program, Settings, cover};

/// In how many permutations of one program a module is checked.
const MOST: usize = 64;

/// The settings to check a module with. If a program has it as a root, or it asks for a program's
/// axes: permutations that cover every pair of values of the axes that it may ask for. Otherwise
/// the settings that were chosen.
pub fn candidate_settings(graph: &Graph, request: &Request<'_>, path: &str) -> Vec<Settings> {
    let programs = || request.manifest.iter().flat_map(|manifest| &manifest.programs);
    let is_root = |program: &&Program| program.files().any(|file| file.path == path);
    let is_read =
        |program: &&Program| program.space.axes().iter().any(|axis| graph.may_ask(&axis.name));
    let roots: Vec<&Program> = programs().filter(is_root).collect();
    let chosen = if roots.is_empty() { programs().filter(is_read).collect() } else { roots };
    if chosen.is_empty() {
        return vec![without_errors(request.settings.clone())];
    }
    chosen.into_iter().flat_map(|program| of_program(graph, request, program)).collect()
}

fn of_program(graph: &Graph, request: &Request<'_>, program: &Program) -> Vec<Settings> {
    let space = narrowed_space(graph, &program.space);
    let points = std::iter::once(program.space.default_assignment())
        .chain(cover::pairwise(&space).points)
        .filter(|point| program.space.is_valid(point))
        .take(MOST);
    let settings = points.map(|point| {
        let mut settings = program.space.settings(&point);
        settings.values.extend(request.settings.values.clone());
        settings.integers.extend(request.settings.integers.clone());
        settings.undeclared = request.settings.undeclared.or(settings.undeclared);
        without_errors(settings)
    });
    settings.collect()
}

/// The space with all axes at their defaults that the module cannot ask for; the whole space if
/// nothing is left.
fn narrowed_space(graph: &Graph, space: &Space) -> Space {
    let mut axes = space.axes().to_vec();
    for axis in axes.iter_mut().filter(|axis| !graph.may_ask(&axis.name)) {
        // A dynamic axis is always at its default.
        axis.mode = Mode::Dynamic;
    }
    Space::new(axes, space.constraints().to_vec(), SliceLists::default())
        .ok()
        .filter(|space| space.count() > 0)
        .unwrap_or_else(|| space.clone())
}

/// Gives undeclared flags a value. They are reported separately, and other errors are looked for
/// without them.
fn without_errors(settings: Settings) -> Settings {
    Settings { undeclared: settings.undeclared.or(Some(false)), ..settings }
}
