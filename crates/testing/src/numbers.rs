//! Comparisons of numbers, with messages that name what was compared.

use glam::DVec3;
use libtest_mimic::Failed;

/// Fails if two numbers differ by more than `error`, or if one is not a number.
pub fn near(what: &str, found: f64, wanted: f64, error: f64) -> Result<(), Failed> {
    if (found - wanted).abs() <= error {
        Ok(())
    } else {
        Err(format!("{what}: {found}, wanted {wanted} within {error:e}").into())
    }
}

/// [`near`] for each component.
pub fn near_vector(what: &str, found: DVec3, wanted: DVec3, error: f64) -> Result<(), Failed> {
    if (found - wanted).abs().cmple(DVec3::splat(error)).all() {
        Ok(())
    } else {
        Err(format!("{what}: {found}, wanted {wanted} within {error:e}").into())
    }
}
