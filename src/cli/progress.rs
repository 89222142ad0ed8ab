//! A progress bar on a terminal; nothing elsewhere.

use std::sync::Mutex;

use indicatif::{ProgressBar, ProgressStyle};

use crate::generate::Progress;

/// Shows how far a run is on standard error.
pub struct Bar(Mutex<ProgressBar>);

impl Bar {
    pub fn new() -> Self {
        let bar = ProgressBar::new(0);
        // The template is fixed and valid, so there is nothing to report.
        if let Ok(style) = ProgressStyle::with_template("{msg:28} {bar:40} {pos}/{len} {elapsed}") {
            bar.set_style(style);
        }
        Self(Mutex::new(bar))
    }

    pub fn show(&self, progress: Progress) {
        if let Ok(bar) = self.0.lock() {
            bar.set_length(progress.total as u64);
            bar.set_message(progress.stage);
            bar.set_position(progress.done as u64);
        }
    }

    pub fn clear(&self) {
        if let Ok(bar) = self.0.lock() {
            bar.finish_and_clear();
        }
    }
}
