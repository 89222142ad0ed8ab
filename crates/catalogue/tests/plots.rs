//! Plots of functions: what is read from their files, and what is drawn.

use lamplight_catalogue::plot::{Plot, SAMPLES, draw_plot, draw_scatter, parse_plots, plot_path};
use lamplight_diagnostic::source::SourceSet;
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("plots::inputs_have_both_ends", inputs_have_both_ends),
        Trial::test("plots::lines_need_two_points", lines_need_two_points),
        Trial::test("plots::curves_break_where_values_are_not_finite", broken_curves),
        Trial::test("plots::stems_begin_at_zero", stems_begin_at_zero),
        Trial::test("plots::names_are_no_markup", names_are_no_markup),
        Trial::test("plots::unknown_keys_are_refused", unknown_keys_are_refused),
    ]
}

fn plots_of(text: &str) -> Result<Vec<Plot>, Failed> {
    let mut sources = SourceSet::default();
    let id = sources.add(plot_path("lighting::spot"), text);
    let plots = parse_plots(&sources, id).map_err(|errors| format!("{errors:?}"))?;
    Ok(plots.into_values().collect())
}

fn one_plot(rest: &str) -> Result<Plot, Failed> {
    plots_of(&format!("[cone]\nvalue = \"cone(x)\"\n{rest}"))?
        .pop()
        .ok_or_else(|| "no plot was read".into())
}

const LINE: &str = "x = { label = \"c\", from = -1, to = 3 }\ny = { from = 0, to = 1 }\n";

fn inputs_have_both_ends() -> Outcome {
    let inputs: Vec<f64> = one_plot(LINE)?.inputs().collect();
    let whole = one_plot("x = { label = \"i\", from = 2, to = 5, unit = \"integers\" }\n")?;
    let stems: Vec<f64> = whole.inputs().collect();
    let ends = (inputs.first(), inputs.last());
    if inputs.len() != SAMPLES || ends != (Some(&-1.0), Some(&3.0)) || stems != [2.0, 3.0, 4.0, 5.0]
    {
        return Err(format!("{} inputs, ends {ends:?}, stems {stems:?}", inputs.len()).into());
    }
    Ok(())
}

/// The frame goes from (56, 252) to (544, 40). Points on a straight line are left out.
fn lines_need_two_points() -> Outcome {
    let plot = one_plot(LINE)?;
    let values: Vec<f64> = plot.inputs().map(|x| (x + 1.0) / 4.0).collect();
    drawn(&draw_plot("cone", &plot, &[values]), "<path d=\"M56 252L544 40\" fill=\"none\"")
}

fn drawn(svg: &str, part: &str) -> Outcome {
    match svg.contains(part) {
        true => Ok(()),
        false => Err(format!("`{part}` is not in\n{svg}").into()),
    }
}

/// A value that is not finite ends one line, and another begins behind it.
fn broken_curves() -> Outcome {
    let plot = one_plot(LINE)?;
    let middle = SAMPLES / 2;
    let value = |index: usize| if index == middle { f64::NAN } else { 0.5 };
    let svg = draw_plot("cone", &plot, &[(0..SAMPLES).map(value).collect()]);
    // One sample is 488 / 320 = 1.525 wide, so the lines end at 298.475 and begin at 301.525.
    drawn(&svg, "d=\"M56 146L298.5 146M301.5 146L544 146\"")
}

fn stems_begin_at_zero() -> Outcome {
    let plot = one_plot(
        "x = { label = \"i\", from = 0, to = 1, unit = \"integers\" }\ny = { from = -1, to = 1 }\n",
    )?;
    // Zero is in the middle of the frame, at 146; the stems are a quarter from its sides.
    drawn(&draw_plot("cone", &plot, &[vec![1.0, -1.0]]), "d=\"M178 146V40M422 146V252\"")
}

fn names_are_no_markup() -> Outcome {
    let plot = one_plot(LINE)?;
    let points = [("a<b".to_owned(), 8.0, 0.1), ("c&d".to_owned(), 64.0, 0.2)];
    for svg in [
        draw_plot("<script>", &plot, &[vec![0.5; SAMPLES]]),
        draw_scatter("<script>", ["cost & more", "error"], &points),
    ] {
        if svg.contains("<script>") || svg.contains("a<b") || svg.contains(">c&d<") {
            return Err(format!("a name is taken for markup:\n{svg}").into());
        }
    }
    Ok(())
}

fn unknown_keys_are_refused() -> Outcome {
    match one_plot(&format!("{LINE}z = 1\n")) {
        Err(error) if error.message().is_some_and(|text| text.contains("unknown field")) => Ok(()),
        other => Err(format!("the key `z` was read: {other:?}").into()),
    }
}
