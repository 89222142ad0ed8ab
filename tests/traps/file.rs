//! Things that are in the place of the file that a command writes.

use std::fs;
use std::io::Read as _;
use std::os::unix::fs::{FileTypeExt as _, symlink};

use super::{MINE, Outcome, Place, Writer, ensure, listed, pipe};

/// The name of the file that the command writes to if it is given `out`.
fn file_name(writer: &Writer) -> &'static str {
    if writer.arguments.contains(&"OUT.lamplight") { "out.lamplight" } else { "out" }
}

/// A file that Lamplight did not make is replaced only with `--force`.
pub fn foreign(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at(file_name(writer));
    fs::write(&path, MINE)?;
    place.refuses(&Place::command_line(writer, "out", false), false)?;
    ensure(fs::read(&path)? == MINE, "the foreign file was overwritten")?;
    place.succeeds(&Place::command_line(writer, "out", true), false)?;
    ensure(fs::read(&path)? != MINE, "`--force` did not replace the foreign file")
}

/// The command replaces an empty file, and then the file that it wrote itself. No file with a
/// temporary name is left.
pub fn own(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    fs::write(place.at(file_name(writer)), b"")?;
    for _ in 0..2 {
        place.succeeds(&Place::command_line(writer, "out", false), false)?;
    }
    let left = listed(place.0.path())?;
    let left = left.keys().find(|name| name.starts_with(".lamplight"));
    ensure(left.is_none(), format!("the temporary file {left:?} was left"))
}

/// A link to a foreign file: the command refuses, and both stay.
pub fn link_to_foreign(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at(file_name(writer));
    fs::write(place.at("victim"), MINE)?;
    symlink(place.at("victim"), &path)?;
    place.refuses(&Place::command_line(writer, "out", false), false)?;
    ensure(fs::read(place.at("victim"))? == MINE, "the link's target was overwritten")?;
    ensure(fs::symlink_metadata(&path)?.is_symlink(), "the link was replaced")
}

/// A link to a file that may be replaced: the command writes to that file, and the link stays.
pub fn link_to_own(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at(file_name(writer));
    fs::create_dir(place.at("elsewhere"))?;
    fs::write(place.at("elsewhere/file"), b"")?;
    symlink(place.at("elsewhere/file"), &path)?;
    place.succeeds(&Place::command_line(writer, "out", false), false)?;
    ensure(fs::symlink_metadata(&path)?.is_symlink(), "the link was replaced")?;
    let is_empty = fs::read(place.at("elsewhere/file"))?.is_empty();
    ensure(!is_empty, "nothing was written to the link's target")
}

/// A link whose target does not exist: the command refuses, also with `--force`.
pub fn link_to_nowhere(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    symlink(place.at("nowhere"), place.at(file_name(writer)))?;
    for force in [false, true] {
        place.refuses(&Place::command_line(writer, "out", force), false)?;
        ensure(!place.at("nowhere").exists(), "the link's target was created")?;
    }
    Ok(())
}

/// A pipe: the command writes to it, and it stays.
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
    let read = reader.join().map_err(|_| "the thread that reads the pipe panicked")??;
    ensure(!read.is_empty(), "nothing came through the pipe")?;
    ensure(fs::symlink_metadata(&path)?.file_type().is_fifo(), "the pipe was replaced")
}

/// A device: the command writes to it, and it stays. The command is given a link to the device, so
/// that a wrong command replaces only the link.
pub fn device(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at(file_name(writer));
    symlink("/dev/null", &path)?;
    place.succeeds(&Place::command_line(writer, "out", false), false)?;
    ensure(fs::symlink_metadata(&path)?.is_symlink(), "the link was replaced")?;
    ensure(fs::metadata("/dev/null")?.file_type().is_char_device(), "the device was replaced")
}

/// A folder in the place of the file: the command refuses, also with `--force`.
pub fn folder(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at(file_name(writer));
    fs::create_dir(&path)?;
    fs::write(path.join("notes.txt"), MINE)?;
    for force in [false, true] {
        place.refuses(&Place::command_line(writer, "out", force), false)?;
        let kept = fs::read(path.join("notes.txt")).is_ok_and(|found| found == MINE);
        ensure(kept, "a file in the folder was changed or removed")?;
    }
    Ok(())
}
