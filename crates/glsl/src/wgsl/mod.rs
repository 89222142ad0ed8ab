//! The translator: a typed tree to readable WGSL, with a source map and what WGSL has no word for.

mod bound;
mod builtin;
mod call;
mod constant;
mod depth;
mod entry;
mod expr;
mod flow;
mod globals;
mod helpers;
mod layout;
mod matrix;
mod memory;
mod names;
mod output;
mod path;
mod stmt;
mod texture;
mod uniforms;
mod value;

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use rustc_hash::{FxHashMap, FxHashSet};

use crate::lexer::At;
use crate::program::Numbers;
use crate::tree::{Item, Op, Place, Shader, Stage};
use crate::types::Type;
use memory::Mem;
pub use output::{AuthorNames, Fact, Facts, InterfaceName, Resource, Segment, Slot};
use output::{Line, Lines};

/// How to translate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// What `gl_Position` is converted from.
    pub clip: Clip,
    /// Whether WGSL's rule for derivatives stays on. GLSL has no such rule, so otherwise a text with
    /// derivatives turns it off.
    pub keeps_rule: bool,
}

/// The clip space of the source, if it is to be converted to WebGPU's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Clip {
    /// The position stays as it is written.
    #[default]
    Kept,
    /// From OpenGL's, whose depth is from -1 to 1.
    OpenGl,
    /// From Vulkan's, whose second coordinate points down.
    Vulkan,
}

/// A translated text.
#[derive(Debug)]
pub struct Written {
    /// The WGSL.
    pub text: String,
    /// Which bytes came from where, in order.
    pub map: Vec<Segment>,
    /// What WGSL has no word for.
    pub facts: Facts,
}

/// Writes a checked shader as WGSL.
///
/// # Errors
/// What has no counterpart in WGSL, each with its place in `source`.
pub fn write(
    shader: &Shader,
    text: &str,
    comments: &[At],
    source: SourceId,
    options: Options,
) -> Result<Written, Diagnostics> {
    let mut writer = Writer::new(shader, text, comments, source, options);
    writer.name_all();
    writer.plan_comparisons();
    writer.plan_globals();
    writer.plan_entry();
    writer.plan_discards();
    let mut bodies: Vec<Lines> = Vec::new();
    for item in &shader.order {
        let lines = writer.item(*item);
        bodies.push(lines);
    }
    let finished = writer.finish(bodies);
    if writer.problems.is_empty() { Ok(finished) } else { Err(writer.problems) }
}

pub(crate) struct Writer<'s> {
    shader: &'s Shader,
    source_text: &'s str,
    comments: &'s [At],
    next_comment: usize,
    source: SourceId,
    options: Options,
    problems: Diagnostics,
    facts: Facts,
    /// Names of the module's scope.
    globals: FxHashSet<String>,
    var_names: FxHashMap<u32, String>,
    struct_names: Vec<String>,
    /// Names of members, by structure.
    member_names: Vec<Vec<String>>,
    function_names: Vec<String>,
    /// Names that are visible in the function that is written, by scope.
    scopes: Vec<FxHashSet<String>>,
    /// Every name of the GLSL text, which names of ours avoid.
    taken: FxHashSet<String>,
    /// Lines of the block that is written.
    lines: Lines,
    temporaries: u32,
    helpers: BTreeMap<String, String>,
    /// Stored forms of variables in memory.
    memory: FxHashMap<u32, std::rc::Rc<Mem>>,
    /// Structures in memory, by structure and rules.
    stored: memory::Stored,
    /// Textures and samplers by variable and path.
    opaque: BTreeMap<(u32, Vec<u32>), globals::OpaqueNames>,
    /// The numbers of the program that the text belongs to.
    numbers: Numbers,
    /// Arrays of bindings, with their sizes.
    bound_arrays: BTreeMap<u32, Option<u32>>,
    /// Texts of declarations of resources, by variable.
    declarations: FxHashMap<u32, Vec<String>>,
    /// Declarations before all others.
    preamble: Vec<String>,
    entry: entry::Plan,
    /// What is compared with.
    compared: depth::Compared,
    /// Variables whose memory is atomic, with the member.
    atomics: BTreeSet<(u32, Option<u32>)>,
    /// The function that is written.
    function: Option<u32>,
    /// Parameters that are copied into a variable, with their names in the head.
    copied: FxHashMap<u32, String>,
    /// Variables that must be declared as `var` before a `switch` and only assigned in it.
    hoisted: FxHashSet<u32>,
    /// Whether every literal gets a suffix.
    suffixed: bool,
    /// Whether derivatives are taken anywhere.
    derivatives: bool,
    clip_distances: bool,
    /// The variable that says that a function other than `main` met a `discard`.
    discarded: Option<String>,
}

impl<'s> Writer<'s> {
    fn new(
        shader: &'s Shader,
        text: &'s str,
        comments: &'s [At],
        source: SourceId,
        options: Options,
    ) -> Self {
        Self {
            shader,
            source_text: text,
            comments,
            next_comment: 0,
            source,
            options,
            problems: Vec::new(),
            facts: Facts::default(),
            globals: FxHashSet::default(),
            var_names: FxHashMap::default(),
            struct_names: Vec::new(),
            member_names: Vec::new(),
            function_names: Vec::new(),
            scopes: Vec::new(),
            taken: FxHashSet::default(),
            lines: Lines::default(),
            temporaries: 0,
            helpers: BTreeMap::new(),
            memory: FxHashMap::default(),
            stored: memory::Stored::default(),
            opaque: BTreeMap::new(),
            numbers: Numbers::of(text),
            bound_arrays: BTreeMap::new(),
            declarations: FxHashMap::default(),
            preamble: Vec::new(),
            entry: entry::Plan::default(),
            compared: depth::Compared::default(),
            atomics: BTreeSet::new(),
            function: None,
            copied: FxHashMap::default(),
            hoisted: FxHashSet::default(),
            suffixed: false,
            derivatives: false,
            clip_distances: false,
            discarded: None,
        }
    }

    /// Reports what has no counterpart.
    fn refuse(&mut self, at: At, message: impl Into<String>) {
        if self.problems.len() < 100 {
            let span = Span::new(self.source, at.range());
            self.problems
                .push(Diagnostic::error(codes::GLSL_NOT_TRANSLATED, message).at(span, "here"));
        }
    }

    fn var(&self, index: u32) -> &'s crate::tree::Var {
        &self.shader.vars[index as usize]
    }

    /// One declaration of the text.
    fn item(&mut self, item: Item) -> Lines {
        self.lines = Lines::default();
        match item {
            Item::Struct(index) => self.structure(index),
            Item::Var(index) => self.global(index),
            Item::Function(index) => self.function(index),
        }
        std::mem::take(&mut self.lines)
    }

    /// Comments of the text before a place.
    fn flush_comments(&mut self, before: u32) {
        while let Some(comment) = self.comments.get(self.next_comment) {
            if comment.start >= before {
                return;
            }
            self.next_comment += 1;
            let text = &self.source_text[comment.range()];
            let behind = self.source_text[..comment.start as usize].rsplit('\n').next();
            let trailing = behind.is_some_and(|line| !line.trim().is_empty());
            let text = comment_text(text);
            let one_line = !text.contains('\n');
            if trailing && one_line && text.starts_with("//") && self.lines.append(&text) {
                continue;
            }
            for line in text.lines() {
                self.lines.push(Line::new(line.trim().to_owned(), *comment));
            }
        }
    }

    /// Adds a line.
    fn line(&mut self, at: At, text: impl Into<String>) {
        self.lines.push(Line::new(text.into(), at));
    }

    /// Runs a part of the translation with its own lines.
    fn capture<T>(&mut self, run: impl FnOnce(&mut Self) -> T) -> (T, Lines) {
        let before = std::mem::take(&mut self.lines);
        let result = run(self);
        let lines = std::mem::replace(&mut self.lines, before);
        (result, lines)
    }

    /// A name for a value of ours.
    fn temporary(&mut self) -> String {
        loop {
            self.temporaries += 1;
            let name = format!("t{}", self.temporaries);
            if !self.taken.contains(&name) && !self.globals.contains(&name) {
                return name;
            }
        }
    }

    /// Whether the stage may take derivatives.
    fn is_fragment(&self) -> bool {
        self.shader.stage == Stage::Fragment
    }

    fn place(&self, index: u32) -> Place {
        self.var(index).place
    }

    /// Declares what a text needs before everything else, and puts the pieces together.
    fn finish(&mut self, bodies: Vec<Lines>) -> Written {
        let mut out = output::Text::default();
        if self.clip_distances {
            out.plain("enable clip_distances;");
        }
        if !self.bound_arrays.is_empty() {
            out.plain("enable wgpu_binding_array;");
        }
        if self.derivatives && !self.options.keeps_rule {
            out.plain("diagnostic(off, derivative_uniformity);");
        }
        let preamble = std::mem::take(&mut self.preamble);
        preamble.iter().for_each(|text| out.block(text));
        bodies.iter().for_each(|lines| out.lines(lines));
        let stored = self.stored.declarations();
        stored.iter().for_each(|text| out.block(text));
        let helpers = std::mem::take(&mut self.helpers);
        helpers.values().for_each(|text| out.block(text));
        let (text, map) = out.finish();
        Written { text, map, facts: std::mem::take(&mut self.facts) }
    }

    /// The name of a type for values.
    fn type_text(&self, ty: &Type) -> String {
        names::value_type(ty, &self.struct_names)
    }

    /// The operator of a compound assignment that WGSL has for these types.
    fn direct_operator(op: Op) -> Option<&'static str> {
        Some(match op {
            Op::Add => "+=",
            Op::Sub => "-=",
            Op::Mul => "*=",
            Op::Div => "/=",
            Op::Mod => "%=",
            Op::And => "&=",
            Op::Or => "|=",
            Op::Xor => "^=",
            _ => return None,
        })
    }
}

/// What ends a line in WGSL, and with it a comment.
const BREAKS: [char; 7] = ['\n', '\u{b}', '\u{c}', '\r', '\u{85}', '\u{2028}', '\u{2029}'];

/// A comment as WGSL reads it. Block comments nest there, a backslash does not join two lines, and
/// other characters end a line too.
fn comment_text(comment: &str) -> Cow<'_, str> {
    match comment.strip_prefix("/*") {
        Some(inside) if inside.contains("/*") => {
            Cow::Owned(format!("/*{}", inside.replace("/*", "/ *")))
        }
        None if comment.contains(BREAKS) => Cow::Owned(comment.replace(BREAKS, "\n// ")),
        Some(_) | None => Cow::Borrowed(comment),
    }
}

#[cfg(test)]
mod tests {
    use super::comment_text;

    #[test]
    fn comments_end_where_they_ended() {
        assert_eq!(comment_text("/* a */"), "/* a */");
        assert_eq!(comment_text("/* a /* b */"), "/* a / * b */");
        assert_eq!(comment_text("/*/ a /*/"), "/*/ a / */");
        assert_eq!(comment_text("// a"), "// a");
        assert_eq!(comment_text("// a \\\nb"), "// a \\\n// b");
        assert_eq!(comment_text("// a\u{2028}b"), "// a\n// b");
    }
}
