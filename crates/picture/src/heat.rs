//! Heat maps: a number of each pixel in the place of its colour, with a scale.

use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_execute::kernel::SENTINEL;
use lamplight_execute::raster::{Measure, Measured, Measuring, draw_frames};

use super::Shot;
use super::pixels::Picture;
use super::prepared::{PreparedPass, no_frame};
use super::strip::write_label;
use lamplight_execute::frame::EntryPoint;

/// What each pixel has.
#[derive(Debug, Clone)]
pub struct HeatMap {
    size: [u32; 2],
    /// Row by row from the top; `None` where nothing was drawn.
    values: Vec<Option<Measured>>,
    /// How many components a value has: 1 to 3.
    components: usize,
    /// Whether the scale is one of powers of ten.
    is_logarithmic: bool,
}

/// The numbers of a heat map in short.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// The smallest finite number.
    pub lowest: f64,
    /// The largest finite number.
    pub highest: f64,
    /// How many pixels have a value.
    pub pixels: usize,
    /// How many have the largest value.
    pub at_highest: usize,
    /// How many have a value that is no number.
    pub nan: usize,
    /// How many have an infinite value.
    pub infinite: usize,
    /// How many fragments ran without coming to the variable.
    pub missing: usize,
}

/// Where nothing was drawn, where there is no value, and what is no number or infinite.
const NOTHING: [u8; 3] = [24, 24, 28];
const MISSING: [u8; 3] = [84, 84, 90];
const NAN: [u8; 3] = [255, 0, 60];
const INFINITE: [u8; 3] = [255, 255, 255];

/// The colours from the lowest to the highest value, which grow lighter.
const RAMP: [[f64; 3]; 6] = [
    [8.0, 10.0, 40.0],
    [40.0, 40.0, 140.0],
    [130.0, 40.0, 150.0],
    [215.0, 75.0, 90.0],
    [245.0, 160.0, 60.0],
    [250.0, 245.0, 170.0],
];

/// The height of the scale below the picture.
const LEGEND: u32 = 44;

impl PreparedPass {
    /// Measures the fragment that each pixel shows: the nearest one, also where it is blended over
    /// others.
    ///
    /// # Errors
    /// A name that no variable has, and those of the stages.
    pub fn measure(&self, measure: &Measure, shot: &Shot) -> Result<HeatMap, Diagnostics> {
        let size = shot.size;
        let mut values = vec![None; size[0] as usize * size[1] as usize];
        let mut components = 1;
        for slice in std::iter::once(self).chain(&self.farther) {
            let mut shown = slice.measured(measure, size).map_err(|problem| vec![problem])?;
            if let Some(blended) = &slice.blended {
                shown.cover(blended.measured(measure, size).map_err(|problem| vec![problem])?);
            }
            components = shown.components;
            for (value, (own, _)) in values.iter_mut().zip(shown.pixels) {
                *value = value.or(own);
            }
        }
        let is_logarithmic = *measure == Measure::Error;
        Ok(HeatMap { size, values, components, is_logarithmic })
    }

    /// Measures the nearest fragment of each pixel, of the objects of this pass alone.
    fn measured(&self, measure: &Measure, size: [u32; 2]) -> Result<Layer, Diagnostic> {
        let stage = self.stages.fragment.as_ref().ok_or_else(no_frame)?;
        let view = self.eye_view([0.0; 2], size)?;
        let (items, views) = (self.items().collect::<Vec<_>>(), std::slice::from_ref(&view));
        // As its author wrote it: what is drawn on devices has counters in its loops.
        let entry = EntryPoint { module: &stage.written.module, entry: stage.entry };
        let drawing = self.drawing(&items, views, size, Some((entry, 1)));
        let measuring = Measuring::new(&drawing, measure)?;
        let frames = draw_frames(&drawing, &measuring)?;
        let frame = frames.first().ok_or_else(no_frame)?;
        let (words, _) = frame.targets.first().map_or(&[][..], Vec::as_slice).as_chunks::<4>();
        let pixel = |(at, words): (usize, &[u32; 4])| {
            let value = (*words != [SENTINEL; 4]).then(|| Measured::of_words(*words));
            (value, frame.depth.get(at).copied().unwrap_or(1.0))
        };
        let pixels = words.iter().enumerate().map(pixel).collect();
        Ok(Layer { pixels, components: measuring.components() as usize })
    }
}

/// What was drawn of some objects: of each pixel what it has, if anything, and its depth.
struct Layer {
    pixels: Vec<(Option<Measured>, f32)>,
    components: usize,
}

impl Layer {
    /// Draws over it what is nearer.
    fn cover(&mut self, other: Self) {
        for (own, other) in self.pixels.iter_mut().zip(other.pixels) {
            if other.0.is_some() && (own.0.is_none() || other.1 < own.1) {
                *own = other;
            }
        }
    }
}

impl HeatMap {
    /// The value of a pixel, if it has one.
    pub fn value(&self, [x, y]: [u32; 2]) -> Option<[f32; 3]> {
        let at = y as usize * self.size[0] as usize + x as usize;
        self.values.get(at).copied().flatten()?.0
    }

    /// The same, with the lowest row first.
    #[must_use]
    pub fn upside_down(mut self) -> Self {
        let width = self.size[0].max(1) as usize;
        self.values = self.values.chunks(width).rev().flatten().copied().collect();
        self
    }

    fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        let shown = self.values.iter().flatten().filter_map(|measured| measured.0);
        shown.flat_map(|value| value.into_iter().take(self.components)).map(f64::from)
    }

    /// Its numbers in short.
    pub fn scale(&self) -> Scale {
        let finite = || self.numbers().filter(|number| number.is_finite());
        let (lowest, highest) =
            (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
        let (lowest, highest) = if lowest <= highest { (lowest, highest) } else { (0.0, 0.0) };
        let shown: Vec<[f32; 3]> =
            self.values.iter().flatten().filter_map(|measured| measured.0).collect();
        let count = |is_meant: &dyn Fn(f64) -> bool| {
            let has = |value: &&[f32; 3]| {
                value.iter().take(self.components).any(|part| is_meant(f64::from(*part)))
            };
            shown.iter().filter(has).count()
        };
        Scale {
            lowest,
            highest,
            pixels: shown.len(),
            at_highest: count(&|number| number == highest),
            nan: count(&f64::is_nan),
            infinite: count(&f64::is_infinite),
            missing: self.values.iter().flatten().filter(|measured| measured.0.is_none()).count(),
        }
    }

    /// The picture, with the scale below it.
    pub fn picture(&self, name: &str) -> Picture {
        let ([width, height], scale) = (self.size, self.scale());
        let reach = self.reach(&scale);
        let mut picture = Picture::filled(width, height + LEGEND, NOTHING);
        for y in 0..height {
            for x in 0..width {
                let at = y as usize * width as usize + x as usize;
                match self.values.get(at).copied().flatten() {
                    None => {}
                    Some(Measured(None)) => picture.set([x, y], MISSING),
                    Some(Measured(Some(value))) => {
                        picture.set([x, y], self.color(value, reach));
                    }
                }
            }
        }
        self.legend(&mut picture, name, reach);
        picture
    }

    /// Where the colours begin and end: a scale of powers of ten begins at the smallest number above 0.
    fn reach(&self, scale: &Scale) -> Reach {
        let (is_logarithmic, to) = (self.is_logarithmic, scale.highest);
        let from = if is_logarithmic {
            let above = self.numbers().filter(|number| *number > 0.0 && number.is_finite());
            above.fold(f64::INFINITY, f64::min).min(to.max(f64::MIN_POSITIVE))
        } else {
            scale.lowest
        };
        Reach { from, to, is_logarithmic }
    }

    fn color(&self, value: [f32; 3], reach: Reach) -> [u8; 3] {
        let parts = &value[..self.components.min(3)];
        if parts.iter().any(|part| part.is_nan()) {
            return NAN;
        }
        if parts.iter().any(|part| part.is_infinite()) {
            return INFINITE;
        }
        let share = |part: &f32| reach.share(f64::from(*part)).clamp(0.0, 1.0);
        if let [one] = parts {
            return ramp(share(one));
        }
        let mut color = [0; 3];
        for (channel, part) in color.iter_mut().zip(parts) {
            *channel = (255.0 * share(part)).round() as u8;
        }
        color
    }

    fn legend(&self, picture: &mut Picture, name: &str, reach: Reach) {
        let [width, top] = self.size;
        let last = f64::from(width.saturating_sub(1).max(1));
        for x in 0..width {
            let share = f64::from(x) / last;
            let grey = [(255.0 * share).round() as u8; 3];
            let color = if self.components == 1 { ramp(share) } else { grey };
            (top + 4..top + 16).for_each(|y| picture.set([x, y], color));
        }
        let [from, to] = [reach.from, reach.to].map(short);
        // A letter is ten pixels wide.
        let room = |text: &str| 10 * text.chars().count() as u32;
        write_label(picture, &from, [2, top + 20], width.saturating_sub(2));
        let right = width.saturating_sub(room(&to) + 2);
        if right > room(&from) + 8 {
            write_label(picture, &to, [right, top + 20], width - right);
            let middle = (room(&from) + right).saturating_sub(room(name)) / 2;
            if middle > room(&from) + 8 && middle + room(name) + 8 < right {
                write_label(picture, name, [middle, top + 20], width - middle);
            }
        }
    }
}

/// Where the colours begin and end.
#[derive(Debug, Clone, Copy)]
struct Reach {
    from: f64,
    to: f64,
    is_logarithmic: bool,
}

impl Reach {
    /// Where a number is on the way.
    fn share(self, number: f64) -> f64 {
        let Self { from, to, is_logarithmic } = self;
        if is_logarithmic {
            let (floor, span) = (from.log10(), to.log10() - from.log10());
            return if number > 0.0 && span > 0.0 { (number.log10() - floor) / span } else { 0.0 };
        }
        if to > from { (number - from) / (to - from) } else { 0.0 }
    }
}

fn ramp(share: f64) -> [u8; 3] {
    let place = share * (RAMP.len() - 1) as f64;
    let at = (place as usize).min(RAMP.len() - 2);
    let rest = place - at as f64;
    std::array::from_fn(|channel| {
        (RAMP[at][channel] + rest * (RAMP[at + 1][channel] - RAMP[at][channel])).round() as u8
    })
}

/// A number in a few letters.
pub fn short(number: f64) -> String {
    let plain = number == 0.0 || (1e-3..1e6).contains(&number.abs());
    let text = if plain { format!("{number:.4}") } else { format!("{number:.2e}") };
    match plain {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(values: &[Option<[f32; 3]>], components: usize) -> HeatMap {
        let size = [values.len() as u32, 1];
        let values = values.iter().map(|value| Some(Measured(*value))).collect();
        HeatMap { size, values, components, is_logarithmic: false }
    }

    #[test]
    fn scales() {
        let values = [1.0, 3.0, f32::NAN, f32::INFINITY, 3.0].map(|value| Some([value; 3]));
        let mut heat = map(&values, 1);
        heat.values.extend([Some(Measured(None)), None]);
        let scale = heat.scale();
        assert_eq!((scale.lowest, scale.highest, scale.pixels), (1.0, 3.0, 5));
        assert_eq!((scale.at_highest, scale.nan, scale.infinite, scale.missing), (2, 1, 1, 1));
        let picture = heat.picture("x");
        assert_eq!(picture.pixel([0, 0]), ramp(0.0));
        assert_eq!(picture.pixel([1, 0]), ramp(1.0));
        assert_eq!((picture.pixel([2, 0]), picture.pixel([3, 0])), (NAN, INFINITE));
    }

    /// From the smallest number above 0, each factor is a step of one length.
    #[test]
    fn powers() {
        let values = [0.0, 20.0_f32.exp2().recip(), 16.0_f32.exp2().recip(), 1.0];
        let heat =
            HeatMap { is_logarithmic: true, ..map(&values.map(|value| Some([value; 3])), 1) };
        let picture = heat.picture("error");
        let found = [0, 1, 2, 3].map(|x| picture.pixel([x, 0]));
        // The third has gone 4 of 20 steps: a fifth of the way, where the second colour is.
        assert_eq!(found, [[8, 10, 40], [8, 10, 40], [40, 40, 140], [250, 245, 170]]);
    }

    /// A map of as many numbers as a picture has pixels, each of which has another one.
    #[test]
    fn a_large_map() {
        let side = 512;
        let values = (1..=side * side).map(|at| Some(Measured(Some([at as f32; 3])))).collect();
        let heat = HeatMap { size: [side; 2], values, components: 1, is_logarithmic: true };
        let picture = heat.picture("error");
        assert_eq!(picture.pixel([0, 0]), ramp(0.0));
        assert_eq!(picture.pixel([side - 1, side - 1]), ramp(1.0));
    }

    #[test]
    fn vectors_are_colours() {
        let heat = map(&[Some([-1.0, 0.0, 1.0]), Some([1.0, 1.0, 1.0])], 3);
        let picture = heat.picture("n");
        assert_eq!(picture.pixel([0, 0]), [0, 128, 255]);
        assert_eq!(picture.pixel([1, 0]), [255; 3]);
    }

    #[test]
    fn ramps_grow_lighter() {
        let light = |share: f64| {
            let [r, g, b] = ramp(share).map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let all: Vec<f64> = (0..=20).map(|step| light(f64::from(step) / 20.0)).collect();
        assert!(all.windows(2).all(|pair| pair[0] < pair[1]), "{all:?}");
    }

    #[test]
    fn short_numbers() {
        let found = [0.0, 0.5, 12.0, 1.0e-7, 1.5e9, -3.25].map(short);
        assert_eq!(found, ["0", "0.5", "12", "1.00e-7", "1.50e9", "-3.25"]);
    }
}
