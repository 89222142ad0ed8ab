//! The form of outputs in SPIR-V: with names, stripped, or optimised by a program.

use std::fmt::Debug;
use std::sync::Arc;

use lamplight_bundle::{Artifact, SpirvForm, Target, Unit};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_emit::spirv::{HEADER_WORDS, bytes, instructions, op, words};

/// A program that optimises SPIR-V. Whoever generates passes it in, since a program of the machine
/// is I/O.
pub trait Optimiser: Sync + Debug {
    /// Its name and its version, in one line. Another version may write other bytes.
    ///
    /// # Errors
    /// Why it cannot be run, and how to install it.
    fn version(&self) -> Result<String, String>;

    /// The optimised module. Bindings and specialisation constants stay, names need not.
    ///
    /// # Errors
    /// What the program says of the module.
    fn optimise(&self, module: &[u8]) -> Result<Vec<u8>, String>;
}

/// Gives the SPIR-V of units the form that is asked for.
#[derive(Debug, Clone, Default)]
pub struct SpirvShaper<'a> {
    form: SpirvForm,
    optimiser: Option<(&'a dyn Optimiser, String)>,
}

impl<'a> SpirvShaper<'a> {
    /// A shaper for outputs in some targets.
    ///
    /// # Errors
    /// If they are to be optimised, and the optimiser is missing.
    pub fn new(
        form: SpirvForm,
        targets: &[Target],
        optimiser: Option<&'a dyn Optimiser>,
    ) -> Result<Self, Diagnostics> {
        if !targets.contains(&Target::SPIRV) {
            return Ok(Self::default());
        }
        if form != SpirvForm::Optimised {
            return Ok(Self { form, optimiser: None });
        }
        let missing = || failed("this build of Lamplight runs no programs, so it has no optimiser");
        let optimiser = optimiser.ok_or_else(|| vec![missing()])?;
        let version = optimiser.version().map_err(|reason| vec![failed(&reason)])?;
        Ok(Self { form, optimiser: Some((optimiser, version)) })
    }

    /// The version of the optimiser, if it is used.
    pub fn version(&self) -> Option<&str> {
        self.optimiser.as_ref().map(|(_, version)| version.as_str())
    }

    /// Changes the SPIR-V of a unit to the form.
    ///
    /// # Errors
    /// What the optimiser says of it.
    pub fn shape(&self, unit: &mut Unit) -> Result<(), Diagnostics> {
        let Some(artifact) = unit.targets.get_mut(Target::SPIRV.name()) else { return Ok(()) };
        if self.form == SpirvForm::Names {
            return Ok(());
        }
        let Artifact { bytes: module, extension: _, native } = artifact;
        *module = match &self.optimiser {
            None => stripped_module(module).into(),
            Some((optimiser, version)) => {
                let made = optimiser.optimise(module).map_err(|reason| vec![failed(&reason)])?;
                Arc::make_mut(native).optimiser = Some(version.clone());
                // Another program wrote it, which may leave something for debuggers.
                stripped_module(&made).into()
            }
        };
        Ok(())
    }
}

fn failed(reason: &str) -> Diagnostic {
    Diagnostic::error(codes::OPTIMISER_FAILED, format!("SPIR-V cannot be optimised: {reason}"))
}

/// The module without the instructions that only debuggers read (SPIR-V 1.6, section 3.52.2 and
/// `OpModuleProcessed`). No other instruction refers to them, except that `OpLine` refers to an
/// `OpString`, and both go.
fn stripped_module(module: &[u8]) -> Vec<u8> {
    let words = words(module);
    let mut made = words.get(..HEADER_WORDS).unwrap_or_default().to_vec();
    let kept = instructions(&words).filter(|one| !op::DEBUG.contains(&one.op));
    made.extend(kept.flat_map(|one| one.words));
    bytes(&made)
}
