//! Things that are in the place of files that a command writes into its folder.

use std::fs;
use std::os::unix::fs::{FileTypeExt as _, symlink};
use std::path::Path;

use super::{
    CASES, MAIN, MINE, Outcome, Place, Writer, ensure, is_cache, listed, pipe, places, refused,
};

/// A file that Lamplight did not make: the command refuses and writes no other file either. With
/// `--force` it replaces the file.
pub fn foreign_file(writer: &Writer, name: &str) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at("out").join(name);
    fs::create_dir_all(path.parent().ok_or("no folder")?)?;
    fs::write(&path, MINE)?;
    let before = listed(&place.at("out"))?;
    refused(&place, writer, false)?;
    ensure(fs::read(&path)? == MINE, "the foreign file was overwritten")?;
    if is_cache(writer) || !writer.files.is_empty() {
        return Ok(());
    }
    ensure(listed(&place.at("out"))? == before, "the refusing command changed the folder")?;
    place.succeeds(&Place::command_line(writer, "out", true), writer.endless)?;
    ensure(fs::read(&path)? != MINE, "`--force` did not replace the foreign file")
}

/// A link to a foreign file: the command refuses, also with `--force`.
pub fn link_to_file(writer: &Writer, name: &str) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at("out").join(name);
    fs::create_dir_all(path.parent().ok_or("no folder")?)?;
    fs::write(place.at("victim"), MINE)?;
    symlink(place.at("victim"), &path)?;
    for force in [false, true] {
        refused(&place, writer, force)?;
        ensure(fs::read(place.at("victim"))? == MINE, "the link's target was changed")?;
        ensure(fs::symlink_metadata(&path)?.is_symlink(), "the link was replaced")?;
    }
    Ok(())
}

/// A link in place of a folder below the command's: nothing is written to the link's target or
/// deleted there, even if its files have names that a bundle's files have.
pub fn link_to_folder(writer: &Writer, name: &str) -> Outcome {
    let Some(folder) = Path::new(name).parent().filter(|folder| folder != &Path::new("")) else {
        return Ok(());
    };
    let place = Place::new(writer)?;
    let path = place.at("out").join(folder);
    fs::create_dir_all(path.parent().ok_or("no folder")?)?;
    fs::create_dir(place.at("victims"))?;
    for victim in ["notes.txt", "0000000000000000.wgsl", ".tmp-1-1"] {
        fs::write(place.at("victims").join(victim), MINE)?;
    }
    symlink(place.at("victims"), &path)?;
    let before = listed(&place.at("victims"))?;
    for force in [false, true] {
        refused(&place, writer, force)?;
        let unchanged = listed(&place.at("victims"))? == before;
        ensure(unchanged, "the folder that the link names was changed")?;
    }
    Ok(())
}

/// A pipe: the command refuses, also with `--force`.
pub fn a_pipe(writer: &Writer, name: &str) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at("out").join(name);
    fs::create_dir_all(path.parent().ok_or("no folder")?)?;
    pipe(&path)?;
    for force in [false, true] {
        refused(&place, writer, force)?;
        ensure(fs::symlink_metadata(&path)?.file_type().is_fifo(), "the pipe was replaced")?;
    }
    Ok(())
}

/// A folder in place of a file: the command refuses, also with `--force`.
pub fn in_the_way(writer: &Writer, name: &str) -> Outcome {
    let place = Place::new(writer)?;
    let path = place.at("out").join(name);
    fs::create_dir_all(&path)?;
    fs::write(path.join("notes.txt"), MINE)?;
    for force in [false, true] {
        refused(&place, writer, force)?;
        let kept = fs::read(path.join("notes.txt")).is_ok_and(|found| found == MINE);
        ensure(kept, "a file in the folder was changed or removed")?;
    }
    Ok(())
}

/// The files that a user puts beside those of the command stay, even if their names look like
/// temporary files. The temporary folder that a killed run left is deleted.
pub fn neighbours(writer: &Writer) -> Outcome {
    let place = Place::new(writer)?;
    let out = place.at("out");
    place.succeeds(&Place::command_line(writer, "out", false), writer.endless)?;
    let mut kept = Vec::new();
    for folder in places(writer)?.iter().filter_map(|name| Path::new(name).parent()) {
        for name in ["notes.txt", ".tmp-1-1", "0123456789abcdef.wgsl"] {
            kept.push(out.join(folder).join(name));
        }
    }
    kept.push(out.join(".lamplight-0123456789abcdef/precious"));
    kept.push(out.join(".lamplight-fedcba9876543210/mark"));
    for path in &kept {
        fs::create_dir_all(path.parent().ok_or("no folder")?)?;
        fs::write(path, MINE)?;
    }
    let left = out.join(".lamplight-00000000000000ff");
    fs::create_dir(&left)?;
    fs::write(left.join("mark"), "Lamplight: files of a run that is not over.")?;
    fs::write(left.join("half"), "half of a file")?;
    fs::write(place.at("main.wesl"), MAIN.replace("vec4f(x)", "vec4f(0.5 * x)"))?;
    fs::write(place.at("half.toml"), CASES.replace("2.0", "3.0"))?;
    place.succeeds(&Place::command_line(writer, "out", false), writer.endless)?;
    for path in &kept {
        let kept = fs::read(path).is_ok_and(|found| found == MINE);
        ensure(kept, format!("{path:?} was changed or removed"))?;
    }
    ensure(!left.exists(), format!("{left:?}, which a killed run left, is still there"))
}
