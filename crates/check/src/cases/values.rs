//! The values of each kind of domain. Random ones come from a seed, the same on every machine.

use crate::cases::domain::{About, Special};

pub(super) fn even_steps(count: u32, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..count).map(|i| f(f64::from(i) / f64::from((count - 1).max(1)))).collect()
}

/// Every vector of `size` components whose components are among the values.
pub(super) fn value_grid(size: usize, values: &[f64]) -> Vec<Vec<f64>> {
    (0..size).fold(vec![Vec::new()], |rows, _| {
        rows.iter()
            .flat_map(|row| values.iter().map(move |value| [row.as_slice(), &[*value]].concat()))
            .collect()
    })
}

/// Unit vectors: the axes in both directions, then random ones.
pub(super) fn unit_vectors(size: usize, count: u32, seed: u64) -> Vec<Vec<f64>> {
    let axes = (0..2 * size).map(|i| {
        (0..size).map(|c| if c == i / 2 { 1.0 - 2.0 * (i % 2) as f64 } else { 0.0 }).collect()
    });
    let mut random = Random::new(seed);
    let rest = std::iter::from_fn(|| Some(random.unit(size)));
    axes.chain(rest).take(count as usize).collect()
}

pub(super) fn related_directions(
    base: &[f64],
    kind: About,
    count: u32,
    seed: u64,
) -> Vec<Vec<f64>> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|i| match kind {
            About::Same => base.to_vec(),
            About::Hemisphere => hemisphere(base, &mut random),
            About::Grazing => grazing(base, i, &mut random),
        })
        .collect()
}

fn hemisphere(base: &[f64], random: &mut Random) -> Vec<f64> {
    let unit = random.unit(base.len());
    let side = if dot(&unit, base) < 0.0 { -1.0 } else { 1.0 };
    unit.iter().map(|x| x * side).collect()
}

/// A unit vector perpendicular to `base`, tilted towards it or away from it. The index chooses the
/// side and the tilt, from 10^-1 to 10^-7.
fn grazing(base: &[f64], index: u32, random: &mut Random) -> Vec<f64> {
    let tilt =
        10f64.powi(-1 - (index / 2 % 7) as i32) * if index.is_multiple_of(2) { 1.0 } else { -1.0 };
    let unit = random.unit(base.len());
    let along = dot(&unit, base) / dot(base, base).max(1e-300);
    let tilted: Vec<f64> = unit.iter().zip(base).map(|(x, n)| x - along * n + tilt * n).collect();
    let length = dot(&tilted, &tilted).sqrt().max(1e-300);
    tilted.iter().map(|x| x / length).collect()
}

/// The value and its f32 neighbours on both sides. All components move together.
pub(super) fn neighbours_of(value: &[f64], ulps: u32) -> Vec<Vec<f64>> {
    let neighbours = |x: f64| {
        let walk = |step: fn(f32) -> f32| {
            let next = std::iter::successors(Some(x as f32), move |at| Some(step(*at)));
            next.take(ulps as usize + 1).map(f64::from).collect::<Vec<f64>>()
        };
        // The neighbours of smaller magnitude come first, then the value, then those of larger
        // magnitude.
        let (up, down) = (walk(f32::next_up), walk(f32::next_down));
        let (behind, before) = if x as f32 >= 0.0 { (up, down) } else { (down, up) };
        before.into_iter().skip(1).rev().chain(behind).collect::<Vec<f64>>()
    };
    let columns: Vec<Vec<f64>> = value.iter().map(|x| neighbours(*x)).collect();
    (0..2 * ulps as usize + 1)
        .map(|row| columns.iter().map(|column| column[row]).collect())
        .collect()
}

pub(super) fn special_values(special: Special) -> Vec<f64> {
    let one = f64::from(1f32.next_down());
    let plain = [0.0, -0.0, 1.0, -1.0, one, f64::from(1f32.next_up()), 0.5, 2.0];
    let small = [1e-45, -1e-45, 1e-39, f64::from(f32::MIN_POSITIVE), 1e-18, -1e-18];
    let large = [1e18, -1e18];
    let mut values = plain.to_vec();
    if special != Special::Plain {
        values.extend(small);
    }
    if special == Special::All {
        values.extend(large);
    }
    values
}

pub(super) fn specials(special: Special, size: usize) -> Vec<Vec<f64>> {
    let values = special_values(special);
    if size == 1 {
        return values.iter().map(|value| vec![*value]).collect();
    }
    let splats = values.iter().map(|value| vec![*value; size]);
    let singles = values.iter().flat_map(|value| {
        (0..size).map(move |c| (0..size).map(|i| if i == c { *value } else { 0.0 }).collect())
    });
    splats.chain(singles).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The splitmix64 generator (Steele, Lea, Flood 2014): one addition and a mix for each number.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// A generator for a seed; neighbouring seeds give unrelated numbers.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Uniform in [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform on the unit sphere of `size` dimensions.
    pub fn unit(&mut self, size: usize) -> Vec<f64> {
        loop {
            let candidate: Vec<f64> = (0..size).map(|_| self.range(-1.0, 1.0)).collect();
            let squared: f64 = candidate.iter().map(|x| x * x).sum();
            if (1e-4..=1.0).contains(&squared) {
                return candidate.iter().map(|x| x / squared.sqrt()).collect();
            }
        }
    }
}
