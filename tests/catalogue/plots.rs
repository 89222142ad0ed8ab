//! Plots show what they are about: curves that can be told apart, and units that fit the parameters.

use std::sync::Mutex;

use lamplight::LIBRARY_FILES;
use lamplight::catalogue::{self, plot};
use lamplight::check::library::Library;
use lamplight::check::plots::plot_curves;
use lamplight::execute::executors::eval::EXECUTOR;
use lamplight::source::{Files as _, SourceSet};
use libtest_mimic::{Failed, Trial};

/// How far apart two curves must be at some point, as a fraction of the plot's height. It is the
/// width of two lines.
const APART: f64 = 0.02;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("catalogue::plots_show_their_parameter", curves_are_apart),
        Trial::test("catalogue::plots_have_units", angles_are_in_degrees),
        Trial::test("catalogue::plots_have_short_labels", labels_fit),
    ]
}

/// Every plot of the library, with the path of its function.
fn all_plots() -> Result<Vec<(String, plot::Plot)>, Failed> {
    let mut all = Vec::new();
    for module in catalogue::library_modules(LIBRARY_FILES) {
        let path = plot::plot_path(&module.path);
        let Some(text) = LIBRARY_FILES.read(&path).ok().flatten() else { continue };
        let mut sources = SourceSet::default();
        let id = sources.add(path, text);
        let plots = plot::parse_plots(&sources, id).map_err(|problems| format!("{problems:?}"))?;
        all.extend(
            plots.into_iter().map(|(name, plot)| (format!("{}::{name}", module.path), plot)),
        );
    }
    Ok(all)
}

/// A curve that lies on its neighbour does not show what the varied parameter does.
fn curves_are_apart() -> Result<(), Failed> {
    let library = Library::shipped(LIBRARY_FILES);
    let mut session = EXECUTOR.start().map_err(|_| "no evaluator")?;
    let mut alike = Vec::new();
    for (path, plot) in all_plots()? {
        let sources = Mutex::new(SourceSet::default());
        let curves = plot_curves(&library, &sources, &path, &plot, session.as_mut())
            .map_err(|problems| format!("{path}: {problems:?}"))?;
        let (low, high) = plot.y.map_or_else(|| bounds(&curves), |range| (range.from, range.to));
        let seen = |value: f64| ((value - low) / (high - low)).clamp(0.0, 1.0);
        for pair in curves.windows(2) {
            let both = pair[0].iter().zip(&pair[1]);
            let apart = both.map(|(one, other)| (seen(*one) - seen(*other)).abs());
            let most = apart.filter(|apart| !apart.is_nan()).fold(0.0, f64::max);
            if most < APART {
                alike.push(format!("{path}: curves are {most:.4} of the height apart"));
            }
        }
    }
    if alike.is_empty() { Ok(()) } else { Err(alike.join("\n").into()) }
}

fn bounds(curves: &[Vec<f64>]) -> (f64, f64) {
    let values = curves.iter().flatten().copied().filter(|value| value.is_finite());
    values.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)))
}

/// Angles are in degrees, and are not replaced by their cosines. A parameter that the expression
/// converts to an integer is plotted with stems at integers, unless there are too many to draw.
fn angles_are_in_degrees() -> Result<(), Failed> {
    const MOST_STEMS: f64 = 100.0;
    let mut wrong = Vec::new();
    for (path, plot) in all_plots()? {
        let (x, label) = (&plot.x, plot.x.label.as_str());
        let named = |words: &[&str]| words.iter().any(|word| label.contains(word));
        if named(&["angle"]) && x.unit != plot::AxisUnit::Degrees || named(&["cosine", "radians"]) {
            wrong.push(format!("{path}: `{label}` is an angle and not in degrees"));
        }
        let is_whole = plot.value.contains("u32(x)") || plot.value.contains("i32(x)");
        if is_whole && x.unit != plot::AxisUnit::Integers && x.to - x.from < MOST_STEMS {
            wrong.push(format!("{path}: `{label}` is an integer and has no stems"));
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n").into()) }
}

/// What is written below a plot is no wider than the plot: 520 pixels, at about 6 for a character.
fn labels_fit() -> Result<(), Failed> {
    const MOST: usize = 82;
    let count = |plot: &plot::Plot| {
        plot.x.label.len() + plot.note.as_ref().map_or(0, |note| "  ()".len() + note.len())
    };
    let plots = all_plots()?;
    let long =
        plots.iter().map(|(path, plot)| (path, count(plot))).filter(|(_, most)| *most > MOST);
    let long: Vec<String> =
        long.map(|(path, count)| format!("{path}: {count} characters below it")).collect();
    if long.is_empty() { Ok(()) } else { Err(long.join("\n").into()) }
}
