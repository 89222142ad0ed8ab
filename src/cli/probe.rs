//! `lamplight probe`: the light of an environment as nine spherical harmonics.

use std::io::Write;

use clap::Args;
use glam::DVec3;

use super::failure::Failure;
use super::render::find_surroundings;
use super::terminal::stdout;
use crate::catalogue::probe::ORDER;
use crate::picture::Surroundings;
use crate::scene::{directions, sh9_project};

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
}

/// Rows of the directions in which a named environment is seen.
const ROWS: usize = 64;

pub fn run_probe(arguments: Arguments) -> Result<(), Failure> {
    let coefficients = projected(&find_surroundings(Some(&arguments.environment))?);
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
}
