//! The library's data files: TOML with a diagnostic at the place of whatever is not as expected.

use serde::de::DeserializeOwned;

use lamplight_compose::project::library_package;
use lamplight_diagnostic::source::{self, Embedded, SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

/// A data file in the set as a value of `T`.
pub fn read_data<T: DeserializeOwned>(sources: &SourceSet, id: SourceId) -> Result<T, Diagnostics> {
    let text = &sources.get(id).text;
    toml::from_str(text).map_err(|error| {
        let range = error.span().unwrap_or(0..0);
        let message = error.message().lines().collect::<Vec<_>>().join("; ");
        vec![invalid_data(
            Span::new(id, range.start.min(text.len())..range.end.min(text.len())),
            message,
        )]
    })
}

/// A file of the library as a value of `T`; `None` if there is no such file.
pub fn find_own<T: DeserializeOwned>(
    library: Embedded,
    sources: &mut SourceSet,
    path: &str,
) -> Result<Option<T>, Diagnostics> {
    let id = source::read(sources, &library_package(library), path)
        .map_err(|error| vec![error.into()])?;
    id.map(|id| read_data(sources, id)).transpose()
}

/// A file that the library has, added to the set.
pub fn add_own(
    library: Embedded,
    sources: &mut SourceSet,
    path: &str,
) -> Result<SourceId, Diagnostics> {
    let id = source::read(sources, &library_package(library), path)
        .map_err(|error| vec![error.into()])?;
    id.ok_or_else(|| vec![Diagnostic::error(codes::UNREADABLE, format!("there is no `{path}`"))])
}

/// A file that the library has, as a value of `T`.
pub fn read_own<T: DeserializeOwned>(
    library: Embedded,
    sources: &mut SourceSet,
    path: &str,
) -> Result<T, Diagnostics> {
    let id = add_own(library, sources, path)?;
    read_data(sources, id)
}

/// The error about a place in a data file that is not as expected.
pub fn invalid_data(span: Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(codes::DATA_SYNTAX, message).at(span, "in this data file")
}
