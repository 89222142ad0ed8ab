//! `--watch`: draws again when something changed that was read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

use super::{Failure, Job, report};
use crate::input;
use crate::limits::MODEL_BYTES;
use crate::source::SourceSet;

/// The time between looks at the files, which are compared by content.
const PAUSE: Duration = Duration::from_millis(100);

/// The files that a picture was made from, with what they held; `None` where there was none.
#[derive(Default)]
pub struct Seen(BTreeMap<PathBuf, Option<Vec<u8>>>);

impl Seen {
    /// Reads a file and remembers it.
    pub fn read(&mut self, path: &Path, most: u64) -> std::io::Result<Vec<u8>> {
        let read = input::read_file(path, most);
        self.0.insert(path.to_owned(), read.as_ref().ok().cloned());
        read
    }

    /// Remembers a file, if it is not known yet.
    pub fn add_file(&mut self, path: &Path) {
        self.0.entry(path.to_owned()).or_insert_with(|| bytes_of(path));
    }

    /// Remembers the texts that were read.
    pub fn add_sources(&mut self, sources: &SourceSet) {
        for (_, source) in sources.iter().filter(|(_, source)| source.on_disk) {
            let bytes = source.text.as_bytes().to_vec();
            self.0.insert(PathBuf::from(&source.path), Some(bytes));
        }
    }

    fn is_current(&self) -> bool {
        self.0.iter().all(|(path, bytes)| bytes_of(path) == *bytes)
    }
}

fn bytes_of(path: &Path) -> Option<Vec<u8>> {
    input::read_file(path, MODEL_BYTES).ok()
}

/// Draws, and again after each change. What is wrong is printed, and the last picture stays.
pub fn draw_again(job: &Job<'_>) -> Result<(), Failure> {
    let mut rows = None;
    loop {
        let mut seen = Seen::default();
        match job.draw(&mut seen) {
            Ok(drawn) => {
                let is_new = rows.as_ref() != Some(&drawn.rows);
                report::report_drawn(job, &drawn, is_new)?;
                rows = Some(drawn.rows);
            }
            Err(failure @ (Failure::Input(..) | Failure::Message(1, _))) => {
                let _ = failure.report(job.form);
            }
            Err(failure) => return Err(failure),
        }
        while seen.is_current() {
            sleep(PAUSE);
        }
    }
}
