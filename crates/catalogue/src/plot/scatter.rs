//! Draws points with their names: cost to the right, on a logarithmic scale, and error upwards.

use std::fmt::Write as _;

use super::AxisUnit;
use super::scale::{PlotScale, fitted_bounds, tick_label};
use super::svg::{BOTTOM, INK, LEFT, RIGHT, TOP, rounded_place, svg_head};
use lamplight_diagnostic::escape_markup;

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
