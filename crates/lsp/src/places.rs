//! Places in the texts of a package, as editors name them. Each text's lines are counted once, so
//! that a text with thousands of places costs as much as its length.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use serde_json::{Value, json};

use super::place::{Lines, file_address};
use lamplight_diagnostic::source::{SourceId, SourceSet, Span};

/// Where a file of the embedded library lies on the disk.
pub type LibraryAddress<'l> = &'l dyn Fn(&str) -> Option<PathBuf>;

/// The texts of a package, and what is known of those that were asked for.
pub struct Places<'s> {
    pub sources: &'s SourceSet,
    library: LibraryAddress<'s>,
    known: RefCell<BTreeMap<SourceId, Rc<KnownText<'s>>>>,
}

struct KnownText<'s> {
    lines: Lines<'s>,
    address: Option<String>,
}

impl<'s> Places<'s> {
    pub fn new(sources: &'s SourceSet, library: LibraryAddress<'s>) -> Self {
        Self { sources, library, known: RefCell::default() }
    }

    fn known(&self, id: SourceId) -> Rc<KnownText<'s>> {
        let mut known = self.known.borrow_mut();
        let text = known.entry(id).or_insert_with(|| {
            let lines = Lines::new(&self.sources.get(id).text);
            Rc::new(KnownText { lines, address: address_of(self.sources, id, self.library) })
        });
        Rc::clone(text)
    }

    pub fn address(&self, id: SourceId) -> Option<String> {
        self.known(id).address.clone()
    }

    /// The line of a span's start, from zero.
    pub fn line(&self, span: Span) -> usize {
        self.known(span.source).lines.units(span.start as usize).0
    }

    pub fn range(&self, span: Span) -> Value {
        self.known(span.source).lines.range(span.range())
    }

    pub fn location(&self, span: Span) -> Option<Value> {
        Some(json!({ "uri": self.address(span.source)?, "range": self.range(span) }))
    }
}

/// The address of a text: of a file on the disk, or of one that the library's copy has.
pub fn address_of(
    sources: &SourceSet,
    id: SourceId,
    library: LibraryAddress<'_>,
) -> Option<String> {
    let source = sources.get(id);
    if !source.on_disk {
        return Some(file_address(&library(source.path.strip_prefix("lamplight/")?)?));
    }
    let path = Path::new(&source.path);
    Some(file_address(&path.canonicalize().unwrap_or_else(|_| path.to_owned())))
}
