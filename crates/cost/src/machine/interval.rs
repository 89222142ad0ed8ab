//! Between which numbers a register of 32 bits lies.

use super::text::constant_of;

/// Numbers from the least to the most, as signed ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Interval {
    pub least: i64,
    pub most: i64,
}

const LOWEST: i64 = i32::MIN as i64;
const HIGHEST: i64 = i32::MAX as i64;

impl Interval {
    const ANY: Self = Self { least: LOWEST, most: HIGHEST };

    pub fn exactly(value: i64) -> Self {
        Self { least: value, most: value }
    }

    pub fn is_exact(self) -> bool {
        self.least == self.most
    }

    /// What an instruction writes, by what is known of its operands. The first one is where it
    /// writes.
    pub fn written(name: &str, operand: impl Fn(usize) -> Option<Self>) -> Option<Self> {
        let signed = |index: usize| operand(index).unwrap_or(Self::ANY);
        match name {
            "s_mov_b32" | "s_movk_i32" | "v_mov_b32" => operand(1),
            "s_cselect_b32" => Some(operand(1)?.hull(operand(2)?)),
            "s_min_i32" | "v_min_i32" => {
                Some(signed(1).with(signed(2), |one, other| one.min(other)))
            }
            "s_max_i32" | "v_max_i32" => {
                Some(signed(1).with(signed(2), |one, other| one.max(other)))
            }
            "s_min_u32" | "v_min_u32" => {
                let known =
                    [1, 2].into_iter().filter_map(&operand).filter(|known| known.least >= 0);
                let most = known.map(|known| known.most).min()?;
                Some(Self { least: 0, most })
            }
            "v_med3_i32" => Some(Self::median([1, 2, 3].map(signed))),
            // Unsigned, a number that may be negative is as good as unknown.
            "v_med3_u32" => {
                let of = |index| operand(index).filter(|known| known.least >= 0);
                let [one, other] = known_pair([of(1), of(2), of(3)])?;
                Some(one.hull(other))
            }
            _ => None,
        }
    }

    fn with(self, other: Self, combine: impl Fn(i64, i64) -> i64) -> Self {
        Self { least: combine(self.least, other.least), most: combine(self.most, other.most) }
    }

    /// The least interval around both.
    fn hull(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), most: self.most.max(other.most) }
    }

    fn median(of: [Self; 3]) -> Self {
        let middle = |mut values: [i64; 3]| {
            values.sort_unstable();
            values[1]
        };
        Self { least: middle(of.map(|one| one.least)), most: middle(of.map(|one| one.most)) }
    }
}

/// The two of three that are known and end first: the median of the three lies between them.
fn known_pair(of: [Option<Interval>; 3]) -> Option<[Interval; 2]> {
    let mut known: Vec<Interval> = of.into_iter().flatten().collect();
    known.sort_by_key(|known| known.most);
    known.first_chunk().copied()
}

/// A constant among the operands of an instruction. Those of some are 16 bits with a sign.
pub fn immediate_of(name: &str, operand: &str) -> Option<i64> {
    let is_short = ["s_movk_i32", "s_addk_i32"].contains(&name)
        || name.starts_with("s_cmpk_") && name.ends_with("_i32");
    let value = constant_of(operand)?;
    Some(if is_short { i64::from(value as i16) } else { value })
}
