//! Random numbers and conditions of generated packages.

use super::FLAGS;
use crate::random::Random;

/// What the generator of packages draws.
pub trait TreeRandom {
    /// A number in WGSL.
    fn number(&mut self) -> String;

    /// A condition over the flags.
    fn condition(&mut self) -> String;
}

impl TreeRandom for Random {
    fn number(&mut self) -> String {
        format!("{}.{}", self.below(8), ["0", "25", "5", "125"][self.below(4)])
    }

    fn condition(&mut self) -> String {
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
