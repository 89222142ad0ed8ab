//! What is printed about a picture of a user's shader, and where it goes.

use std::io::Write as _;
use std::path::PathBuf;

use serde_json::json;

use super::{Colors, Drawn, Failure, Job};
use crate::cli::terminal::{self, stderr, stdout};
use crate::picture::Picture;
use crate::picture::own::table::table_text;
use crate::picture::terminal::{TerminalForm, terminal_text};

/// Prints a note.
pub fn say_note(note: &str) -> Result<(), Failure> {
    Ok(writeln!(stderr(), "note: {note}")?)
}

/// A note about a picture that shows nothing.
pub fn plain_picture(picture: &Picture) -> Option<String> {
    let (pixels, _) = picture.pixels.as_chunks::<3>();
    let first = pixels.first()?;
    if pixels.iter().any(|pixel| pixel != first) {
        return None;
    }
    let [r, g, b] = first;
    Some(match first {
        [0, 0, 0] => "every pixel is black".to_owned(),
        _ => format!("every pixel has the colour #{r:02x}{g:02x}{b:02x}"),
    })
}

/// Writes or shows the picture, and prints what it shows. `has_table` says whether the table is new.
pub fn report_drawn(job: &Job<'_>, drawn: &Drawn, has_table: bool) -> Result<(), Failure> {
    let own = &job.arguments.own;
    if has_table && !own.json {
        if !drawn.rows.is_empty() {
            stderr().write_all(table_text(&drawn.rows).as_bytes())?;
        }
        drawn.notes.iter().try_for_each(|note| say_note(note))?;
    }
    let is_written = own.terminal.is_none() || job.arguments.output.is_some();
    let path = if is_written { Some(write_file(job, drawn)?) } else { None };
    if let Some(form) = own.terminal {
        let variable = |name: &str| std::env::var(name).ok();
        let form = form.unwrap_or_else(|| TerminalForm::of_environment(&variable));
        let text = terminal_text(&drawn.picture, form, terminal::columns());
        terminal::write_picture(&text.map_err(Failure::environment)?)?;
    }
    match own.json {
        true => print_json(job, drawn, path),
        false => print_line(job, drawn, path),
    }
}

fn write_file(job: &Job<'_>, drawn: &Drawn) -> Result<PathBuf, Failure> {
    let stem = job.file.file_stem().unwrap_or_default().to_string_lossy();
    let name = if stem == "-" { "render".into() } else { stem };
    super::super::write_named(job.arguments, &name, &drawn.picture)
}

fn print_line(job: &Job<'_>, drawn: &Drawn, path: Option<PathBuf>) -> Result<(), Failure> {
    let file = job.file.display();
    let shown = path.map_or(String::new(), |path| format!("{}: ", path.display()));
    let Picture { width, height, pixels: _ } = drawn.picture;
    let (model, seconds, adapter) = (&drawn.model, drawn.seconds, job.painter.adapter());
    let colors = match drawn.colors {
        Colors::Linear => "linear colours",
        Colors::Srgb => "colours as they are",
    };
    Ok(writeln!(
        stdout(),
        "{shown}{width} x {height} of {file} {model}, {colors}, in {seconds:.2} s, {adapter}"
    )?)
}

fn print_json(job: &Job<'_>, drawn: &Drawn, path: Option<PathBuf>) -> Result<(), Failure> {
    let Picture { width, height, pixels: _ } = drawn.picture;
    let colors = if drawn.colors == Colors::Linear { "linear" } else { "srgb" };
    let value = json!({
        "file": job.file.display().to_string(),
        "picture": path.map(|path| path.display().to_string()),
        "width": width,
        "height": height,
        "model": drawn.model,
        "colors": colors,
        "executor": job.painter.adapter(),
        "inputs": drawn.rows,
        "notes": drawn.notes,
    });
    Ok(writeln!(stdout(), "{value}")?)
}
