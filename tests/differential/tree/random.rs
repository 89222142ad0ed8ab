//! Random choices that depend on a seed only.

use super::FLAGS;

/// The generator splitmix64.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    pub fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound as u64) as usize
    }

    pub fn chance(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }

    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for last in (1..list.len()).rev() {
            list.swap(last, self.below(last + 1));
        }
    }

    pub fn number(&mut self) -> String {
        format!("{}.{}", self.below(8), ["0", "25", "5", "125"][self.below(4)])
    }

    /// A condition over the flags.
    pub fn condition(&mut self) -> String {
        let flag = |random: &mut Self| FLAGS[random.below(FLAGS.len())].to_owned();
        match self.below(7) {
            0 | 1 => flag(self),
            2 => format!("!{}", flag(self)),
            3 => format!("{} && {}", flag(self), flag(self)),
            4 => format!("{} || !{}", flag(self), flag(self)),
            5 => format!("({} || {}) && !{}", flag(self), flag(self), flag(self)),
            _ => ["true", "false"][self.below(2)].to_owned(),
        }
    }
}
