//! Names and texts of others do not control the user's terminal when the command prints them.

use std::fs;

use libtest_mimic::Trial;

use super::{Outcome, run};

/// Escape sequences that clear a screen, in their 7-bit and 8-bit forms, and the character that
/// reverses the direction of text.
const EVIL: &str = "a\u{1b}[2J\u{9b}2J\u{202e}b";

type Case = (&'static str, fn() -> Outcome);

pub fn trials() -> Vec<Trial> {
    let cases: [Case; 3] =
        [("arguments", arguments), ("messages", messages), ("composed", composed)];
    let trial = |(name, case): Case| Trial::test(format!("hostile::printed_{name}"), case);
    cases.into_iter().map(trial).collect()
}

/// Fails if the command prints a control character, on either stream, in any form of diagnostics.
fn harmless(arguments: &[&str], file: &str) -> Outcome {
    for form in ["human", "short", "json"] {
        let folder = tempfile::tempdir()?;
        fs::write(folder.path().join("m.wesl"), file)?;
        let output = run(&folder, &[arguments, &["--diagnostics", form]].concat())?;
        for stream in [output.stdout, output.stderr] {
            let text = String::from_utf8(stream)?;
            let is_obeyed = |c: char| c != '\n' && c.is_control() || c == '\u{202e}';
            if let Some(found) = text.chars().find(|c| is_obeyed(*c)) {
                return Err(format!("{arguments:?} as {form} prints {found:?}: {text}").into());
            }
        }
    }
    Ok(())
}

fn arguments() -> Outcome {
    harmless(&["show", EVIL], "")?;
    harmless(&["explain", EVIL], "")?;
    harmless(&["compile", "m.wesl", "--target", EVIL], "")?;
    harmless(&["render", EVIL], "")?;
    harmless(&[EVIL], "")?;
    harmless(&["bundle", "list", EVIL], "")?;
    harmless(&["check", EVIL], "")
}

fn messages() -> Outcome {
    harmless(&["compose", "m.wesl"], &format!("import package::{EVIL};\n"))?;
    harmless(
        &["compile", "m.wesl", "--target", "wgsl"],
        &format!("fn f() {{ return \"{EVIL}\"; }}"),
    )
}

/// A composed text that goes to a pipe is not changed.
fn composed() -> Outcome {
    let folder = tempfile::tempdir()?;
    fs::write(folder.path().join("m.wesl"), format!("// {EVIL}\nfn f() {{}}\n"))?;
    let output = run(&folder, &["compose", "m.wesl"])?;
    let text = String::from_utf8(output.stdout)?;
    match text.contains(EVIL) {
        true => Ok(()),
        false => Err(format!("the comment {EVIL:?} should be as it was in: {text:?}").into()),
    }
}
