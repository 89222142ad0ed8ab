//! Writes lists of units as WESL, with the comments and the layout that they had.

use std::collections::BTreeMap;

use super::condition::{self, ShaderDefTest};
use super::import::import_statements;
use super::level::UnitKind;
use super::names::FolderModules;
use super::scan::trivia_length;
use super::tree::{ByteRange, Conditional, DirectiveLine, ImportDirective, Scanned};
use super::unit::{self, Choice, Element, UnitPart, explicit_conditions};
use super::uses;
use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_files::limits;

/// The text of a file in WESL. The error is why there is none.
pub fn write_file(
    text: &str,
    source: SourceId,
    found: &Scanned,
    modules: &FolderModules,
) -> Result<String, Diagnostic> {
    let wrong = |message: &str, place: ByteRange| {
        Diagnostic::error(codes::NOT_MIGRATED, message.to_owned())
            .at(Span::new(source, place), "this file stays as it is")
    };
    let elements = unit::read_elements(text, &found.nodes).map_err(|(at, intricate)| {
        let message = match intricate {
            true => "conditions cut through declarations in too many ways",
            false => "what starts here cannot be understood",
        };
        wrong(message, at..(at + 1).min(text.len()))
    })?;
    let replaced = uses::replaced_tokens(text, found, modules)
        .map_err(|(message, place)| wrong(&message, place))?;
    let mut writer = Writer {
        text,
        modules,
        out: String::with_capacity(text.len() * 2),
        replaced,
        comma: None,
        line_due: false,
        imports_at: None,
        declared: false,
        wrong: None,
    };
    writer.list(UnitKind::Declarations, &elements, &[]);
    writer.out.push_str(&text[found.tail.clone()]);
    writer.late(found);
    match writer.wrong {
        Some((message, place)) => Err(wrong(&message, place)),
        None if writer.out.len() > limits::FILE_BYTES => {
            Err(wrong("the file would be longer than a file may be", 0..0))
        }
        None => Ok(match text.starts_with('\n') {
            true => writer.out,
            false => writer.out.trim_start_matches('\n').to_owned(),
        }),
    }
}

struct Writer<'a> {
    text: &'a str,
    modules: &'a FolderModules,
    out: String,
    /// What stands instead of tokens, by their first byte.
    replaced: BTreeMap<usize, String>,
    /// Where a comma is missing if another unit of the list follows.
    comma: Option<usize>,
    /// What comes next stands on a line of its own.
    line_due: bool,
    /// Where imports from further below go.
    imports_at: Option<usize>,
    /// A declaration was written.
    declared: bool,
    wrong: Option<(String, ByteRange)>,
}

impl Writer<'_> {
    fn list(&mut self, level: UnitKind, elements: &[Element<'_>], around: &[ShaderDefTest]) {
        for element in elements {
            match element {
                Element::Unit(parts) => {
                    let before = (!around.is_empty())
                        .then(|| format!("@if({}) ", condition::joined_conditions(around)));
                    self.unit(level, parts, &before.unwrap_or_default());
                }
                Element::Import(import) => self.import(import, around),
                Element::Comment(line) => {
                    self.lead(&line.lead);
                    let words = &self.text[line.words.clone()];
                    self.out.push_str(&format!("{}// {words}", self.indent(line)));
                    self.rest_of(line);
                }
                Element::Gone(line) => self.gone(line),
                Element::Choice(chosen) => self.choice(level, chosen, around),
            }
        }
    }

    /// Writes blanks and comments.
    fn lead(&mut self, lead: &ByteRange) {
        let lead = &self.text[lead.clone()];
        let fresh = self.out.is_empty() || self.out.ends_with('\n');
        if std::mem::take(&mut self.line_due) && !lead.contains('\n') && !fresh {
            self.out.push('\n');
        }
        self.out.push_str(lead);
    }

    fn indent(&self, line: &DirectiveLine) -> String {
        self.text[line.range.start..line.words.start].to_owned()
    }

    /// Writes the comment behind a directive, and the line break.
    fn rest_of(&mut self, line: &DirectiveLine) {
        let rest = &self.text[line.words.end..line.range.end];
        if !rest.trim().is_empty() {
            self.out.push(' ');
            self.out.push_str(rest.trim());
        }
        self.out.push('\n');
    }

    /// Leaves out a directive, but writes its comment.
    fn gone(&mut self, line: &DirectiveLine) {
        self.lead(&line.lead);
        if !self.text[line.words.end..line.range.end].trim().is_empty() {
            self.out.push_str(self.indent(line).trim_start_matches('\n'));
            let before = self.out.len();
            self.rest_of(line);
            self.out.remove(before);
        }
    }

    fn unit(&mut self, level: UnitKind, parts: &[UnitPart<'_>], before: &str) {
        self.starts_declaration(level, parts);
        let mut behind = None;
        for (index, part) in parts.iter().enumerate() {
            match part {
                UnitPart::Token(token) => {
                    if let Some(end) = behind.replace(token.range.end) {
                        self.gap(end, token.lead.start);
                    }
                    if let Some(at) = self.comma.take().filter(|_| index == 0) {
                        self.out.insert(at, ',');
                    }
                    self.lead(&token.lead);
                    self.out.push_str(if index == 0 { before } else { "" });
                    match self.replaced.get(&token.range.start) {
                        Some(text) => self.out.push_str(text),
                        None => self.out.push_str(&self.text[token.range.clone()]),
                    }
                }
                UnitPart::List(level, elements) => {
                    self.comma = None;
                    self.list(*level, elements, &[]);
                    (self.comma, behind) = (None, None);
                }
            }
        }
        let last = parts.iter().rev().find_map(|part| match part {
            UnitPart::Token(token) => Some(&self.text[token.range.clone()]),
            UnitPart::List(..) => None,
        });
        self.comma = (level.has_commas() && last != Some(",")).then_some(self.out.len());
    }

    /// Writes the blanks and comments that stand between two tokens before a directive that was
    /// between them.
    fn gap(&mut self, end: usize, next: usize) {
        if end == next {
            return;
        }
        let rest = &self.text[end..];
        let blank = trivia_length(rest);
        let lines = rest[..blank].rfind('\n').map_or(0, |newline| newline + 1);
        self.out.push_str(&rest[..lines]);
    }

    fn starts_declaration(&mut self, level: UnitKind, parts: &[UnitPart<'_>]) {
        let Some(UnitPart::Token(first)) = parts.first() else { return };
        let word = &self.text[first.range.clone()];
        let directive = ["enable", "requires", "diagnostic", ";"].contains(&word);
        if level == UnitKind::Declarations && !self.declared && !directive {
            self.declared = true;
            self.imports_at.get_or_insert(self.out.len());
        }
    }

    fn import(&mut self, import: &ImportDirective, around: &[ShaderDefTest]) {
        let line = &import.line;
        let found = self.statements(import, around);
        self.lead(&line.lead);
        let indent = self.indent(line);
        if found.is_empty() {
            let words = self.text[line.words.clone()].replace('\n', "\n// ");
            self.out.push_str(&format!("{indent}// {words}"));
            return self.rest_of(line);
        }
        self.out.push_str(&indent);
        self.out.push_str(&found.join(&format!("\n{indent}")));
        self.rest_of(line);
        if !self.declared {
            self.imports_at = Some(self.out.len());
        }
    }

    fn statements(&mut self, import: &ImportDirective, around: &[ShaderDefTest]) -> Vec<String> {
        let before = match around {
            [] => String::new(),
            _ => format!("@if({}) ", condition::joined_conditions(around)),
        };
        match import_statements(self.text, &import.tree, self.modules) {
            Ok(found) => found.iter().map(|path| format!("{before}import {path};")).collect(),
            Err(message) => {
                self.wrong.get_or_insert((message, import.line.words.clone()));
                Vec::new()
            }
        }
    }

    /// Writes imports that stood among declarations below the other imports.
    fn late(&mut self, found: &Scanned) {
        let mut lines = Vec::new();
        for (around, import) in &found.late {
            for line in self.statements(import, around) {
                if !lines.contains(&line) {
                    lines.push(line);
                }
            }
        }
        if lines.is_empty() {
            return;
        }
        let at = self.imports_at.unwrap_or(0);
        let before = if at == 0 || self.out[..at].ends_with('\n') { "" } else { "\n" };
        let behind = if self.out[at..].starts_with('\n') { "\n" } else { "\n\n" };
        self.out.insert_str(at, &format!("{before}{}{behind}", lines.join("\n")));
    }

    fn choice(&mut self, level: UnitKind, chosen: &Choice<'_>, around: &[ShaderDefTest]) {
        let is_block =
            level == UnitKind::Statements && around.is_empty() && !self.declares_locals(chosen);
        match chosen.written {
            Some(choice) if is_block => self.blocks(level, chosen, choice),
            Some(choice) => self.one_by_one(level, chosen, Some(choice), around),
            None if level.has_blocks() => self.variants(level, chosen),
            None => self.one_by_one(level, chosen, None, around),
        }
    }

    /// Whether a branch declares a local outside of braces. Composers do not agree whether it is in
    /// scope behind braces under a condition, so these are not written around it.
    fn declares_locals(&self, chosen: &Choice<'_>) -> bool {
        let declares = |element: &Element<'_>| match element {
            Element::Unit(parts) => matches!(parts.first(), Some(UnitPart::Token(first))
                if ["let", "var", "const"].contains(&&self.text[first.range.clone()])),
            Element::Choice(inner) => self.declares_locals(inner),
            Element::Import(_) | Element::Comment(_) | Element::Gone(_) => false,
        };
        chosen.branches.iter().any(|(_, elements)| elements.iter().any(declares))
    }

    /// `@if(...) {` in place of `#ifdef`, around statements: `wesl` 0.4 does not read it around
    /// declarations.
    fn blocks(&mut self, level: UnitKind, chosen: &Choice<'_>, choice: &Conditional) {
        for (index, (branch, (_, elements))) in
            choice.branches.iter().zip(&chosen.branches).enumerate()
        {
            self.lead(&branch.line.lead);
            let close = if index == 0 { "" } else { "} " };
            let head = condition_head(index, branch.condition.as_ref());
            self.out.push_str(&format!("{}{close}{head}{{", self.indent(&branch.line)));
            self.rest_of(&branch.line);
            self.list(level, elements, &[]);
            self.line_due = true;
        }
        self.lead(&choice.end.lead);
        self.out.push_str(&format!("{}}}", self.indent(&choice.end)));
        self.rest_of(&choice.end);
    }

    /// A condition before each of the elements.
    fn one_by_one(
        &mut self,
        level: UnitKind,
        chosen: &Choice<'_>,
        choice: Option<&Conditional>,
        around: &[ShaderDefTest],
    ) {
        let conditions: Vec<_> = chosen.branches.iter().map(|(one, _)| one.clone()).collect();
        let is_single = |elements: &Vec<Element<'_>>| matches!(elements[..], [Element::Unit(_)]);
        let alike = chosen.branches.iter().all(|(_, elements)| is_single(elements));
        for (index, ((_, elements), known)) in
            chosen.branches.iter().zip(explicit_conditions(&conditions)).enumerate()
        {
            if let Some(choice) = choice {
                self.gone(&choice.branches[index].line);
            }
            match &elements[..] {
                [Element::Unit(parts)] if alike && around.is_empty() => {
                    self.unit(level, parts, &condition_head(index, conditions[index].as_ref()));
                }
                _ => self.list(level, elements, &[around, &known].concat()),
            }
            self.line_due = true;
        }
        if let Some(choice) = choice {
            self.gone(&choice.end);
        }
    }

    /// Writes the variants of units that a condition cuts through.
    fn variants(&mut self, level: UnitKind, chosen: &Choice<'_>) {
        let lead = common_lead(chosen).unwrap_or(0..0);
        let lead_text = &self.text[lead.clone()];
        self.lead(&lead);
        let indent = lead_text.rsplit('\n').next().unwrap_or_default();
        let mut indent = if indent.trim().is_empty() { indent } else { "" }.to_owned();
        let is_single = |elements: &[Element<'_>]| match elements {
            [Element::Unit(parts)] => !matches!(parts.first(),
                Some(UnitPart::Token(first)) if self.text[first.range.clone()] == *"{"),
            _ => false,
        };
        let (last, others) = match chosen.branches.split_last() {
            Some(found) => found,
            None => return,
        };
        let single = others.iter().all(|(_, elements)| is_single(elements))
            && (is_single(&last.1) || last.1.is_empty());
        for (index, (condition, elements)) in chosen.branches.iter().enumerate() {
            if elements.is_empty() && index + 1 == chosen.branches.len() {
                break;
            }
            let text = self.rendered(level, elements, lead_text);
            if index == 0 && lead_text.is_empty() {
                let blank = text.len() - text.trim_start_matches([' ', '\t']).len();
                text[..blank].clone_into(&mut indent);
                self.out.push_str(&indent);
            }
            let text = text.trim_start();
            let head = condition_head(index, condition.as_ref());
            if single {
                let gap = if index == 0 { String::new() } else { format!("\n{indent}") };
                self.out.push_str(&format!("{gap}{head}{text}"));
            } else {
                let close = if index == 0 { "" } else { " " };
                self.out.push_str(&format!("{close}{head}{{\n{indent}{text}\n{indent}}}"));
            }
        }
        self.line_due = true;
    }

    /// A variant by itself, without the blanks and comments that all of them start with.
    fn rendered(&mut self, level: UnitKind, elements: &[Element<'_>], lead: &str) -> String {
        let before = std::mem::take(&mut self.out);
        let declared = std::mem::replace(&mut self.declared, true);
        self.imports_at.get_or_insert(before.len());
        (self.line_due, self.comma) = (false, None);
        self.list(level, elements, &[]);
        self.declared = declared || level == UnitKind::Declarations;
        let text = std::mem::replace(&mut self.out, before);
        let text = text.strip_prefix(lead).unwrap_or(&text);
        text.trim_start_matches(['\n', '\r']).trim_end().to_owned()
    }
}

/// `@if(...) `, `@elif(...) ` or `@else `.
fn condition_head(index: usize, condition: Option<&ShaderDefTest>) -> String {
    match condition {
        Some(condition) if index == 0 => format!("@if({}) ", condition.text()),
        Some(condition) => format!("@elif({}) ", condition.text()),
        None => "@else ".to_owned(),
    }
}

/// What stands before the first token, if that is the same in all variants.
fn common_lead(chosen: &Choice<'_>) -> Option<ByteRange> {
    let first = |elements: &Vec<Element<'_>>| match elements.first()? {
        Element::Unit(parts) => match parts.first()? {
            UnitPart::Token(token) => Some(token.lead.clone()),
            UnitPart::List(..) => None,
        },
        Element::Choice(chosen) => common_lead(chosen),
        _ => None,
    };
    let mut leads = chosen
        .branches
        .iter()
        .filter(|(_, elements)| !elements.is_empty())
        .map(|(_, one)| first(one));
    let lead = leads.next()??;
    leads.all(|other| other.as_ref() == Some(&lead)).then_some(lead)
}
