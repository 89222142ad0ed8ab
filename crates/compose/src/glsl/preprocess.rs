//! Runs the directives of the root file and of the files that it includes, for given settings.

mod branch;

use std::collections::HashSet;
use std::ops::Range;

use super::expand::{Expander, Fatal, TokenInput, same_definition};
use super::reads::Reads;
use super::table::{MacroMeaning, MacroTable, Spellings};
use super::token::Tok;
use crate::Decision;
use crate::resolve::glsl::{Graph, IncludeTarget};
use lamplight_diagnostic::source::{LIMITS, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_files::limits::count_steps;
use lamplight_permute::Settings;
use lamplight_syntax::glsl::{Directive, FilePart, Macro, Module};

/// The active text of a composition, macros expanded.
pub struct Preprocessed<'g, 's> {
    /// In the order of inclusion.
    pub tokens: Vec<Tok>,
    /// The `#version` line; `None` where the author gave none.
    pub version: Option<Span>,
    /// `#extension` and `#pragma` lines, each once.
    pub header: Vec<Span>,
    pub reads: Reads<'s>,
    pub spellings: Spellings<'g>,
    pub decisions: Vec<Decision>,
    pub warnings: Vec<Diagnostic>,
}

/// Preprocesses the root of a graph. If anything is wrong, the result is all errors that were
/// found.
///
/// `tokens` is memory to use again for the active text.
pub fn preprocess<'g, 's>(
    graph: &'g Graph,
    settings: &'s Settings,
    mut tokens: Vec<Tok>,
) -> Result<Preprocessed<'g, 's>, Diagnostics> {
    tokens.clear();
    let (number, es) = version_and_profile(&graph.modules[0]);
    let mut reads = Reads::new(settings);
    let mut table = MacroTable::new(&graph.symbols, number, es);
    reads.define(&mut table, settings);
    let mut state = PreprocessorState {
        graph,
        expander: Expander::new(graph, table, reads, es),
        // The last one is read first.
        open: [graph.ending, Some(0), graph.definitions]
            .into_iter()
            .flatten()
            .map(OpenFile::start)
            .collect(),
        once: vec![false; graph.modules.len()],
        tokens,
        version: None,
        header: Vec::new(),
        headers: HashSet::new(),
        decisions: Vec::new(),
        warnings: Vec::new(),
    };
    state.check_module(0);
    state.run();
    let PreprocessorState { expander, tokens, version, header, decisions, warnings, .. } = state;
    let Expander { errors, reads, table, .. } = expander;
    if errors.is_empty() {
        let spellings = table.spellings;
        Ok(Preprocessed { tokens, version, header, reads, spellings, decisions, warnings })
    } else {
        Err(errors)
    }
}

/// Version and profile of the root file; 450 where it names none.
fn version_and_profile(root: &Module) -> (u32, bool) {
    match root.parts.first() {
        Some(FilePart::Directive(Directive::Version { number, es, .. }, _)) => (*number, *es),
        _ => (450, false),
    }
}

struct PreprocessorState<'g, 's> {
    graph: &'g Graph,
    expander: Expander<'g, 's>,
    /// The files that are being read, each included by the one before it.
    open: Vec<OpenFile>,
    once: Vec<bool>,
    tokens: Vec<Tok>,
    version: Option<Span>,
    header: Vec<Span>,
    /// The text of each line in `header`.
    headers: HashSet<&'g str>,
    decisions: Vec<Decision>,
    warnings: Vec<Diagnostic>,
}

#[derive(Clone, Copy)]
struct OpenFile {
    module: usize,
    /// The next part to read.
    part: usize,
    line_shift: i64,
    file_number: i64,
    /// The `#include` that opened it.
    directive: Option<Span>,
}

impl OpenFile {
    /// A file that nothing includes.
    fn start(module: usize) -> Self {
        Self { module, part: 0, line_shift: 0, file_number: 0, directive: None }
    }
}

impl<'g> PreprocessorState<'g, '_> {
    fn run(&mut self) {
        while let Some(open) = self.open.last_mut() {
            let Some(part) = self.graph.modules[open.module].parts.get(open.part) else {
                self.open.pop();
                continue;
            };
            open.part += 1;
            let open = *open;
            (self.expander.line_shift, self.expander.file_number) =
                (open.line_shift, open.file_number);
            let before = self.expander.errors.len();
            let chain = self.open.len();
            let result = self.part(open, part);
            let fatal = result.is_err();
            self.expander.errors.extend(result.err().map(|error| *error));
            self.add_chain(before, chain);
            if fatal {
                return;
            }
        }
    }

    /// Adds to new errors the chain of includes that led to their file.
    fn add_chain(&mut self, before: usize, chain: usize) {
        for error in &mut self.expander.errors[before..] {
            for pair in self.open[..chain.min(self.open.len())].windows(2).rev() {
                if let Some(directive) = pair[1].directive {
                    let line = self.graph.modules[pair[0].module].line(directive.start);
                    let note = format!("included from {}:{line}", self.graph.paths[pair[0].module]);
                    // In a cycle of includes the same places repeat.
                    if !error.notes.contains(&note) {
                        error.notes.push(note);
                    }
                }
            }
        }
    }

    fn part(&mut self, open: OpenFile, part: &'g FilePart) -> Result<(), Fatal> {
        count_steps(1);
        match part {
            FilePart::Text(text) => {
                let input = TokenInput::Source {
                    module: open.module as u32,
                    at: text.tokens.start,
                    end: text.tokens.end,
                };
                self.expander.run(input, &mut self.tokens)
            }
            FilePart::Directive(directive, span) => self.directive(open, directive, *span),
        }
    }

    fn directive(
        &mut self,
        open: OpenFile,
        directive: &'g Directive,
        span: Span,
    ) -> Result<(), Fatal> {
        match directive {
            Directive::Include(index) => return self.include(open, *index, span),
            Directive::Define(definition) => self.define(definition),
            Directive::Undef(name) => self.expander.table.unset(*name),
            Directive::If { .. } | Directive::Ifdef { .. } => {
                return self.choose(open.module, open.part - 1);
            }
            // Reached at the end of the branch that was taken: the other branches are skipped.
            Directive::Elif { end, .. } | Directive::Else { end } => self.jump(*end),
            Directive::Endif | Directive::Empty => {}
            Directive::Error(words) => self.author_error(*words, span),
            Directive::Line(tokens) => return self.line(open, tokens.clone(), span),
            Directive::Version { line, .. } => self.version(open, *line),
            Directive::Extension { name, line } => {
                let name = self.graph.symbols.text(*name);
                // Includes are resolved, so the output does not need the extensions for them.
                if name != "GL_GOOGLE_include_directive"
                    && name != "GL_ARB_shading_language_include"
                {
                    self.add_header(open, *line);
                }
            }
            Directive::PragmaOnce => self.once[open.module] = true,
            Directive::Pragma(line) => self.add_header(open, *line),
            Directive::Invalid(error) => self.expander.errors.push((**error).clone()),
        }
        Ok(())
    }

    fn jump(&mut self, part: usize) {
        if let Some(open) = self.open.last_mut() {
            open.part = part;
        }
    }

    fn define(&mut self, definition: &'g Macro) {
        let name = self.graph.symbols.text(definition.name);
        let error = match self.expander.table.get(definition.name) {
            None => None,
            Some(MacroMeaning::User { definition: earlier, .. })
                if same_definition(earlier, definition) =>
            {
                return;
            }
            Some(MacroMeaning::User { definition: earlier, .. }) => {
                let error = Diagnostic::error(
                    codes::MACRO_REDEFINED,
                    format!("the macro `{name}` is defined twice, differently"),
                );
                Some(
                    error
                        .at(definition.name_span, "defined again here")
                        .at(earlier.name_span, "defined first here"),
                )
            }
            Some(_) => {
                let message = format!("the macro `{name}` is defined by the composition already");
                let error = Diagnostic::error(codes::MACRO_REDEFINED, message)
                    .at(definition.name_span, "defined again here");
                return self.expander.errors.push(error);
            }
        };
        self.expander.errors.extend(error);
        self.expander.table.set(definition.name, MacroMeaning::User { definition, active: false });
    }

    fn author_error(&mut self, words: Span, directive: Span) {
        let text =
            &self.graph.modules[self.open.last().map_or(0, |open| open.module)].text[words.range()];
        let text = if words.end == directive.end && words.start > directive.start + 6 {
            text
        } else {
            "an `#error` without a message"
        };
        self.expander
            .errors
            .push(Diagnostic::error(codes::ERROR_DIRECTIVE, text).at(directive, "refused here"));
    }

    fn version(&mut self, open: OpenFile, line: Span) {
        let error = Diagnostic::error(
            codes::MISPLACED_VERSION,
            "`#version` must be the first line of the root file",
        );
        match self.version {
            Some(first) => {
                let error = error.at(line, "a second one").at(first, "the first one");
                self.expander.errors.push(error.note("help: leave this one out"));
            }
            // `open.part` already points behind this directive, so 1 means the first part of the
            // file.
            None if open.module == 0 && open.part == 1 && self.open.len() == 1 => {
                self.version = Some(line)
            }
            None => self.expander.errors.push(error.at(line, "not the first line")),
        }
    }

    fn add_header(&mut self, open: OpenFile, line: Span) {
        if self.headers.insert(&self.graph.modules[open.module].text[line.range()]) {
            self.header.push(line);
        }
    }

    /// `#line N` or `#line N FILE`: sets `__LINE__` and `__FILE__` from the next line on.
    fn line(&mut self, open: OpenFile, tokens: Range<u32>, span: Span) -> Result<(), Fatal> {
        let mut expanded = Vec::new();
        self.expander.run(
            TokenInput::Source { module: open.module as u32, at: tokens.start, end: tokens.end },
            &mut expanded,
        )?;
        let numbers: Option<Vec<i64>> = expanded
            .iter()
            .map(|token| {
                self.expander.table.spellings.text(token.symbol).parse::<u32>().ok().map(i64::from)
            })
            .collect();
        let numbers = numbers.as_deref().filter(|numbers| numbers.len() <= 2);
        let (Some([line, file @ ..]), Some(frame)) = (numbers, self.open.last_mut()) else {
            let error = Diagnostic::error(codes::MALFORMED_DIRECTIVE, "`#line` needs a number");
            self.expander
                .errors
                .push(error.at(span, "expected `#line NUMBER` or `#line NUMBER FILE`"));
            return Ok(());
        };
        frame.line_shift = line - 1 - self.graph.modules[open.module].line(span.start) as i64;
        frame.file_number = file.first().copied().unwrap_or(frame.file_number);
        Ok(())
    }

    fn include(&mut self, open: OpenFile, index: usize, span: Span) -> Result<(), Fatal> {
        let module = match &self.graph.targets[open.module][index] {
            IncludeTarget::Module(module) => *module,
            IncludeTarget::Missing(error) => {
                self.expander.errors.push((**error).clone());
                return Ok(());
            }
        };
        if self.once[module] {
            return Ok(());
        }
        let place = self.graph.modules[open.module].includes[index].span;
        if self.open.len() >= LIMITS.include_depth {
            return Err(Box::new(self.too_deep(module, place)));
        }
        self.expander.spend(0, self.graph.modules[module].text.len() + 1, place)?;
        self.open.push(OpenFile {
            module,
            part: 0,
            line_shift: 0,
            file_number: open.file_number,
            directive: Some(span),
        });
        self.check_module(module);
        Ok(())
    }

    /// A file that cannot be parsed is not read any further. Its errors are reported once.
    fn check_module(&mut self, module: usize) {
        let errors = &self.graph.modules[module].errors;
        if errors.is_empty() {
            return;
        }
        let before = self.expander.errors.len();
        self.expander.errors.extend(errors.iter().cloned());
        self.add_chain(before, self.open.len());
        self.once[module] = true;
        self.open.pop();
    }

    fn too_deep(&self, module: usize, place: Span) -> Diagnostic {
        let Some(start) = self.open.iter().rposition(|open| open.module == module) else {
            let message = format!("includes nest deeper than {}", LIMITS.include_depth);
            return Diagnostic::error(codes::INCLUDE_TOO_DEEP, message).at(place, "one too many");
        };
        let chain = self.open[start..].iter().map(|open| open.module).chain([module]);
        let names: Vec<String> =
            chain.map(|module| format!("`{}`", self.graph.paths[module])).collect();
        Diagnostic::error(
            codes::INCLUDE_CYCLE,
            format!("files include each other in a cycle: {}", names.join(" -> ")),
        )
        .at(place, "closes the cycle")
        .note("help: give the file an include guard or `#pragma once`")
    }
}
