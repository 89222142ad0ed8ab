//! The one way to the disk. Every file that a command or the loader writes for the user goes through
//! here; temporary files for other programs do not.
//!
//! | to write | call | it lives in |
//! |---|---|---|
//! | one file that the user names | [`write_file`], which asks whether a file there is ours | `file.rs` |
//! | one file whose older content the caller has read | [`write()`] | `file.rs` |
//! | a folder of files, each known by its hash | [`write_folder`], or [`OutputFolder`] for one after the other | `folder.rs` |
//! | many files that point to each other | [`Scratch`]: stage all, sync once, rename in the order of use | `scratch.rs`; `publish` in `crates/bundle/src/directory_writer.rs` and `crates/generate/src/cache/folder.rs` do so |
//!
//! Where a file has the new bytes already, [`write_file`] and [`OutputFolder`] write nothing: `has_bytes` in
//! `file.rs` tells. The cache is written in any case. Otherwise a write takes these steps, in this
//! order, so that neither a crash between two of them nor a full disk loses anything:
//!
//! 1. `Scratch::new` makes a folder beside the place. The run keeps a file in it locked, which
//!    tells a later run whether this one is still alive.
//! 2. `Scratch::write` writes the bytes to a new file in this folder, and waits until they are on
//!    the disk. A full disk is an error here, before anything is replaced.
//! 3. `put_file` in `file.rs` gives the file the permissions of the one that it replaces, and
//!    renames it into its place. In an output folder, `OutputFolder::put` in `folder.rs` only
//!    renames it. Both call [`rename_finished`], as bundles and the cache do.
//! 4. `sync_folder` in `scratch.rs` syncs the folder, so that the new name survives a loss of power.
//!    Not every system can do this, and where it fails the write is complete nevertheless.
//! 5. `remove_scratch` removes the scratch folder: when it is dropped, or in the next run's
//!    `Scratch::new` if this run was killed.
//!
//! For a folder, `OutputFolder::note` writes the record of hashes before the files, with the old and
//! the new hash of each, and `OutputFolder::finish` writes it once more at the end; neither does if
//! the record would stay the same. So neither a killed run nor a loss of power leaves a file that
//! the next run takes for a foreign one.
//!
//! A command flattens `Overwrite` of `src/cli/overwrite.rs`, which adds `--force`, and passes
//! `overwrite.replace()`; `src/cli/export/mod.rs` is an example. A command that writes has one line
//! in `FILES` or `FOLDERS` of `tests/traps.rs`, which set a trap at each of its files. A test finds
//! top-level commands with `--force` that have none; it does not see subcommands, further forms of
//! a command, and commands that write without this module.
//!
//! `cargo xtask faults` makes calls of the system fail in `gen`, and ends it at them. It tries no
//! other command.
//!
//! What holds for all of it:
//!
//! - A file is written in a [`Scratch`] folder beside its place, synced, and renamed into it. Only
//!   records of the cache are not synced. A run that is killed leaves the older file whole, and the
//!   next run removes what it left.
//! - Only what is absent, empty or ours is replaced. Ours is decided by content: a mark that the
//!   file carries, or the hash that [`write_folder`] recorded. [`Replace::Any`] stands for a user
//!   who said `--force`.
//! - Nothing is deleted here but scratch folders that no run holds: those that carry our mark, and
//!   empty ones.
//! - Inside an output folder no link is followed. A file that the user names may be a link, whose
//!   target is written, or a stream (a pipe, a terminal, `/dev/null`), which is written to.

mod error;
mod file;
mod folder;
mod scratch;
mod turn;

pub use error::{Error, Foreign};
pub use file::{HEAD_BYTES, write, write_file};
pub use folder::{OutputFolder, write_folder};
pub use scratch::{Scratch, sync_folder};
pub use turn::{Turns, wait_for_turn};

use std::fs;
use std::path::Path;

/// Which of the files that are there may be replaced.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Replace {
    /// Only those that we wrote.
    #[default]
    Ours,
    /// Any regular file: the user asked for it with `--force`.
    Any,
}

/// Renames a finished file into its place. Every rename goes through here.
pub fn rename_finished(finished: &Path, place: &Path) -> std::io::Result<()> {
    fs::rename(finished, place)
}

/// Makes a folder and those above it.
pub fn make_folder(path: &Path) -> Result<(), Error> {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => Ok(()),
        Ok(_) => Err(Foreign::never(path, "is not a folder").into()),
        Err(_) => fs::create_dir_all(path).map_err(|error| match file_in_the_way(path) {
            Some(file) => Foreign::never(file, "is not a folder").into(),
            None => Error::io(path, &error),
        }),
    }
}

/// The file that is where a folder would have to be.
fn file_in_the_way(path: &Path) -> Option<&Path> {
    path.ancestors().find(|above| fs::symlink_metadata(above).is_ok_and(|found| !found.is_dir()))
}
