//! The memory of all lanes: a row of numbers for each slot, one number for each lane.

use super::super::machine::Slots;

/// How many lanes run together.
pub const LANES: usize = 16;

/// A slot of all lanes.
pub type Row = [f32; LANES];

/// A bit for each lane.
pub type Mask = u32;

/// All lanes.
pub const ALL: Mask = (1 << LANES) - 1;

/// A word for each lane: all bits set if the lane is in the mask, else 0.
pub fn kept_lanes(mask: Mask) -> [u32; LANES] {
    each_lane(|lane| 0u32.wrapping_sub(mask >> lane & 1))
}

/// The results of a function for each lane. It is a plain loop, which the compiler vectorizes.
#[inline(always)]
pub fn each_lane<T: Copy + Default>(f: impl Fn(usize) -> T) -> [T; LANES] {
    let mut row = [T::default(); LANES];
    for (lane, value) in row.iter_mut().enumerate() {
        *value = f(lane);
    }
    row
}

/// The lanes of a mask.
pub fn lanes_of(mask: Mask) -> impl Iterator<Item = usize> {
    (0..LANES).filter(move |lane| mask >> lane & 1 != 0)
}

/// The memory, and the lanes that an instruction writes.
pub struct LaneRows<'m> {
    pub m: &'m mut [Row],
    /// The active lanes. Writes leave the other lanes as they are, unless `whole` is set.
    pub mask: Mask,
    /// Set if no other lane has work left. Writes may then overwrite all lanes, which is faster.
    pub whole: bool,
    /// [`kept_lanes`] of the mask.
    keep: &'m [u32; LANES],
}

impl<'m> LaneRows<'m> {
    #[inline(always)]
    pub fn new(m: &'m mut [Row], mask: Mask, whole: bool, keep: &'m [u32; LANES]) -> Self {
        Self { m, mask, whole, keep }
    }

    #[inline(always)]
    pub fn row(&self, slot: u32) -> Row {
        self.m[slot as usize]
    }

    #[inline(always)]
    pub fn words(&self, slot: u32) -> [u32; LANES] {
        let row = &self.m[slot as usize];
        each_lane(|lane| row[lane].to_bits())
    }

    #[inline(always)]
    pub fn put(&mut self, slot: u32, row: Row) {
        let to = &mut self.m[slot as usize];
        if self.whole {
            *to = row;
        } else {
            let (keep, old) = (self.keep, *to);
            *to = each_lane(|lane| {
                let (new, old) = (row[lane].to_bits(), old[lane].to_bits());
                f32::from_bits(new & keep[lane] | old & !keep[lane])
            });
        }
    }

    #[inline(always)]
    pub fn put_words(&mut self, slot: u32, words: [u32; LANES]) {
        self.put(slot, each_lane(|lane| f32::from_bits(words[lane])));
    }

    /// The active lanes whose word in a slot is not 0.
    #[inline(always)]
    pub fn truth(&self, slot: u32) -> Mask {
        if let Some(word) = self.common(slot) {
            return if word == 0 { 0 } else { self.mask };
        }
        let words = self.words(slot);
        let mut truth = 0;
        for (lane, word) in words.iter().enumerate() {
            truth |= u32::from(*word != 0) << lane;
        }
        truth & self.mask
    }

    /// The first active lane.
    #[inline(always)]
    pub fn first(&self) -> usize {
        (self.mask.trailing_zeros() as usize).min(LANES - 1)
    }

    /// Whether all active lanes have the same bits in a row.
    #[inline(always)]
    pub fn is_same(&self, row: &Row) -> bool {
        let first = row[self.first()].to_bits();
        let mut other = 0;
        for (value, keep) in row.iter().zip(self.keep) {
            other |= (value.to_bits() ^ first) & keep;
        }
        other == 0
    }

    /// The word of a slot, if it is the same in all active lanes.
    #[inline(always)]
    pub fn common(&self, slot: u32) -> Option<u32> {
        let row = &self.m[slot as usize];
        self.is_same(row).then(|| row[self.first()].to_bits())
    }

    /// Copies slots; the ranges may overlap. If a range is not inside the memory, nothing is
    /// copied, as for a single lane.
    #[inline(always)]
    pub fn copy(&mut self, to: u32, from: u32, n: u32) {
        let (first, last) = (from as usize, from as usize + n as usize);
        if last > self.m.len() || to as usize + n as usize > self.m.len() {
            return;
        }
        if self.whole && n > 4 {
            return self.m.copy_within(first..last, to as usize);
        }
        for i in 0..n {
            let i = if to <= from { i } else { n - 1 - i };
            self.put(to + i, self.row(from + i));
        }
    }

    /// The memory of one lane.
    pub fn lane(&mut self, lane: usize) -> LaneView<'_> {
        LaneView { m: self.m, lane }
    }
}

/// The memory of one lane.
pub struct LaneView<'m> {
    m: &'m mut [Row],
    lane: usize,
}

impl LaneView<'_> {
    /// Copies slots of this lane, as [`LaneRows::copy`].
    pub fn copy(&mut self, to: u32, from: u32, n: u32) {
        let (to, from, n) = (to as usize, from as usize, n as usize);
        if from + n > self.m.len() || to + n > self.m.len() {
            return;
        }
        let lane = self.lane;
        let move_one = |i: usize, m: &mut [Row]| m[to + i][lane] = m[from + i][lane];
        if to <= from {
            (0..n).for_each(|i| move_one(i, self.m));
        } else {
            (0..n).rev().for_each(|i| move_one(i, self.m));
        }
    }
}

impl Slots<f32> for LaneView<'_> {
    #[inline(always)]
    fn get(&self, slot: u32) -> f32 {
        self.m[slot as usize][self.lane]
    }

    #[inline(always)]
    fn set(&mut self, slot: u32, value: f32) {
        self.m[slot as usize][self.lane] = value;
    }
}
