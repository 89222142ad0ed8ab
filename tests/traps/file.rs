//! Traps for commands that write one file.

use std::fs;
use std::io::Read as _;
use std::os::unix::fs::{FileTypeExt as _, symlink};

use super::{MINE, Outcome, Place, Writer, ensure, listed, pipe};

/// The name that a file command writes to for `out`.
fn file_name(writer: &Writer) -> &'static str {
    if writer.arguments.contains(&"OUT.lamplight") { "out.lamplight" } else { "out" }
}

pub fn foreign(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at(file_name(writer));
    fs::write(&path, MINE)?;
    place.refuses(&Place::command_line(writer, "out", false), false)?;
    ensure(fs::read(&path)? == MINE, "it was overwritten")?;
    place.succeeds(&Place::command_line(writer, "out", true), false)?;
    ensure(fs::read(&path)? != MINE, "`--force` did not replace it")
}

/// An empty file, then its own, then its own again.
pub fn own(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    fs::write(place.at(file_name(writer)), b"")?;
    for _ in 0..2 {
        place.succeeds(&Place::command_line(writer, "out", false), false)?;
    }
    let left = listed(place.0.path())?;
    let left = left.keys().find(|name| name.starts_with(".lamplight"));
    ensure(left.is_none(), format!("{left:?} was left"))
}

pub fn link_to_foreign(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at(file_name(writer));
    fs::write(place.at("victim"), MINE)?;
    symlink(place.at("victim"), &path)?;
    place.refuses(&Place::command_line(writer, "out", false), false)?;
    ensure(fs::read(place.at("victim"))? == MINE, "it was overwritten")?;
    ensure(fs::symlink_metadata(&path)?.is_symlink(), "the link was replaced")
}

pub fn link_to_own(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at(file_name(writer));
    fs::create_dir(place.at("elsewhere"))?;
    fs::write(place.at("elsewhere/file"), b"")?;
    symlink(place.at("elsewhere/file"), &path)?;
    place.succeeds(&Place::command_line(writer, "out", false), false)?;
    ensure(fs::symlink_metadata(&path)?.is_symlink(), "the link was replaced")?;
    ensure(!fs::read(place.at("elsewhere/file"))?.is_empty(), "nothing was written")
}

pub fn link_to_nowhere(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    symlink(place.at("nowhere"), place.at(file_name(writer)))?;
    for force in [false, true] {
        place.refuses(&Place::command_line(writer, "out", force), false)?;
        ensure(!place.at("nowhere").exists(), "the link was followed")?;
    }
    Ok(())
}

pub fn a_pipe(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at(file_name(writer));
    pipe(&path)?;
    let reader = std::thread::spawn({
        let path = path.clone();
        move || {
            let mut bytes = Vec::new();
            fs::File::open(path).and_then(|mut pipe| pipe.read_to_end(&mut bytes)).map(|_| bytes)
        }
    });
    place.succeeds(&Place::command_line(writer, "out", false), false)?;
    let read = reader.join().map_err(|_| "the reader stopped")??;
    ensure(!read.is_empty(), "nothing came through the pipe")?;
    ensure(fs::symlink_metadata(&path)?.file_type().is_fifo(), "the pipe was replaced")
}

/// Through a link, so that a mistake costs a link and no device.
pub fn device(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at(file_name(writer));
    symlink("/dev/null", &path)?;
    place.succeeds(&Place::command_line(writer, "out", false), false)?;
    ensure(fs::symlink_metadata(&path)?.is_symlink(), "the link was replaced")?;
    ensure(fs::metadata("/dev/null")?.file_type().is_char_device(), "the device was replaced")
}

pub fn folder(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at(file_name(writer));
    fs::create_dir(&path)?;
    fs::write(path.join("notes.txt"), MINE)?;
    for force in [false, true] {
        place.refuses(&Place::command_line(writer, "out", force), false)?;
        ensure(fs::read(path.join("notes.txt"))? == MINE, "it was removed")?;
    }
    Ok(())
}
