//! `lamplight probe`: the light of an environment as nine spherical harmonics.

use std::io::Write;

use clap::{Args, ValueEnum};
use glam::DVec3;

use super::failure::Failure;
use super::render::{find_surroundings, read_environment};
use super::terminal::stdout;
use crate::catalogue::probe::ORDER;
use crate::picture::Surroundings;
use crate::scene::{MirrorBall, ProbeMapping, directions, sh9_project};

/// Print the nine coefficients of an environment, as the array `sh` of `sh9_irradiance`.
///
/// They are of its radiance, linear, a line for each with red, green and blue: divide the irradiance
/// that they give by pi for a white matt surface.
#[derive(Args)]
pub struct Arguments {
    /// A Radiance file (`.hdr`) in latitudes and longitudes, or a named environment: `studio`,
    /// `daylight`, `dusk`, `parlour`, `checks` or `constant`.
    #[arg(value_name = "NAME|FILE")]
    environment: String,

    /// The file is a square picture of a mirrored ball: the middle shows +z, the right +x, the top +y.
    #[arg(long, value_enum, value_name = "MAPPING")]
    mirror_ball: Option<Mapping>,
}

/// How far from the middle of a ball's picture a direction is seen.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Mapping {
    /// A photograph from far away.
    Photograph,
    /// A light probe of Debevec's gallery, by its angle.
    Angular,
}

/// Rows of the directions in which a named environment is seen.
const ROWS: usize = 64;
/// Rows of the directions in which a ball is seen: its picture is sharper.
const BALL_ROWS: usize = 256;

pub fn run_probe(arguments: Arguments) -> Result<(), Failure> {
    let coefficients = match arguments.mirror_ball {
        Some(mapping) => mirrored(&arguments.environment, mapping)?,
        None => projected(&find_surroundings(Some(&arguments.environment))?),
    };
    for (name, color) in ORDER.iter().zip(coefficients) {
        // Rounded here, so that no zero has a sign.
        let [r, g, b] = color.to_array().map(|one| (one * 1e6).round() / 1e6 + 0.0);
        writeln!(stdout(), "{name:<5}{r:>10.6} {g:>10.6} {b:>10.6}")?;
    }
    Ok(())
}

/// The coefficients of the radiance from all sides.
fn projected(surroundings: &Surroundings) -> [DVec3; 9] {
    match surroundings {
        Surroundings::Image(image) => sh9_project(image.samples()),
        other => {
            let seen = directions(ROWS).into_iter();
            sh9_project(seen.map(|(at, angle)| (at, angle, other.radiance(at))))
        }
    }
}

/// The coefficients of what a mirrored ball shows.
fn mirrored(name: &str, mapping: Mapping) -> Result<[DVec3; 9], Failure> {
    let mapping = match mapping {
        Mapping::Photograph => ProbeMapping::Photograph,
        Mapping::Angular => ProbeMapping::Angular,
    };
    let ball = MirrorBall::from_radiance(&read_environment(name)?, mapping)
        .map_err(|error| Failure::input(format!("`{name}`: {error}")))?;
    let seen = directions(BALL_ROWS).into_iter();
    Ok(sh9_project(seen.map(|(at, angle)| (at, angle, ball.radiance(at)))))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An environment of radiance 1 has the integral of the first harmonic alone: 4 pi over 2 sqrt(pi).
    #[test]
    fn constant_light_has_one_coefficient() {
        let found = projected(&Surroundings::Formula(|_| DVec3::ONE));
        assert!((found[0].x - 2.0 * std::f64::consts::PI.sqrt()).abs() < 1e-3);
        assert!(found[1..].iter().all(|one| one.abs().max_element() < 1e-3));
    }

    /// A photograph of a ball in a sky that is brighter above has the coefficients of that sky, and a
    /// picture that is no square is refused.
    #[test]
    fn a_ball_shows_its_sky() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ball.hdr");
        let written = |width: usize, height: usize| {
            let blank = MirrorBall::of(&|_| DVec3::ZERO, ProbeMapping::Photograph, width).unwrap();
            let pixel = |index: usize| {
                let seen = blank.direction(index % width, index / width);
                image::Rgb([seen.map_or(0.0, |d| 1.0 + d.y as f32); 3])
            };
            let pixels: Vec<_> = (0..width * height).map(pixel).collect();
            let file = std::fs::File::create(&path).unwrap();
            image::codecs::hdr::HdrEncoder::new(file).encode(&pixels, width, height).unwrap();
            mirrored(&path.to_string_lossy(), Mapping::Photograph)
        };
        let found = written(128, 128).ok().unwrap();
        // 1 + y: 2 sqrt(pi), and 2 sqrt(pi/3) for the harmonic of y.
        assert!((found[0].x - 3.5449).abs() < 0.03, "{}", found[0]);
        assert!((found[1].x - 2.0467).abs() < 0.03, "{}", found[1]);
        assert!(written(64, 32).is_err());
    }
}
