//! Makes the program of a finding smaller: lines of its text are removed as long as the program has
//! the same finding.

use super::program::Program;

/// The most programs that are tried.
const MOST: usize = 600;

pub fn shrunk(program: &Program, has: &dyn Fn(&Program) -> bool) -> Program {
    let mut lines: Vec<String> = program.text.lines().map(str::to_owned).collect();
    let with = |lines: &[String]| Program { text: lines.join("\n") + "\n", ..program.clone() };
    let (mut size, mut at, mut tries) = (lines.len() / 2, 0, 0);
    while size > 0 && tries < MOST {
        if at >= lines.len() {
            (size, at) = (size / 2, 0);
            continue;
        }
        let end = (at + size).min(lines.len());
        let fewer = [&lines[..at], &lines[end..]].concat();
        tries += 1;
        match has(&with(&fewer)) {
            true => lines = fewer,
            false => at = end,
        }
    }
    with(&lines)
}
