//! Numbers that the client sends: each fits, or is refused.

use serde_json::Value;

use crate::answer::{Failed, Turn};

/// What is shown of something that should have been a number.
const SHOWN: usize = 40;

/// A number of an object, such as a line; `None` if it has none.
pub(crate) fn number_of(object: &Value, name: &str) -> Result<Option<u32>, Failed> {
    let found = object.get(name).filter(|value| !value.is_null());
    let read = |value: &Value| {
        let number = value.as_u64().and_then(|number| u32::try_from(number).ok());
        number.ok_or_else(|| {
            let text: String = value.to_string().chars().take(SHOWN).collect();
            format!("`{name}` is {text}: expected a whole number from 0 to {}", u32::MAX)
        })
    };
    found.map(read).transpose()
}

impl Turn<'_> {
    /// A number of the arguments.
    pub fn number(&self, name: &str) -> Result<Option<u32>, Failed> {
        number_of(self.arguments, name)
    }
}

/// How the client counts lines and columns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Counting {
    /// The number of the first line.
    pub line: u32,
    /// The number of the first column.
    pub column: u32,
}

impl Counting {
    /// The line that the client means, from 1.
    pub fn read_line(self, line: u32) -> Result<u32, Failed> {
        let own = u64::from(line) + 1 - u64::from(self.line);
        let own = u32::try_from(own).ok().filter(|own| *own > 0);
        own.ok_or_else(|| format!("there is no line {line}: the first is {}", self.line))
    }

    /// The number of a line from 1, for the client.
    pub fn line(self, line: u32) -> u32 {
        line.saturating_sub(1).saturating_add(self.line)
    }

    /// The number of a column from 1, for the client.
    pub fn column(self, column: u32) -> u32 {
        column.saturating_sub(1).saturating_add(self.column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn numbers_fit_or_are_refused() {
        let most = u64::from(u32::MAX);
        let given = json!({
            "zero": 0, "most": most, "null": null, "more": most + 1, "below": -1, "half": 0.5,
            "text": "7", "least": i64::MIN,
        });
        let read = |name: &str| number_of(&given, name);
        assert_eq!(read("zero"), Ok(Some(0)));
        assert_eq!(read("most"), Ok(Some(u32::MAX)));
        assert_eq!((read("null"), read("missing")), (Ok(None), Ok(None)));
        for wrong in ["more", "below", "half", "text", "least"] {
            assert!(read(wrong).unwrap_err().starts_with(&format!("`{wrong}` is ")));
        }
    }

    #[test]
    fn lines_of_the_client() {
        let (from_0, from_1) = (Counting { line: 0, column: 0 }, Counting { line: 1, column: 1 });
        assert_eq!((from_0.read_line(0), from_1.read_line(1)), (Ok(1), Ok(1)));
        assert!(from_1.read_line(0).is_err() && from_0.read_line(u32::MAX).is_err());
        assert_eq!(from_1.read_line(u32::MAX), Ok(u32::MAX));
        assert_eq!((from_0.line(1), from_1.line(1)), (0, 1));
        assert_eq!((from_0.column(3), from_1.column(3)), (2, 3));
    }
}
