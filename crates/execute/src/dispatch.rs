//! Runs of compute entry points: what is given to them, and in which form an executor takes them.
//!
//! `entry point + bytes of buffers + a grid of workgroups -> the bytes of its storage buffers`

use super::executor_failed;
use super::frame::{Buffers, EntryPoint};
use super::interpreter::eval_failed;
use super::shipped::Shipped;
#[cfg(not(target_family = "wasm"))]
use lamplight_bundle::Binding;
use lamplight_bundle::Target;
use lamplight_diagnostic::Diagnostic;
use lamplight_emit::with_defaults;
use lamplight_eval::{Machine, Program, Resources};
use naga::AddressSpace;

/// In which form an executor takes compute entry points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ComputeForm {
    /// As naga's module.
    Module,
    /// As the output of a target, which it runs unchanged.
    Output(Target),
}

/// A compute entry point in one of the forms.
#[derive(Debug, Clone, Copy)]
pub enum ComputeStage<'a> {
    Module(EntryPoint<'a>),
    Output(&'a Shipped),
}

/// One run of a compute entry point.
#[derive(Debug, Clone, Copy)]
pub struct Dispatch<'a> {
    pub stage: ComputeStage<'a>,
    /// The bytes of uniform and storage buffers. Those that the entry point does not use are
    /// ignored.
    pub buffers: &'a Buffers,
    /// How many workgroups there are.
    pub groups: [u32; 3],
}

/// The storage buffers that an entry point may write to, as they are afterwards.
pub type DispatchResult = Result<Buffers, Diagnostic>;

#[cfg(not(target_family = "wasm"))]
impl<'a> Dispatch<'a> {
    /// The entry point as the output of a target.
    ///
    /// # Errors
    /// It is in another form, or the output of another target.
    pub(super) fn output(&self, target: Target) -> Result<&'a Shipped, Diagnostic> {
        match self.stage {
            ComputeStage::Output(shipped) if shipped.target == target => Ok(shipped),
            ComputeStage::Output(shipped) => {
                Err(executor_failed(format!("this executor runs no {}", shipped.target)))
            }
            ComputeStage::Module(_) => Err(executor_failed("this executor runs outputs only")),
        }
    }

    /// The bytes of a buffer.
    ///
    /// # Errors
    /// None are given.
    pub(super) fn buffer(&self, place: (u32, u32)) -> Result<&'a [u8], Diagnostic> {
        let (group, binding) = place;
        let missing =
            || executor_failed(format!("no buffer is given for group {group}, binding {binding}"));
        self.buffers.get(&place).map(Vec::as_slice).ok_or_else(missing)
    }
}

/// The buffers of an output.
///
/// # Errors
/// What it binds besides, which no executor gives to a compute stage.
#[cfg(not(target_family = "wasm"))]
pub(super) fn bound_buffers(
    shipped: &Shipped,
) -> Result<impl Iterator<Item = &Binding>, Diagnostic> {
    let bindings = &shipped.reflection.bindings;
    match bindings.iter().find(|one| !one.kind.is_buffer()) {
        Some(other) => Err(executor_failed(format!("`{}` is no buffer", other.name))),
        None => Ok(bindings.iter()),
    }
}

/// Runs an entry point of a module on the evaluator, with numbers in f32. Overrides have their
/// defaults.
pub(super) fn evaluate(dispatch: &Dispatch<'_>) -> DispatchResult {
    let ComputeStage::Module(EntryPoint { module, entry }) = dispatch.stage else {
        return Err(executor_failed("the evaluator runs modules only"));
    };
    let (module, info) = with_defaults(module, entry)?;
    let program = Program::new(&module, &info).map_err(eval_failed)?;
    let id = program.function(entry);
    let id = id.ok_or_else(|| executor_failed(format!("there is no entry point `{entry}`")))?;
    let mut machine = Machine::<f32>::new(&program).map_err(eval_failed)?;
    machine
        .bind(Resources { buffers: dispatch.buffers.clone(), ..Resources::default() })
        .map_err(eval_failed)?;
    machine.dispatch(id, dispatch.groups).map_err(eval_failed)?;
    let written = module.global_variables.iter().filter_map(|(_, variable)| match variable.space {
        AddressSpace::Storage { access } if access.contains(naga::StorageAccess::STORE) => {
            variable.binding.map(|place| (place.group, place.binding))
        }
        _ => None,
    });
    Ok(written.filter_map(|place| Some((place, machine.buffer(place.0, place.1)?))).collect())
}
