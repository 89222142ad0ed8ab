//! Linkers that are kept between requests.

use std::cell::RefCell;

use lamplight::bundle::{Conventions, Target};
use lamplight::link::Linker;

/// Linkers with functions that were translated before, by targets and conventions. An output
/// depends on its text alone, so an edit costs only what it changes.
#[derive(Default)]
pub struct Linkers(Vec<(&'static [Target], Conventions, Linker<'static>)>);

impl Linkers {
    /// The linker of some targets and conventions. Lists of targets are few, so each is kept as
    /// long as the page.
    pub fn of(&mut self, targets: &[Target], conventions: Conventions) -> &Linker<'static> {
        let is_it =
            |(known, used): (&[Target], Conventions)| known == targets && used == conventions;
        let known = self.0.iter().position(|(known, used, _)| is_it((known, *used)));
        let index = known.unwrap_or_else(|| {
            let kept: &'static [Target] = Box::leak(targets.to_vec().into_boxed_slice());
            self.0.push((kept, conventions, Linker::with(kept, conventions)));
            self.0.len() - 1
        });
        &self.0[index].2
    }
}

thread_local! {
    pub static LINKERS: RefCell<Linkers> = RefCell::default();
}
