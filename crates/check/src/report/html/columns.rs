//! The columns of a case's table, with what each says.

use std::fmt::Write as _;

/// Heading and meaning.
const COLUMNS: &[(&str, &str)] = &[
    ("executor", "the executor that ran the function"),
    ("language", "the language of the module that was called: WESL or GLSL"),
    ("inputs", "the number of inputs"),
    ("worst error", "the largest absolute error of all inputs"),
    (
        "ULP",
        "the error of the input that came nearest to its tolerance, in units in the last place",
    ),
    ("of allowed", "the error that the tolerance allows for that input, in the same units"),
    ("headroom", "the part of the tolerance that was left, which is negative under a waiver"),
    ("of driver", "the needed part of the error that is recorded for this driver"),
    ("ambiguous", "the share of inputs with a wrong result where rounding may change a comparison"),
    ("free", "the share of inputs without a requirement, since the expected value is not finite"),
    ("parity ULP", "the largest difference from the results of the first language"),
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
