//! The counts of a suite, by cause, and the counts that are expected.

use std::collections::BTreeMap;
use std::fmt;

use lamplight::diagnostic::Diagnostic;

use super::Program;
use xtask::CommandFailure;

/// One line for each suite: its name, its commit or `any`, and the counts of [`WORDS`]. Lines that begin
/// with `outputs:` have the count of outputs and of those that validators refuse. A comment begins with
/// `#`.
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
    /// Programs that compute another value than they should, of suites that have values.
    wrong_values: BTreeMap<String, Vec<String>>,
    /// How many rows of values are right.
    rows: usize,
    /// Cases by the reason for which nothing is asked of them.
    left_out: BTreeMap<String, usize>,
    /// Programs by the reason for which only their compilation is judged.
    not_run: BTreeMap<String, usize>,
    /// Programs by the reason for which they are accepted on purpose.
    chosen: BTreeMap<String, usize>,
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

    /// Counts a case of which nothing is asked.
    pub fn leave_out(&mut self, reason: &str) {
        *self.left_out.entry(reason.to_owned()).or_default() += 1;
    }

    /// Counts a program that is compiled and not run.
    pub fn add_not_run(&mut self, reason: &str) {
        *self.not_run.entry(reason.to_owned()).or_default() += 1;
    }

    /// Counts a program that should be refused, and is accepted for a reason.
    pub fn add_choice(&mut self, reason: &str) {
        self.programs += 1;
        *self.chosen.entry(reason.to_owned()).or_default() += 1;
    }

    /// Counts rows of values that are right.
    pub fn add_rows(&mut self, rows: usize) {
        self.rows += rows;
    }

    pub fn add_wrong_value(&mut self, name: &str, message: &str) {
        let group = name.rsplit_once('.').map_or(name, |(group, _)| group);
        self.wrong_values.entry(group.to_owned()).or_default().push(format!("{name}: {message}"));
    }

    /// How many there are.
    pub fn programs(&self) -> usize {
        self.programs
    }

    /// Every program that is judged wrongly.
    pub fn listed(&self) -> String {
        let all = self.wrongly_refused.iter().chain(&self.wrongly_accepted);
        let all = all.chain(&self.wrong_values);
        all.flat_map(|(cause, names)| names.iter().map(move |name| format!("{name}: {cause}\n")))
            .collect()
    }

    /// Compares with what is expected of a suite at a commit.
    pub fn compare(&self, suite: &str, commit: &str) -> Result<Comparison, CommandFailure> {
        let wrong = [&self.wrongly_refused, &self.wrongly_accepted, &self.wrong_values];
        let [refused, accepted, values] = wrong.map(count);
        let counts = |reasons: &BTreeMap<String, usize>| reasons.values().sum();
        let (chosen, not_run) = (counts(&self.chosen), counts(&self.not_run));
        let least = [self.programs, self.rows];
        let most = [refused, accepted, values, chosen, not_run];
        compare_counts(suite, commit, WORDS, (&least, &most))
    }
}

/// The text for the reader, or the counts that are worse than expected.
pub type Comparison = Result<String, String>;

/// The counts of a suite, in the order of a line.
const WORDS: &str = "programs, right rows of values, wrongly refused, wrongly accepted, wrong values, \
                     accepted on purpose, not run";

/// Compares counts with a line of `expected.txt`: those that should be at least as many, and those that
/// should be at most.
pub fn compare_counts(
    suite: &str,
    commit: &str,
    words: &str,
    (least, most): (&[usize], &[usize]),
) -> Result<Comparison, CommandFailure> {
    let found = [least, most].concat();
    let Some((line, expected)) = expected_of(suite, commit)? else {
        let counts: Vec<String> = found.iter().map(usize::to_string).collect();
        let line = format!("{suite} {commit} {}", counts.join(" "));
        return Ok(Ok(format!("expected.txt has no line for this commit: {line}")));
    };
    if expected.len() != found.len() {
        let message = format!("expected.txt: `{line}` needs {} counts: {words}", found.len());
        return Err(CommandFailure::input(message));
    }
    let message = format!("{line}: {words}: {found:?}, but expected.txt has {expected:?}");
    let (floor, ceiling) = expected.split_at(least.len());
    let is_worse = least.iter().zip(floor).any(|(found, expected)| found < expected)
        || most.iter().zip(ceiling).any(|(found, expected)| found > expected);
    Ok(match (found == expected, is_worse) {
        (true, _) => Ok(format!("{line}: as expected")),
        (false, true) => Err(message),
        (false, false) => Ok(format!("{message}: update it")),
    })
}

/// How the names begin that lines about outputs have.
pub const OUTPUTS: &str = "outputs:";

/// The line of a suite at a commit, with its counts. A folder of shaders, and the outputs of any suite,
/// are known by their commits alone.
fn expected_of(suite: &str, commit: &str) -> Result<Option<(String, Vec<usize>)>, CommandFailure> {
    for line in EXPECTED.lines().filter(|line| !line.starts_with('#')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [name, at, counts @ ..] = words.as_slice() else { continue };
        let is_commit = *at == "any" || commit.starts_with(at);
        let is_of_outputs = name.starts_with(OUTPUTS) == suite.starts_with(OUTPUTS);
        let is_named = match suite {
            "folder" => *at != "any",
            _ => suite == *name,
        };
        if !(is_commit && is_of_outputs && is_named) {
            continue;
        }
        let counts: Result<Vec<usize>, _> = counts.iter().map(|count| count.parse()).collect();
        let wrong =
            |_| CommandFailure::input(format!("expected.txt: `{line}` is no line of counts"));
        return Ok(Some(((*name).to_owned(), counts.map_err(wrong)?)));
    }
    Ok(None)
}

impl fmt::Display for Table {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { programs: _, accepted, refused, rows, .. } = self;
        writeln!(to, "rightly accepted {accepted}, rightly refused {refused}")?;
        if *rows > 0 {
            writeln!(to, "rows of values that are right {rows}")?;
        }
        let counted = [
            ("nothing asked", &self.left_out),
            ("not run", &self.not_run),
            ("accepted on purpose", &self.chosen),
        ];
        for (what, reasons) in counted.into_iter().filter(|(_, reasons)| !reasons.is_empty()) {
            writeln!(to, "{what} {}", reasons.values().sum::<usize>())?;
            for (reason, programs) in reasons {
                writeln!(to, "{programs:6} {reason}")?;
            }
        }
        let parts = [
            ("wrongly refused", &self.wrongly_refused),
            ("wrongly accepted", &self.wrongly_accepted),
            ("wrong values", &self.wrong_values),
        ];
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
pub fn general(message: &str) -> String {
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
