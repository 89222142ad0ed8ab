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
    let mut findings = Vec::new();
    let mut number = 10_000;
    let mut killed = |call: &str, occurrence: usize| {
        number += 1;
        let inject = format!("inject={call}:signal=KILL:when={occurrence}");
        package.injected(call, &inject, number)
    };
    for first in FIRST {
        for occurrence in 1..=MOST {
            for (second, step) in SECOND {
                for later in (1..=MOST).step_by(step) {
                    let (one, two) = (killed(first, occurrence)?, killed(second, later)?);
                    if matches!(one, Injected::No) || matches!(two, Injected::No) {
                        break;
                    }
                    *counts.entry("killed twice").or_default() += 1;
                    for (run, found) in [("first", one), ("second", two)] {
                        if let Injected::Wrong(reason) = found {
                            let place = format!("{first} {occurrence}, then {second} {later}");
                            findings.push(format!("{place}: after the {run} run: {reason}"));
                        }
                    }
                }
            }
        }
    }
    findings.iter().for_each(|finding| println!("{finding}"));
    Ok(findings)
}
