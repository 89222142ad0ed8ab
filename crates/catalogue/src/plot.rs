//! Plots of the library's functions: what to draw, read from `NAME.plot.toml` beside a module.
//!
//! ```toml
//! [cone_exponent]                              # a function of the module
//! value = "cone_exponent(x, 0.5, e)"           # WGSL over `x`, and over the curves' name
//! x = { label = "c", from = -1, to = 1 }       # the main parameter
//! y = { from = 0, to = 1 }                     # fitted to the values, where it is left out
//! curves = { name = "e", values = [1, 8, 64] } # one curve for each; one in all, without it
//! note = "cutoff 0.5"                          # what was fixed
//! ```
//!
//! `x`, `y` and `curves` may have a `unit`: `degrees`, or `integers` for `x`, whose values are
//! drawn as stems. `labels` of `curves` stand for their values; curves that are called red, green
//! and blue have these colours.
//!
//! Functions of the module are called by name, others by their path from the library's root.
//! The values come from outside: [`draw_plot`] takes them as curves and returns an SVG.
//! [`draw_scatter`] draws points with their names: cost to the right, on a logarithmic scale, and error
//! upwards. Colours have enough contrast on white and on near-black, since a picture in a page cannot
//! know the page's theme.

use crate::reader;
use lamplight_diagnostic::source::{SourceId, SourceSet};
use lamplight_diagnostic::{Diagnostics, escape_markup};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Points at which a curve over a continuous parameter is computed.
pub const SAMPLES: usize = 321;

/// The unit of the numbers on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase", rename = "Unit")]
pub enum AxisUnit {
    #[default]
    Numbers,
    Degrees,
    /// Whole numbers, with nothing between them.
    Integers,
}

impl AxisUnit {
    /// One word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Numbers => "numbers",
            Self::Degrees => "degrees",
            Self::Integers => "integers",
        }
    }
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plot {
    /// A WGSL expression of type f32 over `x` and the curves' name.
    pub value: String,
    pub x: PlotAxis,
    pub y: Option<Range>,
    pub curves: Option<Curves>,
    /// What the expression keeps fixed.
    pub note: Option<String>,
}

/// The horizontal axis.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Axis")]
pub struct PlotAxis {
    /// The text beside the axis, with the unit unless `unit` gives it.
    pub label: String,
    pub from: f64,
    pub to: f64,
    #[serde(default)]
    pub unit: AxisUnit,
}

/// The bounds of the vertical axis.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    pub from: f64,
    pub to: f64,
    #[serde(default)]
    pub unit: AxisUnit,
}

/// A second parameter, with one curve for each of its values.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Curves {
    /// A parameter of the expression.
    pub name: String,
    pub values: Vec<f64>,
    #[serde(default)]
    pub unit: AxisUnit,
    /// Words for the values, in their order.
    #[serde(default)]
    pub labels: Vec<String>,
}

impl Curves {
    /// What a curve is called.
    pub fn label(&self, index: usize) -> String {
        let value = || tick_label(*self.values.get(index)?, self.unit).into();
        self.labels.get(index).cloned().or_else(value).unwrap_or_default()
    }
}

impl PlotAxis {
    /// How many values it has, including both ends.
    fn samples(&self) -> usize {
        match self.unit {
            AxisUnit::Integers => (self.to - self.from).max(1.0) as usize + 1,
            AxisUnit::Numbers | AxisUnit::Degrees => SAMPLES,
        }
    }
}

impl Plot {
    /// The main parameter at each sample, from the left.
    pub fn inputs(&self) -> impl Iterator<Item = f64> {
        let (from, to, samples) = (self.x.from, self.x.to, self.x.samples());
        (0..samples).map(move |index| from + (to - from) * index as f64 / (samples - 1) as f64)
    }

    /// What is drawn, as Markdown: the expression, and what its variables are.
    pub fn caption(&self) -> String {
        let curves = self.curves.as_ref().map_or(String::new(), |curves| {
            let labels: Vec<String> = (0..curves.values.len()).map(|at| curves.label(at)).collect();
            format!(", for `{}` = {}", curves.name, labels.join(", "))
        });
        format!("`{}` over `x`{curves}", self.value)
    }
}

/// The plots of a module, by function.
pub type Plots = BTreeMap<String, Plot>;

/// Reads a file of plots that is in the set.
pub fn parse_plots(sources: &SourceSet, id: SourceId) -> Result<Plots, Diagnostics> {
    reader::read_data(sources, id)
}

/// The path of a module's plots: `lighting/spot.plot.toml` for `lighting::spot`.
pub fn plot_path(module: &str) -> String {
    format!("{}.plot.toml", module.replace("::", "/"))
}

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 300.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 544.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 252.0;

/// The colour of lines and letters.
const INK: &str = "#7d8794";
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

fn svg_head(title: &str) -> String {
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
fn rounded_place(value: f64) -> String {
    let rounded = (value * 10.0).round() / 10.0;
    rounded.to_string()
}

const POINT: &str = "#3987e5";
/// The width of a letter and the height of a line.
const LETTER: (f64, f64) = (5.8, 11.0);
/// A name that is this far from its point is joined to it by a line.
const APART: f64 = 18.0;
/// Places of a label beside its point: its anchor, and where it is.
const PLACES: [(&str, f64, f64); 12] = [
    ("start", 7.0, 4.0),
    ("end", -7.0, 4.0),
    ("middle", 0.0, -8.0),
    ("middle", 0.0, 16.0),
    ("start", 6.0, -9.0),
    ("end", -6.0, -9.0),
    ("middle", 0.0, -20.0),
    ("start", 6.0, -21.0),
    ("end", -6.0, -21.0),
    ("middle", 0.0, -32.0),
    ("start", 6.0, -33.0),
    ("end", -6.0, -33.0),
];

/// The points: name, cost, error. The labels are those of the axes.
pub fn draw_scatter(title: &str, labels: [&str; 2], points: &[(String, f64, f64)]) -> String {
    let costs = || points.iter().map(|(_, cost, _)| cost.max(1.0).log2());
    let (from, to) = (costs().fold(f64::MAX, f64::min), costs().fold(0.0, f64::max));
    let x =
        PlotScale { from: from.min(to).floor(), to: (to + 0.3).ceil(), start: LEFT, end: RIGHT };
    let (_, most) = fitted_bounds(points.iter().map(|(.., error)| *error).chain([0.0]));
    let y = PlotScale { from: 0.0, to: most, start: BOTTOM, end: TOP };
    let mut svg = svg_head(title);
    draw_grid(&mut svg, &x, &y);
    draw_points(&mut svg, &x, &y, points);
    let middle = (LEFT + RIGHT) / 2.0;
    let [cost, error] = labels.map(escape_markup);
    let _ = writeln!(
        svg,
        "<text x=\"{LEFT}\" y=\"22\" fill=\"{INK}\" font-weight=\"600\">{}</text>\n\
         <text x=\"{RIGHT}\" y=\"22\" fill=\"{INK}\" text-anchor=\"end\">{error}</text>\n\
         <text x=\"{middle}\" y=\"290\" fill=\"{INK}\" text-anchor=\"middle\">{cost}</text>\n</svg>",
        escape_markup(title)
    );
    svg
}

fn draw_grid(svg: &mut String, x: &PlotScale, y: &PlotScale) {
    let mut lines = String::new();
    let mut numbers = String::new();
    for value in y.ticks(5.0, AxisUnit::Numbers) {
        let at = y.place(value);
        let _ = write!(lines, "M{LEFT} {}H{RIGHT}", rounded_place(at));
        let place = (rounded_place(LEFT - 8.0), rounded_place(at + 4.0));
        numbers += &number_text(place, "end", &tick_label(value, AxisUnit::Numbers));
    }
    for power in x.from as i32..=x.to as i32 {
        let at = rounded_place(x.place(f64::from(power)));
        let _ = write!(lines, "M{at} {BOTTOM}V{TOP}");
        let place = (at, rounded_place(BOTTOM + 18.0));
        numbers +=
            &number_text(place, "middle", &tick_label(f64::from(power).exp2(), AxisUnit::Numbers));
    }
    let _ = write!(
        svg,
        "<path d=\"{lines}\" stroke=\"{INK}\" stroke-opacity=\"0.25\"/>\n\
         <g fill=\"{INK}\">\n{numbers}</g>\n"
    );
}

fn number_text((x, y): (String, String), anchor: &str, text: &str) -> String {
    format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{text}</text>\n")
}

/// Each point with its name at the first place where it touches no other name and no point. The
/// points on the right come first: they have the least room.
fn draw_points(svg: &mut String, x: &PlotScale, y: &PlotScale, points: &[(String, f64, f64)]) {
    let place = |cost: f64, error: f64| (x.place(cost.max(1.0).log2()), y.place(error));
    let dots = points.iter().map(|(_, cost, error)| {
        let (at, up) = place(*cost, *error);
        [at - 4.0, up - 4.0, at + 4.0, up + 4.0]
    });
    let mut taken: Vec<[f64; 4]> = dots.collect();
    let mut points: Vec<_> = points.iter().collect();
    points.sort_by(|one, other| other.1.total_cmp(&one.1));
    for (name, cost, error) in points {
        let (at, up) = place(*cost, *error);
        let width = LETTER.0 * name.chars().count() as f64;
        let boxed = |(anchor, across, down): (&str, f64, f64)| {
            let left = match anchor {
                "start" => at + across,
                "end" => at + across - width,
                _ => at + across - width / 2.0,
            };
            [left, up + down - LETTER.1 + 2.0, left + width, up + down + 2.0]
        };
        let is_free = |place: &&(&str, f64, f64)| {
            let label = boxed(**place);
            let within = label[0] >= LEFT && label[2] <= RIGHT + 6.0 && label[3] <= BOTTOM + 6.5;
            within && !taken.iter().any(|other| boxes_overlap(&label, other))
        };
        let (anchor, across, down) = *PLACES.iter().find(is_free).unwrap_or(&PLACES[0]);
        taken.push(boxed((anchor, across, down)));
        if down < -APART {
            let (from, to) = (rounded_place(up), rounded_place(up + down + 3.0));
            let (at, beside) = (rounded_place(at), rounded_place(at + across));
            let _ = writeln!(
                svg,
                "<path d=\"M{at} {from}L{beside} {to}\" stroke=\"{INK}\" stroke-opacity=\"0.5\"/>"
            );
        }
        let _ = writeln!(
            svg,
            "<circle cx=\"{}\" cy=\"{}\" r=\"4\" fill=\"{POINT}\"/>\n\
             <text x=\"{}\" y=\"{}\" fill=\"{INK}\" font-size=\"11\" text-anchor=\"{anchor}\">{}</text>",
            rounded_place(at),
            rounded_place(up),
            rounded_place(at + across),
            rounded_place(up + down),
            escape_markup(name)
        );
    }
}

fn boxes_overlap(one: &[f64; 4], other: &[f64; 4]) -> bool {
    one[0] < other[2] && other[0] < one[2] && one[1] < other[3] && other[1] < one[3]
}

/// An interval of values, and the interval of the page on which it is drawn.
struct PlotScale {
    pub from: f64,
    pub to: f64,
    pub start: f64,
    pub end: f64,
}

impl PlotScale {
    pub fn place(&self, value: f64) -> f64 {
        self.start + (value - self.from) / (self.to - self.from) * (self.end - self.start)
    }

    /// Round values within the interval, about `count` of them.
    pub fn ticks(&self, count: f64, unit: AxisUnit) -> Vec<f64> {
        let step = tick_step((self.to - self.from) / count, unit);
        let (first, last) =
            ((self.from / step - 1e-9).ceil() as i64, (self.to / step + 1e-9).floor() as i64);
        (first..=last).map(|index| index as f64 * step).collect()
    }
}

/// Bounds of the values, extended to the next tick. The interval is not empty even if all values
/// are the same.
fn fitted_bounds(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return (0.0, 1.0);
    }
    // Most functions of light start at 0, so a scale that would start near 0 starts there.
    let low = if low > 0.0 && low < 0.4 * high { 0.0 } else { low };
    let step = tick_step((high - low).max(high.abs().max(1e-6) * 0.01) / 4.0, AxisUnit::Numbers);
    let (from, to) = ((low / step + 1e-6).floor() * step, (high / step - 1e-6).ceil() * step);
    if to > from { (from, to) } else { (from - step, from + step) }
}

/// The smallest step for ticks above a size: 1, 2 or 5 times a power of ten, or a part of a turn.
fn tick_step(size: f64, unit: AxisUnit) -> f64 {
    const PARTS: [f64; 9] = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 60.0, 90.0];
    let is_enough = |step: &f64| *step >= size * 0.999;
    if unit == AxisUnit::Degrees
        && let Some(step) = PARTS.into_iter().find(is_enough)
    {
        return step;
    }
    let power = 10f64.powf(size.log10().floor());
    let step = [1.0, 2.0, 5.0].into_iter().map(|factor| factor * power).find(is_enough);
    let step = step.unwrap_or(10.0 * power);
    if unit == AxisUnit::Integers { step.max(1.0) } else { step }
}

/// A value, as short as possible.
fn tick_label(value: f64, unit: AxisUnit) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    let text = if rounded == 0.0 { "0".to_owned() } else { rounded.to_string() };
    let sign = if unit == AxisUnit::Degrees { "\u{b0}" } else { "" };
    text.replace('-', "\u{2212}") + sign
}
