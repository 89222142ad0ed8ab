//! The text that a writer of naga fills: it ends with an error where no bundle would take it.
//!
//! A few bytes of a shader can stand for a text of any length, such as a zero for each element of
//! an array. Nothing of naga says how long; so the writer is stopped.

use std::fmt;

use crate::limits::GROUP_BYTES;

/// A text of at most [`GROUP_BYTES`].
#[derive(Debug, Default)]
pub struct Text(pub String);

impl Text {
    /// An error of a writer over this text, in words.
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

impl fmt::Write for Text {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        if self.is_full() {
            return Err(fmt::Error);
        }
        self.0.push_str(text);
        Ok(())
    }
}
