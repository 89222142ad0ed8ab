//! Rewrites a file about one target into a file about another, such as another version.

/// Words to replace, in order.
pub struct Renaming {
    words: Vec<(String, String)>,
}

impl Renaming {
    /// From one target to another, as a string, in documentation and as a constant. The name of a
    /// module of naga stays. If both names end with a number of three digits, the number is
    /// replaced too, as `450`, `4.50` and `4.5`.
    pub fn new(from: &str, to: &str) -> Self {
        let around = [("\"", "\""), ("`", "`"), ("\"", ".")];
        let in_each = |name: &str| around.map(|(left, right)| format!("{left}{name}{right}"));
        let mut words: Vec<_> = in_each(from).into_iter().zip(in_each(to)).collect();
        let constant = |name: &str| format!("Target::{}", name.to_uppercase());
        words.push((constant(from), constant(to)));
        if let (Some(old), Some(new)) = (number_of(from), number_of(to)) {
            let dotted = |text: &str| format!("{}.{}", &text[..1], &text[1..]);
            let short = |text: &str| format!("{}.{}", &text[..1], &text[1..2]);
            words.push((old.to_owned(), new.to_owned()));
            words.push((dotted(old), dotted(new)));
            words.push((short(old), short(new)));
        }
        Self { words }
    }

    /// The text with each word replaced.
    pub fn apply(&self, text: &str) -> String {
        self.words.iter().fold(text.to_owned(), |text, (from, to)| replace_word(&text, from, to))
    }
}

/// The three digits at the end of a name.
fn number_of(name: &str) -> Option<&str> {
    let letters = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let number = &name[letters.len()..];
    (number.len() == 3).then_some(number)
}

/// Replaces a word where it is no part of a longer word or number.
fn replace_word(text: &str, from: &str, to: &str) -> String {
    let joins = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let [begins, ends] = [from.starts_with(joins), from.ends_with(joins)];
    let mut made = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(from) {
        let (before, after) = (&rest[..at], &rest[at + from.len()..]);
        let is_part = begins && before.ends_with(joins) || ends && after.starts_with(joins);
        made.push_str(before);
        made.push_str(if is_part { from } else { to });
        rest = after;
    }
    made + rest
}
