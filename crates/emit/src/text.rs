//! The text that a writer of naga fills. Writing fails once the text is larger than a bundle
//! allows.
//!
//! A few bytes of a shader can become a very long text, such as a zero for each element of an
//! array. naga has no bound for that, so the writer is stopped here.

use std::fmt;

use lamplight_files::limits::GROUP_BYTES;

/// A text that refuses further writes once it has [`GROUP_BYTES`]. The last write before that may
/// go beyond.
#[derive(Debug, Default)]
pub struct BoundedText(pub String);

impl BoundedText {
    /// The message for an error of a writer over this text.
    pub fn explain(&self, error: impl fmt::Display) -> String {
        match self.is_full() {
            true => format!("the output has more than {} MiB", GROUP_BYTES >> 20),
            false => error.to_string(),
        }
    }

    fn is_full(&self) -> bool {
        self.0.len() >= GROUP_BYTES
    }
}

impl fmt::Write for BoundedText {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        if self.is_full() {
            return Err(fmt::Error);
        }
        self.0.push_str(text);
        Ok(())
    }
}
