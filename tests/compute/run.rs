//! Compiles compute entry points for all targets, and runs them on all executors.

use std::collections::BTreeMap;
use std::fmt::Write;

use lamplight::bundle::{Conventions, Language, Target};
use lamplight::compose::{Composed, lean};
use lamplight::diagnostic::{Diagnostic, codes};
use lamplight::execute::Session;
use lamplight::execute::dispatch::{ComputeForm, ComputeStage, Dispatch, DispatchResult};
use lamplight::execute::executors::{self, ExecutorEntry};
use lamplight::execute::frame::{Buffers, EntryPoint};
use lamplight::execute::shipped::Shipped;
use lamplight::link::{Linker, TextForms, compile};
use lamplight::validate::{Validated, validate};

use crate::glsl_values::device::compile_spirv;

/// The targets that have compute stages.
pub const TARGETS: [Target; 5] =
    [Target::SPIRV, Target::WGSL, Target::GLSL450, Target::HLSL, Target::MSL];

/// Executors that are left out: what wgpu writes for OpenGL by itself is no output of ours.
const OTHERS: [&str; 1] = ["gl"];

/// An entry point in every form, and what it is run with.
pub struct Compiled {
    pub validated: Validated,
    pub entry: String,
    pub buffers: Buffers,
    pub groups: [u32; 3],
    /// For each target its output, or why there is none.
    pub outputs: BTreeMap<Target, Result<Shipped, Vec<Diagnostic>>>,
}

/// Compiles the entry point of a text.
///
/// # Errors
/// The text's own.
pub fn compiled(
    text: String,
    entry: &str,
    conventions: Conventions,
) -> Result<Compiled, Vec<Diagnostic>> {
    let composed = Composed::of_text(Language::Wesl, None, text);
    let lean = lean(&composed);
    let validated = validate(&lean)?;
    let output = |target: Target| {
        let targets = [target];
        let linker = Linker::with(&targets, conventions);
        let text = TextForms { composed: &composed, lean: &lean };
        let unit = compile(&text, entry, &targets, &linker)?.unit;
        let artifact = unit.targets[target.name()].clone();
        let (bytes, native) = (artifact.bytes.to_vec(), (*artifact.native).clone());
        Ok(Shipped { target, bytes, native, reflection: (*unit.reflection).clone() })
    };
    let outputs = TARGETS.map(|target| (target, output(target))).into();
    let (buffers, groups) = (Buffers::new(), [1; 3]);
    Ok(Compiled { validated, entry: entry.to_owned(), buffers, groups, outputs })
}

/// An open executor.
pub struct Opened {
    pub entry: &'static ExecutorEntry,
    pub form: ComputeForm,
    session: Box<dyn Session>,
}

/// Opens every executor that has compute stages.
///
/// # Errors
/// One of them is missing.
pub fn opened() -> Result<Vec<Opened>, String> {
    let wanted = executors::ALL.iter().filter(|one| !OTHERS.contains(&one.name));
    wanted
        .filter_map(|entry| Some((*entry, entry.compute?)))
        .map(|(entry, form)| Ok(Opened { entry, form, session: entry.start()? }))
        .collect()
}

impl Opened {
    /// Opens an executor on the driver that draws files of bundles.
    ///
    /// # Errors
    /// There is none, or it is missing.
    pub fn second(name: &str) -> Result<Self, String> {
        let entry = executors::ALL.iter().copied().find(|one| one.name == name);
        let (entry, form) = entry.and_then(|one| Some((one, one.compute?))).ok_or("no executor")?;
        let shipping = entry.shipping.as_ref().ok_or("no second driver")?;
        let session = (shipping.open)().map_err(|error| format!("{error:?}"))?;
        Ok(Self { entry, form, session })
    }

    /// Runs all of them. `None` where there is no output for the executor's target.
    pub fn run(&mut self, all: &[Compiled]) -> Vec<Option<DispatchResult>> {
        let dispatches: Vec<_> = all.iter().map(|one| one.dispatch(self.form)).collect();
        let there: Vec<Dispatch<'_>> = dispatches.iter().flatten().copied().collect();
        let mut results = self.session.dispatch(&there).into_iter();
        dispatches.iter().map(|one| one.and_then(|_| results.next())).collect()
    }
}

impl Compiled {
    fn dispatch(&self, form: ComputeForm) -> Option<Dispatch<'_>> {
        let stage = match form {
            ComputeForm::Module => ComputeStage::Module(EntryPoint {
                module: &self.validated.module,
                entry: &self.entry,
            }),
            ComputeForm::Output(target) => {
                ComputeStage::Output(self.outputs[&target].as_ref().ok()?)
            }
        };
        Some(Dispatch { stage, buffers: &self.buffers, groups: self.groups })
    }

    /// The same with one output, as SPIR-V: that of SPIR-V as it is, or what glslang makes of GLSL 4.50.
    ///
    /// # Errors
    /// There is no output, or glslang refuses it.
    pub fn as_spirv(&self, target: Target) -> Result<Self, String> {
        let output = |target| self.outputs[&target].clone().map_err(|_| "no output".to_owned());
        let mut spirv = output(Target::SPIRV)?;
        if target == Target::GLSL450 {
            let text = output(target)?.text().into_owned();
            let words = compile_spirv(&with_sets(&text))?;
            spirv.bytes = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        }
        let outputs = [(Target::SPIRV, Ok(spirv))].into();
        let (validated, entry) = (self.validated.clone(), self.entry.clone());
        Ok(Self { validated, entry, buffers: self.buffers.clone(), groups: self.groups, outputs })
    }

    /// Whether the output for an executor writes to a buffer.
    pub fn binds(&self, form: ComputeForm, (group, binding): (u32, u32)) -> bool {
        let ComputeForm::Output(target) = form else { return true };
        self.outputs[&target].as_ref().is_ok_and(|output| {
            let mut bindings = output.reflection.bindings.iter();
            bindings.any(|one| one.writable && (one.group, one.binding) == (group, binding))
        })
    }

    /// The output for an executor, as text for people.
    pub fn output_text(&self, form: ComputeForm) -> String {
        match form {
            ComputeForm::Output(target) if target != Target::SPIRV => self.outputs[&target]
                .as_ref()
                .map(|one| one.text().into_owned())
                .unwrap_or_default(),
            _ => String::new(),
        }
    }
}

/// Whether an error only says that an executor lacks something.
pub fn is_lack(error: &Diagnostic) -> bool {
    error.code.name == codes::EXECUTOR_LACKS.name
}

/// GLSL with the author's numbers of bindings, in the place of the one number that OpenGL has.
fn with_sets(text: &str) -> String {
    let mut parts = text.split("binding = ");
    let mut made = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(part.len());
        let (number, rest) = part.split_at(end);
        let number = number.parse::<u32>().unwrap_or_default();
        let _ = write!(made, "set = {}, binding = {}{rest}", number / 16, number % 16);
    }
    made
}
