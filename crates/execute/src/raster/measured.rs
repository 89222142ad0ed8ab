//! Runs the fragment stage for what a person wants to know of each pixel, and not for its colour.

use lamplight_diagnostic::{Diagnostic, codes, nearest_name};
use lamplight_eval::{
    Action, Error, Executed, FindingKind, FunctionId, Machine, Number, Observer, Program,
    Resources, Shape, ShapePart, SlotKind, SlotRange, Traced, Variable, VariableKind,
    VariablePlace,
};
use rayon::prelude::*;

use super::{Corner, Evaluated, FragmentOutput, Quad, ScalarSource, ShadedQuad, Shading};
use crate::frame::{Buffers, Drawing, Mesh};
use crate::interpreter::eval_failed;
use crate::{executor_failed, module_info};

/// What is asked of each pixel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Measure {
    /// 1 where NaN is computed of finite numbers, 2 where it is returned.
    Nan,
    /// The largest bound of the error of a component that is returned.
    Error,
    /// Turns of loops.
    Iterations,
    /// Steps of the evaluator.
    Cost,
    /// Decisions: conditions of `if` and of loops, and `switch`.
    Branches,
    /// The last value of a variable, or of one of its components or members.
    Value(String),
}

impl Measure {
    /// The words for those that are no names of variables.
    pub const WORDS: [&str; 5] = ["nan", "error", "iterations", "cost", "branches"];

    /// What a word asks for; a variable, if it is none of ours.
    pub fn named(word: &str) -> Self {
        match word {
            "nan" => Self::Nan,
            "error" => Self::Error,
            "iterations" => Self::Iterations,
            "cost" => Self::Cost,
            "branches" => Self::Branches,
            name => Self::Value(name.to_owned()),
        }
    }
}

/// The fourth word of a fragment that has a value, and of one that has none.
const HAS_VALUE: f32 = 1.0;
const HAS_NONE: f32 = 0.0;

/// A value with up to three components, which a fragment may lack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured(pub Option<[f32; 3]>);

impl Measured {
    /// Reads it from the words of a target.
    pub fn of_words([x, y, z, has]: [u32; 4]) -> Self {
        let value = [x, y, z].map(f32::from_bits);
        Self((f32::from_bits(has) == HAS_VALUE).then_some(value))
    }

    fn words(self) -> [u32; 4] {
        let has = if self.0.is_some() { HAS_VALUE } else { HAS_NONE };
        let [x, y, z] = self.0.unwrap_or_default();
        [x, y, z, has].map(f32::to_bits)
    }
}

/// Shading that measures.
pub struct Measuring<'a> {
    plain: Evaluated,
    program: Program,
    function: FunctionId,
    measure: &'a Measure,
    /// The place, the kind and the number of the scalars of the variable that is asked for.
    asked: Option<Asked>,
}

#[derive(Debug, Clone, Copy)]
struct Asked {
    place: VariablePlace,
    first: u32,
    count: u32,
    kind: SlotKind,
    reached: Reached,
}

/// When a variable has a value.
#[derive(Debug, Clone, Copy)]
enum Reached {
    /// Before the stage runs.
    Given,
    /// Once this function is called.
    Called(FunctionId),
    /// Once this instruction runs, which follows the declaration.
    At(u32),
    /// Once it is written.
    Written,
}

impl<'a> Measuring<'a> {
    /// Lowers the stages of a drawing.
    ///
    /// # Errors
    /// Those of the stages, and a name that no variable has.
    pub fn new(drawing: &Drawing<'_>, measure: &'a Measure) -> Result<Self, Diagnostic> {
        let missing = || executor_failed("the program has no fragment stage".to_owned());
        let stage = drawing.fragment.ok_or_else(missing)?;
        let info = module_info("program", stage.module)?;
        let program = Program::with_names(stage.module, &info).map_err(eval_failed)?;
        let found = program.functions().filter(|(_, function)| function.name == stage.entry).last();
        let function = found.map(|(id, _)| id).ok_or_else(missing)?;
        let asked = match measure {
            Measure::Value(name) => Some(find(&program, function, name)?),
            _ => None,
        };
        Ok(Self { plain: Evaluated::new(drawing)?, program, function, measure, asked })
    }

    /// How many components a value has.
    pub fn components(&self) -> u32 {
        self.asked.map_or(1, |asked| asked.count)
    }

    fn machine<N: Number>(&self, resources: &Resources) -> Result<Machine<'_, N>, Error> {
        let mut machine = Machine::<N>::new(&self.program)?;
        machine.sanitize(*self.measure == Measure::Nan);
        machine.bind(resources.clone())?;
        Ok(machine)
    }

    fn quad<N: Number>(
        &self,
        machine: &Machine<'_, N>,
        quad: &Quad,
        has_depth: Option<usize>,
    ) -> Result<ShadedQuad, Error> {
        let mut shaded = ShadedQuad::default();
        for (lane, output) in shaded.iter_mut().enumerate() {
            *output = self.lane(machine, quad, lane, has_depth)?;
        }
        Ok(shaded)
    }

    fn lane<N: Number>(
        &self,
        machine: &Machine<'_, N>,
        quad: &Quad,
        lane: usize,
        has_depth: Option<usize>,
    ) -> Result<Option<FragmentOutput>, Error> {
        let kinds = self.program.signature(self.function).map_or(&[][..], |one| &one.arguments);
        let slots = |words: &[f32]| -> Vec<N> {
            let slot = |(word, kind): (&f32, &SlotKind)| match kind {
                SlotKind::Float => N::from_f64(f64::from(*word)),
                _ => N::from_word(word.to_bits()),
            };
            words.iter().zip(kinds).map(slot).collect()
        };
        let all = quad.arguments.each_ref().map(|words| slots(words));
        let mut run = machine.pace_quad(self.function, all.each_ref().map(Vec::as_slice), lane)?;
        let is_reached = self.asked.is_some_and(|one| matches!(one.reached, Reached::Given));
        let mut counter = Counter { asked: self.asked, is_reached, branches: 0, has_nan: false };
        run.finish(&self.program, &mut counter)?;
        if run.is_discarded() {
            return Ok(None);
        }
        let result = run.result(&self.program);
        let depth = has_depth.and_then(|slot| result.get(slot)).map(|slot| slot.value() as f32);
        let measured = self.value(&counter, &run, &result);
        Ok(Some(FragmentOutput { targets: vec![measured.words()], depth }))
    }

    fn value<N: Number>(
        &self,
        counter: &Counter,
        run: &lamplight_eval::Paced<N>,
        result: &[N],
    ) -> Measured {
        let (steps, turns) = run.made();
        let number = |value: f64| Measured(Some([value as f32; 3]));
        match (self.measure, self.asked) {
            (Measure::Nan, _) if result.iter().any(|slot| slot.value().is_nan()) => number(2.0),
            (Measure::Nan, _) => number(f64::from(u8::from(counter.has_nan))),
            (Measure::Error, _) => number(result.iter().map(|slot| slot.error()).fold(0.0, worse)),
            (Measure::Iterations, _) => number(turns as f64),
            (Measure::Cost, _) => number(steps as f64),
            (Measure::Branches, _) => number(counter.branches as f64),
            (Measure::Value(_), None) => Measured(None),
            (Measure::Value(_), Some(asked)) => {
                let scalar = |index: u32| {
                    let index = index.min(asked.count.saturating_sub(1));
                    let slot = asked.place.slot(asked.first + index, run.memory());
                    let slot = run.memory().get(slot as usize).copied().unwrap_or_default();
                    match asked.kind {
                        SlotKind::Float => slot.value() as f32,
                        SlotKind::Sint => slot.word() as i32 as f32,
                        _ => slot.word() as f32,
                    }
                };
                let value = [0, 1, 2].map(scalar);
                Measured(counter.is_reached.then_some(value))
            }
        }
    }
}

/// The larger one; infinite, if one is no number.
fn worse(one: f64, other: f64) -> f64 {
    if one.is_nan() || other.is_nan() { f64::INFINITY } else { one.max(other) }
}

impl Shading for Measuring<'_> {
    fn corners(&self, mesh: &Mesh, resources: Resources) -> Result<Vec<Corner>, Diagnostic> {
        self.plain.corners(mesh, resources)
    }

    fn given(&self) -> Vec<(ScalarSource, bool)> {
        self.plain.given()
    }

    fn taken(&self) -> Option<Vec<ScalarSource>> {
        self.plain.taken()
    }

    fn shade(
        &self,
        buffers: Buffers,
        textures: &Resources,
        quads: &[Quad],
    ) -> Result<Vec<ShadedQuad>, Diagnostic> {
        let resources = Resources { buffers, ..textures.clone() };
        let outputs = self.program.signature(self.function).map_or(&[][..], |one| &one.outputs);
        let is_depth = |source: &ScalarSource| {
            matches!(source, ScalarSource::BuiltIn(naga::BuiltIn::FragDepth, _))
        };
        let depth = super::scalar_sources(outputs).iter().position(is_depth);
        match self.measure {
            Measure::Error => self.shade_with::<Traced>(&resources, quads, depth),
            _ => self.shade_with::<f32>(&resources, quads, depth),
        }
    }
}

impl Measuring<'_> {
    fn shade_with<N: Number + Send + Sync>(
        &self,
        resources: &Resources,
        quads: &[Quad],
        depth: Option<usize>,
    ) -> Result<Vec<ShadedQuad>, Diagnostic> {
        const CHUNK: usize = 64;
        let shaded: Vec<Vec<ShadedQuad>> = quads
            .par_chunks(CHUNK)
            .map(|quads| {
                let machine = self.machine::<N>(resources)?;
                quads.iter().map(|quad| self.quad(&machine, quad, depth)).collect()
            })
            .collect::<Result<_, Error>>()
            .map_err(eval_failed)?;
        Ok(shaded.into_iter().flatten().collect())
    }
}

/// Counts what a fragment does.
struct Counter {
    branches: u64,
    has_nan: bool,
    asked: Option<Asked>,
    /// Whether the variable that is asked for has a value.
    is_reached: bool,
}

impl<N: Number> Observer<N> for Counter {
    fn ahead(&mut self, _: &mut Executed<'_, N>) -> Result<(), Error> {
        Ok(())
    }

    fn see(&mut self, seen: &mut Executed<'_, N>) -> Result<(), Error> {
        let is_branch = matches!(seen.action, Action::Branch { .. } | Action::Switch { .. });
        self.branches += u64::from(is_branch);
        self.has_nan |= seen.found.contains(&FindingKind::NotANumber) || leaves_domain(seen);
        if let Some(asked) = self.asked.filter(|_| !self.is_reached) {
            self.is_reached = match asked.reached {
                Reached::Given => true,
                Reached::Called(own) => seen.action == Action::Call { function: own },
                Reached::At(pc) => seen.pc == pc,
                Reached::Written => {
                    let range: SlotRange = seen.written();
                    let first = asked.place.slot(asked.first, seen.memory);
                    range.start < first + asked.count && first < range.end
                }
            };
        }
        Ok(())
    }
}

/// Whether a function got finite arguments outside of its domain, and gave NaN. Some give a number.
fn leaves_domain<N: Number>(seen: &Executed<'_, N>) -> bool {
    if seen.domain().is_none() {
        return false;
    }
    let slots = |range: SlotRange| {
        let range = range.start as usize..range.end as usize;
        seen.memory.get(range).unwrap_or_default().iter().map(|slot| slot.value())
    };
    let mut is_finite = true;
    seen.read(&mut |range| is_finite &= slots(range).all(f64::is_finite));
    is_finite && slots(seen.written()).any(f64::is_nan)
}

/// The variable that a name such as `n`, `n.x` or `lamp.position` means: in the stage, else in any
/// function, else of the module.
fn find(program: &Program, stage: FunctionId, asked: &str) -> Result<Asked, Diagnostic> {
    let (name, path) = asked.split_at(asked.find(['.', '[']).unwrap_or(asked.len()));
    let all = program.variables();
    let is_named = |one: &&Variable| one.name == name && one.kind != VariableKind::Result;
    let own = |one: &&Variable| is_named(one) && one.function == Some(stage);
    let found = all.iter().rev().find(own).or_else(|| all.iter().rev().find(is_named));
    let variable = found.ok_or_else(|| unknown(program, name))?;
    let none = |piece: String| {
        let help = "members and components have names, such as `.position.x`, elements numbers";
        refused(format!("`{name}` has no `{piece}`"), help)
    };
    let ShapePart { name: _, first, shape } = variable.shape.follow(path).map_err(none)?;
    let (count, kind) = match shape {
        Shape::Scalar(kind) => (1, kind),
        Shape::Vector(count, kind) => (count.min(3), kind),
        _ => {
            let help = "name a number or a vector in it, such as `lamp.position`";
            return Err(refused(format!("`{asked}` is no number and no vector"), help));
        }
    };
    let reached = match (variable.function, variable.kind) {
        (None, _) => Reached::Given,
        (Some(function), VariableKind::Parameter) if function == stage => Reached::Given,
        (Some(function), VariableKind::Parameter) => Reached::Called(function),
        _ => program.reached_by(variable).map_or(Reached::Written, Reached::At),
    };
    Ok(Asked { place: variable.place, first, count, kind, reached })
}

fn refused(message: String, help: &str) -> Diagnostic {
    Diagnostic::error(codes::PICTURE_INVALID, message).note(format!("help: {help}"))
}

fn unknown(program: &Program, name: &str) -> Diagnostic {
    let mut names: Vec<&str> = program.variables().iter().map(|one| one.name.as_str()).collect();
    names.retain(|name| *name != "return" && !name.starts_with("lamplight_"));
    names.sort_unstable();
    names.dedup();
    let known = names.iter().copied().chain(Measure::WORDS);
    let help = match nearest_name(name, known.clone()) {
        Some(nearest) => format!("did you mean `{nearest}`?"),
        None => format!("there are {}", known.collect::<Vec<_>>().join(", ")),
    };
    refused(format!("no variable of the shader is named `{name}`"), &help)
}
