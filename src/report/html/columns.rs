//! The columns of a case's table, with what each says.

use std::fmt::Write as _;

/// Heading and meaning.
const COLUMNS: &[(&str, &str)] = &[
    ("executor", "what ran it"),
    ("language", "which module was called: WESL or GLSL"),
    ("inputs", "how many inputs were tried"),
    ("worst error", "the largest absolute error of all inputs"),
    (
        "ULP",
        "the error of the input that came nearest to its tolerance, in units in the last place",
    ),
    ("of allowed", "what the tolerance allows that input, in the same units"),
    ("headroom", "the part of the tolerance that was left, below 0 under a waiver"),
    ("of driver", "how much of what was recorded for this driver was needed"),
    ("ambiguous", "inputs that are off where a comparison is too close to call"),
    ("free", "inputs for which nothing is promised: the expected value is not a finite f32"),
    ("parity ULP", "the largest distance from the results of the first language"),
];

/// The head of a table, and the start of its body.
pub fn write_heading(html: &mut String) {
    html.push_str("<table><thead><tr>");
    for (name, meaning) in COLUMNS {
        let _ = write!(html, "<th title=\"{meaning}\">{name}</th>");
    }
    html.push_str("</tr></thead><tbody>\n");
}

/// What the columns say, for readers without a pointer.
pub fn write_legend(html: &mut String) {
    html.push_str("<section id=\"columns\"><h2>columns</h2>\n<table><tbody>\n");
    for (name, meaning) in COLUMNS {
        let _ = writeln!(html, "<tr><td>{name}</td><td class=\"words\">{meaning}</td></tr>");
    }
    html.push_str("</tbody></table></section>\n");
}
