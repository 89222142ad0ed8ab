//! Compiles texts for every target, each text once.

use rayon::prelude::*;

use super::compositions::ComposedForms;
use super::entry::ShaderEntry;
use super::sink::Sink;
use super::spirv_form::SpirvShaper;
use crate::cache::{Cache, CachedUnit, CompileJob};
use lamplight_bundle::{Conventions, Digest, Target};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_link::{self as link, Linker, Reason};

/// What remains of [`link::CompiledUnit`] once the unit has gone to the sink.
#[derive(Debug)]
pub struct Compiled {
    pub digest: Digest,
    pub warnings: Diagnostics,
    pub whole: Vec<(Target, Reason)>,
}

/// Compiles texts for the same targets, and passes the units on.
pub struct Compiler<'a> {
    pub targets: &'a [Target],
    pub conventions: Conventions,
    pub sink: &'a dyn Sink,
    pub cache: Option<&'a Cache>,
    pub linker: Linker<'a>,
    pub shaper: SpirvShaper<'a>,
}

impl Compiler<'_> {
    /// Compiles every text of a batch that the cache does not know, and gives the units to the
    /// sink.
    pub fn make(
        &self,
        batch: &[(&ComposedForms, &ShaderEntry)],
    ) -> Vec<Result<Compiled, Diagnostics>> {
        let made = batch.par_iter().map(|(text, entry)| self.make_one(text, entry)).collect();
        self.linker.forget();
        made
    }

    fn make_one(&self, text: &ComposedForms, entry: &ShaderEntry) -> Result<Compiled, Diagnostics> {
        let job = CompileJob {
            text: &text.lean.text,
            composed: &text.composed,
            entry: &entry.name,
            options: &entry.options,
            targets: self.targets,
            conventions: self.conventions,
            optimiser: self.shaper.version(),
        };
        if let Some(found) = self.cache.and_then(|cache| cache.find(job)) {
            return self.pass_on(found?, Vec::new());
        }
        let both = link::TextForms { composed: &text.composed, lean: &text.lean };
        let made = link::compile(&both, &entry.name, self.targets, &self.linker);
        let (made, whole) = match made {
            Ok(link::CompiledUnit { mut unit, warnings, whole }) => {
                let shaped = self.shaper.shape(&mut unit);
                (shaped.map(|()| CachedUnit { unit, warnings }), whole)
            }
            Err(errors) => (Err(errors), Vec::new()),
        };
        if !is_of_this_machine(&made) {
            self.cache.into_iter().for_each(|cache| cache.keep(job, &made));
        }
        self.pass_on(made?, whole)
    }

    fn pass_on(
        &self,
        made: CachedUnit,
        whole: Vec<(Target, Reason)>,
    ) -> Result<Compiled, Diagnostics> {
        let digest = self
            .sink
            .add(made.unit)
            .map_err(|error| vec![Diagnostic::error(codes::BUNDLE_FAILED, error.to_string())])?;
        Ok(Compiled { digest, warnings: made.warnings, whole })
    }
}

/// Whether the failure is one of this machine, now: another machine, or this one later, might
/// succeed.
fn is_of_this_machine(made: &Result<CachedUnit, Diagnostics>) -> bool {
    let of_machine = [codes::NAGA_EXHAUSTED, codes::OPTIMISER_FAILED];
    let is_of_machine = |error: &Diagnostic| of_machine.contains(&error.code);
    made.as_ref().is_err_and(|errors| errors.iter().any(is_of_machine))
}
