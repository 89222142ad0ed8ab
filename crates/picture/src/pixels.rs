//! Linear colours, and the pictures made of them.

use std::f64::consts::PI;

use glam::{DMat4, DVec3};
use image::ImageEncoder as _;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use rayon::prelude::*;

use super::Surroundings;
use super::needs::BackgroundKind;
use super::values::{PassCamera, UniformValues};
use lamplight_scene::irradiance_sh9;
use lamplight_scenes::linear_from_srgb;

/// Sums of linear colours. Each sample is clamped to [0, 1], so that the edges of bright things are
/// smooth.
#[derive(Debug, Clone)]
pub struct Linear {
    size: [u32; 2],
    sums: Vec<DVec3>,
    /// The first sample of each pixel, not clamped; `None` for the background.
    first: Vec<Option<DVec3>>,
    samples: u32,
}

/// An 8-bit picture, sRGB.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    /// Red, green, blue of each pixel, row by row from the top.
    pub pixels: Vec<u8>,
}

/// What is visible where nothing is drawn.
#[derive(Clone)]
pub struct Background {
    world_from_clip: DMat4,
    kind: PixelSource,
}

#[derive(Clone)]
enum PixelSource {
    /// A dark background, darker towards the edges.
    Backdrop,
    Around(Surroundings),
    /// The irradiance that the probe gives a surface whose normal is the direction, and a factor
    /// for it.
    Probe(Box<[DVec3; 9]>, f64),
    /// The colour from below, and from above.
    Hemisphere(DVec3, DVec3),
    /// The fog's own colour, and the sun in it.
    Haze(DVec3, Option<Sun>),
}

/// A sun in fog, as in the block `haze` of `forward`.
#[derive(Debug, Clone, Copy)]
struct Sun {
    light: DVec3,
    /// Unit, towards it.
    direction: DVec3,
    /// The mean cosine of the angle by which the fog scatters light.
    forwardness: f64,
}

impl Sun {
    fn of(values: &UniformValues<'_>) -> Option<Self> {
        let vector = |path| values.number(path)?.try_into().ok().map(DVec3::from_array);
        Some(Self {
            light: vector("haze.sun")?,
            direction: vector("haze.to_sun")?,
            forwardness: *values.number("haze.forwardness")?.first()?,
        })
    }

    /// The sunlight that an infinite fog scatters to the viewer along a direction, by Henyey and
    /// Greenstein's phase function.
    fn scattered(&self, view: DVec3) -> DVec3 {
        let g = self.forwardness;
        let spread = 1.0 + g * g - 2.0 * g * view.dot(self.direction);
        self.light * ((1.0 - g * g) / (4.0 * PI * spread.powf(1.5)))
    }
}

impl Background {
    /// The background that fits the pass that lights the scene.
    pub fn new(values: &UniformValues<'_>, eye: PassCamera) -> Self {
        let needs = &values.lit.needs;
        let kind = match needs.background {
            BackgroundKind::Haze => {
                let color = values.number("haze.color").and_then(|color| color.try_into().ok());
                let sun = if needs.sun { Sun::of(values) } else { None };
                PixelSource::Haze(color.map_or(values.scene.haze, DVec3::from_array), sun)
            }
            BackgroundKind::Surroundings => PixelSource::Around(values.shot.surroundings.clone()),
            BackgroundKind::Probe if needs.unlit => {
                PixelSource::Probe(Box::new(values.probe().map(DVec3::from_array)), 0.5 / PI)
            }
            BackgroundKind::Hemisphere => {
                PixelSource::Hemisphere(values.scene.ground, values.scene.sky)
            }
            BackgroundKind::Probe | BackgroundKind::Backdrop => PixelSource::Backdrop,
        };
        Self { world_from_clip: eye.clip_from_world.inverse(), kind }
    }

    /// The dark backdrop.
    pub fn backdrop(eye: PassCamera) -> Self {
        Self { world_from_clip: eye.clip_from_world.inverse(), kind: PixelSource::Backdrop }
    }

    /// The background at a place of the picture. Both coordinates are in [0, 1], from the upper
    /// left.
    pub(super) fn color(&self, u: f64, v: f64) -> DVec3 {
        let at = |depth: f64| {
            self.world_from_clip.project_point3(DVec3::new(2.0 * u - 1.0, 1.0 - 2.0 * v, depth))
        };
        let direction = || (at(1.0) - at(0.0)).normalize_or(DVec3::NEG_Z);
        match &self.kind {
            PixelSource::Backdrop => {
                let edge = ((u - 0.5).powi(2) + (v - 0.5).powi(2)) * 1.6;
                DVec3::new(0.05, 0.056, 0.068).lerp(DVec3::new(0.012, 0.014, 0.018), edge.min(1.0))
            }
            PixelSource::Around(surroundings) => surroundings.radiance(direction()),
            PixelSource::Probe(probe, scale) => {
                (irradiance_sh9(direction(), probe) * *scale).max(DVec3::ZERO)
            }
            PixelSource::Hemisphere(ground, sky) => {
                ground.lerp(*sky, (0.5 + 0.5 * direction().y * 1.6).clamp(0.0, 1.0))
            }
            PixelSource::Haze(haze, None) => *haze,
            PixelSource::Haze(haze, Some(sun)) => *haze + sun.scattered(direction()),
        }
    }
}

impl Linear {
    pub fn new(size: [u32; 2]) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        Self { size, sums: vec![DVec3::ZERO; pixels], first: vec![None; pixels], samples: 0 }
    }

    /// Adds one sample of every pixel, from a picture that was moved by `shift` pixels. `color` gives
    /// what was drawn at a pixel, counted row by row, over a background; `None` for that alone.
    pub fn add(
        &mut self,
        color: impl Fn(usize, &dyn Fn() -> DVec3) -> Option<DVec3> + Sync,
        shift: [f64; 2],
        background: &Background,
        exposure: f64,
    ) {
        let ([width, height], columns) = (self.size.map(f64::from), self.size[0].max(1) as usize);
        let (factor, is_first) = (exposure.exp2(), self.samples == 0);
        let rows = self.sums.par_chunks_mut(columns).zip(self.first.par_chunks_mut(columns));
        rows.enumerate().for_each(|(y, (sums, first))| {
            // The projection was moved by `shift` (x to the right, y upwards), in pixels. So each
            // pixel shows the background that lies `shift` to the left of it and below it.
            let v = (y as f64 + 0.5 + shift[1]) / height;
            for (x, (sum, first)) in sums.iter_mut().zip(first).enumerate() {
                let behind = || background.color((x as f64 + 0.5 - shift[0]) / width, v);
                let drawn = color(y * columns + x, &behind);
                *sum += visible_part(drawn.unwrap_or_else(behind) * factor);
                if is_first {
                    *first = drawn;
                }
            }
        });
        self.samples += 1;
    }

    /// Adds one sample of every pixel, where all pixels were drawn.
    pub fn add_all(&mut self, colors: impl Iterator<Item = DVec3>, exposure: f64) {
        let factor = exposure.exp2();
        for (sum, color) in self.sums.iter_mut().zip(colors) {
            *sum += visible_part(color * factor);
        }
        self.samples += 1;
    }

    /// Downsamples with a box filter: each pixel is the mean of a block of `factor` x `factor`.
    /// [`Self::drawn`] then returns the value of the pixel nearest to the block's middle.
    #[must_use]
    pub fn shrunk(&self, factor: u32) -> Self {
        let size = self.size.map(|side| side / factor.max(1));
        let at = |x: u32, y: u32| (y * self.size[0] + x) as usize;
        let mean = |x: u32, y: u32| {
            let parts = (0..factor).flat_map(|j| (0..factor).map(move |i| (i, j)));
            let sum: DVec3 =
                parts.map(|(i, j)| self.sums[at(factor * x + i, factor * y + j)]).sum();
            sum / f64::from(factor * factor)
        };
        let middle =
            |x: u32, y: u32| self.first[at(factor * x + factor / 2, factor * y + factor / 2)];
        let places = || (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        Self {
            size,
            sums: places().map(|(x, y)| mean(x, y)).collect(),
            first: places().map(|(x, y)| middle(x, y)).collect(),
            samples: self.samples,
        }
    }

    /// What was drawn at a pixel, neither clamped nor averaged; `None` for the background.
    pub fn drawn(&self, x: u32, y: u32) -> Option<DVec3> {
        self.first.get((y * self.size[0] + x) as usize).copied().flatten()
    }

    /// The picture in sRGB.
    pub fn develop(&self) -> Picture {
        let scale = 1.0 / f64::from(self.samples.max(1));
        let codes = Codes::new();
        let mut pixels = Vec::with_capacity(3 * self.sums.len());
        for sum in &self.sums {
            pixels.extend(sum.to_array().map(|linear| codes.of(linear * scale)));
        }
        Picture { width: self.size[0], height: self.size[1], pixels }
    }
}

/// The colour clamped to what can be shown. NaN becomes 0.
fn visible_part(seen: DVec3) -> DVec3 {
    let parts = seen.to_array().map(|part| if part.is_nan() { 0.0 } else { part });
    DVec3::from_array(parts).clamp(DVec3::ZERO, DVec3::ONE)
}

/// The 8-bit sRGB code of a linear number.
pub(crate) fn srgb_code(linear: f64) -> u8 {
    (srgb_encoded(linear) * 255.0).round() as u8
}

/// How many parts the numbers from 0 to 1 are divided into.
const PARTS: usize = 4096;

/// A table of [`srgb_code`], which saves the power for most numbers. The function is monotonic, so
/// if both ends of a part have the same code, the whole part has it.
struct Codes(Vec<Option<u8>>);

impl Codes {
    fn new() -> Self {
        let ends: Vec<u8> =
            (0..=PARTS).map(|index| srgb_code(index as f64 / PARTS as f64)).collect();
        Self(ends.windows(2).map(|two| (two[0] == two[1]).then_some(two[0])).collect())
    }

    fn of(&self, linear: f64) -> u8 {
        let known = self.0.get((linear * PARTS as f64) as usize).copied().flatten();
        known.unwrap_or_else(|| srgb_code(linear))
    }
}

/// The transfer function of sRGB.
fn srgb_encoded(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Bytes of the signature of a PNG file and of its first chunk, the header.
const PNG_HEADER_BYTES: usize = 8 + 25;

/// A PNG chunk that names the program: length, type, keyword and text, checksum. A picture with it
/// may be replaced.
const PNG_MARK: &[u8] = b"\0\0\0\x12tEXtSoftware\0Lamplight\x4f\xb9\x48\x3e";

/// Whether a file begins as one that [`Picture::png`] wrote.
pub fn is_own_png(head: &[u8]) -> bool {
    head.get(PNG_HEADER_BYTES..).is_some_and(|rest| rest.starts_with(PNG_MARK))
}

impl Picture {
    /// The picture as a PNG file.
    ///
    /// # Errors
    /// A message, if the number of pixels does not fit the size.
    pub fn png(&self) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        let encoder =
            PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
        let written = encoder.write_image(
            &self.pixels,
            self.width,
            self.height,
            image::ExtendedColorType::Rgb8,
        );
        written.map_err(|error| error.to_string())?;
        if bytes.len() > PNG_HEADER_BYTES {
            bytes.splice(PNG_HEADER_BYTES..PNG_HEADER_BYTES, PNG_MARK.iter().copied());
        }
        Ok(bytes)
    }

    /// One colour everywhere.
    pub fn filled(width: u32, height: u32, color: [u8; 3]) -> Self {
        Self { width, height, pixels: color.repeat(width as usize * height as usize) }
    }

    /// Gives a pixel a colour, if there is one at that place.
    pub fn set(&mut self, [x, y]: [u32; 2], color: [u8; 3]) {
        if x < self.width && y < self.height {
            let at = 3 * (y as usize * self.width as usize + x as usize);
            self.pixels[at..at + 3].copy_from_slice(&color);
        }
    }

    /// The colour of a pixel; black outside.
    pub fn pixel(&self, [x, y]: [u32; 2]) -> [u8; 3] {
        let at = 3 * (y as usize * self.width as usize + x as usize);
        let inside = x < self.width && y < self.height;
        let found = if inside { self.pixels.get(at..at + 3) } else { None };
        found.and_then(|found| found.try_into().ok()).unwrap_or_default()
    }

    /// The picture with its rows in the other order.
    #[must_use]
    pub fn upside_down(&self) -> Self {
        let rows = self.pixels.chunks(3 * self.width.max(1) as usize).rev();
        Self { pixels: rows.flatten().copied().collect(), ..*self }
    }

    /// Puts another picture over this one.
    pub fn place(&mut self, other: &Self, [left, top]: [u32; 2]) {
        for (index, color) in other.pixels.as_chunks::<3>().0.iter().enumerate() {
            let index = index as u32;
            self.set([left + index % other.width, top + index / other.width], *color);
        }
    }

    /// A part of the picture. What is outside of the picture is black.
    #[must_use]
    pub fn part(&self, [left, top]: [u32; 2], [width, height]: [u32; 2]) -> Self {
        let mut part = Self::filled(width, height, [0; 3]);
        let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        places.for_each(|[x, y]| part.set([x, y], self.pixel([left + x, top + y])));
        part
    }

    /// Draws the outline of a rectangle, one pixel wide.
    pub fn outline(&mut self, [left, top]: [u32; 2], [width, height]: [u32; 2], color: [u8; 3]) {
        for x in left..left + width {
            self.set([x, top], color);
            self.set([x, (top + height).saturating_sub(1)], color);
        }
        for y in top..top + height {
            self.set([left, y], color);
            self.set([(left + width).saturating_sub(1), y], color);
        }
    }

    /// The picture, downsampled with a box filter: each pixel is the mean of a block of `factor` x
    /// `factor` pixels in linear light. What remains at the right and the bottom is cut off.
    #[must_use]
    pub fn shrunk(&self, factor: u32) -> Self {
        let factor = factor.max(1);
        let (width, height) = (self.width / factor, self.height / factor);
        let light: Vec<f64> =
            (0..=255).map(|byte| linear_from_srgb(f64::from(byte) / 255.0)).collect();
        let mean = |x: u32, y: u32, channel: u32| {
            let at = |i: u32, j: u32| {
                let pixel = (y * factor + j) * self.width + x * factor + i;
                light[usize::from(self.pixels[(3 * pixel + channel) as usize])]
            };
            let all = (0..factor).flat_map(|j| (0..factor).map(move |i| (i, j)));
            let sum: f64 = all.map(|(i, j)| at(i, j)).sum();
            srgb_code(sum / f64::from(factor * factor))
        };
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let pixels = places.flat_map(|(x, y)| [0, 1, 2].map(|channel| mean(x, y, channel)));
        Self { width, height, pixels: pixels.collect() }
    }

    /// The picture of a PNG file.
    ///
    /// # Errors
    /// A message, if the bytes are not a PNG file.
    pub fn from_png(bytes: &[u8]) -> Result<Self, String> {
        let decoded = image::load_from_memory_with_format(bytes, image::ImageFormat::Png)
            .map_err(|error| error.to_string())?;
        let pixels = decoded.to_rgb8();
        Ok(Self { width: pixels.width(), height: pixels.height(), pixels: pixels.into_raw() })
    }
}
