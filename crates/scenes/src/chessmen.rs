//! The men of a game of chess, in the style of Staunton, and how much of the sky they hide.

use std::f64::consts::TAU;

use glam::{DMat4, DVec2, DVec3};

use super::lathe::{Turn, profile_arcs, turned_shape, waved_shape};
use super::shape::Shape;

/// A kind of chessman. There is no knight, since a lathe cannot turn one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Man {
    Pawn,
    Rook,
    Bishop,
    Queen,
    King,
}

/// Quads around a man.
const AROUND: u32 = 44;

const PAWN: &[Turn] = &[
    (0.0, 0.0, 0.0),
    (0.3, 0.0, 0.0),
    (0.32, 0.02, 0.414),
    (0.32, 0.065, 0.0),
    (0.3, 0.085, 0.414),
    (0.285, 0.09, 0.0),
    (0.215, 0.195, 0.5),
    (0.2, 0.2, 0.0),
    (0.1, 0.62, -0.26),
    (0.175, 0.665, -0.3),
    (0.175, 0.7, 0.8),
    (0.115, 0.725, 0.0),
    (0.0, 1.06, 0.727),
];
const ROOK: &[Turn] = &[
    (0.0, 0.0, 0.0),
    (0.35, 0.0, 0.0),
    (0.37, 0.02, 0.414),
    (0.37, 0.08, 0.0),
    (0.35, 0.1, 0.414),
    (0.33, 0.105, 0.0),
    (0.265, 0.23, 0.5),
    (0.245, 0.235, 0.0),
    (0.185, 0.82, -0.13),
    (0.215, 0.84, 0.6),
    (0.215, 0.865, 0.4),
    (0.265, 0.94, -0.35),
    (0.28, 0.955, 0.414),
    (0.28, 1.09, 0.0),
    (0.19, 1.09, 0.0),
    (0.185, 1.04, 0.0),
    (0.0, 1.04, 0.0),
];
const BISHOP: &[Turn] = &[
    (0.0, 0.0, 0.0),
    (0.34, 0.0, 0.0),
    (0.36, 0.02, 0.414),
    (0.36, 0.075, 0.0),
    (0.34, 0.095, 0.414),
    (0.32, 0.1, 0.0),
    (0.24, 0.22, 0.5),
    (0.22, 0.225, 0.0),
    (0.11, 0.92, -0.17),
    (0.2, 0.965, -0.3),
    (0.2, 1.0, 0.8),
    (0.14, 1.02, 0.0),
    (0.15, 1.055, 0.5),
    (0.115, 1.075, 0.3),
    (0.205, 1.2, -0.06),
    (0.045, 1.5, 0.32),
    (0.04, 1.51, 0.0),
    (0.0, 1.61, 0.72),
];
const QUEEN: &[Turn] = &[
    (0.0, 0.0, 0.0),
    (0.37, 0.0, 0.0),
    (0.39, 0.02, 0.414),
    (0.39, 0.085, 0.0),
    (0.37, 0.105, 0.414),
    (0.35, 0.11, 0.0),
    (0.265, 0.25, 0.5),
    (0.24, 0.255, 0.0),
    (0.12, 1.15, -0.13),
    (0.22, 1.205, -0.3),
    (0.22, 1.24, 0.8),
    (0.155, 1.26, 0.0),
    (0.165, 1.3, 0.5),
    (0.13, 1.32, 0.3),
    (0.255, 1.68, -0.16),
    (0.22, 1.685, 0.3),
    (0.2, 1.65, 0.0),
    (0.055, 1.755, 0.3),
    (0.05, 1.765, 0.0),
    (0.0, 1.875, 0.75),
];
const KING: &[Turn] = &[
    (0.0, 0.0, 0.0),
    (0.39, 0.0, 0.0),
    (0.41, 0.02, 0.414),
    (0.41, 0.09, 0.0),
    (0.39, 0.11, 0.414),
    (0.37, 0.115, 0.0),
    (0.28, 0.265, 0.5),
    (0.255, 0.27, 0.0),
    (0.13, 1.24, -0.12),
    (0.235, 1.295, -0.3),
    (0.235, 1.33, 0.8),
    (0.165, 1.35, 0.0),
    (0.175, 1.395, 0.5),
    (0.14, 1.415, 0.3),
    (0.26, 1.8, -0.08),
    (0.265, 1.83, 0.6),
    (0.235, 1.845, 0.3),
    (0.06, 1.925, 0.2),
    (0.055, 1.94, 0.0),
    (0.0, 1.945, 0.0),
];

impl Man {
    /// The outline of the man.
    pub fn profile(self) -> &'static [Turn] {
        match self {
            Self::Pawn => PAWN,
            Self::Rook => ROOK,
            Self::Bishop => BISHOP,
            Self::Queen => QUEEN,
            Self::King => KING,
        }
    }

    /// The man as a shape. It stands on the origin.
    pub fn shape(self) -> Shape {
        match self {
            Self::Pawn | Self::Bishop => turned_shape(self.profile(), AROUND),
            Self::Rook => (0..6)
                .fold(turned_shape(ROOK, AROUND), |shape, index| shape.with(merlon_shape(index))),
            Self::Queen => waved_shape(QUEEN, 2 * AROUND, |u, point| {
                // The crown has its points on the rim alone.
                let share = ((point.y - 1.6) / 0.08).clamp(0.0, 1.0) * (point.x / 0.25).powi(6);
                0.03 * share * (9.0 * TAU * u).cos()
            }),
            Self::King => turned_shape(KING, AROUND).with(cross_shape()),
        }
    }
}

/// One of the six merlons on the tower of a rook.
fn merlon_shape(index: u32) -> Shape {
    let (inner, outer, low, high) = (0.19, 0.28, 1.09, 1.19);
    let start = f64::from(index) / 6.0;
    let at = move |u: f64, radius: f64, height: f64| {
        let (sin, cos) = (TAU * (start + 0.115 * u)).sin_cos();
        DVec3::new(radius * cos, height, -radius * sin)
    };
    let between = |low: f64, high: f64, share: f64| low + (high - low) * share;
    let round = |radius: f64| move |u: f64, v: f64| at(u, radius, between(low, high, v));
    let end = |u: f64| move |s: f64, v: f64| at(u, between(outer, inner, s), between(low, high, v));
    Shape::surface(4, 1, round(outer))
        .with(Shape::surface(4, 1, move |u, v| round(inner)(1.0 - u, v)))
        .with(Shape::surface(4, 1, move |u, v| at(u, between(outer, inner, v), high)))
        .with(Shape::surface(1, 1, end(1.0)))
        .with(Shape::surface(1, 1, move |s, v| end(0.0)(1.0 - s, v)))
}

/// A cross whose arms become wider outwards, on a king's head.
fn cross_shape() -> Shape {
    // The upper edge of a box is widened, and the box is turned to each side.
    let arm = |length: f64, turn: f64| {
        let half = DVec3::new(0.022, 0.5 * length, 0.026);
        let widened = Shape::cuboid(half, 1).map(|vertex| {
            if vertex.position.y > 0.0 {
                vertex.position.x *= 2.2;
            }
            vertex.position.y += 0.5 * length;
        });
        widened.faceted().transformed(
            DMat4::from_translation(DVec3::new(0.0, 2.07, 0.0)) * DMat4::from_rotation_z(turn),
        )
    };
    [(0.13, 0.0), (0.1, 0.25), (0.14, 0.5), (0.1, 0.75)]
        .into_iter()
        .fold(Shape::default(), |shape, (length, turn)| shape.with(arm(length, TAU * turn)))
}

/// A man who stands upright on the ground.
pub struct Standing {
    place: DVec2,
    /// The middle and the end of each line or arc of the profile: radius and height.
    rings: Vec<DVec2>,
}

impl Standing {
    pub fn new(man: Man, place: DVec2) -> Self {
        let ends = profile_arcs(man.profile()).flat_map(|arc| [arc.point(0.5), arc.point(1.0)]);
        Self { place, rings: ends.collect() }
    }
}

/// The share of the sky, weighted by the cosine to the ground's normal, that is seen from the
/// ground between upright men.
pub fn open_share(at: DVec2, men: &[Standing]) -> f64 {
    const DIRECTIONS: u32 = 24;
    const FARTHEST: f64 = 2.5;
    let near: Vec<_> = men.iter().filter(|man| man.place.distance(at) < FARTHEST).collect();
    let open = |direction: u32| {
        let ahead = DVec2::from_angle(TAU * (f64::from(direction) + 0.5) / f64::from(DIRECTIONS));
        let slopes = near.iter().map(|man| steepest_slope(&man.rings, at - man.place, ahead));
        let slope = slopes.fold(0.0, f64::max);
        // The cosine-weighted share of the sky above an elevation is the square of the cosine of
        // the elevation.
        1.0 / (1.0 + slope * slope)
    };
    (0..DIRECTIONS).map(open).sum::<f64>() / f64::from(DIRECTIONS)
}

/// The slope of the steepest ray in a direction that a man stops. The man is taken as solid below
/// each of its rings.
fn steepest_slope(rings: &[DVec2], from: DVec2, ahead: DVec2) -> f64 {
    let along = -from.dot(ahead);
    let aside = from.perp_dot(ahead);
    let slope = |point: &DVec2| {
        let depth = point.x * point.x - aside * aside;
        if along <= 0.0 || depth <= 0.0 {
            return 0.0;
        }
        point.y / (along - depth.sqrt()).max(0.01)
    };
    rings.iter().map(slope).fold(0.0, f64::max)
}
