//! The counts of a suite, by cause, and the counts that are expected.

use std::collections::BTreeMap;
use std::fmt;

use lamplight::diagnostic::Diagnostic;

use super::Program;
use xtask::CommandFailure;

/// One line for each suite: its name, the count of programs, of those wrongly refused and of those
/// wrongly accepted. A comment begins with `#`.
const EXPECTED: &str = include_str!("expected.txt");

/// How many causes are printed.
const CAUSES: usize = 60;

#[derive(Default)]
pub struct Table {
    programs: usize,
    accepted: usize,
    refused: usize,
    /// By cause, the names of the programs.
    wrongly_refused: BTreeMap<String, Vec<String>>,
    wrongly_accepted: BTreeMap<String, Vec<String>>,
}

impl Table {
    pub fn add(&mut self, program: &Program, refusal: Option<&Diagnostic>) {
        self.programs += 1;
        let name = program.name.clone();
        match (program.expected, refusal) {
            (true, None) => self.accepted += 1,
            (false, Some(_)) => self.refused += 1,
            (true, Some(refusal)) => {
                let cause = format!("[{}] {}", refusal.code.name, general(&refusal.message));
                self.wrongly_refused.entry(cause).or_default().push(name);
            }
            (false, None) => {
                let group = name.split(':').next().unwrap_or_default().to_owned();
                self.wrongly_accepted.entry(group).or_default().push(name);
            }
        }
    }

    /// How many there are.
    pub fn programs(&self) -> usize {
        self.programs
    }

    /// Every program that is judged wrongly.
    pub fn listed(&self) -> String {
        let all = self.wrongly_refused.iter().chain(&self.wrongly_accepted);
        all.flat_map(|(cause, names)| names.iter().map(move |name| format!("{name}: {cause}\n")))
            .collect()
    }

    /// How the counts differ from those that are expected of a suite.
    pub fn compare(&self, suite: &str) -> Result<Option<String>, CommandFailure> {
        let found = [self.programs, count(&self.wrongly_refused), count(&self.wrongly_accepted)];
        let mut lines = EXPECTED.lines().filter(|line| !line.starts_with('#'));
        let Some(line) = lines.find(|line| line.split_whitespace().next() == Some(suite)) else {
            return Ok(None);
        };
        let numbers: Result<Vec<usize>, _> =
            line.split_whitespace().skip(1).map(str::parse).collect();
        let expected = numbers
            .map_err(|error| CommandFailure::input(format!("expected.txt: `{line}`: {error}")))?;
        let words = "programs, wrongly refused, wrongly accepted";
        let is_same = expected == found;
        Ok((!is_same)
            .then(|| format!("{suite}: {words}: {found:?}, but expected.txt has {expected:?}")))
    }
}

impl fmt::Display for Table {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { programs: _, accepted, refused, wrongly_refused, wrongly_accepted } = self;
        writeln!(to, "rightly accepted {accepted}, rightly refused {refused}")?;
        let parts = [("wrongly refused", wrongly_refused), ("wrongly accepted", wrongly_accepted)];
        for (what, causes) in parts {
            writeln!(to, "{what} {}", count(causes))?;
            let mut causes: Vec<_> = causes.iter().collect();
            causes.sort_by_key(|(_, names)| std::cmp::Reverse(names.len()));
            for (cause, names) in causes.iter().take(CAUSES) {
                let example = names.first().map_or("", String::as_str);
                writeln!(to, "{:6} {cause} ({example})", names.len())?;
            }
        }
        Ok(())
    }
}

fn count(causes: &BTreeMap<String, Vec<String>>) -> usize {
    causes.values().map(Vec::len).sum()
}

/// A message without the names and numbers of its text.
fn general(message: &str) -> String {
    let mut parts = message.split('`');
    let mut general = parts.next().unwrap_or_default().to_owned();
    while let (Some(_), rest) = (parts.next(), parts.next()) {
        general.push_str("`…`");
        general.push_str(rest.unwrap_or_default());
    }
    let mut digits = false;
    general.retain(|letter| {
        let was_digit = std::mem::replace(&mut digits, letter.is_ascii_digit());
        !(was_digit && digits)
    });
    general
}
