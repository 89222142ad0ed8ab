//! Texts of expressions: how strongly they bind, and whether they may be evaluated later.

/// How strongly a text binds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Strength {
    Or,
    And,
    Bits,
    Relation,
    Shift,
    Sum,
    Product,
    Unary,
    Primary,
}

/// Texts as the arguments of a call. A `<` and a `>` of two arguments would be the brackets of a
/// template, as in `f(a < b, c > d)`, so comparisons before a `>` are in brackets.
pub(super) fn list_text(values: &[Value]) -> String {
    let opens = |value: &Value| value.strength <= Strength::Relation && value.text.contains(" < ");
    let last = values.iter().rposition(|value| value.text.contains('>')).unwrap_or(0);
    let texts: Vec<String> = values
        .iter()
        .enumerate()
        .map(|(at, value)| match at < last && opens(value) {
            true => format!("({})", value.text),
            false => value.text.clone(),
        })
        .collect();
    texts.join(", ")
}

/// The text of an expression.
#[derive(Debug, Clone)]
pub(super) struct Value {
    pub(super) text: String,
    pub(super) strength: Strength,
    /// Whether nothing that runs later changes its value.
    pub(super) stable: bool,
}

impl Value {
    pub(super) fn primary(text: impl Into<String>, stable: bool) -> Self {
        Self { text: text.into(), strength: Strength::Primary, stable }
    }

    /// The text as an operand that must bind at least so strongly.
    pub(super) fn at_least(&self, strength: Strength) -> String {
        if self.strength >= strength { self.text.clone() } else { format!("({})", self.text) }
    }

    /// Whether writing the text twice costs nothing.
    pub(super) fn is_simple(&self) -> bool {
        let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "_.-".contains(letter);
        self.strength >= Strength::Unary && self.text.chars().all(is_plain)
    }
}
