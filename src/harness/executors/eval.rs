//! The interpreter of this crate in f32, every operation rounded to nearest: needs nothing.

use super::{Entry, Unavailable};
use crate::diagnostic::{Diagnostic, codes};
use crate::eval::{self, FunctionId, Machine, Program, Resources};
use crate::harness::Session;
use crate::harness::fixture::{Address, Compare, Fixture, Sampler, Texture, TextureKind};
use crate::harness::kernel::{Kernel, ParameterKind};
use naga::valid::{Capabilities, ValidationFlags, Validator};

pub const EXECUTOR: Entry = Entry {
    name: "eval",
    about: "interpreter on the CPU, f32 rounded to nearest",
    needs: &[],
    open: || Ok::<_, Unavailable>(Box::new(Cpu::default())),
};

/// The program of the last kernel: rows of one kernel follow each other.
#[derive(Default)]
struct Cpu {
    last: Option<(u64, Program)>,
}

impl Session for Cpu {
    fn adapter(&self) -> String {
        format!("lamplight {} eval f32", env!("CARGO_PKG_VERSION"))
    }

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        let program = self.program(kernel)?;
        let mut machine = Machine::<f32>::new(program).map_err(failed)?;
        machine.bind(resources(kernel)).map_err(failed)?;
        let (function, handles) = (FunctionId::from(kernel.function), handles(kernel, program)?);
        let stride = kernel.input_words() as usize;
        let count = inputs.len().checked_div(stride).unwrap_or(1);
        let (mut results, mut arguments, mut result) = (Vec::new(), Vec::new(), Vec::new());
        for call in 0..count {
            flatten(kernel, &handles, &inputs[call * stride..(call + 1) * stride], &mut arguments);
            machine.call_words(function, &arguments, &mut result).map_err(failed)?;
            results.extend_from_slice(&result);
        }
        Ok(results)
    }
}

impl Cpu {
    fn program(&mut self, kernel: &Kernel) -> Result<&Program, Diagnostic> {
        if self.last.as_ref().is_none_or(|(id, _)| *id != kernel.id) {
            let validated = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&kernel.module);
            let info = validated.map_err(|error| Diagnostic::error(codes::EXECUTOR_FAILED, format!("the kernel is not valid: {error}")))?;
            self.last = Some((kernel.id, Program::new(&kernel.module, &info).map_err(failed)?));
        }
        self.last.as_ref().map(|(_, program)| program).ok_or_else(|| Diagnostic::error(codes::EVAL_INTERNAL, "no program"))
    }
}

/// The word of each parameter that is bound, in the order of parameters.
pub(in crate::harness) fn handles(kernel: &Kernel, program: &Program) -> Result<Vec<u32>, Diagnostic> {
    let unbound = |binding| Diagnostic::error(codes::EVAL_UNBOUND, format!("the kernel has no binding {binding}"));
    kernel.resources().map(|resource| program.handle(0, resource.binding).ok_or_else(|| unbound(resource.binding))).collect()
}

/// One invocation's words with the handles between them, as the function declares them.
pub(in crate::harness) fn flatten(kernel: &Kernel, handles: &[u32], words: &[u32], arguments: &mut Vec<u32>) {
    arguments.clear();
    let mut handles = handles.iter();
    for parameter in &kernel.parameters {
        match &parameter.kind {
            ParameterKind::Words { offset, shape } => {
                let first = *offset as usize;
                arguments.extend_from_slice(&words[first..first + shape.words() as usize]);
            }
            ParameterKind::Resource(_) => arguments.extend(handles.next()),
        }
    }
}

/// The fixtures of a kernel at their bindings.
pub(in crate::harness) fn resources(kernel: &Kernel) -> Resources {
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

impl From<&Texture> for eval::Texture {
    fn from(fixture: &Texture) -> Self {
        let shape = match fixture.kind {
            TextureKind::Depth2d | TextureKind::Color2d => eval::Shape::D2,
            TextureKind::DepthCube | TextureKind::ColorCube => eval::Shape::Cube,
        };
        let texel = |channels: &[f32]| std::array::from_fn(|channel| channels.get(channel).map_or(0.0, |value| f64::from(*value)));
        let texels = fixture.texels.chunks(fixture.kind.channels()).map(texel).collect();
        eval::Texture::flat(shape, fixture.width, fixture.height, fixture.kind.layers(), texels)
    }
}

impl From<Sampler> for eval::Sampler {
    fn from(fixture: Sampler) -> Self {
        let address = match fixture.address {
            Address::Clamp => eval::Address::Clamp,
            Address::Repeat => eval::Address::Repeat,
            Address::Mirror => eval::Address::Mirror,
        };
        let filter = if fixture.linear { eval::Filter::Linear } else { eval::Filter::Nearest };
        let compare = fixture.compare.map(|compare| match compare {
            Compare::Less => eval::Compare::Less,
            Compare::LessEqual => eval::Compare::LessEqual,
            Compare::Greater => eval::Compare::Greater,
            Compare::GreaterEqual => eval::Compare::GreaterEqual,
        });
        eval::Sampler { address: [address; 3], mag: filter, min: filter, compare, ..eval::Sampler::default() }
    }
}

/// The text naga read is the kernel's, not the author's: no place is given.
fn failed(error: eval::Error) -> Diagnostic {
    Diagnostic::error(error.code, error.message)
}
