//! Draws several pictures at once.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

use super::super::executor;
use super::Failure;
use crate::diagnostic::stopped_message;
use crate::execute::executors::ExecutorEntry;
use crate::execute::{STACK, Session};
use crate::output::OutputFolder;

/// How many pictures are drawn at once. While one is prepared or encoded, which is work for one
/// thread, the device draws the other.
const AT_ONCE: usize = 2;

/// Files with their names, and what else is kept of a subject.
pub type DrawnFiles<T> = (Vec<(String, Vec<u8>)>, T);

/// The number of a subject, and what was drawn of it.
type NumberedFiles<T> = (usize, Result<DrawnFiles<T>, Failure>);

/// Draws all subjects, on executors of their own, and writes the files as they are ready. Returns
/// the rest in the order of the subjects.
///
/// After a failure no further subject is begun. Subjects are begun in their order, so the failure
/// that is returned, that of the lowest number, is always the same.
pub fn draw_all<S: Sync, T: Send>(
    entry: &ExecutorEntry,
    subjects: &[S],
    draw: impl Fn(&mut dyn Session, &S) -> Result<DrawnFiles<T>, Failure> + Sync,
    folder: &mut OutputFolder,
) -> Result<Vec<T>, Failure> {
    let (next, is_stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (sender, drawn) = channel();
    let work = |sender: Sender<NumberedFiles<T>>| {
        let mut painter = match executor::open_executor(entry) {
            Ok(painter) => painter,
            Err(failure) => {
                is_stopped.store(true, Ordering::Relaxed);
                return drop(sender.send((0, Err(failure))));
            }
        };
        while !is_stopped.load(Ordering::Relaxed) {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(subject) = subjects.get(index) else { break };
            let result = draw(painter.as_mut(), subject);
            is_stopped.fetch_or(result.is_err(), Ordering::Relaxed);
            if sender.send((index, result)).is_err() {
                break;
            }
        }
    };
    std::thread::scope(|scope| {
        let start = |_| {
            let (work, sender) = (&work, sender.clone());
            let thread = std::thread::Builder::new().stack_size(STACK);
            thread.spawn_scoped(scope, move || work(sender))
        };
        let threads = (0..AT_ONCE.min(subjects.len())).map(start).collect::<Result<Vec<_>, _>>();
        let threads = threads.map_err(|error| Failure::environment(error.to_string()))?;
        drop(sender);
        // If a file cannot be written, the receiver is gone, and the threads end at their next send.
        let kept = collect(drawn, subjects.len(), folder);
        // The end of a scope does not wait for the thread-local state of drivers, but this does.
        let ended: Vec<_> = threads.into_iter().map(|thread| thread.join()).collect();
        match ended.iter().all(Result::is_ok) {
            true => kept,
            false => Err(Failure::environment(stopped_message("the renderer"))),
        }
    })
}

/// Writes the files of all subjects until none is left, or one has failed.
fn collect<T>(
    drawn: Receiver<NumberedFiles<T>>,
    count: usize,
    folder: &mut OutputFolder,
) -> Result<Vec<T>, Failure> {
    let mut kept: Vec<Option<T>> = (0..count).map(|_| None).collect();
    let mut failed: Option<(usize, Failure)> = None;
    for (index, result) in drawn {
        match result {
            Ok((files, rest)) => {
                for (name, bytes) in files {
                    folder.write(&name, &bytes)?;
                }
                kept[index] = Some(rest);
            }
            Err(failure) if failed.as_ref().is_none_or(|(first, _)| index < *first) => {
                failed = Some((index, failure));
            }
            Err(_) => {}
        }
    }
    match failed {
        Some((_, failure)) => Err(failure),
        None => kept
            .into_iter()
            .collect::<Option<_>>()
            .ok_or_else(|| Failure::environment(stopped_message("the renderer"))),
    }
}
