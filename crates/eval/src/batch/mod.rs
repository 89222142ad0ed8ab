//! Many lanes in lock-step: each instruction is decoded once for all lanes that are at it. Every
//! lane gets the bits that [`Machine::call`] and [`Machine::quad`] would give it. If a lane fails,
//! the machine runs the lanes again one by one, and its error is returned.

mod compute;
mod geometry;
mod image;
mod rows;
mod run;
mod schedule;

use super::error::Error;
use super::machine::Machine;
use super::program::FunctionId;
use rows::{ALL, LANES, Row};
use schedule::Lanes;

/// The most slots of a program that runs in lock-step; larger ones run lane by lane.
const MOST_SLOTS: usize = 1 << 18;

/// A machine, and the memory of many lanes beside its own.
#[derive(Debug)]
pub struct Batch<'p> {
    machine: Machine<'p, f32>,
    /// A row for each slot; empty for a program that is too large.
    memory: Vec<Row>,
    lanes: Lanes,
    /// A row for each slot of the result.
    results: Vec<Row>,
}

/// Receives the index of a lane, its flattened result, and whether it was discarded.
type Give<'g> = dyn FnMut(usize, &[f32], bool) + 'g;

impl<'p> Batch<'p> {
    /// How many lanes run together.
    pub const LANES: usize = LANES;

    /// Takes a machine with its constants and all that is bound to it.
    pub fn new(machine: Machine<'p, f32>) -> Self {
        let slots = machine.memory();
        let memory = match slots.len() <= MOST_SLOTS {
            true => slots.iter().map(|value| [*value; LANES]).collect(),
            false => Vec::new(),
        };
        Self { machine, memory, lanes: Lanes::default(), results: Vec::new() }
    }

    /// Runs a function once for each element of `arguments`. The lanes are independent, so
    /// derivatives are not possible.
    ///
    /// # Errors
    /// Those of [`Machine::call`].
    pub fn calls(
        &mut self,
        id: FunctionId,
        arguments: &[&[f32]],
        give: &mut Give<'_>,
    ) -> Result<(), Error> {
        for (index, some) in arguments.chunks(LANES).enumerate() {
            let first = index * LANES;
            if self.run(id, some, false).is_some() {
                self.give_back(first, some.len(), give);
                continue;
            }
            for (lane, arguments) in some.iter().enumerate() {
                self.machine.call(id, arguments)?;
                let is_killed = self.machine.discarded();
                give(first + lane, self.machine.result(id), is_killed);
            }
        }
        Ok(())
    }

    /// Runs a function on the fragments of quads, four after four in the order of
    /// [`Machine::quad`].
    ///
    /// # Errors
    /// Those of [`Machine::quad`].
    pub fn quads(
        &mut self,
        id: FunctionId,
        arguments: &[[&[f32]; 4]],
        give: &mut Give<'_>,
    ) -> Result<(), Error> {
        for (index, quads) in arguments.chunks(LANES / 4).enumerate() {
            let first = index * LANES;
            if self.run(id, quads.as_flattened(), true).is_some() {
                self.give_back(first, 4 * quads.len(), give);
                continue;
            }
            for (place, quad) in quads.iter().enumerate() {
                let results = self.machine.quad(id, *quad)?;
                let killed = self.machine.quad_discarded();
                for (lane, result) in results.iter().enumerate() {
                    give(first + 4 * place + lane, result, killed[lane]);
                }
            }
        }
        Ok(())
    }

    /// Runs up to [`Self::LANES`] lanes. `None` if a lane fails or the program is too large: the
    /// caller then runs the lanes on the machine, which also finds the error.
    fn run(&mut self, id: FunctionId, arguments: &[&[f32]], is_quads: bool) -> Option<()> {
        if self.memory.is_empty() {
            return None;
        }
        let function = self.machine.runnable(id, arguments)?;
        self.begin();
        for (lane, arguments) in arguments.iter().enumerate() {
            let mut rest = arguments.iter();
            for parameter in &function.parameters {
                let to = parameter.pointee.unwrap_or(parameter.slot);
                for (slot, value) in (to..to + parameter.n).zip(&mut rest) {
                    self.memory[slot as usize][lane] = *value;
                }
                if let Some(pointee) = parameter.pointee {
                    self.memory[parameter.slot as usize][lane] = f32::from_bits(pointee);
                }
            }
        }
        let running = if arguments.len() < LANES { (1 << arguments.len()) - 1 } else { ALL };
        self.results.clear();
        self.results.resize(function.result.len(), [0.0; LANES]);
        self.lanes.begin(function.entry, running);
        let env = self.machine.env(is_quads);
        run::run_lanes(
            env,
            &mut self.memory,
            &mut self.lanes,
            (function.result_slot, &mut self.results),
        )
    }

    /// Sets private variables to their initial values.
    fn begin(&mut self) {
        for (slots, from) in self.machine.program().privates() {
            match from {
                Some(from) => self.memory.copy_within(from, slots.start),
                None => self.memory[slots].fill([0.0; LANES]),
            }
        }
    }

    fn give_back(&self, first: usize, count: usize, give: &mut Give<'_>) {
        let mut result = vec![0.0; self.results.len()];
        for lane in 0..count {
            for (value, row) in result.iter_mut().zip(&self.results) {
                *value = row[lane];
            }
            give(first + lane, &result, self.lanes.killed >> lane & 1 != 0);
        }
    }
}
