//! Lines of WGSL with their places, and facts beside them.

use crate::lexer::At;

/// A line, and what of the text it came from.
#[derive(Debug, Clone)]
pub(super) struct Line {
    text: String,
    at: At,
    depth: usize,
}

impl Line {
    pub(super) fn new(text: String, at: At) -> Self {
        Self { text, at, depth: 0 }
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }
}

/// Lines in order.
#[derive(Debug, Default, Clone)]
pub(super) struct Lines(Vec<Line>);

impl Lines {
    pub(super) fn push(&mut self, line: Line) {
        self.0.push(line);
    }

    pub(super) fn into_iter(self) -> impl Iterator<Item = Line> {
        self.0.into_iter()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn extend(&mut self, other: Self) {
        self.0.extend(other.0);
    }

    /// Adds lines one level deeper.
    pub(super) fn nest(&mut self, other: Self) {
        self.0.extend(other.0.into_iter().map(|line| Line { depth: line.depth + 1, ..line }));
    }

    /// Appends a comment to the last line, if there is one.
    pub(super) fn append(&mut self, comment: &str) -> bool {
        match self.0.last_mut() {
            Some(line) if !line.text.contains("//") => {
                line.text.push(' ');
                line.text.push_str(comment.trim_end());
                true
            }
            _ => false,
        }
    }

    /// Takes the only line, if there is one and it has no comment.
    pub(super) fn single(&self) -> Option<&str> {
        match self.0.as_slice() {
            [line] if !line.text.contains("//") => Some(&line.text),
            _ => None,
        }
    }
}

/// A run of output bytes that came from one place of the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Segment {
    /// The first byte of the output; the segment reaches to the next one's.
    pub start: u32,
    /// Where it came from; empty for text of the translator.
    pub at: At,
}

/// The text as it grows.
#[derive(Debug, Default)]
pub(super) struct Text {
    text: String,
    map: Vec<Segment>,
}

impl Text {
    pub(super) fn plain(&mut self, text: &str) {
        self.map.push(Segment { start: self.text.len() as u32, at: At::default() });
        self.text.push_str(text);
        self.text.push('\n');
    }

    /// A declaration after a blank line.
    pub(super) fn block(&mut self, text: &str) {
        if !self.text.is_empty() {
            self.text.push('\n');
        }
        self.plain(text);
    }

    pub(super) fn lines(&mut self, lines: &Lines) {
        let starts_block = lines.0.len() > 1;
        if starts_block && !self.text.is_empty() {
            self.text.push('\n');
        }
        for line in &lines.0 {
            self.map.push(Segment { start: self.text.len() as u32, at: line.at });
            if !line.text.is_empty() {
                self.text.extend(std::iter::repeat_n("    ", line.depth));
                self.text.push_str(&line.text);
            }
            self.text.push('\n');
        }
    }

    pub(super) fn finish(self) -> (String, Vec<Segment>) {
        (self.text, self.map)
    }
}

/// Where a resource is bound.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Resource {
    /// Its name in GLSL, with members and indices.
    pub name: String,
    /// Its name in WGSL.
    pub wgsl: String,
    /// `@group`
    pub group: u32,
    /// `@binding`
    pub binding: u32,
    /// `@binding` of the sampler that belongs to the texture.
    pub sampler: Option<u32>,
}

/// One thing that WGSL has no word for.
#[derive(Debug, Clone, PartialEq)]
pub enum Fact {
    /// An output of the language that is computed and dropped: its name.
    Dropped(String),
    /// A uniform's initial value, as numbers.
    Initial(String, Vec<f64>),
    /// Push constants are in this uniform block.
    PushConstant(String),
    /// An input attachment is this sampled texture.
    Attachment(String, u32),
    /// How `gl_FragDepth` is bounded.
    DepthMode(String),
    /// A location that the text leaves open: an input or output, and what it got.
    Location(String, u32),
    /// A binding that is not the text's: the resource, the text's number, and what it got.
    Binding(String, u32, u32),
}

/// Where a value enters or leaves the stage.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Slot {
    /// `@location`
    Location(u32),
    /// `@builtin`
    Builtin(String),
}

/// What the author calls a value that enters or leaves the stage.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InterfaceName {
    pub is_input: bool,
    pub slot: Slot,
    pub name: String,
}

/// What the author calls what the host sees.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct AuthorNames {
    /// Inputs and outputs.
    pub interface: Vec<InterfaceName>,
    /// Uniforms, buffers, textures and images.
    pub resources: Vec<Resource>,
}

/// The side table.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Facts {
    pub names: AuthorNames,
    /// What else there is, with the declarations.
    pub list: Vec<(Fact, At)>,
}

impl std::fmt::Display for Fact {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Dropped(name) => write!(out, "`{name}` is computed, and has no effect"),
            Self::Initial(name, numbers) => {
                let list: Vec<String> = numbers.iter().map(f64::to_string).collect();
                let list = list.join(", ");
                write!(out, "the host sets the uniform `{name}`, which begins with {list}")
            }
            Self::PushConstant(name) => {
                write!(out, "`{name}` was a push constant, and is a uniform block here")
            }
            Self::Attachment(name, index) => {
                write!(
                    out,
                    "`{name}` was the input attachment {index}: the host binds it as a texture"
                )
            }
            Self::DepthMode(mode) => write!(out, "`gl_FragDepth` was declared as `{mode}`"),
            Self::Location(name, location) => {
                write!(out, "`{name}` had no location, and has {location} here")
            }
            Self::Binding(name, wanted, found) => {
                write!(out, "`{name}` had the binding {wanted}, and has {found} here")
            }
        }
    }
}
