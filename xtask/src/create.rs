//! `cargo xtask new KIND NAME`: writes the files that a task needs, so that nobody has to find
//! them.

use crate::generate::root;
use crate::{Failure, Outcome, new};

/// Writes the files, and prints them with what remains to be done.
pub fn run(arguments: &[String]) -> Outcome {
    let [kind, name] = arguments else { return Err(Failure::usage(usage())) };
    let made = new::make(&root(), kind, name).map_err(Failure::usage)?;
    for (path, text) in &made.files {
        let file = root().join(path);
        lamplight::output::write(&file, text.as_bytes())
            .map_err(|error| Failure::environment(format!("cannot write `{path}`: {error}")))?;
        println!("wrote {path}");
    }
    println!("\nnow:");
    made.next.iter().for_each(|step| println!("- {step}"));
    Ok(())
}

fn usage() -> String {
    let kinds = new::KINDS.iter().map(|kind| format!("\n  {:12}{}", kind.name, kind.example));
    format!("usage: cargo xtask new KIND NAME\n{}", kinds.collect::<String>())
}
