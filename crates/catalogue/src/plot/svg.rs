//! Draws a plot as SVG: two axes with numbers, and curves or stems.
//!
//! Colours have enough contrast on white and on near-black, since a picture in a page cannot
//! know the page's theme.

use std::fmt::Write as _;

use super::scale::{PlotScale, fitted_bounds, tick_label};
use super::{AxisUnit, Curves, Plot};
use lamplight_diagnostic::escape_markup;

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 300.0;
pub(super) const LEFT: f64 = 56.0;
pub(super) const RIGHT: f64 = 544.0;
pub(super) const TOP: f64 = 40.0;
pub(super) const BOTTOM: f64 = 252.0;

/// The colour of lines and letters.
pub(super) const INK: &str = "#7d8794";
/// A colour and a dash for each curve, in order.
const CURVES: [(&str, &str); 4] =
    [("#3987e5", ""), ("#e0701b", "8 4"), ("#2da05a", "2 3"), ("#b05fd0", "10 3 2 3")];
/// Colours of curves with these labels.
const NAMED: [(&str, &str); 3] = [("red", "#e0474c"), ("green", "#2da05a"), ("blue", "#3987e5")];
/// Points nearer to a line than this are left out.
const FLAT: f64 = 0.04;

/// The plot with the values of its curves, each at the inputs of the plot.
pub fn draw_plot(title: &str, plot: &Plot, curves: &[Vec<f64>]) -> String {
    let (from, to) = plot.y.map_or_else(
        || fitted_bounds(curves.iter().flatten().copied()),
        |range| (range.from, range.to),
    );
    // The outermost stems stand within the frame.
    let room = if plot.x.unit == AxisUnit::Integers { 0.5 } else { 0.0 };
    let x = PlotScale { from: plot.x.from - room, to: plot.x.to + room, start: LEFT, end: RIGHT };
    let y = PlotScale { from, to, start: BOTTOM, end: TOP };
    let mut svg = svg_head(title);
    draw_axes(
        &mut svg,
        (&x, plot.x.unit),
        (&y, plot.y.map_or(AxisUnit::Numbers, |range| range.unit)),
    );
    let looks = curve_looks(plot);
    for (index, values) in curves.iter().enumerate() {
        let points = curve_points(plot, values, &x, &y);
        if plot.x.unit == AxisUnit::Integers {
            draw_stems(&mut svg, looks[index].0, &points, &y, (index, curves.len()));
        } else {
            draw_curve(&mut svg, looks[index], &curve_path(&points));
        }
    }
    draw_captions(&mut svg, title, plot);
    svg.push_str("</svg>\n");
    svg
}

/// The colour and the dash of each curve.
fn curve_looks(plot: &Plot) -> Vec<(&'static str, &'static str)> {
    let count = plot.curves.as_ref().map_or(1, |curves| curves.values.len());
    let label = |index: usize| plot.curves.as_ref().map(|curves| curves.label(index));
    let named = |index: usize| {
        let label = label(index)?;
        NAMED.iter().find(|(name, _)| *name == label).map(|(_, color)| *color)
    };
    let of = |index: usize| {
        let (color, dashes) = CURVES[index % CURVES.len()];
        (named(index).unwrap_or(color), dashes)
    };
    (0..count).map(of).collect()
}

pub(super) fn svg_head(title: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
         role=\"img\" font-family=\"system-ui, sans-serif\" font-size=\"12\">\n<title>{}</title>\n",
        escape_markup(title)
    )
}

fn draw_axes(
    svg: &mut String,
    (x, across): (&PlotScale, AxisUnit),
    (y, up): (&PlotScale, AxisUnit),
) {
    let _ = writeln!(svg, "<g stroke=\"{INK}\" stroke-opacity=\"0.25\">");
    for value in y.ticks(5.0, up) {
        let at = rounded_place(y.place(value));
        let _ = writeln!(svg, "<path d=\"M{LEFT} {at}H{RIGHT}\"/>");
    }
    for value in x.ticks(6.0, across) {
        let at = rounded_place(x.place(value));
        let _ = writeln!(svg, "<path d=\"M{at} {BOTTOM}V{TOP}\"/>");
    }
    let _ = writeln!(svg, "</g>\n<g fill=\"{INK}\">");
    for value in y.ticks(5.0, up) {
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
            LEFT - 8.0,
            rounded_place(y.place(value) + 4.0),
            tick_label(value, up)
        );
    }
    for value in x.ticks(6.0, across) {
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            rounded_place(x.place(value)),
            BOTTOM + 18.0,
            tick_label(value, across)
        );
    }
    svg.push_str("</g>\n");
}

fn draw_curve(svg: &mut String, (color, dashes): (&str, &str), path: &str) {
    let _ = writeln!(
        svg,
        "<path d=\"{path}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\" stroke-linejoin=\"round\"{}/>",
        dash_attribute(dashes)
    );
}

/// A line from zero to each value, with a dot at its end. Stems of several curves stand side by
/// side.
fn draw_stems(
    svg: &mut String,
    color: &str,
    points: &[Option<(f64, f64)>],
    y: &PlotScale,
    (index, count): (usize, usize),
) {
    let apart = (0.6 * (RIGHT - LEFT) / points.len().max(1) as f64 / count as f64).min(8.0);
    let aside = (index as f64 - 0.5 * (count - 1) as f64) * apart;
    let zero = rounded_place(y.place(0f64.clamp(y.from, y.to)));
    let radius = rounded_place((0.45 * apart).clamp(1.5, 3.5));
    let (mut lines, mut dots) = (String::new(), String::new());
    for (x, y) in points.iter().flatten() {
        let (x, y) = (rounded_place(x + aside), rounded_place(*y));
        let _ = write!(lines, "M{x} {zero}V{y}");
        let _ = writeln!(dots, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>");
    }
    let _ = writeln!(
        svg,
        "<path d=\"{lines}\" stroke=\"{color}\" stroke-width=\"1.5\"/>\n<g fill=\"{color}\">\n{dots}</g>"
    );
}

fn dash_attribute(dashes: &str) -> String {
    if dashes.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dashes}\"") }
}

/// The name, the legend, the note, and the label of the horizontal axis.
fn draw_captions(svg: &mut String, title: &str, plot: &Plot) {
    let _ = writeln!(
        svg,
        "<text x=\"{LEFT}\" y=\"22\" fill=\"{INK}\" font-weight=\"600\">{}</text>",
        escape_markup(title)
    );
    let stems = plot.x.unit == AxisUnit::Integers;
    let mut right = RIGHT;
    for (text, (color, dashes)) in legend_entries(plot).iter().zip(curve_looks(plot)).rev() {
        let start = right - 7.0 * text.chars().count() as f64;
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"22\" fill=\"{INK}\">{}</text>",
            rounded_place(start),
            escape_markup(text)
        );
        let line = format!("M{} 18h22", rounded_place(start - 28.0));
        let _ = writeln!(
            svg,
            "<path d=\"{line}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"{}/>",
            dash_attribute(if stems { "" } else { dashes })
        );
        right = start - 44.0;
    }
    let middle = (LEFT + RIGHT) / 2.0;
    let note = plot.note.as_ref().map_or(String::new(), |note| format!("  ({note})"));
    let _ = writeln!(
        svg,
        "<text x=\"{middle}\" y=\"290\" fill=\"{INK}\" text-anchor=\"middle\">{}</text>",
        escape_markup(&(plot.x.label.clone() + &note))
    );
}

/// One entry for each curve; the parameter's name is on the first, unless the curves have names.
fn legend_entries(plot: &Plot) -> Vec<String> {
    let entry = |curves: &Curves, index: usize| match (index, curves.labels.is_empty()) {
        (0, true) => format!("{} = {}", curves.name, curves.label(index)),
        _ => curves.label(index),
    };
    let curves = plot.curves.iter();
    curves.flat_map(|curves| (0..curves.values.len()).map(|index| entry(curves, index))).collect()
}

/// The places of a curve's values. There is none where a value is not finite.
fn curve_points(
    plot: &Plot,
    values: &[f64],
    x: &PlotScale,
    y: &PlotScale,
) -> Vec<Option<(f64, f64)>> {
    let place = |(input, value): (f64, &f64)| {
        let up = y.place(*value).clamp(TOP - 4.0, BOTTOM + 4.0);
        value.is_finite().then(|| (x.place(input), up))
    };
    plot.inputs().zip(values).map(place).collect()
}

/// A curve within the frame. It is interrupted where a value is not finite.
fn curve_path(points: &[Option<(f64, f64)>]) -> String {
    let pieces = points.split(Option::is_none).filter(|piece| piece.len() > 1);
    pieces.map(|piece| piece_path(&piece.iter().flatten().copied().collect::<Vec<_>>())).collect()
}

fn piece_path(points: &[(f64, f64)]) -> String {
    let mut kept = vec![false; points.len()];
    (kept[0], kept[points.len() - 1]) = (true, true);
    keep_bends(points, &mut kept, 0, points.len() - 1);
    let corners = points
        .iter()
        .zip(kept)
        .filter(|(_, kept)| *kept)
        .map(|((x, y), _)| format!("{} {}", rounded_place(*x), rounded_place(*y)));
    format!("M{}", corners.collect::<Vec<_>>().join("L"))
}

/// Marks the points that are too far from a line between the first and the last (Douglas and
/// Peucker).
fn keep_bends(points: &[(f64, f64)], kept: &mut [bool], first: usize, last: usize) {
    let distance = |index: usize| {
        let ((ax, ay), (bx, by), (px, py)) = (points[first], points[last], points[index]);
        ((bx - ax) * (py - ay) - (by - ay) * (px - ax)).abs() / (bx - ax).hypot(by - ay)
    };
    let Some(farthest) = (first + 1..last).max_by(|a, b| distance(*a).total_cmp(&distance(*b)))
    else {
        return;
    };
    if distance(farthest) > FLAT {
        kept[farthest] = true;
        keep_bends(points, kept, first, farthest);
        keep_bends(points, kept, farthest, last);
    }
}

/// Rounded to a tenth of a unit: finer than can be seen, coarser than differences of rounding.
pub(super) fn rounded_place(value: f64) -> String {
    let rounded = (value * 10.0).round() / 10.0;
    rounded.to_string()
}
