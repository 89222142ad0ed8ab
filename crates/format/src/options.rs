//! What a formatted text looks like: the options of the formatter, and the table of a manifest
//! that has them.

use std::path::Path;

use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What one level of indentation is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Indent {
    /// So many spaces.
    Spaces(u8),
    /// One tab, which counts as four columns of the width.
    Tab,
}

impl Indent {
    /// Columns of one level.
    pub(crate) fn columns(self) -> usize {
        match self {
            Self::Spaces(count) => count.into(),
            Self::Tab => 4,
        }
    }
}

/// Where the brace stands that opens a block.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Braces {
    /// Where its author put it: behind its header, or in a line of its own.
    #[default]
    Keep,
    /// Behind its header.
    SameLine,
    /// In a line of its own, as `else` is.
    NextLine,
}

/// Where lines of the preprocessor, or conditions such as `@if(FOG)`, begin.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Margin {
    /// In column 0 if their author put them there, and with the code around them otherwise.
    #[default]
    Keep,
    /// In column 0.
    Start,
    /// With the code around them.
    Indented,
}

/// The line breaks of a formatted text.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LineEnds {
    /// Those of most lines of the text.
    #[default]
    Keep,
    /// Line feeds.
    Unix,
    /// Carriage returns with line feeds.
    Windows,
}

/// What a formatted text looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// The most columns of a line, where it can be broken.
    pub width: usize,
    /// What one level of indentation is.
    pub indent: Indent,
    /// Where the brace stands that opens a block.
    pub braces: Braces,
    /// Where lines of the preprocessor begin.
    pub directives: Margin,
    /// Where conditions of WESL begin.
    pub conditions: Margin,
    /// The line breaks.
    pub line_ends: LineEnds,
    /// Whether the last line ends with a line break; otherwise that is kept.
    pub final_newline: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            width: 100,
            indent: Indent::Spaces(4),
            braces: Braces::default(),
            directives: Margin::default(),
            conditions: Margin::default(),
            line_ends: LineEnds::default(),
            final_newline: true,
        }
    }
}

/// The name of the table in a manifest.
pub const TABLE: &str = "format";

/// The least and the most columns of a line.
const WIDTHS: std::ops::RangeInclusive<i64> = 20..=1000;
/// The most spaces of one level.
const SPACES: std::ops::RangeInclusive<i64> = 0..=16;

const BRACES: [(&str, Braces); 3] =
    [("keep", Braces::Keep), ("same_line", Braces::SameLine), ("next_line", Braces::NextLine)];
const MARGINS: [(&str, Margin); 3] =
    [("keep", Margin::Keep), ("start", Margin::Start), ("indented", Margin::Indented)];
const LINE_ENDS: [(&str, LineEnds); 3] =
    [("keep", LineEnds::Keep), ("unix", LineEnds::Unix), ("windows", LineEnds::Windows)];

/// Manifests that may have the table. The first one has precedence.
const MANIFESTS: [&str; 2] = ["lamplight.toml", "wesl.toml"];

/// The options for a file: those of the nearest manifest in its folder or above that has a table
/// `[format]`, and `base` for keys that it does not have. `read` reads a manifest, if it is there.
///
/// # Errors
/// Those of [`read_options`].
pub fn options_for(
    file: &Path,
    base: Options,
    sources: &mut SourceSet,
    read: impl Fn(&Path) -> Option<String>,
) -> Result<Options, Diagnostics> {
    let folders = file.ancestors().skip(1);
    let places = folders.flat_map(|folder| MANIFESTS.map(|name| folder.join(name)));
    for place in places {
        let Some(text) = read(&place) else { continue };
        let id = sources.add(place.display().to_string(), text);
        let text = sources.get(id).text.to_string();
        if let Some(options) = read_options(&text, id, base)? {
            return Ok(options);
        }
    }
    Ok(base)
}

/// Reads the table `[format]` of a manifest; `base` has the values of keys that it does not have.
///
/// | key | values | default |
/// |---|---|---|
/// | `width` | 20 to 1000 | 100 |
/// | `indent` | 0 to 16 spaces, or `"tab"` | 4 |
/// | `braces` | `"keep"`, `"same_line"`, `"next_line"` | `"keep"` |
/// | `directives`, `conditions` | `"keep"`, `"start"`, `"indented"` | `"keep"` |
/// | `line_ends` | `"keep"`, `"unix"`, `"windows"` | `"keep"` |
/// | `final_newline` | `true`, `false` | `true` |
///
/// # Errors
/// For a text that is not TOML, and for keys and values that are not in this table.
pub fn read_options(
    text: &str,
    source: SourceId,
    base: Options,
) -> Result<Option<Options>, Diagnostics> {
    let document =
        DeTable::parse(text).map_err(|error| vec![syntax_error(&error, source, text.len())])?;
    let Some(found) = document.get_ref().get(TABLE) else { return Ok(None) };
    let table = Place { source, key: TABLE, value: found };
    let DeValue::Table(entries) = found.get_ref() else {
        return Err(vec![table.wrong("a table")]);
    };
    let (mut options, mut errors) = (base, Vec::new());
    for (key, value) in entries {
        let place = Place { source, key: key.get_ref(), value };
        errors.extend(read_entry(&mut options, &place, key.span()).err());
    }
    if errors.is_empty() { Ok(Some(options)) } else { Err(errors) }
}

fn syntax_error(error: &toml::de::Error, source: SourceId, length: usize) -> Diagnostic {
    let range = error.span().unwrap_or(0..0);
    let span = Span::new(source, range.start.min(length)..range.end.min(length));
    let message = error.message().lines().collect::<Vec<_>>().join("; ");
    Diagnostic::error(codes::MANIFEST_SYNTAX, message).at(span, "")
}

const KEYS: [&str; 7] =
    ["width", "indent", "braces", "directives", "conditions", "line_ends", "final_newline"];

fn read_entry(
    options: &mut Options,
    place: &Place<'_>,
    key: std::ops::Range<usize>,
) -> Result<(), Diagnostic> {
    match place.key {
        "width" => options.width = place.number(&WIDTHS)?,
        "indent" => options.indent = place.indent()?,
        "braces" => options.braces = place.choice(&BRACES)?,
        "directives" => options.directives = place.choice(&MARGINS)?,
        "conditions" => options.conditions = place.choice(&MARGINS)?,
        "line_ends" => options.line_ends = place.choice(&LINE_ENDS)?,
        "final_newline" => options.final_newline = place.truth()?,
        name => {
            let message = format!("`[{TABLE}]` has no key `{name}`");
            let error = Diagnostic::error(codes::UNKNOWN_KEY, message)
                .at(Span::new(place.source, key), "unknown key");
            return Err(error.suggest(name, KEYS));
        }
    }
    Ok(())
}

/// A value of the table.
struct Place<'t> {
    source: SourceId,
    key: &'t str,
    value: &'t Spanned<DeValue<'t>>,
}

impl Place<'_> {
    fn wrong(&self, expected: &str) -> Diagnostic {
        Diagnostic::error(codes::WRONG_TYPE, format!("`{}` must be {expected}", self.key))
            .at(Span::new(self.source, self.value.span()), "this value")
    }

    fn number(&self, range: &std::ops::RangeInclusive<i64>) -> Result<usize, Diagnostic> {
        let number = match self.value.get_ref() {
            DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix()).ok(),
            _ => None,
        };
        let found = number.filter(|number| range.contains(number));
        found.and_then(|number| usize::try_from(number).ok()).ok_or_else(|| {
            self.wrong(&format!("an integer from {} to {}", range.start(), range.end()))
        })
    }

    fn indent(&self) -> Result<Indent, Diagnostic> {
        if self.value.get_ref().as_str() == Some("tab") {
            return Ok(Indent::Tab);
        }
        let count = self.number(&SPACES).ok().and_then(|count| u8::try_from(count).ok());
        count.map(Indent::Spaces).ok_or_else(|| {
            self.wrong(&format!("`\"tab\"`, or {} to {} spaces", SPACES.start(), SPACES.end()))
        })
    }

    fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Result<T, Diagnostic> {
        let word = self.value.get_ref().as_str();
        let found = choices.iter().find(|(name, _)| Some(*name) == word);
        found.map(|(_, choice)| *choice).ok_or_else(|| {
            let names: Vec<String> =
                choices.iter().map(|(name, _)| format!("`\"{name}\"`")).collect();
            self.wrong(&format!("one of {}", names.join(", ")))
        })
    }

    fn truth(&self) -> Result<bool, Diagnostic> {
        self.value.get_ref().as_bool().ok_or_else(|| self.wrong("`true` or `false`"))
    }
}
