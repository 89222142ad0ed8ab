//! Blue noise: an order in which points fill a square that repeats, such that they are spread
//! evenly after any number of points.
//!
//! Ulichney, "The Void-and-Cluster Method for Dither Array Generation", 1993.

use crate::SIDE;

/// Width of the filter that tells clusters from voids, in cells.
const SIGMA: f64 = 1.9;
/// Cells that are filled at first.
const FIRST: usize = SIDE * SIDE / 10;
/// The seed of the random generator that places the first cells.
const SEED: u64 = 0x1a3b_5c7d_9e2f_4061;

const CELLS: usize = SIDE * SIDE;

/// Which cells are filled, and how crowded each is.
struct Field {
    filled: Vec<bool>,
    crowd: Vec<f64>,
    /// The weight of a filled cell for a cell at a distance, by rows and columns.
    weights: Vec<f64>,
}

impl Field {
    fn new() -> Self {
        let weight = |index: usize| {
            let wrapped = |d: usize| d.min(SIDE - d) as f64;
            let (x, y) = (wrapped(index % SIDE), wrapped(index / SIDE));
            (-(x * x + y * y) / (2.0 * SIGMA * SIGMA)).exp()
        };
        let weights = (0..CELLS).map(weight).collect();
        Self { filled: vec![false; CELLS], crowd: vec![0.0; CELLS], weights }
    }

    fn set(&mut self, cell: usize, is_filled: bool) {
        self.filled[cell] = is_filled;
        let sign = if is_filled { 1.0 } else { -1.0 };
        let (x, y) = (cell % SIDE, cell / SIDE);
        for (index, crowd) in self.crowd.iter_mut().enumerate() {
            let (dx, dy) = ((index % SIDE + SIDE - x) % SIDE, (index / SIDE + SIDE - y) % SIDE);
            *crowd += sign * self.weights[dy * SIDE + dx];
        }
    }

    /// The filled cell that is most crowded; of several, the first.
    fn cluster(&self) -> usize {
        let filled = (0..CELLS).filter(|cell| self.filled[*cell]);
        filled
            .fold(None, |best: Option<usize>, cell| match best {
                Some(best) if self.crowd[best] >= self.crowd[cell] => Some(best),
                _ => Some(cell),
            })
            .unwrap_or(0)
    }

    /// The empty cell that is least crowded; of several, the first.
    fn void(&self) -> usize {
        let empty = (0..CELLS).filter(|cell| !self.filled[*cell]);
        empty
            .fold(None, |best: Option<usize>, cell| match best {
                Some(best) if self.crowd[best] <= self.crowd[cell] => Some(best),
                _ => Some(cell),
            })
            .unwrap_or(0)
    }
}

/// For every cell, `(rank + 0.5) / CELLS`.
pub fn rows() -> Vec<Vec<f64>> {
    let mut field = first();
    let mut ranks = vec![0; CELLS];
    // Backwards from the first cells: the most crowded cell is removed first, so it has the highest
    // rank.
    let kept = field.filled.clone();
    for rank in (0..FIRST).rev() {
        let cell = field.cluster();
        ranks[cell] = rank;
        field.set(cell, false);
    }
    let mut field = Field::new();
    for cell in (0..CELLS).filter(|cell| kept[*cell]) {
        field.set(cell, true);
    }
    for rank in FIRST..CELLS {
        let cell = field.void();
        ranks[cell] = rank;
        field.set(cell, true);
    }
    ranks.iter().map(|rank| vec![(*rank as f64 + 0.5) / CELLS as f64]).collect()
}

/// Random cells, moved from clusters to voids until none moves any more.
fn first() -> Field {
    let mut field = Field::new();
    let mut state = SEED;
    let mut count = 0;
    while count < FIRST {
        // Knuth, "The Art of Computer Programming", volume 2, section 3.3.4: MMIX.
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let cell = (state >> 33) as usize % CELLS;
        if !field.filled[cell] {
            field.set(cell, true);
            count += 1;
        }
    }
    loop {
        let cluster = field.cluster();
        field.set(cluster, false);
        let void = field.void();
        field.set(void, true);
        if void == cluster {
            return field;
        }
    }
}
