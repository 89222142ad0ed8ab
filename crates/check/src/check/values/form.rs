//! The text of a record: one JSON object a line, so that a version control system shows which
//! function changed.
//!
//! ```text
//! {"format":"lamplight-values","version":1,"tool":"0.1.0","library":"0.1.0","package":"app","cases":1}
//! {"case":"light::half","language":"wesl","signature":"(f32) -> f32","rows":1}
//! {"in":"3f800000","out":"3f000000","exact":[0.5],"allowed":[1e-7]}
//! ```
//!
//! Inputs and results are words in hexadecimal: the bits of `f32` values.

use std::fmt::Write as _;

use serde_json::{Map, Value};

use super::{RecordedCase, RecordedRow, ValueRecord};
use lamplight_bundle::Language;
use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, codes};

const FORMAT: &str = "lamplight-values";
/// The version of the form that is written, and the only one that is read.
const VERSION: u64 = 1;

/// The text of a record.
pub fn record_text(record: &ValueRecord) -> String {
    let ValueRecord { tool, library, package, cases } = record;
    let (tool, library) = (Value::from(tool.as_str()), Value::from(library.as_str()));
    let (package, count) = (Value::from(package.clone()), cases.len());
    let mut text = format!(
        "{{\"format\":\"{FORMAT}\",\"version\":{VERSION},\"tool\":{tool},\"library\":{library},\"package\":{package},\"cases\":{count}}}\n"
    );
    let mut sorted: Vec<&RecordedCase> = cases.iter().collect();
    sorted.sort_by(|a, b| case_order(a).cmp(&case_order(b)));
    for case in sorted {
        write_case(&mut text, case);
    }
    text
}

/// What cases are sorted by.
pub(super) fn case_order(case: &RecordedCase) -> (&str, &'static str) {
    (&case.name, case.language.name())
}

fn write_case(text: &mut String, case: &RecordedCase) {
    let RecordedCase { name, language, signature, fixtures, rows } = case;
    let (name, signature) = (Value::from(name.as_str()), Value::from(signature.as_str()));
    let fixtures = match fixtures.as_str() {
        "" => String::new(),
        hash => format!("\"fixtures\":\"{hash}\","),
    };
    let (language, count) = (language.name(), rows.len());
    let _ = writeln!(
        text,
        "{{\"case\":{name},\"language\":\"{language}\",\"signature\":{signature},{fixtures}\"rows\":{count}}}"
    );
    for RecordedRow { inputs, results, exact, allowed } in rows {
        let (inputs, results) = (words_text(inputs), words_text(results));
        let exact = match exact[..] {
            [] => String::new(),
            _ => format!("\"exact\":{exact:?},"),
        };
        let _ = writeln!(
            text,
            "{{\"in\":\"{inputs}\",\"out\":\"{results}\",{exact}\"allowed\":{allowed:?}}}"
        );
    }
}

fn words_text(words: &[u32]) -> String {
    words.iter().map(|word| format!("{word:08x}")).collect::<Vec<_>>().join(" ")
}

const LANGUAGES: [Language; 2] = [Language::Wesl, Language::Glsl];

/// Whether the first bytes of a file are those of a record.
pub fn is_record(head: &[u8]) -> bool {
    head.starts_with(format!("{{\"format\":\"{FORMAT}\"").as_bytes())
}

/// Reads a record.
///
/// # Errors
/// `record-syntax` with the line that is not as it was written.
pub fn parse_record(text: &str, id: SourceId) -> Result<ValueRecord, Diagnostic> {
    let mut lines = Lines { rest: text, id, start: 0, span: Span::new(id, 0..0) };
    let first = lines.next_object().ok().flatten();
    let header = first.filter(|found| found.get("format").and_then(Value::as_str) == Some(FORMAT));
    let Some(header) = header else {
        let error = lines.wrong("this is not a record of values");
        return Err(error.note("`lamplight check --record FILE` writes one"));
    };
    check_version(&lines, &header)?;
    let mut record = ValueRecord {
        tool: lines.text_of(&header, "tool")?,
        library: lines.text_of(&header, "library")?,
        package: header.get("package").and_then(Value::as_str).map(str::to_owned),
        cases: Vec::new(),
    };
    let count = lines.count_of(&header, "cases")?;
    let header_span = lines.span;
    while let Some(line) = lines.next_object()? {
        let case = read_case(&mut lines, &line)?;
        record.cases.push(case);
    }
    if record.cases.len() as u64 != count {
        let found = record.cases.len();
        let message = format!("the record is incomplete: it has {found} of {count} cases");
        return Err(record_error(message).at(header_span, "counted here"));
    }
    Ok(record)
}

fn check_version(lines: &Lines<'_>, header: &Map<String, Value>) -> Result<(), Diagnostic> {
    let version = lines.count_of(header, "version")?;
    if version == VERSION {
        return Ok(());
    }
    let message = format!(
        "the record has format version {version}, but this program reads version {VERSION}"
    );
    Err(lines.wrong(&message).note("compare with the version of Lamplight that wrote it, or later"))
}

fn read_case(lines: &mut Lines<'_>, line: &Map<String, Value>) -> Result<RecordedCase, Diagnostic> {
    let word = lines.text_of(line, "language")?;
    let known = LANGUAGES.iter().find(|known| known.name() == word);
    let language = known.ok_or_else(|| lines.wrong("`language` is `wesl` or `glsl`"))?;
    let mut case = RecordedCase {
        name: lines.text_of(line, "case")?,
        language: *language,
        signature: lines.text_of(line, "signature")?,
        fixtures: line.get("fixtures").and_then(Value::as_str).unwrap_or_default().to_owned(),
        rows: Vec::new(),
    };
    let (count, span) = (lines.count_of(line, "rows")?, lines.span);
    for read in 0..count {
        let Some(row) = lines.next_object()? else {
            let message =
                format!("the record is incomplete: `{}` has {read} of {count} rows", case.name);
            return Err(record_error(message).at(span, "counted here"));
        };
        case.rows.push(read_row(lines, &row)?);
    }
    Ok(case)
}

fn read_row(lines: &Lines<'_>, row: &Map<String, Value>) -> Result<RecordedRow, Diagnostic> {
    let words = |key: &str| {
        let text = lines.text_of(row, key)?;
        let word = |word: &str| u32::from_str_radix(word, 16).ok();
        let words: Option<Vec<u32>> = text.split_whitespace().map(word).collect();
        words.ok_or_else(|| lines.wrong(&format!("`{key}` has words in hexadecimal")))
    };
    let numbers = |key: &str| {
        let listed = row.get(key).and_then(Value::as_array).into_iter().flatten();
        let numbers: Option<Vec<f64>> = listed.map(Value::as_f64).collect();
        numbers.ok_or_else(|| lines.wrong(&format!("`{key}` has numbers")))
    };
    let row = RecordedRow {
        inputs: words("in")?,
        results: words("out")?,
        exact: numbers("exact")?,
        allowed: numbers("allowed")?,
    };
    if row.allowed.len() != row.results.len() {
        return Err(lines.wrong("`allowed` has one number for each word of `out`"));
    }
    Ok(row)
}

fn record_error(message: String) -> Diagnostic {
    Diagnostic::error(codes::RECORD_SYNTAX, message)
}

/// The lines of a record, with the place of the last one.
struct Lines<'t> {
    rest: &'t str,
    id: SourceId,
    start: usize,
    span: Span,
}

impl Lines<'_> {
    fn wrong(&self, message: &str) -> Diagnostic {
        record_error(message.to_owned()).at(self.span, "in this line")
    }

    /// The next line, if there is one.
    fn next_object(&mut self) -> Result<Option<Map<String, Value>>, Diagnostic> {
        let Some(line) = self.rest.split_inclusive('\n').next() else { return Ok(None) };
        self.rest = &self.rest[line.len()..];
        self.span = Span::new(self.id, self.start..self.start + line.trim_end().len());
        self.start += line.len();
        match serde_json::from_str(line) {
            Ok(Value::Object(object)) => Ok(Some(object)),
            _ => Err(self.wrong("expected one JSON object in each line")),
        }
    }

    fn text_of(&self, object: &Map<String, Value>, key: &str) -> Result<String, Diagnostic> {
        let found = object.get(key).and_then(Value::as_str).map(str::to_owned);
        found.ok_or_else(|| self.wrong(&format!("expected a text `{key}`")))
    }

    fn count_of(&self, object: &Map<String, Value>, key: &str) -> Result<u64, Diagnostic> {
        let found = object.get(key).and_then(Value::as_u64);
        found.ok_or_else(|| self.wrong(&format!("expected a number `{key}`")))
    }
}
