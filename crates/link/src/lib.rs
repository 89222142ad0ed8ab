//! Separate compilation: every function is translated once, by itself, and texts are put together
//! from functions. This is the one way from a composed text to its outputs, for every command.
//!
//! Texts are WGSL: GLSL is translated before, by [`compile()`].
//!
//! # Why an output is a function of its text
//!
//! 1. [`outline`] takes the declarations of a text and their references from the composer, which
//!    resolved every name.
//! 2. [`canonical`] writes a text for each function: the function, the declarations that it
//!    names, and a stub for each function that it calls. The key of a function is the hash of all
//!    that this text is made of, and [`translate`] sees nothing else. So a translated function (a
//!    *unit*) depends on its key alone: not on the program around it, on other permutations, other
//!    targets, their order, or the cache.
//! 3. A stub has the signature of its function, uses the same variables of the module, and
//!    samples the same textures ([`summary`]). naga's own analysis must find in the stub what it
//!    found in the function, or the text is compiled as a whole.
//! 4. In the texts that naga writes, the author's names are marks ([`mark`]). [`cut`] divides an
//!    output into declarations; marks are its only references to the author's declarations. All
//!    declarations besides the author's functions come along with a unit, since its canonical text
//!    needed them.
//! 5. [`pool`] puts the units of a text together in an order that depends on their content. Each
//!    name is written as naga writes it alone, or numbered where the text has that identifier with
//!    another meaning ([`names`]). Two declarations of one name that differ are refused.
//!
//! Whatever is refused is compiled by naga as a whole, in that target only, and the [`Reason`] is
//! reported. The reason depends on the text and the target, so that those bytes too are a function
//! of the text.
//!
//! # What this rests on in naga 30
//!
//! - A writer translates a function from its body, from the types, constants and variables that it
//!   names, and from nothing of its callees but names, arguments, results, and the variables of the
//!   module that they use (Metal passes those along, in the order of the module).
//! - A writer's output depends on the names of types, constants, variables and functions only where
//!   it writes them; the namer leaves a mark as it is.
//! - HLSL declares a structure differently if an entry point returns it, and every function that
//!   uses it gets that declaration. So the canonical text's entry point returns it too.
//!
//! `link::whole_and_linked` in the tests compares what is linked with what naga writes of the whole
//! text, declaration by declaration and up to names, for every target: it fails where a version of
//! naga breaks one of these assumptions.

mod browsers;
mod canonical;
mod compile;
pub mod cut;
pub mod mark;
mod marked;
mod module;
pub mod names;
mod outline;
mod pool;
pub mod ready;
mod reason;
mod spirv;
mod summary;
mod text;
mod texts;
mod translate;
mod uses;

pub use compile::{CompiledUnit, TextForms, compile, perform_job};
pub use module::module_linked;
pub use reason::Reason;

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use canonical::{Recipe, make_recipe};
use lamplight_bundle::{Artifact, Conventions, Reflection, Target};
use lamplight_compose::Composed;
use lamplight_files::limits::LINKED_BYTES;
use outline::Outline;
use pool::{LinkParts, Pool, Unit};
use summary::FunctionSummary;
use translate::translate_unit;

/// Bytes of units after which the pool is emptied. A unit that is needed again is translated again,
/// to the same bytes.
const SIZE: usize = 96 << 20;

/// The bound instead of [`SIZE`] if more than a quarter of the units were new: units that no other
/// text uses are not worth keeping.
const SIZE_UNSHARED: usize = 2 << 20;

/// Links texts for a list of targets. It keeps the translated functions, so that texts share them.
pub struct Linker<'a> {
    targets: &'a [Target],
    conventions: Conventions,
    pool: Pool,
    /// Units asked for since the last batch, and how many of them were new.
    requested: AtomicUsize,
    new: AtomicUsize,
}

/// A text, linked in the targets where that is possible.
pub struct Linked {
    pub reflection: Arc<Reflection>,
    /// For each target its output, or why it has to be compiled as a whole.
    pub targets: Vec<Result<Artifact, Reason>>,
    /// Whether the text may break a rule of browsers. The lint of the whole text decides.
    pub suspect: bool,
}

impl<'a> Linker<'a> {
    pub fn new(targets: &'a [Target]) -> Self {
        Self::with(targets, Conventions::default())
    }

    /// A linker whose outputs keep the given conventions.
    pub fn with(targets: &'a [Target], conventions: Conventions) -> Self {
        let (requested, new) = (AtomicUsize::new(0), AtomicUsize::new(0));
        Self { targets, conventions, pool: Pool::new(targets), requested, new }
    }

    /// The targets that it translates to.
    pub fn targets(&self) -> &'a [Target] {
        self.targets
    }

    /// Links a lean text from its functions. New functions are translated first.
    ///
    /// # Errors
    /// The reason why all targets of the text are compiled as a whole. It depends on the text
    /// alone.
    pub fn link(&self, lean: &Composed, entry: &str) -> Result<Linked, Reason> {
        let outline = Outline::read(lean, entry)?;
        let mut units: Vec<Option<Arc<Unit>>> = vec![None; outline.declarations.len()];
        let functions = outline.functions_before_entry();
        // A declaration that several functions name is read once for each of them, so all of them
        // count.
        let mut left = LINKED_BYTES;
        for function in functions {
            let unit = canonical::UnitId::Function(*function);
            units[*function] = Some(self.unit(&outline, unit, &units, &mut left)?);
        }
        let entry = self.unit(&outline, canonical::UnitId::Entry, &units, &mut left)?;
        let suspect = entry.summary.breaks_rules;
        let reflection = entry.reflection.clone().ok_or(Reason::EntryPoint)?;
        let named = functions.iter().filter_map(|function| {
            Some((outline.declarations[*function].name(), units[*function].clone()?))
        });
        let parts = LinkParts { functions: named.collect(), entry };
        let (targets, mut text) = (self.targets.iter().enumerate(), String::new());
        let link =
            |(index, target): (usize, &Target)| self.pool.link(&parts, index, *target, &mut text);
        let targets = targets.map(link);
        let targets = targets.collect();
        Ok(Linked { reflection, targets, suspect })
    }

    /// The author's name of the function that a target cannot express. Of several it is the first,
    /// callees before callers.
    pub fn culprit(&self, lean: &Composed, entry: &str, target: Target) -> Option<String> {
        let outline = Outline::read(lean, entry).ok()?;
        let index = self.targets.iter().position(|known| *known == target)?;
        let mut units: Vec<Option<Arc<Unit>>> = vec![None; outline.declarations.len()];
        let mut left = LINKED_BYTES;
        for function in outline.functions_before_entry() {
            let name = || Some(outline.declarations[*function].name().to_owned());
            let unit = canonical::UnitId::Function(*function);
            match self.unit(&outline, unit, &units, &mut left) {
                Ok(unit) if unit.is_refused(index) => return name(),
                Ok(unit) => units[*function] = Some(unit),
                Err(Reason::Refused) => return name(),
                Err(_) => return None,
            }
        }
        None
    }

    /// The unit, translated now if the pool lacks it. `left` is how many bytes of declarations the
    /// units of this text may still have in total. A declaration counts for each unit that names
    /// it.
    fn unit(
        &self,
        outline: &Outline<'_>,
        unit: canonical::UnitId,
        units: &[Option<Arc<Unit>>],
        left: &mut usize,
    ) -> Result<Arc<Unit>, Reason> {
        let summary = |function: usize| -> Option<&FunctionSummary> {
            units.get(function)?.as_ref().map(|unit| &unit.summary)
        };
        let recipe: Recipe<'_> = make_recipe(outline, unit, &summary)?;
        *left = left.checked_sub(recipe.bytes(outline)).ok_or(Reason::Large)?;
        let key = recipe.key(outline);
        self.requested.fetch_add(1, Ordering::Relaxed);
        if let Some(known) = self.pool.find(&key) {
            return known;
        }
        self.new.fetch_add(1, Ordering::Relaxed);
        let translated = translate_unit(outline, &recipe, self.targets, self.conventions);
        let function = match unit {
            canonical::UnitId::Function(function) => Some(outline.declarations[function].name()),
            canonical::UnitId::Entry => None,
        };
        let callees: BTreeSet<&str> = recipe
            .stubs
            .iter()
            .map(|(stub, _)| outline.declarations[*stub].name())
            .chain(function)
            .collect();
        self.pool.keep(key, translated, function, &callees)
    }

    /// Keeps the pool within its bound; no output depends on this. Call it between batches only: a
    /// text that is being linked needs the pool that its units came from.
    pub fn forget(&self) {
        let (requested, new) =
            (self.requested.swap(0, Ordering::Relaxed), self.new.swap(0, Ordering::Relaxed));
        let bound = if 4 * new > requested { SIZE_UNSHARED } else { SIZE };
        if self.pool.size() > bound {
            self.pool.clear(self.targets);
        }
    }
}
