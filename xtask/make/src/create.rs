//! `cargo xtask new KIND NAME`: writes the files that a task needs, so that nobody has to find
//! them.

use crate::new;
use xtask::process::root;
use xtask::{CommandFailure, CommandResult};

/// Writes the files, and prints them with what remains to be done.
pub fn run(arguments: &[String]) -> CommandResult {
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let [kind, name, rest @ ..] = words.as_slice() else {
        return Err(CommandFailure::usage(usage()));
    };
    let made = new::make(&root(), kind, name, rest).map_err(CommandFailure::usage)?;
    for (path, text) in &made.files {
        let file = root().join(path);
        lamplight::output::write(&file, text.as_bytes()).map_err(|error| {
            CommandFailure::environment(format!("cannot write `{path}`: {error}"))
        })?;
        println!("wrote {path}");
    }
    println!("\nnow:");
    for step in &made.next {
        // Details of a step stand below it.
        let mark = if step.starts_with(' ') { "" } else { "- " };
        println!("{mark}{step}");
    }
    Ok(())
}

fn usage() -> String {
    let line = |kind: &new::TaskKind| {
        let example: Vec<String> = kind.example.iter().map(|word| quoted(word)).collect();
        format!("\n  {:12}{} {}", kind.name, example.join(" "), kind.rest).trim_end().to_owned()
    };
    let kinds: String = new::KINDS.iter().map(line).collect();
    format!("usage: cargo xtask new KIND NAME ...\n\nkinds, each with an example:{kinds}")
}

/// An argument as a shell reads it.
fn quoted(word: &str) -> String {
    if word.contains(' ') { format!("'{word}'") } else { word.to_owned() }
}
