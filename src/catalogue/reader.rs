//! The library's data files: TOML with a diagnostic at the place of whatever is not as expected.

use serde::de::DeserializeOwned;

use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::source::{SourceId, SourceSet, Span};

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

/// Something in a data file is not as expected.
pub fn invalid_data(span: Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(codes::DATA_SYNTAX, message).at(span, "in this data file")
}
