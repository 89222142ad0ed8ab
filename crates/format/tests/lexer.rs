//! A lexer to compare texts before and after: all but blanks must be the same. It shares no code with
//! the formatter but the algorithm of template lists, which verdicts of Tint test in `rules`.

use lamplight_format::Language;
use lamplight_syntax::wesl::{Piece, template_lists};

/// Operators of GLSL, longest first.
const GLSL: [&str; 22] = [
    "<<=", ">>=", "++", "--", "<=", ">=", "==", "!=", "&&", "||", "^^", "+=", "-=", "*=", "/=",
    "%=", "&=", "|=", "^=", "<<", ">>", "::",
];
/// Operators of WGSL. Those with `<` and `>` are left out: whether `>=` is one token, the template
/// lists say.
const WESL: [&str; 16] = [
    "->", "::", "&&", "||", "==", "!=", "++", "--", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=",
];

/// The tokens of a text, comments and lines of the preprocessor included. Comments are given line
/// by line, without the blanks at both ends of a line.
pub fn tokens_of(text: &str, language: Language) -> Vec<String> {
    let text = text.replace("\r\n", "\n").replace('\r', "\n");
    let letters: Vec<char> = text.trim_start_matches('\u{feff}').chars().collect();
    // Each with its first letter.
    let mut tokens: Vec<(usize, String)> = Vec::new();
    let (mut at, mut is_first) = (0, true);
    while at < letters.len() {
        if is_blank(letters[at]) {
            is_first |= is_break(letters[at]);
            at += 1;
            continue;
        }
        let next = token_end(&letters, at, language, is_first);
        let mut token: String = letters[at..next].iter().collect();
        if is_comment(&token) || (is_first && token.starts_with('#')) {
            let lines: Vec<&str> =
                token.split('\n').map(|line| line.trim_matches(is_blank)).collect();
            token = lines.join("\n").trim_end().to_owned();
        }
        tokens.push((at, token));
        (at, is_first) = (next, false);
    }
    let joined = joined_angles(&tokens, language);
    let mut tokens: Vec<String> = tokens.into_iter().map(|(_, token)| token).collect();
    for at in joined {
        tokens[at].push('~');
    }
    tokens
}

/// Whether a token is a comment.
fn is_comment(token: &str) -> bool {
    token.starts_with("//") || token.starts_with("/*")
}

/// The tokens that may be one with the token before them, since nothing stands between: `<=` and the
/// like. In WGSL, a `>` that closes a template list is one for itself.
fn joined_angles(tokens: &[(usize, String)], language: Language) -> Vec<usize> {
    let closers = match language {
        Language::Wesl => closers_of(tokens),
        Language::Glsl => Vec::new(),
    };
    let is_joined = |at: &usize| {
        let ((start, last), (next, token)) = (&tokens[at - 1], &tokens[*at]);
        let is_angle = last.starts_with('<') && token.starts_with(['<', '='])
            || last.starts_with('>') && token.starts_with(['>', '=']);
        is_angle && start + last.len() == *next && !closers.contains(&(at - 1))
    };
    (1..tokens.len()).filter(is_joined).collect()
}

/// The tokens that close a template list.
fn closers_of(tokens: &[(usize, String)]) -> Vec<usize> {
    let is_code = |at: &usize| !is_comment(&tokens[*at].1) && !tokens[*at].1.starts_with('#');
    let code: Vec<usize> = (0..tokens.len()).filter(is_code).collect();
    let is_word = |token: &str| token.starts_with(|it: char| it.is_alphabetic() || it == '_');
    let piece = |at: &usize| {
        let (start, token) = &tokens[*at];
        Piece { text: token, start: *start as u32, is_word: is_word(token) }
    };
    let pieces: Vec<Piece<'_>> = code.iter().map(piece).collect();
    template_lists(&pieces).into_iter().map(|(_, close)| code[close]).collect()
}

fn is_blank(letter: char) -> bool {
    matches!(letter, ' ' | '\t' | '\u{200e}' | '\u{200f}') || is_break(letter)
}

fn is_break(letter: char) -> bool {
    matches!(letter, '\n' | '\u{b}' | '\u{c}' | '\u{85}' | '\u{2028}' | '\u{2029}')
}

fn token_end(letters: &[char], at: usize, language: Language, is_first: bool) -> usize {
    let rest = &letters[at..];
    let begins = |word: &str| {
        word.chars().zip(rest).all(|(one, other)| one == *other)
            && word.chars().count() <= rest.len()
    };
    if begins("//") {
        return line_end(letters, at, language);
    }
    if begins("/*") {
        return comment_end(letters, at, language);
    }
    if is_first && rest[0] == '#' && rest.get(1) != Some(&'{') {
        return line_end(letters, at, Language::Glsl);
    }
    let is_number = |from: usize| rest.get(from).is_some_and(char::is_ascii_digit);
    if is_number(0) || (rest[0] == '.' && is_number(1)) {
        return number_end(letters, at);
    }
    if rest[0].is_alphanumeric() || rest[0] == '_' {
        let is_part = |letter: &char| letter.is_alphanumeric() || *letter == '_';
        return at + rest.iter().take_while(|letter| is_part(letter)).count();
    }
    let known: &[&str] = if language == Language::Glsl { &GLSL } else { &WESL };
    at + known.iter().find(|word| begins(word)).map_or(1, |word| word.len())
}

fn line_end(letters: &[char], mut at: usize, language: Language) -> usize {
    while at < letters.len() {
        let ends = match language {
            Language::Wesl => is_break(letters[at]),
            Language::Glsl => letters[at] == '\n' && letters[at - 1] != '\\',
        };
        if ends {
            break;
        }
        at += 1;
    }
    at
}

fn comment_end(letters: &[char], mut at: usize, language: Language) -> usize {
    let mut depth = 0;
    while at < letters.len() {
        match (letters[at], letters.get(at + 1)) {
            ('/', Some('*')) if depth == 0 || language == Language::Wesl => {
                (at, depth) = (at + 2, depth + 1)
            }
            ('*', Some('/')) => {
                (at, depth) = (at + 2, depth - 1);
                if depth == 0 {
                    return at;
                }
            }
            _ => at += 1,
        }
    }
    at
}

fn number_end(letters: &[char], start: usize) -> usize {
    let is_hexadecimal = letters.get(start + 1).is_some_and(|letter| matches!(letter, 'x' | 'X'));
    let exponents = if is_hexadecimal { ['p', 'P'] } else { ['e', 'E'] };
    let mut at = start;
    while let Some(letter) = letters.get(at) {
        let is_sign = matches!(letter, '+' | '-') && exponents.contains(&letters[at - 1]);
        if !(letter.is_ascii_alphanumeric() || *letter == '.' || is_sign) {
            break;
        }
        at += 1;
    }
    at
}
