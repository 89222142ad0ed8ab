//! Escapes control characters for terminals and JSON, and reserved characters for markup.

/// Whether a terminal or an editor would act on a character instead of showing it: control
/// characters other than line ends and tabs, and bidirectional formatting characters. All of them
/// have 16 bits.
pub fn needs_escape(character: char) -> bool {
    match character {
        '\n' | '\t' => false,
        '\u{61c}' | '\u{200e}' | '\u{200f}' => true,
        '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        other => other.is_control(),
    }
}

/// Text in which each character that [`needs_escape`] is written as `\u001b` and the like, which
/// mean the same characters in JSON.
pub fn escape_controls(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match needs_escape(character) {
            true => escaped += &format!("\\u{:04x}", u32::from(character)),
            false => escaped.push(character),
        }
    }
    escaped
}

/// Text with the reserved characters of HTML and XML replaced, without those that XML refuses.
pub fn escape_markup(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            letter if needs_escape(letter) || matches!(letter, '\u{fffe}' | '\u{ffff}') => {}
            letter => escaped.push(letter),
        }
    }
    escaped
}
