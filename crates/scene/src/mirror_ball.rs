//! Light probes: pictures of a mirrored ball, which show the surroundings in all directions.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::sky::{Equirect, Sky, decode_radiance};

/// How far from the middle of the disk a direction is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProbeMapping {
    /// A photograph of the ball from far away: at the sine of half of the angle between the direction
    /// and that to the camera.
    Photograph,
    /// The light probes of Debevec's gallery, which are made of such photographs: at the share of the
    /// angle in 180 degrees.
    Angular,
}

/// A picture of a mirrored ball, which fills the square. The camera looks along -z with +y up: the
/// middle shows the direction +z, back to the camera, and the rim shows -z, which is behind the ball.
#[derive(Debug, Clone, PartialEq)]
pub struct MirrorBall {
    mapping: ProbeMapping,
    side: usize,
    /// Linear RGB radiance, row by row from the top.
    pixels: Vec<DVec3>,
}

impl MirrorBall {
    /// A picture from its pixels, linear RGB, row by row from the top; `None` where they are not
    /// `side * side`, or none.
    pub fn new(mapping: ProbeMapping, side: usize, pixels: Vec<DVec3>) -> Option<Self> {
        let count = side.checked_mul(side)?;
        (count > 0 && pixels.len() == count).then_some(Self { mapping, side, pixels })
    }

    /// The picture that a ball in a sky gives; black beside the ball.
    pub fn of(sky: &Sky<'_>, mapping: ProbeMapping, side: usize) -> Option<Self> {
        let blank = Self { mapping, side, pixels: Vec::new() };
        let places = (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
        let seen = |(column, row)| blank.direction(column, row).map_or(DVec3::ZERO, sky);
        Self::new(mapping, side, places.map(seen).collect())
    }

    /// The picture of a Radiance file (`.hdr`).
    ///
    /// # Errors
    /// A message: as for [`Equirect::from_radiance`], or the picture is not a square.
    pub fn from_radiance(bytes: &[u8], mapping: ProbeMapping) -> Result<Self, String> {
        let (width, height, pixels) = decode_radiance(bytes)?;
        if width != height {
            return Err(format!("a picture of a ball is a square, and not {width} x {height}"));
        }
        Self::new(mapping, width, pixels).ok_or_else(|| "the image is empty".to_owned())
    }

    /// The direction that a pixel shows: `None` beside the ball.
    ///
    /// Source: Debevec, "Rendering Synthetic Objects into Real Scenes", 1998, and his light probe image
    /// gallery, where `r = acos(D.z) / pi` over the length of `(D.x, D.y)` takes a direction to its
    /// place.
    pub fn direction(&self, column: usize, row: usize) -> Option<DVec3> {
        let place = self.place(column, row);
        let radius = place.length();
        if radius > 1.0 {
            return None;
        }
        let angle = match self.mapping {
            ProbeMapping::Photograph => 2.0 * radius.asin(),
            ProbeMapping::Angular => PI * radius,
        };
        let aside = place.normalize_or_zero() * angle.sin();
        Some(DVec3::new(aside.x, aside.y, angle.cos()))
    }

    /// The middle of a pixel, in radii of the ball from its middle, to the right and upwards.
    fn place(&self, column: usize, row: usize) -> DVec2 {
        let at = |index: usize| 2.0 * (index as f64 + 0.5) / self.side as f64 - 1.0;
        DVec2::new(at(column), -at(row))
    }

    /// The radiance from a direction: linear between the pixels that show the ball. Directions near -z
    /// are all at the rim, where few pixels show them.
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        let d = direction.normalize_or(DVec3::Z);
        let angle = d.z.clamp(-1.0, 1.0).acos();
        let radius = match self.mapping {
            ProbeMapping::Photograph => (0.5 * angle).sin(),
            ProbeMapping::Angular => angle / PI,
        };
        let aside = DVec2::new(d.x, d.y).try_normalize().unwrap_or(DVec2::X);
        // Within a pixel of the rim there may be no pixel of the ball.
        let inner = (1.0 - 4.0 / self.side as f64).max(0.0);
        self.linear(aside * radius)
            .or_else(|| self.linear(aside * radius.min(inner)))
            .unwrap_or_else(|| self.pixels[self.pixels.len() / 2])
    }

    /// The weighted mean of the four pixels around a place, without those beside the ball.
    fn linear(&self, place: DVec2) -> Option<DVec3> {
        let side = self.side as f64;
        let at = (DVec2::new(place.x, -place.y) * 0.5 + 0.5) * side - 0.5;
        let corner = at.floor();
        let part = at - corner;
        let (mut sum, mut all) = (DVec3::ZERO, 0.0);
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let pixel = (corner + DVec2::new(x, y)).clamp(DVec2::ZERO, DVec2::splat(side - 1.0));
            let (column, row) = (pixel.x as usize, pixel.y as usize);
            if self.place(column, row).length() > 1.0 {
                continue;
            }
            let weight = (1.0 - (part.x - x).abs()) * (1.0 - (part.y - y).abs());
            sum += self.pixels[row * self.side + column] * weight;
            all += weight;
        }
        (all > 1e-9).then(|| sum / all)
    }
}

impl Equirect {
    /// Latitudes and longitudes of what a mirrored ball shows. Where the picture is finer than the
    /// result, pixels of it are left out: choose a `height` near its side, and a `width` of twice
    /// that.
    ///
    /// Returns: `None` for no pixels.
    pub fn from_mirror_ball(ball: &MirrorBall, width: usize, height: usize) -> Option<Self> {
        Self::of(&|direction| ball.radiance(direction), width, height)
    }
}
