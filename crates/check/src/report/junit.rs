//! `junit.xml`: one test suite a module, one test case for each case, language and executor, and
//! one for what is proven of a case without an executor.

use std::fmt::Write as _;

use super::ReportOrigin;
use crate::check::{CheckReport, failures_as_text, of_outcome, of_proof};
use lamplight_diagnostic::{Diagnostic, escape_markup};

/// A test case: the module it belongs to, its name, how it failed, and why it cannot run.
struct Test<'a> {
    module: &'a str,
    name: String,
    /// File and line of the case.
    place: (&'a str, usize),
    failure: Option<Diagnostic>,
    lacks: Option<&'a str>,
}

/// The report as JUnit understands it.
pub fn junit_report(report: &CheckReport, origin: &ReportOrigin<'_>) -> String {
    let tests = junit_tests(report, origin);
    let mut modules: Vec<&str> = tests.iter().map(|test| test.module).collect();
    modules.sort_unstable();
    modules.dedup();
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        text,
        "<testsuites name=\"lamplight\" tests=\"{}\" failures=\"{}\">",
        tests.len(),
        failed_count(&tests)
    );
    for module in modules {
        let own: Vec<&Test<'_>> = tests.iter().filter(|test| test.module == module).collect();
        write_suite(&mut text, module, &own);
    }
    text + "</testsuites>\n"
}

fn junit_tests<'a>(report: &'a CheckReport, origin: &'a ReportOrigin<'_>) -> Vec<Test<'a>> {
    let outcomes = report.outcomes.iter().map(|outcome| Test {
        module: &outcome.module,
        name: format!(
            "{} case {} {} {}",
            outcome.function,
            outcome.case + 1,
            outcome.language.name(),
            outcome.executor
        ),
        place: origin.place(outcome.span),
        failure: of_outcome(outcome),
        lacks: outcome.lacks().map(|lack| lack.message.as_str()),
    });
    let proofs = report.proofs.iter().map(|proof| Test {
        module: &proof.module,
        name: format!("{} case {} in f64", proof.function, proof.case + 1),
        place: origin.place(proof.span),
        failure: of_proof(proof),
        lacks: None,
    });
    outcomes.chain(proofs).collect()
}

fn failed_count<'a>(tests: impl IntoIterator<Item = &'a Test<'a>>) -> usize {
    tests.into_iter().filter(|test| test.failure.is_some()).count()
}

fn write_suite(text: &mut String, module: &str, tests: &[&Test<'_>]) {
    let failures = failed_count(tests.iter().copied());
    let _ = writeln!(
        text,
        "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{failures}\" skipped=\"{}\">",
        escape_markup(module),
        tests.len(),
        tests.iter().filter(|test| test.lacks.is_some()).count()
    );
    for test in tests {
        let _ = write!(
            text,
            "    <testcase classname=\"{}\" name=\"{}\" file=\"{}\" line=\"{}\"",
            escape_markup(module),
            escape_markup(&test.name),
            escape_markup(test.place.0),
            test.place.1
        );
        let Some(failure) = &test.failure else {
            text.push_str(&match test.lacks {
                Some(reason) => {
                    format!(
                        ">\n      <skipped message=\"{}\"/>\n    </testcase>\n",
                        escape_markup(reason)
                    )
                }
                None => "/>\n".to_owned(),
            });
            continue;
        };
        let _ = writeln!(
            text,
            ">\n      <failure message=\"{}\">{}</failure>\n    </testcase>",
            escape_markup(&failure.message),
            escape_markup(&failures_as_text(std::slice::from_ref(failure)))
        );
    }
    text.push_str("  </testsuite>\n");
}
