//! Runs kernels on the crate's own evaluator, with any of its kinds of numbers.

use std::sync::atomic::{AtomicU64, Ordering};

use super::fixture::{Fixture, FixtureSampler, FixtureTexture, TextureKind};
use super::kernel::{Kernel, ParameterKind};
use super::module_info;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_eval::{self as eval, FunctionId, Machine, Number, Program, Resources, Texels};
use naga::{Module, ScalarKind};

/// A kernel's module, lowered.
pub struct Interpreter {
    program: Program,
    function: FunctionId,
    /// What each slot of the arguments is filled with.
    slots: Vec<ArgumentSlot>,
    resources: Resources,
    /// Steps of all calls so far, and how many there may be.
    steps: AtomicU64,
    most: u64,
}

/// An argument slot of the function.
#[derive(Clone, Copy)]
enum ArgumentSlot {
    /// The next word of the row, of that kind.
    Word(ScalarKind),
    /// The handle of a texture or sampler.
    Handle(u32),
}

/// Calls of a kernel with one kind of number, and the memory for them.
pub struct KernelCalls<'p, N> {
    interpreter: &'p Interpreter,
    /// The machine, for its findings and limits.
    pub machine: Machine<'p, N>,
    arguments: Vec<N>,
}

impl Interpreter {
    /// Validates the kernel's module and lowers it.
    pub fn new(kernel: &Kernel) -> Result<Self, Diagnostic> {
        Self::of(kernel, &kernel.module)
    }

    /// As [`Self::new`], for a changed copy of the kernel's module, such as a mutant. The kernel's
    /// function must have the same handle in it.
    pub fn of(kernel: &Kernel, module: &Module) -> Result<Self, Diagnostic> {
        let info = module_info("kernel", module)?;
        let program = Program::new(module, &info).map_err(eval_failed)?;
        let slots = argument_slots(kernel, &program)?;
        Ok(Self {
            function: FunctionId::from(kernel.function),
            program,
            slots,
            resources: kernel_resources(kernel),
            steps: AtomicU64::new(0),
            most: kernel.steps,
        })
    }

    /// The same, with that many times the steps for all calls together.
    pub fn with_steps_times(self, times: u64) -> Self {
        Self { most: self.most.saturating_mul(times), ..self }
    }

    /// The lowered module.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The memory for the calls of one thread.
    pub fn calls<N: Number>(&self) -> Result<KernelCalls<'_, N>, Diagnostic> {
        let mut machine = Machine::new(&self.program).map_err(eval_failed)?;
        machine.bind(self.resources.clone()).map_err(eval_failed)?;
        Ok(KernelCalls { interpreter: self, machine, arguments: Vec::new() })
    }
}

impl<N: Number> KernelCalls<'_, N> {
    /// Calls the function with one row of words, and returns its flattened result.
    pub fn call(&mut self, row: &[u32]) -> Result<&[N], Diagnostic> {
        let mut words = row.iter().copied();
        self.arguments.clear();
        self.arguments.extend(self.interpreter.slots.iter().map(|slot| match slot {
            ArgumentSlot::Handle(handle) => N::from_word(*handle),
            ArgumentSlot::Word(kind) => slot_from_word(words.next().unwrap_or(0), *kind),
        }));
        let Interpreter { function, steps, most, .. } = self.interpreter;
        self.machine.call(*function, &self.arguments).map_err(eval_failed)?;
        let taken = self.machine.steps();
        if steps.fetch_add(taken, Ordering::Relaxed).saturating_add(taken) > *most {
            let message = format!("all calls together take more than {most} steps");
            return Err(Diagnostic::error(codes::EVAL_LOOP_LIMIT, message));
        }
        Ok(self.machine.result(*function))
    }
}

/// A slot from a word of the kind.
fn slot_from_word<N: Number>(word: u32, kind: ScalarKind) -> N {
    match kind {
        ScalarKind::Float => N::from_f64(f64::from(f32::from_bits(word))),
        _ => N::from_word(word),
    }
}

pub fn slot_value<N: Number>(slot: N, kind: ScalarKind) -> f64 {
    match kind {
        ScalarKind::Float => slot.value(),
        _ => super::kernel::word_value(slot.word(), kind),
    }
}

/// The word that represents a slot's value as f32 or as an integer.
pub fn word_of<N: Number>(slot: N, kind: ScalarKind) -> u32 {
    match kind {
        ScalarKind::Float => slot.bits(),
        _ => slot.word(),
    }
}

fn argument_slots(kernel: &Kernel, program: &Program) -> Result<Vec<ArgumentSlot>, Diagnostic> {
    let mut slots = Vec::new();
    for parameter in &kernel.parameters {
        match &parameter.kind {
            ParameterKind::Words { shape, .. } => {
                slots.extend(shape.kinds().into_iter().map(ArgumentSlot::Word))
            }
            ParameterKind::Resource(resource) => {
                let unbound = || {
                    Diagnostic::error(
                        codes::EVAL_UNBOUND,
                        format!("the kernel has no binding {}", resource.binding),
                    )
                };
                slots.push(ArgumentSlot::Handle(
                    program.handle(0, resource.binding).ok_or_else(unbound)?,
                ));
            }
        }
    }
    Ok(slots)
}

/// The fixtures of a kernel at their bindings.
pub fn kernel_resources(kernel: &Kernel) -> Resources {
    let mut resources = Resources::default();
    for resource in kernel.resources() {
        let place = (0, resource.binding);
        match &*resource.fixture {
            Fixture::Texture(fixture) => drop(resources.textures.insert(place, fixture.into())),
            Fixture::Sampler(fixture) => drop(resources.samplers.insert(place, (*fixture).into())),
        }
    }
    resources
}

impl From<&FixtureTexture> for eval::Texture {
    fn from(fixture: &FixtureTexture) -> Self {
        let shape = match fixture.kind {
            TextureKind::Depth2d | TextureKind::Color2d => eval::TextureDimension::D2,
            TextureKind::DepthCube | TextureKind::ColorCube => eval::TextureDimension::Cube,
        };
        let texels =
            Texels::Channels { count: fixture.kind.channels(), values: fixture.texels.clone() };
        Self::of(shape, fixture.width, fixture.height, fixture.kind.layers(), texels)
    }
}

impl From<FixtureSampler> for eval::Sampler {
    fn from(fixture: FixtureSampler) -> Self {
        let FixtureSampler { compare, address, .. } = fixture;
        let filter = if fixture.linear { eval::Filter::Linear } else { eval::Filter::Nearest };
        Self { address: [address; 3], mag: filter, min: filter, compare, ..Self::default() }
    }
}

/// The error as a diagnostic without a place, since naga read the kernel's text and not the
/// author's.
pub fn eval_failed(error: eval::Error) -> Diagnostic {
    Diagnostic::error(error.code, error.message)
}
