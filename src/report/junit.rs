//! `junit.xml`: one test suite a module, one test case for each case, language and executor.

use std::fmt::Write as _;

use super::escaped;
use crate::harness::check::{Outcome, Report, failures_of, language};

/// The report as JUnit understands it.
pub fn text(report: &Report) -> String {
    let mut modules: Vec<&str> = report.outcomes.iter().map(|outcome| outcome.module.as_str()).collect();
    modules.dedup();
    let failed = report.outcomes.iter().filter(|outcome| !outcome.passed()).count();
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(text, "<testsuites name=\"lamplight\" tests=\"{}\" failures=\"{failed}\">", report.outcomes.len());
    for module in modules {
        suite(&mut text, module, report);
    }
    text + "</testsuites>\n"
}

fn suite(text: &mut String, module: &str, report: &Report) {
    let outcomes: Vec<&Outcome> = report.outcomes.iter().filter(|outcome| outcome.module == module).collect();
    let failed = outcomes.iter().filter(|outcome| !outcome.passed()).count();
    let _ = writeln!(text, "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{failed}\">", escaped(module), outcomes.len());
    for outcome in outcomes {
        let name = format!("{} case {} {} {}", outcome.function, outcome.case + 1, language(outcome.language), outcome.executor);
        let _ = write!(text, "    <testcase classname=\"{}\" name=\"{}\"", escaped(module), escaped(&name));
        if outcome.passed() {
            text.push_str("/>\n");
            continue;
        }
        let details = failures_of(std::slice::from_ref(outcome), &[]);
        let first = details.lines().next().unwrap_or_default();
        let _ = writeln!(text, ">\n      <failure message=\"{}\">{}</failure>\n    </testcase>", escaped(first), escaped(&details));
    }
    text.push_str("  </testsuite>\n");
}
