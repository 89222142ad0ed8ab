//! Environments: images around a point, from Radiance files (`.hdr`) among others, and skies given by
//! a formula.

use glam::DVec3;
use image::ImageDecoder as _;
use image::codecs::hdr::HdrDecoder;
use lamplight_files::limits::ENVIRONMENT_PIXELS;
use lamplight_files::sandbox::try_in_sandbox;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Radiance by direction, linear RGB. The direction is of unit length, world space.
pub type Sky<'a> = dyn Fn(DVec3) -> DVec3 + Sync + 'a;

/// A light probe as an equirectangular image: rows from +y down to -y, columns once around from
/// -x over -z, +x and +z, so that -z is in the middle of the left half.
#[derive(Debug, Clone, PartialEq)]
pub struct Equirect {
    width: usize,
    height: usize,
    /// Linear RGB radiance, row by row.
    pixels: Vec<DVec3>,
}

impl Equirect {
    /// An image from its pixels; `None` where they are not `width * height`, or none.
    pub fn new(width: usize, height: usize, pixels: Vec<DVec3>) -> Option<Self> {
        (width > 0 && pixels.len() == width * height && height > 0).then_some(Self {
            width,
            height,
            pixels,
        })
    }

    /// An image of a sky, sampled in the middle of each pixel.
    pub fn of(sky: &Sky<'_>, width: usize, height: usize) -> Option<Self> {
        let blank = Self { width, height, pixels: Vec::new() };
        let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        Self::new(
            width,
            height,
            pixels.map(|(column, row)| sky(blank.direction(column, row))).collect(),
        )
    }

    /// The direction through the middle of a pixel.
    pub fn direction(&self, column: usize, row: usize) -> DVec3 {
        let around = TAU * (column as f64 + 0.5) / self.width as f64;
        let down = PI * (row as f64 + 0.5) / self.height as f64;
        DVec3::new(-around.cos() * down.sin(), down.cos(), -around.sin() * down.sin())
    }

    /// The solid angle of a pixel of that row, steradians; all pixels together have 4 pi.
    pub fn solid_angle(&self, row: usize) -> f64 {
        let edge = |row: usize| (PI * row as f64 / self.height as f64).cos();
        TAU / self.width as f64 * (edge(row) - edge(row + 1))
    }

    /// Every pixel: the direction through it, its solid angle, and its radiance.
    pub fn samples(&self) -> impl Iterator<Item = (DVec3, f64, DVec3)> {
        self.pixels.iter().enumerate().map(|(index, radiance)| {
            let (column, row) = (index % self.width, index / self.width);
            (self.direction(column, row), self.solid_angle(row), *radiance)
        })
    }

    /// The radiance from a direction: linear between pixels, around the seam and over the poles.
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        let d = direction.normalize_or_zero();
        let around = (-d.z).atan2(-d.x).rem_euclid(TAU) / TAU * self.width as f64 - 0.5;
        let down = (FRAC_PI_2 - d.y.clamp(-1.0, 1.0).asin()) / PI * self.height as f64 - 0.5;
        let (height, top) = (self.height as f64, down.floor());
        let row = |row: f64| {
            // Beyond a pole, the image continues in the nearest rows, half way around.
            let beyond = row < 0.0 || row >= height;
            let inside = if row < 0.0 { -1.0 - row } else { row.min(2.0 * height - 1.0 - row) };
            let around = if beyond { around + 0.5 * self.width as f64 } else { around };
            let left = around.floor();
            let pixel = |column: f64| {
                self.pixels
                    [inside as usize * self.width + column.rem_euclid(self.width as f64) as usize]
            };
            pixel(left).lerp(pixel(left + 1.0), around - left)
        };
        row(top).lerp(row(top + 1.0), down - top)
    }
}

/// The stage of [`try_in_sandbox`] that runs the decoder.
pub const DECODER: &str = "picture";

impl Equirect {
    /// The image of a Radiance file (`.hdr`).
    ///
    /// # Errors
    /// A message: the bytes are not such a file, the image is too large, or its decoder needs too
    /// much memory or time.
    pub fn from_radiance(bytes: &[u8]) -> Result<Self, String> {
        let (width, height, pixels) = decode_radiance(bytes)?;
        Self::new(width, height, pixels).ok_or_else(|| "the image is empty".to_owned())
    }
}

/// The width, the height and the pixels of a Radiance file, row by row from the top.
pub fn decode_radiance(bytes: &[u8]) -> Result<(usize, usize, Vec<DVec3>), String> {
    let decoder =
        HdrDecoder::new(std::io::Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions();
    // The header alone decides how much memory is allocated, so it is checked first.
    if u64::from(width) * u64::from(height) > ENVIRONMENT_PIXELS {
        return Err(format!("{width} x {height} pixels are more than {ENVIRONMENT_PIXELS}"));
    }
    // Images up to 4096 x 2048 are decoded without the sandbox.
    if u64::from(width) * u64::from(height) > ENVIRONMENT_PIXELS / 2 {
        try_in_sandbox(DECODER, bytes).map_err(|how| format!("its decoder {how}"))?;
    }
    let mut read =
        vec![0; usize::try_from(decoder.total_bytes()).map_err(|error| error.to_string())?];
    decoder.read_image(&mut read).map_err(|error| error.to_string())?;
    let number = |bytes: &[u8; 4]| f64::from(f32::from_ne_bytes(*bytes));
    let pixels = read.as_chunks::<12>().0.iter().map(|rgb| {
        let [red, green, blue] = [0, 4, 8].map(|at| rgb[at..].first_chunk().map_or(0.0, number));
        DVec3::new(red, green, blue)
    });
    Ok((width as usize, height as usize, pixels.collect()))
}
