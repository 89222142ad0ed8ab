//! Lists of the lamps that reach each cell of the view frustum, for the axis `clustered`.

use std::collections::BTreeMap;

use glam::{DMat4, DVec2, DVec3};

/// Where a lamp shines: a ball in world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// The middle, in world space.
    pub position: DVec3,
    /// Beyond this distance the lamp adds nothing, scene units. Infinite for lamps that reach
    /// everything.
    pub range: f64,
}

/// Cells of the view frustum. Their slices of the depth grow by a constant factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cells {
    /// Number of cells across, down and in depth, each at least 1.
    pub counts: [u32; 3],
    /// Where the slices begin, scene units, more than 0. The first slice also holds what is nearer.
    pub near: f64,
    /// Where the slices end, scene units, more than `near`. The last slice also holds what is
    /// farther.
    pub far: f64,
}

/// The lists as the uniform block `clusters` has them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Clusters {
    /// For each cell, the place of its first index in the low 16 bits, and how many indices there
    /// are in the high 16 bits.
    pub cells: Vec<u32>,
    /// Indices of lamps, four in a word, the lowest bits first.
    pub indices: Vec<u32>,
}

/// Why there are no lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClusterError {
    /// The counts have a 0, or their product is too large.
    Cells,
    /// The range of the slices is empty, or the projection does not scale x or y.
    Camera,
    /// There are too many lamps: an index is one byte.
    Lamps,
    /// The block is full. Fewer cells or shorter ranges need fewer indices.
    Indices,
}

impl std::fmt::Display for ClusterError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Cells => write!(f, "expected 1 to {MOST_CELLS} cells"),
            Self::Camera => write!(f, "expected a projection, and 0 < near < far"),
            Self::Lamps => write!(f, "expected at most {MOST_LAMPS} lamps"),
            Self::Indices => write!(f, "the lists have more than {MOST_INDICES} indices"),
        }
    }
}

impl std::error::Error for ClusterError {}

/// How many cells the block has room for.
pub const MOST_CELLS: usize = 2048;
/// How many indices the block has room for.
pub const MOST_INDICES: usize = 7680;
/// How many lamps indices can name.
pub const MOST_LAMPS: usize = 255;
/// How much a ball is enlarged, since devices find the cell of a point in f32.
const MARGIN: f64 = 1e-4;

impl Clusters {
    /// The lists of all cells. Equal lists are stored once.
    ///
    /// Parameters: `clip_from_view`, `view_from_world` of the camera that the frame is drawn with;
    /// `lamps` in the order of the block `lamps`.
    ///
    /// # Errors
    /// Inputs that have no lists, or that need larger ones than the block has.
    pub fn new(
        cells: &Cells,
        clip_from_view: DMat4,
        view_from_world: DMat4,
        lamps: &[Reach],
    ) -> Result<Self, ClusterError> {
        let total = cells
            .counts
            .iter()
            .try_fold(1_usize, |total, count| total.checked_mul(*count as usize));
        let total = total.filter(|total| (1..=MOST_CELLS).contains(total));
        let total = total.ok_or(ClusterError::Cells)?;
        let is_range = 0.0 < cells.near && cells.near < cells.far && cells.far.is_finite();
        let frustum = ClusterFrustum { cells, clip_from_view };
        if !is_range || !frustum.has_sides() {
            return Err(ClusterError::Camera);
        }
        if lamps.len() > MOST_LAMPS {
            return Err(ClusterError::Lamps);
        }
        let balls: Vec<Reach> = lamps
            .iter()
            .map(|lamp| Reach {
                position: view_from_world.transform_point3(lamp.position),
                range: lamp.range * (1.0 + MARGIN) + MARGIN,
            })
            .collect();
        let mut lists = LampLists::default();
        let placed: Result<Vec<u32>, _> =
            (0..total).map(|cell| lists.place(frustum.reached(cell, &balls))).collect();
        let (words, rest) = lists.indices.as_chunks::<4>();
        let mut last = [0; 4];
        last[..rest.len()].copy_from_slice(rest);
        let words = words.iter().chain((!rest.is_empty()).then_some(&last));
        Ok(Self {
            cells: placed?,
            indices: words.map(|bytes| u32::from_le_bytes(*bytes)).collect(),
        })
    }

    /// The lamps that a cell lists.
    pub fn list(&self, cell: usize) -> Vec<u8> {
        let Some(word) = self.cells.get(cell) else { return Vec::new() };
        let (first, count) = ((word & 0xffff) as usize, (word >> 16) as usize);
        let bytes: Vec<u8> = self.indices.iter().flat_map(|word| word.to_le_bytes()).collect();
        bytes.get(first..first + count).unwrap_or_default().to_vec()
    }
}

/// The lists so far.
#[derive(Default)]
struct LampLists {
    indices: Vec<u8>,
    /// The word of `cells` for each list that is stored.
    known: BTreeMap<Vec<u8>, u32>,
}

impl LampLists {
    fn place(&mut self, list: Vec<u8>) -> Result<u32, ClusterError> {
        if let Some(word) = self.known.get(&list) {
            return Ok(*word);
        }
        let word = self.indices.len() as u32 | (list.len() as u32) << 16;
        self.indices.extend(&list);
        if self.indices.len() > MOST_INDICES {
            return Err(ClusterError::Indices);
        }
        self.known.insert(list, word);
        Ok(word)
    }
}

/// The view frustum of the camera, divided into cells.
struct ClusterFrustum<'a> {
    cells: &'a Cells,
    clip_from_view: DMat4,
}

impl ClusterFrustum<'_> {
    /// Whether the projection scales both x and y, so that cells have sides in view space.
    fn has_sides(&self) -> bool {
        let [x, y] = [self.clip_from_view.x_axis.x, self.clip_from_view.y_axis.y];
        x != 0.0 && y != 0.0 && self.clip_from_view.is_finite()
    }

    /// The numbers of the lamps that reach a cell: balls that meet the box around it.
    fn reached(&self, cell: usize, balls: &[Reach]) -> Vec<u8> {
        let [across, down, deep] = self.cells.counts.map(|count| count as usize);
        let at = [cell % across, cell / across % down, cell / (across * down)];
        let depth = |slice: usize| {
            let Cells { near, far, .. } = self.cells;
            near * (far / near).powf(slice as f64 / deep as f64)
        };
        // The first slice also holds what is nearer, and the last one what is farther.
        let first = if at[2] == 0 { 0.0 } else { depth(at[2]) };
        let is_last = at[2] + 1 == deep;
        let reaches = |ball: &Reach| {
            let behind = -ball.position.z + ball.range;
            let last = if is_last { depth(deep).max(behind) } else { depth(at[2] + 1) };
            let (low, high) = self.bounds([at[0], at[1]], [first, last.min(f64::MAX)]);
            let nearest = ball.position.clamp(low, high);
            nearest.distance_squared(ball.position) <= ball.range * ball.range
        };
        let numbered =
            balls.iter().zip(0_u8..).filter(|(ball, _)| ball.range.is_infinite() || reaches(ball));
        numbered.map(|(_, index)| index).collect()
    }

    /// The box in view space around a cell between two depths.
    fn bounds(&self, at: [usize; 2], depths: [f64; 2]) -> (DVec3, DVec3) {
        let counts = DVec2::new(f64::from(self.cells.counts[0]), f64::from(self.cells.counts[1]));
        let place = DVec2::new(at[0] as f64, at[1] as f64);
        let clip = &self.clip_from_view;
        let corner = |(edge, depth): (DVec2, f64)| {
            let screen = 2.0 * (place + edge) / counts - 1.0;
            let z = -depth;
            let w = clip.z_axis.w * z + clip.w_axis.w;
            let moved =
                DVec2::new(clip.z_axis.x * z + clip.w_axis.x, clip.z_axis.y * z + clip.w_axis.y);
            let side = (screen * w - moved) / DVec2::new(clip.x_axis.x, clip.y_axis.y);
            side.extend(z)
        };
        let edges = [DVec2::ZERO, DVec2::ONE];
        let corners = edges.iter().flat_map(|edge| depths.map(|depth| corner((*edge, depth))));
        let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        corners.fold(start, |(low, high), corner| (low.min(corner), high.max(corner)))
    }
}
