//! `index.html`: one page that needs nothing else.

mod columns;

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::plot::{Series, error_plot, heat_map};
use super::{ReportOrigin, executors_of, functions_of};
use crate::check::{
    CaseVerdict, CheckReport, Outcome, ProfiledInput, Proof, failures_as_text, headroom_text,
    of_outcome, short_number,
};
use lamplight_bundle::Language;
use lamplight_diagnostic::escape_markup;

const STYLE: &str = include_str!("style.css");

/// What a browser may do with the page: apply its own styles, and nothing else. The page has names
/// and texts of modules, which may be untrusted.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";

/// The report as a page.
pub fn html_report(report: &CheckReport, origin: &ReportOrigin<'_>) -> String {
    let page = ReportPage::new(report, origin);
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\"><meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>Lamplight: numbers</title>\n<style>\n{STYLE}</style></head>\n<body>\n<header><h1>Lamplight: numbers</h1>\n"
    );
    page.summary(&mut html);
    html += "</header>\n<main>\n";
    page.failed(&mut html);
    page.index(&mut html);
    for (path, outcomes) in page.failures_first() {
        page.function(&mut html, path, outcomes);
    }
    columns::write_legend(&mut html);
    html + "</main></body></html>\n"
}

/// A report, sorted for reading.
struct ReportPage<'a> {
    report: &'a CheckReport,
    origin: &'a ReportOrigin<'a>,
    /// With their adapters, in the order in which they first ran.
    executors: Vec<(&'static str, &'a str)>,
    functions: BTreeMap<String, Vec<&'a Outcome>>,
}

impl<'a> ReportPage<'a> {
    fn new(report: &'a CheckReport, origin: &'a ReportOrigin<'a>) -> Self {
        let (executors, functions) = (executors_of(report), functions_of(report));
        Self { report, origin, executors, functions }
    }

    fn fails(&self, path: &str, outcomes: &[&Outcome]) -> bool {
        outcomes.iter().any(|outcome| outcome.failed())
            || self.report.proofs.iter().any(|proof| !proof.passed() && proof.path() == path)
    }

    /// Functions, those that fail first.
    fn failures_first(&self) -> Vec<(&String, &Vec<&'a Outcome>)> {
        let mut functions: Vec<_> = self.functions.iter().collect();
        functions.sort_by_key(|(path, outcomes)| !self.fails(path, outcomes));
        functions
    }

    /// Links to what fails, above everything else.
    fn failed(&self, html: &mut String) {
        let failing = self.functions.iter().filter(|(path, outcomes)| self.fails(path, outcomes));
        let links: Vec<String> = failing
            .map(|(path, _)| format!("<a href=\"#{0}\">{0}</a>", escape_markup(path)))
            .collect();
        if !links.is_empty() {
            let _ = writeln!(
                html,
                "<p class=\"failed\"><b class=\"bad\">fails</b> {}</p>",
                links.join(", ")
            );
        }
        if !self.report.untested.is_empty() {
            let untested = escape_markup(&self.report.untested.join(", "));
            let _ = writeln!(html, "<p class=\"note\">Without a case: {untested}.</p>");
        }
    }

    fn class(&self, outcome: &Outcome) -> usize {
        self.executors.iter().position(|(name, _)| *name == outcome.executor).unwrap_or(0)
    }

    fn summary(&self, html: &mut String) {
        let (all, passed) = (
            self.report.outcomes.len(),
            self.report.outcomes.iter().filter(|outcome| outcome.passed()).count(),
        );
        let inputs: usize = self
            .report
            .outcomes
            .iter()
            .filter_map(|outcome| Some(outcome.verdict.as_ref().ok()?.inputs))
            .sum();
        let verdict = if self.report.passed() {
            "<b class=\"ok\">all hold</b>"
        } else {
            "<b class=\"bad\">not all hold</b>"
        };
        let _ = writeln!(
            html,
            "<p>{} functions, {passed} of {all} runs pass over {inputs} inputs: {verdict}.</p>",
            self.functions.len()
        );
        html.push_str("<ul class=\"key\">");
        for (index, (executor, adapter)) in self.executors.iter().enumerate() {
            let _ = write!(
                html,
                "<li><i class=\"swatch b{index}\"></i><b>{executor}</b> {}</li>",
                escape_markup(adapter)
            );
        }
        let (version, command) = (env!("CARGO_PKG_VERSION"), escape_markup(&self.origin.command));
        let _ =
            write!(html, "</ul><p class=\"note\">lamplight {version}: <code>{command}</code></p>");
        html.push_str("<p class=\"note\">Lines show the largest error over each parameter, dashed for GLSL; the grey area is what is allowed. Headroom is what is left of that.</p>\n");
    }

    /// One row a function, one column an executor.
    fn index(&self, html: &mut String) {
        html.push_str("<table class=\"index\"><thead><tr><th>function</th>");
        for (executor, _) in &self.executors {
            let _ = write!(html, "<th>{executor}</th>");
        }
        html.push_str("</tr></thead><tbody>\n");
        for (path, outcomes) in self.failures_first() {
            let _ = write!(html, "<tr><td><a href=\"#{0}\">{0}</a></td>", escape_markup(path));
            for (executor, _) in &self.executors {
                let own: Vec<&&Outcome> =
                    outcomes.iter().filter(|outcome| outcome.executor == *executor).collect();
                let share = own.iter().map(|outcome| worst_share(outcome)).fold(0.0, f64::max);
                let text = html_cell(!own.iter().any(|outcome| outcome.failed()), share);
                html.push_str(&text);
            }
            html.push_str("</tr>\n");
        }
        html.push_str("</tbody></table>\n");
    }

    fn function(&self, html: &mut String, path: &str, outcomes: &[&Outcome]) {
        let _ = writeln!(html, "<section id=\"{0}\"><h2>{0}</h2>", escape_markup(path));
        let mut cases: Vec<usize> = outcomes.iter().map(|outcome| outcome.case).collect();
        cases.sort_unstable();
        cases.dedup();
        for case in cases {
            let own: Vec<&Outcome> =
                outcomes.iter().copied().filter(|outcome| outcome.case == case).collect();
            let proof = self.report.proofs.iter().find(|proof| {
                proof.case == case && own.first().is_some_and(|outcome| belongs_to(proof, outcome))
            });
            self.case(html, case, &own, proof);
        }
        html.push_str("</section>\n");
    }

    fn case(&self, html: &mut String, case: usize, outcomes: &[&Outcome], proof: Option<&Proof>) {
        let place = outcomes.first().map_or(String::new(), |outcome| {
            let (file, line) = self.origin.place(outcome.span);
            format!(", {}:{line}", escape_markup(file))
        });
        let _ = writeln!(html, "<h3>case {}{place}</h3>", case + 1);
        columns::write_heading(html);
        for outcome in outcomes {
            write_row(html, outcome);
        }
        html.push_str("</tbody></table>\n");
        if let Some(proof) = proof {
            let _ = writeln!(html, "<p class=\"note\">{}</p>", proven_parts(proof));
        }
        self.plots(html, outcomes);
        write_failing(html, outcomes);
        write_inputs(html, outcomes);
    }

    fn plots(&self, html: &mut String, outcomes: &[&Outcome]) {
        let series: Vec<Series<'_>> = outcomes
            .iter()
            .filter_map(|outcome| {
                let profile = outcome.verdict.as_ref().ok()?.profile.as_deref()?;
                Some(Series {
                    class: self.class(outcome),
                    dashed: outcome.language == Language::Glsl,
                    profile,
                })
            })
            .collect();
        let Some(first) = series.first() else { return };
        html.push_str("<div class=\"plots\">");
        for index in 0..first.profile.axes.len() {
            html.push_str(&error_plot(index, &series).unwrap_or_default());
        }
        let hottest = series
            .iter()
            .filter_map(|one| Some((one, one.profile.map.as_ref()?)))
            .max_by(|a, b| sum_cells(&a.1.cells).total_cmp(&sum_cells(&b.1.cells)));
        if let Some((one, map)) = hottest {
            html.push_str(&heat_map(map, one.profile).unwrap_or_default());
        }
        html.push_str("</div>\n");
    }
}

fn sum_cells(cells: &[f64]) -> f64 {
    cells.iter().filter(|cell| !cell.is_nan()).sum()
}

fn belongs_to(proof: &Proof, outcome: &Outcome) -> bool {
    proof.module == outcome.module && proof.function == outcome.function
}

fn worst_share(outcome: &Outcome) -> f64 {
    outcome
        .verdict
        .as_ref()
        .ok()
        .and_then(|verdict| verdict.worst)
        .map_or(0.0, |worst| worst.share())
}

/// A table cell, with a bar that shows how much of the tolerance is used.
fn html_cell(passed: bool, share: f64) -> String {
    let class = if !passed {
        "bad"
    } else if share > 0.8 {
        "near"
    } else {
        "ok"
    };
    let text = if passed { headroom_text(share) } else { "fails".to_owned() };
    format!(
        "<td class=\"bar {class}\" style=\"--used:{:.0}%\">{text}</td>",
        100.0 * share.clamp(0.0, 1.0)
    )
}

fn write_row(html: &mut String, outcome: &Outcome) {
    let _ = write!(html, "<tr><td>{}</td><td>{}</td>", outcome.executor, outcome.language.name());
    match &outcome.verdict {
        Err(error) => {
            let _ = write!(
                html,
                "<td colspan=\"9\" class=\"{}\">{}: {}</td>",
                if outcome.failed() { "bad" } else { "note" },
                if outcome.failed() { "not run" } else { "cannot run here" },
                escape_markup(&error.message)
            );
        }
        Ok(verdict) => write_numbers(html, outcome, verdict),
    }
    html.push_str("</tr>\n");
}

fn write_numbers(html: &mut String, outcome: &Outcome, verdict: &CaseVerdict) {
    let (ulps, allowed) =
        verdict.worst.map_or((0.0, 0.0), |worst| (worst.ulps(), worst.allowed_ulps()));
    let percent =
        |rows: usize| format!("{:.2} %", 100.0 * rows as f64 / verdict.inputs.max(1) as f64);
    let _ = write!(
        html,
        "<td>{}</td><td>{}</td><td>{}</td><td>{}</td>{}",
        verdict.inputs,
        short_number(verdict.largest),
        short_number(ulps),
        short_number(allowed),
        html_cell(outcome.passed(), worst_share(outcome))
    );
    let driver =
        outcome.of_driver().map_or("–".to_owned(), |share| format!("{:.0} %", 100.0 * share));
    let parity = verdict.parity.map_or("–".to_owned(), short_number);
    let _ = write!(
        html,
        "<td>{driver}</td><td>{}</td><td>{}</td><td>{parity}</td>",
        percent(verdict.ambiguous),
        percent(verdict.indeterminate)
    );
}

/// What is proven without a device, a sentence for each part.
fn proven_parts(proof: &Proof) -> String {
    let mut text = match &proof.spec {
        Err(error) => format!("WGSL's own bound is not known: {}. ", escape_markup(error)),
        Ok(spec) if spec.bound_ulps == 0.0 => String::new(),
        Ok(spec) => {
            let (stated, bound) = (short_number(spec.stated_ulps), short_number(spec.bound_ulps));
            format!(
                "Tightest: {stated} ULP stated where WGSL allows {bound} ({} of {} inputs state less than WGSL allows). ",
                spec.stricter, spec.rows
            )
        }
    };
    match proof.value {
        None => {}
        Some(value) if value.off == 0 => {
            text += &format!(
                "In f64 the code is within {} of what is allowed, on {} inputs. ",
                short_number(value.share),
                value.rows
            )
        }
        Some(value) => {
            let (off, rows, share) = (value.off, value.rows, short_number(value.share));
            text += &format!(
                "<b class=\"bad\">In f64 the code is off on {off} of {rows} inputs, by up to {share} of what is allowed.</b> "
            );
        }
    }
    match &proof.parity {
        None => {}
        Some(Err(error)) => {
            text +=
                &format!("The languages could not be compared in f64: {}.", escape_markup(error))
        }
        Some(Ok(parity)) if parity.apart == 0 => {
            text += &format!("WESL and GLSL agree in f64 on {} inputs.", parity.rows)
        }
        Some(Ok(parity)) => {
            text += &format!(
                "WESL and GLSL differ in f64 on {} of {} inputs, by up to {:.1e} of the value.",
                parity.apart, parity.rows, parity.worst
            )
        }
    }
    text
}

fn write_failing(html: &mut String, outcomes: &[&Outcome]) {
    for failure in outcomes.iter().filter_map(|outcome| of_outcome(outcome)) {
        let text = failures_as_text(std::slice::from_ref(&failure));
        let _ = writeln!(html, "<pre class=\"bad\">{}</pre>", escape_markup(&text));
    }
}

/// Lists the inputs whose error is largest in relation to the tolerance. They are from the run with
/// the largest such ratio.
fn write_inputs(html: &mut String, outcomes: &[&Outcome]) {
    let Some(outcome) = outcomes.iter().max_by(|a, b| worst_share(a).total_cmp(&worst_share(b)))
    else {
        return;
    };
    let profile = outcome.verdict.as_ref().ok().and_then(|verdict| verdict.profile.as_deref());
    let Some(worst) = profile.map(|profile| &profile.worst).filter(|worst| !worst.is_empty())
    else {
        return;
    };
    let _ = write!(
        html,
        "<details><summary>worst inputs ({}, {})</summary><table><tbody>",
        outcome.executor,
        outcome.language.name()
    );
    for ProfiledInput { words, worst } in worst {
        let words: Vec<String> = words
            .iter()
            .map(|(name, value, bits)| {
                format!("{} = {value} <i>0x{bits:08x}</i>", escape_markup(name))
            })
            .collect();
        let _ = write!(
            html,
            "<tr><td class=\"words\">{}</td><td>found {}, expected {}: {} of {} ULP</td></tr>",
            words.join(", "),
            worst.found,
            worst.expected,
            short_number(worst.ulps()),
            short_number(worst.allowed_ulps())
        );
    }
    html.push_str("</tbody></table></details>\n");
}
