//! Accesses to textures, and derivatives, for the active lanes.

use super::super::code::{Binary, DerivativeDirection, Unary};
use super::super::machine::{
    Env, Watch, apply_access, coordinate_of, derivative_lanes, gradient_of,
};
use super::super::number::Number;
use super::rows::{ALL, LANES, LaneRows, Mask, Row, kept_lanes, lanes_of};

/// Runs an access for each active lane, without the gradients of a quad. `None` if it fails.
pub fn run_single(env: Env<'_>, index: u32, rows: &mut LaneRows<'_>, at: u32) -> Option<()> {
    let access = env.program.access(index)?;
    let mut watch = Watch::default();
    for lane in lanes_of(rows.mask) {
        apply_access(env, access, &mut rows.lane(lane), None, (at, &mut watch)).ok()?;
    }
    Some(())
}

/// Runs an access whose level of detail comes from the gradients within a quad, for the lanes of
/// `mask`. `None` if it fails.
pub fn run_quads(env: Env<'_>, index: u32, memory: &mut [Row], mask: Mask) -> Option<()> {
    let access = env.program.access(index)?;
    let mut watch = Watch::default();
    let keep = kept_lanes(ALL);
    let mut rows = LaneRows::new(memory, ALL, false, &keep);
    for quad in 0..LANES / 4 {
        let coordinates = std::array::from_fn(|place| {
            let lane = 4 * quad + place;
            (mask >> lane & 1 != 0).then(|| coordinate_of(access, &rows.lane(lane)))
        });
        for lane in lanes_of(mask & 0xf << (4 * quad)) {
            let gradient = gradient_of(&coordinates, lane & 3);
            apply_access(env, access, &mut rows.lane(lane), Some(gradient), (0, &mut watch))
                .ok()?;
        }
    }
    Some(())
}

/// Writes the derivative of a slot for the lanes of `mask`: the difference of two lanes of the
/// quad, or 0 if one of these is not in `mask`.
pub fn derivative(
    memory: &mut [Row],
    mask: Mask,
    axis: DerivativeDirection,
    coarse: bool,
    (to, from): (u32, u32),
) {
    let values = memory[from as usize];
    for lane in lanes_of(mask) {
        let quad = lane & !3;
        let along = |axis| {
            let (low, high) = derivative_lanes(lane & 3, axis, coarse);
            let (low, high) = (quad + low, quad + high);
            let are_there = mask >> low & mask >> high & 1 != 0;
            match are_there {
                true => f32::binary(Binary::Subtract, values[high], values[low], &mut false),
                false => 0.0,
            }
        };
        memory[to as usize][lane] = match axis {
            DerivativeDirection::Width => {
                let [x, y] = [DerivativeDirection::X, DerivativeDirection::Y]
                    .map(|axis| f32::unary(Unary::Abs, along(axis), &mut false));
                f32::binary(Binary::Add, x, y, &mut false)
            }
            axis => along(axis),
        };
    }
}
