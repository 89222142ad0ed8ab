//! Random numbers from a seed, the same on every machine.

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
