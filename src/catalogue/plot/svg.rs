//! Draws a plot as SVG: two axes with numbers, and curves.
//!
//! Colours have enough contrast on white and on near-black, since a picture in a page cannot
//! know the page's theme.

use std::fmt::Write as _;

use super::scale::{Scale, fitted_bounds, tick_label};
use super::{Plot, SAMPLES};

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
/// Points nearer to a line than this are left out.
const FLAT: f64 = 0.04;

/// The plot with the values of its curves, each at the [`SAMPLES`] inputs of the plot.
pub fn draw_plot(title: &str, plot: &Plot, curves: &[Vec<f64>]) -> String {
    let (from, to) = plot.y.map_or_else(
        || fitted_bounds(curves.iter().flatten().copied()),
        |range| (range.from, range.to),
    );
    let x = Scale { from: plot.x.from, to: plot.x.to, start: LEFT, end: RIGHT };
    let y = Scale { from, to, start: BOTTOM, end: TOP };
    let mut svg = svg_head(title);
    draw_axes(&mut svg, &x, &y);
    for (index, values) in curves.iter().enumerate() {
        draw_curve(&mut svg, index, &curve_path(values, &x, &y));
    }
    draw_captions(&mut svg, title, plot);
    svg.push_str("</svg>\n");
    svg
}

pub(super) fn svg_head(title: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
         role=\"img\" font-family=\"system-ui, sans-serif\" font-size=\"12\">\n<title>{}</title>\n",
        escape_xml(title)
    )
}

fn draw_axes(svg: &mut String, x: &Scale, y: &Scale) {
    let _ = writeln!(svg, "<g stroke=\"{INK}\" stroke-opacity=\"0.25\">");
    for value in y.ticks(5.0) {
        let at = rounded_place(y.place(value));
        let _ = writeln!(svg, "<path d=\"M{LEFT} {at}H{RIGHT}\"/>");
    }
    for value in x.ticks(6.0) {
        let at = rounded_place(x.place(value));
        let _ = writeln!(svg, "<path d=\"M{at} {BOTTOM}V{TOP}\"/>");
    }
    let _ = writeln!(svg, "</g>\n<g fill=\"{INK}\">");
    for value in y.ticks(5.0) {
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
            LEFT - 8.0,
            rounded_place(y.place(value) + 4.0),
            tick_label(value)
        );
    }
    for value in x.ticks(6.0) {
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            rounded_place(x.place(value)),
            BOTTOM + 18.0,
            tick_label(value)
        );
    }
    svg.push_str("</g>\n");
}

fn draw_curve(svg: &mut String, index: usize, path: &str) {
    let (colour, dashes) = CURVES[index % CURVES.len()];
    let _ = writeln!(
        svg,
        "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\" stroke-linejoin=\"round\"{}/>",
        dash_attribute(dashes)
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
        escape_xml(title)
    );
    let mut right = RIGHT;
    for (index, text) in legend_entries(plot).iter().enumerate().rev() {
        let (colour, dashes) = CURVES[index % CURVES.len()];
        let start = right - 7.0 * text.chars().count() as f64;
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"22\" fill=\"{INK}\">{}</text>",
            rounded_place(start),
            escape_xml(text)
        );
        let line = format!("M{} 18h22", rounded_place(start - 28.0));
        let _ = writeln!(
            svg,
            "<path d=\"{line}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"{}/>",
            dash_attribute(dashes)
        );
        right = start - 44.0;
    }
    let middle = (LEFT + RIGHT) / 2.0;
    let note = plot.note.as_ref().map_or(String::new(), |note| format!("  ({note})"));
    let _ = writeln!(
        svg,
        "<text x=\"{middle}\" y=\"290\" fill=\"{INK}\" text-anchor=\"middle\">{}</text>",
        escape_xml(&(plot.x.label.clone() + &note))
    );
}

/// One entry for each curve; the parameter's name is on the first.
fn legend_entries(plot: &Plot) -> Vec<String> {
    let named = |curves: &super::Curves, index: usize, value: &f64| {
        if index == 0 {
            format!("{} = {}", curves.name, tick_label(*value))
        } else {
            tick_label(*value)
        }
    };
    plot.curves
        .iter()
        .flat_map(|curves| {
            curves.values.iter().enumerate().map(|(index, value)| named(curves, index, value))
        })
        .collect()
}

/// A curve within the frame. It is interrupted where a value is not finite.
fn curve_path(values: &[f64], x: &Scale, y: &Scale) -> String {
    let step = (x.to - x.from) / (SAMPLES - 1) as f64;
    let points: Vec<Option<(f64, f64)>> = values
        .iter()
        .enumerate()
        .map(|(index, value)| {
            value.is_finite().then(|| {
                (
                    x.place(x.from + step * index as f64),
                    y.place(*value).clamp(TOP - 4.0, BOTTOM + 4.0),
                )
            })
        })
        .collect();
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

pub(super) fn escape_xml(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
