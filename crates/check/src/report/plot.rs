//! Small plots as SVG.

use std::fmt::Write as _;

use crate::check::{BINS, CELLS, ErrorMap, Profile, ProfileAxis, ProfileScale, short_number};
use lamplight_diagnostic::escape_markup;

const WIDTH: f64 = 250.0;
const HEIGHT: f64 = 116.0;
const LEFT: f64 = 46.0;
const TOP: f64 = 16.0;
const RIGHT: f64 = 8.0;
const BOTTOM: f64 = 16.0;
/// Decades of the error that are shown.
const DECADES: f64 = 9.0;
/// How many colours a map has for cells within the tolerance. Cells beyond it have one more colour.
const LEVELS: usize = 8;

/// One line of a plot: class of its colour, whether it is dashed, and where its numbers are.
pub struct Series<'a> {
    pub class: usize,
    pub dashed: bool,
    pub profile: &'a Profile,
}

/// Plots the error and the tolerance over one parameter, on a logarithmic scale.
pub fn error_plot(index: usize, series: &[Series<'_>]) -> Option<String> {
    let axes: Vec<(&Series<'_>, &ProfileAxis)> =
        series.iter().filter_map(|one| Some((one, one.profile.axes.get(index)?))).collect();
    let (_, first) = axes.first()?;
    let values =
        || axes.iter().flat_map(|(_, axis)| &axis.bins).flat_map(|bin| [bin.error, bin.allowed]);
    let most = values().filter(|value| value.is_finite()).fold(0.0, f64::max);
    if most == 0.0 {
        return None;
    }
    let floor = most * 10f64.powf(-DECADES);
    let least = values().filter(|value| *value > floor).fold(most, f64::min) / 2.0;
    let frame = Decades { low: least.log10(), high: most.log10().max(least.log10() + 0.5) };
    let mut svg = format!(
        "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" class=\"plot\"><text x=\"{LEFT}\" y=\"10\" class=\"name\">{}</text>",
        escape_markup(&first.name)
    );
    let _ = write!(svg, "<path class=\"allowed\" d=\"{}\"/>", frame.area(&axes));
    for (one, axis) in &axes {
        let points: Vec<String> = axis
            .bins
            .iter()
            .map(|bin| format!("{:.1} {:.1}", x_of_index(bin.index), frame.y(bin.error)))
            .collect();
        let dash = if one.dashed { " dash" } else { "" };
        let _ =
            write!(svg, "<path class=\"line e{}{dash}\" d=\"M{}\"/>", one.class, points.join("L"));
    }
    write_labels(&mut svg, &frame, first.scale);
    Some(svg + "</svg>")
}

/// The decades that are shown.
struct Decades {
    low: f64,
    high: f64,
}

impl Decades {
    fn y(&self, value: f64) -> f64 {
        let place = if value > 0.0 {
            ((value.log10() - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        HEIGHT - BOTTOM - place * (HEIGHT - BOTTOM - TOP)
    }

    /// The area below the tolerance.
    fn area(&self, axes: &[(&Series<'_>, &ProfileAxis)]) -> String {
        let allowed = |index: usize| {
            axes.iter()
                .flat_map(|(_, axis)| &axis.bins)
                .filter(|bin| bin.index == index)
                .map(|bin| bin.allowed)
                .reduce(f64::max)
        };
        let points: Vec<(f64, f64)> = (0..BINS)
            .filter_map(|index| Some((x_of_index(index), self.y(allowed(index)?))))
            .collect();
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return String::new();
        };
        let line: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
        let floor = HEIGHT - BOTTOM;
        format!("M{:.1} {floor}L{}L{:.1} {floor}z", first.0, line.join("L"), last.0)
    }
}

fn x_of_index(index: usize) -> f64 {
    LEFT + (index as f64 + 0.5) / BINS as f64 * (WIDTH - LEFT - RIGHT)
}

fn write_labels(svg: &mut String, frame: &Decades, scale: ProfileScale) {
    let (floor, right) = (HEIGHT - BOTTOM, WIDTH - RIGHT);
    let _ = write!(svg, "<path class=\"frame\" d=\"M{LEFT} {TOP}V{floor}H{right}\"/>");
    for (value, y) in [(frame.high, TOP + 4.0), (frame.low, floor)] {
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{y}\" class=\"end\">{:.0e}</text>",
            LEFT - 3.0,
            10f64.powf(value)
        );
    }
    for (place, class) in [(0.0, "start"), (0.5, "middle"), (1.0, "end")] {
        let x = LEFT + place * (right - LEFT);
        let _ = write!(
            svg,
            "<text x=\"{x}\" y=\"{}\" class=\"{class}\">{}</text>",
            HEIGHT - 4.0,
            short_number(scale.value(place))
        );
    }
}

/// A heat map over two parameters: the error as a share of the tolerance, from light to dark.
pub fn heat_map(map: &ErrorMap, profile: &Profile) -> Option<String> {
    let (x, y) = (profile.axes.get(map.across)?, profile.axes.get(map.up)?);
    let side = HEIGHT - TOP - BOTTOM;
    let cell = side / CELLS as f64;
    let width = LEFT + side + RIGHT;
    let mut paths = vec![String::new(); LEVELS + 1];
    for (index, share) in map.cells.iter().enumerate().filter(|(_, share)| !share.is_nan()) {
        let level =
            if *share > 1.0 { LEVELS } else { ((share * LEVELS as f64) as usize).min(LEVELS - 1) };
        let (column, row) = (index % CELLS, index / CELLS);
        let _ = write!(
            paths[level],
            "M{:.1} {:.1}h{cell:.2}v{cell:.2}h-{cell:.2}z",
            LEFT + column as f64 * cell,
            TOP + side - (row + 1) as f64 * cell
        );
    }
    let names = [x, y].map(|axis| escape_markup(&axis.name));
    let title = format!("{} across, {} up: share of allowed", names[0], names[1]);
    let mut svg =
        format!("<svg viewBox=\"0 0 {width} {HEIGHT}\" class=\"plot map\"><title>{title}</title>");
    for (level, path) in paths.iter().enumerate().filter(|(_, path)| !path.is_empty()) {
        let _ = write!(svg, "<path class=\"h{level}\" d=\"{path}\"/>");
    }
    let (floor, right) = (HEIGHT - BOTTOM, LEFT + side);
    let _ = write!(
        svg,
        "<text x=\"{LEFT}\" y=\"10\" class=\"name\">{} × {}</text>",
        names[0], names[1]
    );
    for (value, y) in [(y.scale.high, TOP + 4.0), (y.scale.low, floor)] {
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{y}\" class=\"end\">{}</text>",
            LEFT - 3.0,
            short_number(value)
        );
    }
    for (value, x, class) in [(x.scale.low, LEFT, "start"), (x.scale.high, right, "end")] {
        let _ = write!(
            svg,
            "<text x=\"{x}\" y=\"{}\" class=\"{class}\">{}</text>",
            HEIGHT - 4.0,
            short_number(value)
        );
    }
    Some(svg + "</svg>")
}
