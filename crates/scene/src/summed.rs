//! Summed-area tables of moments, which `shadow::summed` of the library reads.

use glam::{DVec2, IVec2};

/// The sums of the moments of a map, each less the mean over the map.
///
/// The sums are exact to f64 here. In the 32 bits of a texture, a sum keeps 24 binary digits of itself,
/// so that differences of large sums lose digits: [`rounding`](Self::rounding) says how many.
#[derive(Debug, Clone, PartialEq)]
pub struct SummedArea {
    width: usize,
    height: usize,
    mean: DVec2,
    /// The sum over all texels from the first row and column up to this one.
    sums: Vec<DVec2>,
}

impl SummedArea {
    /// The table of a map.
    ///
    /// Parameters: `moments` the two moments of each texel, row by row from the top, as of the
    /// library's `vsm_moments` or `vsm_moments_slope`.
    /// Returns: `None` where there are not `width * height` of them, or none.
    /// Source: Crow, "Summed-Area Tables for Texture Mapping", 1984; without the mean: Hensley,
    /// Scheuermann, Coombe, Singh, Lastra, "Fast Summed-Area Table Generation and its Applications",
    /// 2005.
    pub fn of(width: usize, height: usize, moments: &[DVec2]) -> Option<Self> {
        let count = width.checked_mul(height)?;
        if count == 0 || moments.len() != count {
            return None;
        }
        let mean = moments.iter().sum::<DVec2>() / count as f64;
        let mut sums = Vec::with_capacity(count);
        for (row, texels) in moments.chunks_exact(width).enumerate() {
            let mut along = DVec2::ZERO;
            for (column, texel) in texels.iter().enumerate() {
                along += *texel - mean;
                let above = row.checked_sub(1).map(|row| sums[row * width + column]);
                sums.push(along + above.unwrap_or(DVec2::ZERO));
            }
        }
        Some(Self { width, height, mean, sums })
    }

    /// The mean moments over the map: the parameter `mean` of `summed_moments`.
    pub fn mean(&self) -> DVec2 {
        self.mean
    }

    /// The texels of a texture of two components of 32 bits, row by row from the top.
    pub fn texels(&self) -> Vec<[f32; 2]> {
        self.sums.iter().map(|sum| sum.as_vec2().to_array()).collect()
    }

    /// The mean moments of the texels from `low` up to but without `high`, each a column and a row;
    /// what is off the map does not count.
    ///
    /// Returns: `None` where no texel is between them.
    pub fn mean_of(&self, low: IVec2, high: IVec2) -> Option<DVec2> {
        let size = IVec2::new(
            i32::try_from(self.width).unwrap_or(i32::MAX),
            i32::try_from(self.height).unwrap_or(i32::MAX),
        );
        let (low, high) = (low.max(IVec2::ZERO), high.min(size));
        if low.cmpge(high).any() {
            return None;
        }
        let up_to = |x: i32, y: i32| {
            let index = |at: i32| usize::try_from(at - 1).ok();
            let (column, row) = (index(x)?, index(y)?);
            self.sums.get(row * self.width + column).copied()
        };
        let sum = |x, y| up_to(x, y).unwrap_or(DVec2::ZERO);
        let all =
            sum(high.x, high.y) - sum(low.x, high.y) - (sum(high.x, low.y) - sum(low.x, low.y));
        let sides = (high - low).as_dvec2();
        Some(all / (sides.x * sides.y) + self.mean)
    }

    /// By how much a mean over `texels` texels may be off for the rounding of [`texels`](Self::texels)
    /// alone: four sums, each by half of its last digit. The least variance of `savsm` must be larger.
    pub fn rounding(&self, texels: f64) -> DVec2 {
        let largest = self.sums.iter().fold(DVec2::ZERO, |most, sum| most.max(sum.abs()));
        largest * (4.0 * 0.5 * f64::from(f32::EPSILON)) / texels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Depths without a pattern, in [0, 1).
    fn map(width: usize, height: usize) -> Vec<DVec2> {
        let depth = |index: usize| (index as f64 * 0.754_877_666).fract();
        (0..width * height).map(|index| DVec2::new(depth(index), depth(index).powi(2))).collect()
    }

    /// A mean of the table is that of the texels, summed one by one.
    #[test]
    fn means_are_those_of_the_texels() {
        let (width, height) = (13, 7);
        let moments = map(width, height);
        let table = SummedArea::of(width, height, &moments).unwrap();
        for (low, high) in
            [([0, 0], [13, 7]), ([3, 2], [9, 3]), ([12, 0], [13, 7]), ([-4, 5], [2, 99])]
        {
            let inside = |index: &usize| {
                let (x, y) = ((index % width) as i32, (index / width) as i32);
                (low[0]..high[0]).contains(&x) && (low[1]..high[1]).contains(&y)
            };
            let texels: Vec<usize> = (0..moments.len()).filter(inside).collect();
            let wanted =
                texels.iter().map(|index| moments[*index]).sum::<DVec2>() / texels.len() as f64;
            let found = table.mean_of(IVec2::from(low), IVec2::from(high)).unwrap();
            assert!((found - wanted).length() < 1e-13, "{low:?} {high:?}: {found}, {wanted}");
        }
        assert_eq!(table.mean_of(IVec2::new(3, 3), IVec2::new(3, 5)), None);
        assert_eq!(table.mean_of(IVec2::new(20, 0), IVec2::new(30, 5)), None);
    }

    /// The sums of a map of 512 by 512 texels stay small enough for 32 bits: a mean over a texel is off
    /// by less than the usual least variance. Sums of the moments themselves reach 131,072.
    #[test]
    fn sums_are_small() {
        let table = SummedArea::of(512, 512, &map(512, 512)).unwrap();
        let texels = table.texels();
        let largest = texels.iter().flatten().fold(0.0_f32, |most, sum| most.max(sum.abs()));
        assert!(largest < 100.0, "{largest}");
        assert!(table.rounding(1.0).max_element() < 2e-5, "{}", table.rounding(1.0));
        let lost = |at: usize| {
            (DVec2::new(texels[at][0].into(), texels[at][1].into()) - table.sums[at]).abs()
        };
        let most = (0..texels.len()).map(|at| lost(at).max_element()).fold(0.0, f64::max);
        assert!(4.0 * most <= table.rounding(1.0).max_element(), "{most}");
    }

    #[test]
    fn other_counts_are_refused() {
        assert_eq!(SummedArea::of(2, 2, &[DVec2::ZERO; 3]), None);
        assert_eq!(SummedArea::of(0, 2, &[]), None);
        assert_eq!(SummedArea::of(usize::MAX, 2, &[]), None);
    }
}
