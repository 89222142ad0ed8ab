//! Two runs that are killed one after the other in the same folder: the second begins with whatever
//! the first has left.

use std::collections::BTreeMap;

use super::{FaultPackage, Injected};
use xtask::CommandFailure;

/// The calls that change the folder, at which the first run is killed.
const FIRST: [&str; 4] = ["rename", "unlink", "mkdir", "fsync"];

/// The calls at which the second run is killed, with the distance of the occurrences that are tried.
const SECOND: [(&str, usize); 4] = [("rename", 3), ("unlink", 3), ("mkdir", 1), ("fsync", 4)];

/// The most occurrences of each call.
const MOST: usize = 16;

/// Kills a run at each change of the folder, and then a second one at some; returns the findings.
pub fn run(
    package: &FaultPackage,
    counts: &mut BTreeMap<&'static str, usize>,
) -> Result<Vec<String>, CommandFailure> {
    let mut killer = Killer { package, number: 10_000, findings: Vec::new() };
    let all = FIRST.iter().flat_map(|first| (1..=MOST).map(move |at| (*first, at)));
    for first in all {
        for (second, step) in SECOND {
            for later in (1..=MOST).step_by(step) {
                // Neither call is made so often.
                if !killer.killed(first, "")? || !killer.killed((second, later), &place(first))? {
                    break;
                }
                *counts.entry("killed twice").or_default() += 1;
            }
        }
    }
    killer.findings.iter().for_each(|finding| println!("{finding}"));
    Ok(killer.findings)
}

/// A call, and which of its occurrences.
type Occurrence<'c> = (&'c str, usize);

fn place((call, occurrence): Occurrence<'_>) -> String {
    format!("{call} {occurrence}, then ")
}

/// Kills runs of a package.
struct Killer<'p> {
    package: &'p FaultPackage,
    /// What the next run writes.
    number: usize,
    findings: Vec<String>,
}

impl Killer<'_> {
    /// Kills a run at a call, and notes what is wrong after it. Returns whether there was such a call.
    fn killed(&mut self, at: Occurrence<'_>, before: &str) -> Result<bool, CommandFailure> {
        let (call, occurrence) = at;
        self.number += 1;
        let inject = format!("inject={call}:signal=KILL:when={occurrence}");
        Ok(match self.package.injected(call, &inject, self.number)? {
            Injected::No => false,
            Injected::Whole => true,
            Injected::Wrong(reason) => {
                self.findings.push(format!("{before}{call} {occurrence}: {reason}"));
                true
            }
        })
    }
}
