//! Separate compilation: a text whose functions have all been written before is put together from
//! them, and naga never sees it.
//!
//! Permutations differ in a few functions and share the others. [`Outline`] gives each function
//! a key that covers all that its translation can depend on. What a text compiled as a whole
//! gives is taken apart by functions ([`Linker::take`]), kept by their keys, and put together
//! ([`Linker::link`]), also for that text itself: the bytes of a text are the same whether its
//! functions come from its own translation or from those of others.
//!
//! Whatever is not understood stays whole: a text with overrides or of a compute shader, a
//! derivative where fragments may have parted, an output of an unknown shape.

mod local;
mod outline;
mod pool;
mod scan;
mod spirv;
mod take;
mod text;
mod words;

pub use local::marked;
pub use outline::{Declaration, Key, Outline, Scans};
pub use take::{Taken, Whole};

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError, RwLock};

use crate::bundle::{Target, Unit};
use pool::Pool;

/// So many new functions are many.
const MANY: usize = 16;

/// Bytes of pieces after which all is forgotten.
const SIZE: usize = 128 << 20;

/// The same where most texts had something new: to keep what is not shared saves nothing.
const SIZE_UNSHARED: usize = 4 << 20;

/// Functions in all targets of a program.
pub struct Linker<'a> {
    targets: &'a [Target],
    names: take::Names,
    scans: Scans,
    /// Functions that some text is compiled for, whether or not it has been.
    claimed: Mutex<BTreeSet<Key>>,
    pool: RwLock<Pool>,
    /// Whether most texts of the last batch had something new.
    unshared: AtomicBool,
    /// Texts of which no function was compiled.
    linked: AtomicUsize,
}

impl<'a> Linker<'a> {
    pub fn new(targets: &'a [Target]) -> Self {
        let names = take::Names::new(targets);
        let pool = RwLock::new(Pool::new(&names));
        Self {
            targets,
            names,
            scans: Scans::default(),
            claimed: Mutex::default(),
            pool,
            unshared: AtomicBool::new(false),
            linked: AtomicUsize::new(0),
        }
    }

    /// The functions of a lean text whose one entry point is `entry`; `None` where it is to stay whole.
    pub fn outline<'t>(&self, text: &'t str, entry: &str) -> Option<Outline<'t>> {
        Outline::read(text, entry, &self.scans)
    }

    /// For each text of a batch, the functions that it is to be compiled for, and taken apart: every
    /// function is compiled once. Texts with many new ones go first, so that few are compiled.
    pub fn claim(&self, batch: &[Option<Outline<'_>>]) -> Vec<BTreeSet<Key>> {
        let mut claimed = self.claimed.lock().unwrap_or_else(PoisonError::into_inner);
        let new = |outline: &Outline<'_>| outline.functions().map(|function| function.key).filter(|key| !claimed.contains(key)).collect();
        let mut open: Vec<BTreeSet<Key>> = batch.iter().map(|outline| outline.as_ref().map(new).unwrap_or_default()).collect();
        let mut claims = vec![BTreeSet::new(); batch.len()];
        for least in (1..=MANY).rev() {
            for (claim, open) in claims.iter_mut().zip(&mut open).filter(|(_, open)| open.len() >= least) {
                open.retain(|key| !claimed.contains(key));
                if open.len() >= least {
                    claimed.extend(open.iter());
                    *claim = std::mem::take(open);
                }
            }
        }
        let (texts, new) = (batch.iter().flatten().count(), claims.iter().filter(|claim| !claim.is_empty()).count());
        self.unshared.store(2 * new > texts, Ordering::Relaxed);
        claims
    }

    /// Takes apart what a text was compiled to, as far as the functions are wanted.
    ///
    /// # Errors
    /// Where something is not understood: the text stays as it is.
    pub fn take(&self, outline: &Outline<'_>, whole: Whole, wanted: &BTreeSet<Key>) -> Result<Taken, String> {
        take::take(outline, whole, self.targets, &self.names, &|key| wanted.contains(key), take::Overloads::Leave)
    }

    /// Keeps functions for all texts to come. What cannot be kept will be missing.
    pub fn keep(&self, taken: impl IntoIterator<Item = Taken>) {
        let mut pool = self.pool.write().unwrap_or_else(PoisonError::into_inner);
        for taken in taken {
            let _ = pool.keep(taken);
        }
        pool.settle();
    }

    /// The text from functions that are kept, of which it was compiled for `claimed`; `None` where
    /// one is missing.
    pub fn link(&self, outline: &Outline<'_>, claimed: &BTreeSet<Key>) -> Option<Unit> {
        let unit = self.pool.read().unwrap_or_else(PoisonError::into_inner).link(outline, self.targets)?;
        self.linked.fetch_add(usize::from(claimed.is_empty()), Ordering::Relaxed);
        Some(unit)
    }

    /// Ends a batch: bounds what is kept. A text's bytes do not depend on it.
    pub fn forget(&self) {
        let mut pool = self.pool.write().unwrap_or_else(PoisonError::into_inner);
        let bound = if self.unshared.load(Ordering::Relaxed) { SIZE_UNSHARED } else { SIZE };
        if pool.size() > bound {
            *pool = Pool::new(&self.names);
            self.claimed.lock().unwrap_or_else(PoisonError::into_inner).clear();
            self.scans.clear();
        }
    }

    /// Texts that were linked so far and not compiled.
    pub fn linked(&self) -> usize {
        self.linked.load(Ordering::Relaxed)
    }

    /// The text from its own functions alone.
    ///
    /// # Errors
    /// As of [`Linker::take`].
    pub fn alone(&self, outline: &Outline<'_>, whole: Whole) -> Result<Unit, String> {
        let mut pool = Pool::new(&self.names);
        pool.keep(take::take(outline, whole, self.targets, &self.names, &|_| true, take::Overloads::Take)?)?;
        pool.settle();
        pool.link(outline, self.targets).ok_or_else(|| "a function was lost".to_owned())
    }
}
