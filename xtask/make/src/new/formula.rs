//! The formula of a new function: statements in WESL.

/// The statements of a formula. The last one returns the result.
#[derive(Debug)]
pub struct FormulaBody {
    statements: Vec<String>,
}

/// Words that begin statements with a block.
const BLOCKS: [&str; 5] = ["if", "for", "while", "loop", "switch"];

impl FormulaBody {
    /// Reads an expression, or statements with `;` between them.
    pub fn read(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> =
            text.split(';').map(str::trim).filter(|part| !part.is_empty()).collect();
        let statements = match parts[..] {
            [] => return Err("the formula is empty".to_owned()),
            [value] if !["return ", "let ", "var "].iter().any(|word| value.starts_with(word)) => {
                vec![format!("return {value}")]
            }
            _ => parts.iter().map(|part| read_statement(part)).collect::<Result<_, _>>()?,
        };
        let returns = |one: &String| one.starts_with("return ");
        match statements.iter().position(returns) {
            Some(at) if at + 1 == statements.len() => Ok(Self { statements }),
            Some(_) => Err("only the last statement of a formula is `return VALUE`".to_owned()),
            None => Err("the last statement of a formula is `return VALUE`".to_owned()),
        }
    }

    /// The body of the function.
    pub fn in_wesl(&self) -> String {
        self.statements.iter().map(|one| format!("    {one};\n")).collect()
    }
}

fn read_statement(text: &str) -> Result<String, String> {
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
    let first = text.split(|one: char| !is_part(one)).next().unwrap_or_default();
    let is_declared = ["let", "var"].contains(&first);
    let is_block = text.contains(['{', '}']) || BLOCKS.contains(&first);
    match (first, text.contains('=') && !is_block) {
        ("return", _) | (_, true) => Ok(text.to_owned()),
        _ if is_declared => Err(format!("`{text}` is not `{first} NAME = VALUE`")),
        _ => Err(format!(
            "`{text}` is none of the statements of a formula: `let NAME = VALUE`, `var NAME = VALUE`, `NAME = VALUE`, `return VALUE`"
        )),
    }
}
