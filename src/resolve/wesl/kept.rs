//! Parsed texts that are kept from one reading of a package to the next, as editors need it: after
//! a keystroke, all files but one have the text that they had before.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use crate::parse::wesl::{Module, Names, parse_for_editor};
use crate::source::SourceId;

/// A text that was not read again in so many readings is forgotten.
const READINGS: u64 = 64;

/// Identifiers that are kept at most. More than a package has come together as its author types.
const NAMES: usize = 1 << 20;

/// Parsed texts by their content, with the identifiers that all of them share.
#[derive(Debug, Default)]
pub struct Kept {
    /// Absent while a reading has them, and where one ended early.
    names: Option<Arc<Names>>,
    modules: FxHashMap<Arc<str>, (Arc<Module>, u64)>,
    reading: u64,
}

impl Kept {
    /// Begins a reading; gives the identifiers to it.
    pub(super) fn begin(&mut self) -> Names {
        self.reading += 1;
        let oldest = self.reading.saturating_sub(READINGS);
        self.modules.retain(|_, (_, last)| *last >= oldest);
        match self.names.take().filter(|names| names.len() <= NAMES) {
            Some(names) => Arc::unwrap_or_clone(names),
            // The parsed texts have numbers of identifiers that are lost.
            None => {
                self.modules.clear();
                Names::default()
            }
        }
    }

    /// Ends a reading.
    pub(super) fn end(&mut self, names: Arc<Names>) {
        self.names = Some(names);
    }

    /// The parsed text, which need not be that of this file alone.
    pub(super) fn parse(
        &mut self,
        source: SourceId,
        text: Arc<str>,
        names: &mut Names,
    ) -> Arc<Module> {
        let reading = self.reading;
        if let Some((module, last)) = self.modules.get_mut(&text) {
            *last = reading;
            return Arc::clone(module);
        }
        let module = Arc::new(parse_for_editor(source, Arc::clone(&text), names));
        self.modules.insert(text, (Arc::clone(&module), reading));
        module
    }
}
