//! Visibility from four moments of random depths, some of which the point is behind.

use super::Calls;
use crate::random::Random;

/// The bias of the moments, as large as rounding to 32 bits needs.
const BIAS: f64 = 3e-5;

/// Depths and their weights, whose sum is 1.
struct Depths(Vec<(f64, f64)>);

impl Depths {
    /// Depths that are at least `apart` from each other.
    fn random(random: &mut Random, count: usize, apart: f64) -> Self {
        loop {
            let mut depths: Vec<f64> = (0..count).map(|_| random.fraction()).collect();
            depths.sort_by(f64::total_cmp);
            if depths.windows(2).all(|pair| pair[1] - pair[0] >= apart) {
                let weights: Vec<f64> = depths.iter().map(|_| 0.05 + random.fraction()).collect();
                let sum: f64 = weights.iter().sum();
                let one = |(depth, weight)| (depth, weight / sum);
                return Self(depths.into_iter().zip(weights).map(one).collect());
            }
        }
    }

    fn moments(&self) -> Vec<f64> {
        (1..=4).map(|power| self.0.iter().map(|(d, weight)| weight * d.powi(power)).sum()).collect()
    }

    /// The share of depths that a point is not behind.
    fn lit(&self, t: f64) -> f64 {
        self.0.iter().filter(|(depth, _)| *depth >= t).map(|(_, weight)| weight).sum()
    }
}

/// For two to five random depths, the result is at least the lit share, apart from an error of the
/// bias. Peters and Klein, "Moment Shadow Mapping", 2015, section 3.2: the shadow is a lower bound,
/// so that no surface shadows itself.
pub fn bound_the_shadow(calls: &mut Calls<'_>) -> Result<(), String> {
    let mut random = Random(1);
    let (mut rows, mut lit) = (Vec::new(), Vec::new());
    for index in 0..20_000 {
        let depths = Depths::random(&mut random, 2 + index % 4, 0.02);
        let t = f64::from(random.fraction() as f32);
        rows.push([depths.moments(), vec![t, BIAS]].concat());
        lit.push(depths.lit(t));
    }
    let kernel = calls.kernel("shadow::moments", "msm_visibility")?;
    let found = calls.run(&kernel, &rows)?;
    let darker = lit.iter().zip(&found).map(|(lit, found)| lit - found);
    let (row, worst) = darker.enumerate().fold((0, 0.0), |a, b| if b.1 > a.1 { b } else { a });
    // Somewhere the bound must be sharp, or a visibility of 1 would pass.
    let sharp =
        lit.iter().zip(&found).filter(|(lit, found)| (**found - **lit).abs() < 0.01).count();
    if worst > BIAS || sharp < found.len() / 4 {
        let what =
            format!("{:?}: {}, and {} of the depths are lit", rows[row], found[row], lit[row]);
        return Err(format!("{what}: too dark by {worst}; {sharp} are sharp"));
    }
    Ok(())
}

/// For a point at one of three depths, the bound is the truth: no other depths have these moments.
pub fn three_depths(calls: &mut Calls<'_>) -> Result<(), String> {
    let mut random = Random(2);
    let (mut rows, mut lit) = (Vec::new(), Vec::new());
    for index in 0..3_000 {
        let depths = Depths::random(&mut random, 3, 0.2);
        let t = depths.0[index % 3].0;
        rows.push([depths.moments(), vec![t, BIAS]].concat());
        lit.push(depths.lit(t));
    }
    let kernel = calls.kernel("shadow::moments", "msm_visibility")?;
    let found = calls.run(&kernel, &rows)?;
    let apart = lit.iter().zip(&found).map(|(lit, found)| (lit - found).abs());
    let (row, worst) = apart.enumerate().fold((0, 0.0), |a, b| if b.1 > a.1 { b } else { a });
    match worst > 2e-3 {
        true => {
            Err(format!("{:?}: {}, expected {}: off by {worst}", rows[row], found[row], lit[row]))
        }
        false => Ok(()),
    }
}
