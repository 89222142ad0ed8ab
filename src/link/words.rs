//! The identifiers in a text of WGSL or of a language of the C family, without comments.

/// An identifier.
#[derive(Debug, Clone, Copy)]
pub struct Word<'a> {
    pub text: &'a str,
    /// Where it starts.
    pub at: usize,
    /// The last byte before it that is not white space; a blank where there is none.
    pub before: u8,
}

/// Every identifier and keyword. Letters within a number, such as an exponent, do not count.
pub fn words(text: &str) -> impl Iterator<Item = Word<'_>> {
    let bytes = text.as_bytes();
    let (mut at, mut before) = (0, b' ');
    std::iter::from_fn(move || {
        while let Some(&byte) = bytes.get(at) {
            let start = at;
            at = end(bytes, at);
            let last = before;
            before = if byte.is_ascii_whitespace() { before } else { bytes[at - 1] };
            if begins_word(byte) {
                return Some(Word { text: &text[start..at], at: start, before: last });
            }
        }
        None
    })
}

pub fn begins_word(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || byte == b'_'
}

/// The end of the word, the number or the character that starts at `start`.
pub fn end(bytes: &[u8], start: usize) -> usize {
    let first = bytes[start];
    let belongs = |byte: &u8| match first {
        b'0'..=b'9' => byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.'),
        _ => byte.is_ascii_alphanumeric() || *byte == b'_',
    };
    let long = first.is_ascii_digit() || begins_word(first);
    let rest =
        if long { bytes[start + 1..].iter().take_while(|byte| belongs(byte)).count() } else { 0 };
    // A character of several bytes is one.
    let more =
        bytes[start + 1..].iter().take_while(|byte| first >= 0x80 && **byte & 0xc0 == 0x80).count();
    start + 1 + rest + more
}
