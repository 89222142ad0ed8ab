//! Runs the four fragments of a quad. Each runs alone up to a derivative, where it waits for the
//! others.

use super::super::code::{Binary, DerivativeDirection, Instruction, Unary};
use super::super::error::{Error, FindingKind};
use super::super::number::Number;
use super::super::program::FunctionId;
use super::lane::{self, Env, Lane, LaneStop};
use super::{Machine, begin_lane, callable_function, place_arguments, result_slots, texture};

impl<N: Number> Machine<'_, N> {
    /// Runs a function on the four fragments of a quad, in the order (0, 0), (1, 0), (0, 1),
    /// (1, 1), and gives their flattened results.
    ///
    /// Where only some of the fragments reach a derivative, it is 0 for those whose neighbour is
    /// missing, and it is reported.
    ///
    /// # Errors
    /// Those of [`Self::call`].
    pub fn quad(&mut self, id: FunctionId, arguments: [&[N]; 4]) -> Result<[Vec<N>; 4], Error> {
        N::run_quad(self, id, arguments)
    }

    /// [`Self::quad`].
    pub(crate) fn run_quad(
        &mut self,
        id: FunctionId,
        arguments: [&[N]; 4],
    ) -> Result<[Vec<N>; 4], Error> {
        let program = self.program;
        let mut lanes = std::mem::take(&mut self.quad);
        lanes.resize_with(4, || self.lane.clone());
        let mut entry = None;
        for (lane, arguments) in lanes.iter_mut().zip(arguments) {
            let function = callable_function(program, id, arguments.len())?;
            self.check_buffers(function)?;
            begin_lane(program, lane);
            place_arguments(lane, function, arguments);
            (lane.pc, lane.trips, lane.killed) = (function.entry, 0, false);
            lane.steps = 0;
            lane.calls.clear();
            entry = Some(function);
        }
        let outcomes = self.together(&mut lanes);
        self.killed = [0, 1, 2, 3].map(|index| lanes.get(index).is_some_and(|lane| lane.killed));
        let results = std::array::from_fn(|index| {
            entry
                .zip(lanes.get(index))
                .map_or(Vec::new(), |(function, lane)| result_slots(lane, function).to_vec())
        });
        self.quad = lanes;
        outcomes.map(|()| results)
    }

    /// Whether each fragment of the last quad ran into `discard`.
    pub fn quad_discarded(&self) -> [bool; 4] {
        self.killed
    }

    fn together(&mut self, lanes: &mut [Lane<N>]) -> Result<(), Error> {
        let env = Env {
            program: self.program,
            bound: &self.resolved,
            loop_limit: self.loop_limit,
            quad: true,
        };
        let mut running = [true; 4];
        loop {
            let mut waiting = Vec::new();
            for index in (0..4).filter(|index| running[*index]).collect::<Vec<_>>() {
                match lane::run_lane(env, &mut lanes[index], &mut self.watch)? {
                    LaneStop::Done => running[index] = false,
                    LaneStop::Quad => waiting.push(index),
                }
            }
            // The lanes that are furthest behind go first, since the others may wait at a place
            // that those still reach.
            let Some(&first) = waiting
                .iter()
                .min_by(|a, b| waiting_position(&lanes[**a]).cmp(waiting_position(&lanes[**b])))
            else {
                return Ok(());
            };
            let group: Vec<usize> = waiting
                .into_iter()
                .filter(|index| {
                    waiting_position(&lanes[*index]).eq(waiting_position(&lanes[first]))
                })
                .collect();
            let at = lanes[first].pc;
            if group.len() < 4 {
                self.watch.note(FindingKind::DivergentDerivative, at);
            }
            match self.program.code[at as usize] {
                Instruction::Derivative { axis, coarse, n, to, a } => {
                    for i in 0..u32::from(n) {
                        derivative(lanes, &group, axis, coarse, (to + i) as usize, a.at(i));
                    }
                }
                Instruction::Image { access } => {
                    texture::run_quad(env, access, lanes, &group, &mut self.watch)?
                }
                _ => {}
            }
            group.iter().for_each(|index| lanes[*index].pc += 1);
        }
    }
}

/// Where a lane waits: the return addresses of its calls, then its instruction.
fn waiting_position<N>(lane: &Lane<N>) -> impl Iterator<Item = u32> + '_ {
    lane.calls.iter().copied().chain([lane.pc])
}

/// The two lanes whose difference is the derivative for a lane.
pub fn derivative_lanes(lane: usize, axis: DerivativeDirection, coarse: bool) -> (usize, usize) {
    let lane = if coarse { 0 } else { lane };
    match axis {
        DerivativeDirection::Y => (lane & 1, lane | 2),
        _ => (lane & 2, lane | 1),
    }
}

fn derivative<N: Number>(
    lanes: &mut [Lane<N>],
    group: &[usize],
    axis: DerivativeDirection,
    coarse: bool,
    to: usize,
    from: usize,
) {
    let values: [Option<N>; 4] =
        std::array::from_fn(|index| group.contains(&index).then(|| lanes[index].memory[from]));
    let mut doubt = false;
    for &index in group {
        let mut along = |axis| {
            let (low, high) = derivative_lanes(index, axis, coarse);
            match (values[low], values[high]) {
                (Some(low), Some(high)) => N::binary(Binary::Subtract, high, low, &mut doubt),
                _ => N::default(),
            }
        };
        let result = match axis {
            DerivativeDirection::Width => {
                let [x, y] = [along(DerivativeDirection::X), along(DerivativeDirection::Y)]
                    .map(|slope| N::unary(Unary::Abs, slope, &mut false));
                N::binary(Binary::Add, x, y, &mut false)
            }
            axis => along(axis),
        };
        lanes[index].memory[to] = result;
    }
}
