//! Maps values to places on the page, and chooses the numbers at the axes.

use super::AxisUnit;

/// An interval of values, and the interval of the page on which it is drawn.
pub struct PlotScale {
    pub from: f64,
    pub to: f64,
    pub start: f64,
    pub end: f64,
}

impl PlotScale {
    /// The place of a value.
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
pub fn fitted_bounds(values: impl Iterator<Item = f64>) -> (f64, f64) {
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
pub fn tick_label(value: f64, unit: AxisUnit) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    let text = if rounded == 0.0 { "0".to_owned() } else { rounded.to_string() };
    let sign = if unit == AxisUnit::Degrees { "\u{b0}" } else { "" };
    text.replace('-', "\u{2212}") + sign
}
