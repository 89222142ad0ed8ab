//! Computes the values for the catalogue's plots, on any executor.

use std::collections::BTreeMap;
use std::sync::Mutex;

use super::library::Library;
use lamplight_bundle::Language;
use lamplight_catalogue::plot::Plot;
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::{Session, kernel};

/// Name of the function around a plot's expression.
const FUNCTION: &str = "lamplight_plot";

/// The value of each of a plot's curves at each of its inputs. `path` is the function's in the
/// library.
pub fn plot_curves(
    library: &Library,
    sources: &Mutex<SourceSet>,
    path: &str,
    plot: &Plot,
    session: &mut dyn Session,
) -> Result<Vec<Vec<f64>>, Diagnostics> {
    let name = plot.curves.as_ref().map_or("unused", |curves| &curves.name);
    let value = &plot.value;
    let text = format!(
        "import {}::{path};\n\nfn {FUNCTION}(x: f32, {name}: f32) -> f32 {{\n    return {value};\n}}\n",
        library.name()
    );
    let module = library.importing(sources, ("plot.wesl", &text), Language::Wesl, FUNCTION)?.module;
    let kernel =
        kernel::build_kernel(&module, FUNCTION, &BTreeMap::new()).map_err(|error| vec![error])?;
    if kernel.input_words() != 2 || kernel.result_words() != 1 {
        return Err(vec![Diagnostic::error(
            codes::UNTESTABLE_FUNCTION,
            format!("the plot of `{path}` needs a function of two numbers that gives one"),
        )]);
    }
    let values = plot.curves.as_ref().map_or(vec![0.0], |curves| curves.values.clone());
    let inputs = |second: f64| {
        plot.inputs()
            .flat_map(move |x| [(x as f32).to_bits(), (second as f32).to_bits()])
            .collect::<Vec<_>>()
    };
    let mut run = |second: f64| session.run(&kernel, &inputs(second)).map_err(|error| vec![error]);
    values
        .into_iter()
        .map(|second| {
            Ok(run(second)?.into_iter().map(|word| f64::from(f32::from_bits(word))).collect())
        })
        .collect()
}
