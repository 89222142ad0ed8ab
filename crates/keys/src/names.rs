//! Names of axes and values as identifiers.

use lamplight_diagnostic::needs_escape;
use lamplight_permute::Setting;

/// `pcf_3x3` as `Pcf3x3`.
pub fn camel_case(name: &str) -> String {
    let words = name.split('_').filter(|word| !word.is_empty());
    let joined: String = words.map(|word| word[..1].to_ascii_uppercase() + &word[1..]).collect();
    if joined.starts_with(|first: char| first.is_ascii_digit()) {
        format!("N{joined}")
    } else {
        joined
    }
}

/// `depth_view` as `depthView`.
pub fn lower_camel(name: &str) -> String {
    let camel = camel_case(name);
    let length = camel.len().min(1);
    camel[..length].to_ascii_lowercase() + &camel[length..]
}

/// A value as a part of an identifier. A number gets a letter before it, and a word for its sign.
pub fn value_name(value: &Setting) -> String {
    match value {
        Setting::Int(number) if *number < 0 => format!("minus_{}", number.unsigned_abs()),
        Setting::Int(number) => format!("n{number}"),
        other => other.to_string(),
    }
}

/// Gives out identifiers, each once. If one is taken, the later one gets underscores and the
/// earlier one keeps its name.
#[derive(Default)]
pub struct Taken(Vec<String>);

impl Taken {
    /// Names that must not be given out.
    pub fn new(reserved: &[&str]) -> Self {
        Self(reserved.iter().map(|name| (*name).to_owned()).collect())
    }

    pub fn give(&mut self, mut name: String) -> String {
        while self.0.contains(&name) {
            name.push('_');
        }
        self.0.push(name.clone());
        name
    }
}

/// The lines of a text as lines of a comment.
pub fn comment_lines(prefix: &str, text: &str) -> String {
    // Each of these characters ends a line comment in some language. A lone carriage return is an
    // error in a comment of Rust.
    let text = text.replace("\r\n", "\n").replace(['\r', '\u{2028}', '\u{2029}'], "\n");
    text.lines()
        .map(|line| line.replace(needs_escape, "?"))
        .map(|line| format!("{}\n", format!("{prefix} {}", line.replace("*/", "* /")).trim_end()))
        .collect()
}

/// As [`comment_lines`], for a language whose tools run the code in documentation. No line is code:
/// it is not indented, and no fence begins or ends in it.
pub fn documentation_lines(prefix: &str, text: &str) -> String {
    let plain = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        words.join(" ").replace("```", r"\`\`\`").replace("~~~", r"\~\~\~")
    };
    comment_lines(prefix, text).lines().fold(String::new(), |mut lines, line| {
        let indent = &prefix[..prefix.len() - prefix.trim_start().len()];
        lines.extend([indent, &plain(line), "\n"]);
        lines
    })
}
