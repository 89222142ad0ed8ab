//! Divides a text that naga wrote into declarations.

use lamplight_emit::is_header_line;
use lamplight_syntax::words::{LexemeKind, piece_at, word_end, words};

/// What a declaration of an output is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum OutputKind {
    Type,
    Constant,
    Function,
    /// A bound variable, or one that enters or leaves the stage.
    Global,
}

/// One declaration, as written.
#[derive(Debug)]
pub struct OutputDeclaration<'a> {
    pub kind: OutputKind,
    pub name: &'a str,
    pub text: &'a str,
}

/// The text before all declarations, and the declarations.
///
/// # Errors
/// Where the text has a form that this crate does not know.
pub fn split_declarations(text: &str) -> Result<(&str, Vec<OutputDeclaration<'_>>), String> {
    let header = header_length(text);
    let (mut rest, mut declared) = (text[header..].trim_start(), Vec::new());
    while !rest.is_empty() {
        let length = declaration_length(rest).ok_or("a declaration has no end")?;
        let (first, after) = rest.split_at(length);
        declared.push(read_declaration(first.trim_end())?);
        rest = after.trim_start();
    }
    Ok((text[..header].trim_end(), declared))
}

/// Length of the lines before the first declaration.
fn header_length(text: &str) -> usize {
    text.split_inclusive('\n').take_while(|line| is_header_line(line)).map(str::len).sum()
}

/// Length of the declaration at the start of the text, with the semicolon after its brackets.
fn declaration_length(text: &str) -> Option<usize> {
    // In `typedef struct { ... } name;` the name comes after the brackets.
    let names_what_it_holds = text.starts_with("typedef ");
    let mut depth = 0_usize;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.checked_sub(1)?,
            b';' if depth == 0 => return Some(at + 1),
            _ => continue,
        }
        if depth == 0 && byte == b'}' && !names_what_it_holds {
            let after = &text[at + 1..];
            let blanks = after.len() - after.trim_start().len();
            return Some(if after.trim_start().starts_with(';') {
                at + blanks + 2
            } else {
                at + 1
            });
        }
    }
    None
}

fn read_declaration(text: &str) -> Result<OutputDeclaration<'_>, String> {
    let head = declaration_head(text);
    // Where the name comes last, it may be any word, a keyword of another language too.
    let (last, before) =
        head.words.split_last().map_or((None, &[][..]), |(last, all)| (Some(*last), all));
    let has = |word: &str| before.contains(&word);
    let (kind, name) = match head.stop {
        _ if has("struct") || has("cbuffer") => {
            let kind = if has("struct") { OutputKind::Type } else { OutputKind::Global };
            (kind, last)
        }
        b'{' if has("typedef") => (OutputKind::Type, words(text).last().map(|word| word.text)),
        _ if has("typedef") || has("alias") => (OutputKind::Type, last),
        b'(' => (OutputKind::Function, last),
        // A uniform block is known by the name of its instance.
        b'{' if has("uniform") || has("buffer") => {
            (OutputKind::Global, words(text).last().map(|word| word.text))
        }
        b'{' | b' ' => (OutputKind::Global, None),
        _ if has("const") && !before.iter().any(|word| word.starts_with("Sampler")) => {
            (OutputKind::Constant, last)
        }
        _ if has("constant") => (OutputKind::Constant, last),
        _ => (OutputKind::Global, last),
    };
    let name = name.ok_or_else(|| {
        format!("a declaration without a name: {}", text.chars().take(60).collect::<String>())
    })?;
    Ok(OutputDeclaration { kind, name, text })
}

/// The words before a declaration's value, arguments or content.
struct DeclarationHead<'a> {
    words: Vec<&'a str>,
    /// The character that ended them.
    stop: u8,
}

/// How long the brackets at the start of the text are, if a name follows them.
fn array_of_result(text: &str) -> Option<usize> {
    let end = text.find(']')? + 1;
    let next = text[end..].trim_start().bytes().next()?;
    (next == b'[' || next == b'_' || next.is_ascii_alphabetic()).then_some(end)
}

fn declaration_head(text: &str) -> DeclarationHead<'_> {
    let bytes = text.as_bytes();
    let (mut at, mut words, mut is_attribute) = (0, Vec::new(), false);
    while let Some(piece) = piece_at(text, at) {
        at = piece.end();
        let byte = bytes[piece.at];
        match byte {
            b'(' if is_attribute => at += text[at..].find(')').map_or(0, |found| found + 1),
            b'<' => at += text[at..].find('>').map_or(0, |found| found + 1),
            b':' if bytes.get(at) == Some(&b':') => at += 1,
            // If a function of GLSL returns an array, its length comes before the function's name.
            b'[' if let Some(length) = array_of_result(&text[at..]) => at += length,
            b'(' | b'{' | b'=' | b'[' | b';' | b':' => {
                return DeclarationHead { words, stop: byte };
            }
            // Attributes of WGSL and layouts of GLSL have arguments of their own, which are
            // skipped.
            b'@' => {
                at = word_end(text, at);
                is_attribute = true;
                continue;
            }
            _ if piece.kind == LexemeKind::Word => words.push(piece.text),
            _ if piece.kind == LexemeKind::Blank => continue,
            _ => {}
        }
        is_attribute = words.last() == Some(&"layout");
    }
    DeclarationHead { words, stop: b' ' }
}
