//! A room whose walls give off light: as panels that a scene can draw, and as the environment that
//! somebody in its middle sees. Both are the same room, so a mirror shows whether a projection onto
//! its walls is right.

use glam::{DVec2, DVec3};

/// A corner of the room, and the opposite one. The floor is at y = 0.
pub const LOW: DVec3 = DVec3::new(-4.0, 0.0, -5.0);
/// See [`LOW`].
pub const HIGH: DVec3 = DVec3::new(4.0, 4.4, 5.0);
/// The point from which the environment is seen.
pub const CENTRE: DVec3 = DVec3::new(0.0, 1.8, 0.0);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RoomSide {
    Floor,
    Ceiling,
    Left,
    Right,
    Back,
    Front,
}

/// A rectangle on a side of the room.
#[derive(Debug, Clone, Copy)]
pub struct Panel {
    /// The side that it is on.
    pub side: RoomSide,
    /// Its lower corner along [`RoomSide::axes`], scene units.
    pub low: DVec2,
    /// Its upper corner.
    pub high: DVec2,
    /// Linear light that it gives off.
    pub color: DVec3,
}

impl RoomSide {
    pub const ALL: [Self; 6] =
        [Self::Floor, Self::Ceiling, Self::Left, Self::Right, Self::Back, Self::Front];

    /// The axis perpendicular to the side, 0 to 2 for x to z, and whether the side is at [`HIGH`].
    fn across(self) -> (usize, bool) {
        match self {
            Self::Floor => (1, false),
            Self::Ceiling => (1, true),
            Self::Left => (0, false),
            Self::Right => (0, true),
            Self::Back => (2, false),
            Self::Front => (2, true),
        }
    }

    /// The axes along the side: that of the first and that of the second coordinate of panels.
    pub fn axes(self) -> [usize; 2] {
        match self.across().0 {
            0 => [2, 1],
            1 => [0, 2],
            _ => [0, 1],
        }
    }

    /// A place of the room, from coordinates on this side and a distance into the room.
    pub fn place(self, at: DVec2, depth: f64) -> DVec3 {
        let ((axis, is_high), [first, second]) = (self.across(), self.axes());
        let mut place = DVec3::ZERO;
        (place[first], place[second]) = (at.x, at.y);
        place[axis] = if is_high { HIGH[axis] - depth } else { LOW[axis] + depth };
        place
    }

    /// Whether its coordinates and its direction into the room are a left-handed system.
    pub fn is_left_handed(self) -> bool {
        matches!(self, Self::Floor | Self::Left | Self::Front)
    }

    fn extent(self) -> (DVec2, DVec2) {
        let [first, second] = self.axes();
        (DVec2::new(LOW[first], LOW[second]), DVec2::new(HIGH[first], HIGH[second]))
    }
}

const PLASTER: DVec3 = DVec3::new(0.36, 0.31, 0.25);
const WOOD: DVec3 = DVec3::new(0.1, 0.052, 0.026);
const FRAME: DVec3 = DVec3::new(0.05, 0.035, 0.025);
const SKY: DVec3 = DVec3::new(1.9, 2.5, 3.4);
const GARDEN: DVec3 = DVec3::new(0.35, 0.62, 0.16);
const LAMP: DVec3 = DVec3::new(6.0, 4.6, 3.0);
/// Light of the floor's light and dark tiles.
const TILES: [DVec3; 2] = [DVec3::new(0.135, 0.12, 0.105), DVec3::new(0.045, 0.04, 0.035)];
/// Tiles along each edge of the floor.
pub const TILES_ALONG: i32 = 10;

/// The panels of the room; later ones hide earlier ones.
pub fn panels() -> Vec<Panel> {
    let mut all: Vec<Panel> = RoomSide::ALL.into_iter().map(whole_side).collect();
    all.extend(light_tiles());
    for side in [RoomSide::Left, RoomSide::Right, RoomSide::Back, RoomSide::Front] {
        let (low, high) = side.extent();
        all.push(panel(side, low, DVec2::new(high.x, 0.9), WOOD));
    }
    for middle in [-2.5, 0.0, 2.5] {
        all.extend(window_panels(RoomSide::Back, middle));
        all.extend(window_panels(RoomSide::Front, middle));
    }
    all.extend(painting_panels(RoomSide::Left, -2.6));
    all.extend(painting_panels(RoomSide::Left, 1.4));
    all.extend(painting_panels(RoomSide::Right, 2.2));
    // A door to a corridor with a warm light.
    all.push(panel(RoomSide::Right, DVec2::new(-3.5, 0.0), DVec2::new(-1.3, 3.0), FRAME));
    let corridor = DVec3::new(1.9, 0.95, 0.36);
    all.push(panel(RoomSide::Right, DVec2::new(-3.35, 0.0), DVec2::new(-1.45, 2.85), corridor));
    for x in [-2.0, 2.0] {
        all.push(panel(
            RoomSide::Ceiling,
            DVec2::new(x - 0.2, -5.0),
            DVec2::new(x + 0.2, 5.0),
            WOOD,
        ));
    }
    all.push(panel(RoomSide::Ceiling, DVec2::new(-0.9, -1.6), DVec2::new(0.9, -0.4), LAMP));
    all
}

fn panel(side: RoomSide, low: DVec2, high: DVec2, color: DVec3) -> Panel {
    Panel { side, low, high, color }
}

fn whole_side(side: RoomSide) -> Panel {
    let (low, high) = side.extent();
    let color = match side {
        RoomSide::Floor => TILES[1],
        RoomSide::Ceiling => DVec3::new(0.42, 0.4, 0.37),
        _ => PLASTER,
    };
    panel(side, low, high, color)
}

/// The light tiles of a checkerboard, whose dark tiles are the floor itself.
fn light_tiles() -> impl Iterator<Item = Panel> {
    let (low, high) = RoomSide::Floor.extent();
    let step = (high - low) / f64::from(TILES_ALONG);
    let places = (0..TILES_ALONG).flat_map(|z| (0..TILES_ALONG).map(move |x| (x, z)));
    places.filter(|(x, z)| (x + z) % 2 == 0).map(move |(x, z)| {
        let corner = low + step * DVec2::new(f64::from(x), f64::from(z));
        panel(RoomSide::Floor, corner, corner + step, TILES[0])
    })
}

/// A window of two by three panes: the sky above a garden.
fn window_panels(side: RoomSide, middle: f64) -> Vec<Panel> {
    let (half, low, high) = (0.75, 1.2, 3.7);
    let frame = DVec2::splat(0.09);
    let (from, to) = (DVec2::new(middle - half, low), DVec2::new(middle + half, high));
    let mut all = vec![panel(side, from - frame, to + frame, FRAME)];
    let pane = (to - from) / DVec2::new(2.0, 3.0);
    for (column, row) in [(0, 0), (1, 0), (0, 1), (1, 1), (0, 2), (1, 2)] {
        let corner = from + pane * DVec2::new(f64::from(column), f64::from(row));
        let color = if row == 0 { GARDEN } else { SKY * (0.55 + 0.45 * f64::from(row - 1)) };
        all.push(panel(side, corner + 0.03, corner + pane - 0.03, color));
    }
    all
}

/// A painting of stripes and a square.
fn painting_panels(side: RoomSide, middle: f64) -> Vec<Panel> {
    const STRIPES: [DVec3; 4] = [
        DVec3::new(0.62, 0.08, 0.05),
        DVec3::new(0.75, 0.42, 0.06),
        DVec3::new(0.04, 0.3, 0.34),
        DVec3::new(0.05, 0.08, 0.3),
    ];
    let (half, low, high) = (1.1, 1.5, 3.1);
    let from = DVec2::new(middle - half, low);
    let frame = DVec2::splat(0.1);
    let mut all = vec![panel(side, from - frame, DVec2::new(middle + half, high) + frame, FRAME)];
    let step = (high - low) / STRIPES.len() as f64;
    for (index, color) in STRIPES.into_iter().enumerate() {
        let corner = from + DVec2::Y * step * index as f64;
        all.push(panel(side, corner, corner + DVec2::new(2.0 * half, step), color));
    }
    let square = DVec2::new(middle + 0.2, low + 0.5);
    all.push(panel(side, square, square + 0.6, DVec3::new(0.85, 0.82, 0.74)));
    all
}

/// The panels of each side, in the order of [`RoomSide::ALL`]. Earlier ones hide later ones.
fn panels_by_side() -> [Vec<Panel>; 6] {
    let all = panels();
    RoomSide::ALL.map(|side| all.iter().rev().filter(|panel| panel.side == side).copied().collect())
}

/// The light that arrives at the middle of the room from a direction.
pub fn interior_light(direction: DVec3) -> DVec3 {
    thread_local! {
        static PANELS: [Vec<Panel>; 6] = panels_by_side();
    }
    let far = |axis: usize| {
        let wall = if direction[axis] > 0.0 { HIGH[axis] } else { LOW[axis] };
        if direction[axis] == 0.0 { f64::INFINITY } else { (wall - CENTRE[axis]) / direction[axis] }
    };
    let distances = [far(0), far(1), far(2)];
    let nearest = (0..3).min_by(|a, b| distances[*a].total_cmp(&distances[*b])).unwrap_or(0);
    let point = CENTRE + direction * distances[nearest];
    let across = (nearest, direction[nearest] > 0.0);
    PANELS.with(|panels| {
        let hit = RoomSide::ALL.iter().position(|side| side.across() == across);
        let found = hit.and_then(|side| {
            panels[side].iter().find(|panel| {
                let [first, second] = panel.side.axes();
                let at = DVec2::new(point[first], point[second]);
                at.cmpge(panel.low).all() && at.cmple(panel.high).all()
            })
        });
        found.map_or(PLASTER, |panel| panel.color)
    })
}
