//! The formula of a new function: statements in WESL, and the same in GLSL.

use super::parameter::TYPES;

/// The statements of a formula. The last one returns the result.
#[derive(Debug)]
pub struct FormulaBody {
    statements: Vec<Statement>,
}

#[derive(Debug)]
enum Statement {
    /// `let NAME = VALUE`, or `var`.
    Declared { keyword: &'static str, name: String, ty: DeclaredType, value: String },
    /// `NAME = VALUE`, or `NAME += VALUE`.
    Assigned { text: String },
    /// `return VALUE`.
    Returned { value: String },
}

/// The type of a declaration, as WESL writes it. GLSL needs it, WESL does not.
#[derive(Debug, Default)]
struct DeclaredType {
    given: Option<String>,
    found: Option<String>,
}

/// Names of functions that GLSL spells otherwise.
const NAMES: [(&str, &str); 6] = [
    ("inverseSqrt", "inversesqrt"),
    ("atan2", "atan"),
    ("dpdx", "dFdx"),
    ("dpdy", "dFdy"),
    ("countOneBits", "bitCount"),
    ("reverseBits", "bitfieldReverse"),
];

/// Calls that GLSL writes in another form, with `$` and the number of an argument.
const CALLS: [(&str, &str); 2] =
    [("saturate", "clamp($0, 0.0, 1.0)"), ("select", "($2 ? $1 : $0)")];

impl FormulaBody {
    /// Reads an expression, or statements with `;` between them.
    pub fn read(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> =
            text.split(';').map(str::trim).filter(|part| !part.is_empty()).collect();
        let mut statements = match parts[..] {
            [] => return Err("the formula is empty".to_owned()),
            [value] if !["return ", "let ", "var "].iter().any(|word| value.starts_with(word)) => {
                vec![Statement::Returned { value: value.to_owned() }]
            }
            _ => parts.iter().map(|part| Statement::read(part)).collect::<Result<_, _>>()?,
        };
        let returns = |one: &Statement| matches!(one, Statement::Returned { .. });
        let last = statements.pop().filter(returns);
        let last = last.ok_or("the last statement of a formula is `return VALUE`")?;
        if statements.iter().any(returns) {
            return Err("only the last statement of a formula is `return VALUE`".to_owned());
        }
        statements.push(last);
        Ok(Self { statements })
    }

    /// The body of the function in WESL.
    pub fn in_wesl(&self) -> String {
        self.statements.iter().map(Statement::in_wesl).collect()
    }

    /// The body of the function in GLSL, or why it cannot be written.
    pub fn in_glsl(&self) -> Result<String, String> {
        self.statements.iter().map(Statement::in_glsl).collect()
    }

    /// Finds the type of each declaration that states none: the first of the known types with which
    /// the body up to there compiles. `compiles` gets that part in WESL.
    pub fn find_types(&mut self, compiles: impl Fn(&str) -> bool) {
        let mut before = String::new();
        for statement in &mut self.statements {
            if let Statement::Declared { keyword, name, ty, value } = statement
                && ty.given.is_none()
            {
                let fits = |known: &str| {
                    compiles(&format!("{before}    {keyword} {name}: {known} = {value};\n"))
                };
                let mut names = BY_LITERAL.into_iter().chain(TYPES.iter().map(|known| known.wesl));
                ty.found = names.find(|known| fits(known)).map(str::to_owned);
            }
            before += &statement.in_wesl();
        }
    }
}

/// The types that a literal such as `2` may have, in the order in which they are tried.
const BY_LITERAL: [&str; 2] = ["i32", "f32"];

impl Statement {
    fn read(text: &str) -> Result<Self, String> {
        if let Some(value) = text.strip_prefix("return ") {
            return Ok(Self::Returned { value: value.trim().to_owned() });
        }
        for keyword in ["let", "var"] {
            let Some(rest) = text.strip_prefix(keyword).filter(|rest| rest.starts_with(' ')) else {
                continue;
            };
            let wrong = || format!("`{text}` is not `{keyword} NAME = VALUE`");
            let (declared, value) = rest.split_once('=').ok_or_else(wrong)?;
            let (name, given) = match declared.split_once(':') {
                Some((name, ty)) => (name, Some(ty.trim().to_owned())),
                None => (declared, None),
            };
            let ty = DeclaredType { given, found: None };
            let (name, value) = (name.trim().to_owned(), value.trim().to_owned());
            return Ok(Self::Declared { keyword, name, ty, value });
        }
        let words = ["if", "for", "while", "loop", "switch"];
        let is_block = text.contains(['{', '}'])
            || text.split(|one: char| !is_part(one)).next().is_some_and(|one| words.contains(&one));
        match text.contains('=') && !is_block {
            true => Ok(Self::Assigned { text: text.to_owned() }),
            false => Err(format!(
                "`{text}` is none of the statements of a formula: `let NAME = VALUE`, `var NAME = VALUE`, `NAME = VALUE`, `return VALUE`"
            )),
        }
    }

    fn in_wesl(&self) -> String {
        match self {
            Self::Declared { keyword, name, ty, value } => {
                let ty = ty.given.as_ref().map_or(String::new(), |ty| format!(": {ty}"));
                format!("    {keyword} {name}{ty} = {value};\n")
            }
            Self::Assigned { text } => format!("    {text};\n"),
            Self::Returned { value } => format!("    return {value};\n"),
        }
    }

    fn in_glsl(&self) -> Result<String, String> {
        Ok(match self {
            Self::Declared { keyword: _, name, ty, value } => {
                let ty = ty.given.as_ref().or(ty.found.as_ref());
                let ty = ty.ok_or_else(|| format!("`{name}` has none of the known types"))?;
                format!("    {} {name} = {};\n", glsl_word(ty), glsl_expression(value))
            }
            Self::Assigned { text } => format!("    {};\n", glsl_expression(text)),
            Self::Returned { value } => format!("    return {};\n", glsl_expression(value)),
        })
    }
}

fn is_part(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// GLSL's name of a type or a function.
fn glsl_word(word: &str) -> &str {
    let ty = TYPES.iter().find(|ty| ty.wesl == word).map(|ty| ty.glsl);
    let name = NAMES.iter().find(|(wesl, _)| *wesl == word).map(|(_, glsl)| *glsl);
    ty.or(name).unwrap_or(word)
}

/// An expression of WESL with GLSL's names of types and functions.
fn glsl_expression(text: &str) -> String {
    let Some(start) = text.find(is_part) else { return text.to_owned() };
    let end = text[start..].find(|one| !is_part(one)).map_or(text.len(), |at| start + at);
    let (before, word, after) = (&text[..start], &text[start..end], &text[end..]);
    let form = CALLS.iter().find(|(name, _)| *name == word);
    if let Some(((_, form), (arguments, rest))) = form.zip(call_arguments(after)) {
        let arguments = arguments.into_iter().map(glsl_expression).enumerate();
        let made = arguments.fold((*form).to_owned(), |made, (index, argument)| {
            made.replace(&format!("${index}"), &argument)
        });
        return format!("{before}{made}{}", glsl_expression(rest));
    }
    format!("{before}{}{}", glsl_word(word), glsl_expression(after))
}

/// The arguments of a call in parentheses at the start of a text, and the text behind them.
fn call_arguments(text: &str) -> Option<(Vec<&str>, &str)> {
    let inner = text.strip_prefix('(')?;
    let (mut depth, mut start, mut arguments) = (0_usize, 0, Vec::new());
    for (at, letter) in inner.char_indices() {
        match letter {
            ')' | ']' if depth > 0 => depth -= 1,
            ')' => {
                arguments.push(inner[start..at].trim());
                return Some((arguments, &inner[at + 1..]));
            }
            '(' | '[' => depth += 1,
            ',' if depth == 0 => {
                arguments.push(inner[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    None
}
