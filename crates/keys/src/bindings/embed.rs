//! The bytes of a bundle as source.

/// Numbers with commas between them, a few in each line.
pub fn byte_lines(bytes: &[u8]) -> String {
    let line = |bytes: &[u8]| {
        let numbers: Vec<String> = bytes.iter().map(u8::to_string).collect();
        format!("    {},\n", numbers.join(", "))
    };
    bytes.chunks(20).map(line).collect()
}

/// The bytes in the letters of base64, with padding.
pub fn base64_text(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let letters = |bytes: &[u8]| {
        let word = bytes.iter().fold(0, |word, byte| word << 8 | u32::from(*byte));
        let word = word << (8 * (3 - bytes.len()));
        let letter = |place: usize| char::from(LETTERS[(word >> (18 - 6 * place)) as usize & 63]);
        let mut text: String = (0..=bytes.len()).map(letter).collect();
        text.push_str(&"="[..(bytes.len() == 2) as usize]);
        text.push_str(&"=="[..2 * (bytes.len() == 1) as usize]);
        text
    };
    bytes.chunks(3).map(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::base64_text;

    /// The test vectors of RFC 4648, section 10.
    #[test]
    fn base64_is_that_of_the_standard() {
        let cases = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (bytes, text) in cases {
            assert_eq!(base64_text(bytes.as_bytes()), text);
        }
    }
}
