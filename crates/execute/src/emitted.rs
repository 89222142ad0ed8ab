//! Emits kernels in the languages of the targets.

use naga::Module;

use crate::executor_failed;
use crate::kernel::{ENTRY, Kernel};
use lamplight_bundle::{Native, Target};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_emit::Emitted;
use lamplight_link::{self as link, Linker};
use lamplight_validate::{Validated, info_of};

/// Emits the kernel's entry point in a target's language. Executors of emitted files get their
/// bytes only from here.
///
/// # Errors
/// `executor-lacks` where the target's language cannot express something in the kernel.
pub fn emit_kernel(kernel: &Kernel, target: Target) -> Result<Emitted, Diagnostic> {
    Ok(of_module(&kernel.module, ENTRY, target, &Linker::new(&[target]))?.0)
}

/// Emits an entry point of a module in a target's language, with the module's analysis. The linker
/// is one of that target.
///
/// # Errors
/// Those of [`emit_kernel`].
pub fn of_module(
    module: &Module,
    entry: &str,
    target: Target,
    linker: &Linker<'_>,
) -> Result<(Emitted, Validated), Diagnostic> {
    let info = info_of(module)
        .map_err(|error| executor_failed(format!("the module is not valid: {error}")))?;
    let validated = Validated { module: module.clone(), info, portable: true };
    match link::module_linked(&validated, entry, target, linker) {
        Ok(artifact) => {
            let (bytes, native) = (artifact.bytes.to_vec(), Native::clone(&artifact.native));
            Ok((Emitted { bytes, native }, validated))
        }
        Err(errors) => Err(kernel_refused(errors, target)),
    }
}

/// The first of a kernel's errors. Where the target lacks a construct, the error says that the
/// executor cannot run the kernel.
fn kernel_refused(errors: Diagnostics, target: Target) -> Diagnostic {
    let lost = || Diagnostic::error(codes::EMIT_FAILED, format!("no output for {target}"));
    let error = errors.into_iter().next().unwrap_or_else(lost);
    if error.code.name == codes::EMIT_FAILED.name {
        Diagnostic::error(codes::EXECUTOR_LACKS, error.message)
    } else {
        error
    }
}
