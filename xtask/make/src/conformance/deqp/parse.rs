//! Reads the files `*.test` of dEQP's shader library: groups of cases, and of each case its texts and
//! the values that it computes.

use std::iter::Peekable;
use std::vec::IntoIter;

/// What a case expects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Expect {
    /// It compiles, and computes the values of the case.
    Pass,
    /// It compiles.
    Build,
    /// A stage is refused.
    CompileFail,
    /// The stages do not fit together, or a pipeline of programs does not.
    LinkFail,
}

/// What a value is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    Input,
    Output,
    /// The case declares it itself.
    Uniform,
}

/// A variable, and its numbers in each run.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseValue {
    pub role: Role,
    /// As GLSL names it.
    pub ty: String,
    /// With members and indices, such as `val[1].a`.
    pub name: String,
    pub rows: Vec<Vec<f64>>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The file and the groups that it is in, and its own name.
    pub name: String,
    pub expect: Expect,
    pub values: Vec<CaseValue>,
    /// Each text, with the word before it: `both`, `vertex`, `fragment` or another stage.
    pub texts: Vec<(String, String)>,
    /// Extensions of GLSL that it asks for, each with the stages of it.
    pub extensions: Vec<(String, Vec<String>)>,
    /// Whether it is a pipeline of programs that are linked one by one.
    pub is_pipeline: bool,
}

#[derive(Debug, PartialEq)]
enum Token {
    /// Between quotes.
    Text(String),
    Word(String),
}

/// The words that begin a part of a case.
const PARTS: &[&str] = &[
    "active_stages",
    "both",
    "compute",
    "desc",
    "end",
    "expect",
    "fragment",
    "geometry",
    "output_color",
    "pipeline_program",
    "require",
    "tessellation_control",
    "tessellation_evaluation",
    "values",
    "version",
    "vertex",
];

/// All cases of a file.
///
/// # Errors
/// What was expected, and where.
pub fn parse_cases(file: &str, text: &str) -> Result<Vec<Case>, String> {
    let mut reader = Reader { tokens: split_tokens(text).into_iter().peekable() };
    let mut cases = Vec::new();
    while reader.tokens.peek().is_some() {
        reader.item(file, &mut cases)?;
    }
    Ok(cases)
}

struct Reader {
    tokens: Peekable<IntoIter<Token>>,
}

impl Reader {
    fn next(&mut self) -> Result<Token, String> {
        self.tokens.next().ok_or_else(|| "the file ends within a case".to_owned())
    }

    fn word(&mut self) -> Result<String, String> {
        match self.next()? {
            Token::Word(word) => Ok(word),
            Token::Text(text) => Err(format!("expected a word, found the text `{text}`")),
        }
    }

    fn expect(&mut self, expected: &str) -> Result<(), String> {
        let found = self.word()?;
        match found == expected {
            true => Ok(()),
            false => Err(format!("expected `{expected}`, found `{found}`")),
        }
    }

    fn is_next(&mut self, word: &str) -> bool {
        matches!(self.tokens.peek(), Some(Token::Word(found)) if found == word)
    }

    /// Passes over a text, if one is next, and gives it.
    fn text(&mut self) -> Option<String> {
        match self.tokens.next_if(|token| matches!(token, Token::Text(_)))? {
            Token::Text(text) => Some(text),
            Token::Word(_) => None,
        }
    }

    fn item(&mut self, group: &str, cases: &mut Vec<Case>) -> Result<(), String> {
        match self.word()?.as_str() {
            "group" => {
                let group = format!("{group}.{}", self.word()?);
                self.text();
                while !self.is_next("end") {
                    self.item(&group, cases)?;
                }
                self.expect("end")
            }
            "case" => {
                let name = format!("{group}.{}", self.word()?);
                let case = self.case(name.clone()).map_err(|error| format!("{name}: {error}"))?;
                cases.push(case);
                Ok(())
            }
            "import" => self.next().map(|_| ()),
            other => Err(format!("expected `group` or `case` in `{group}`, found `{other}`")),
        }
    }

    fn case(&mut self, name: String) -> Result<Case, String> {
        let mut case = Case {
            name,
            expect: Expect::Pass,
            values: Vec::new(),
            texts: Vec::new(),
            extensions: Vec::new(),
            is_pipeline: false,
        };
        loop {
            match self.word()?.as_str() {
                "end" => return Ok(case),
                "desc" => {
                    self.text();
                }
                "expect" => case.expect = self.expectation()?,
                "values" => self.values(&mut case.values)?,
                "pipeline_program" => {
                    case.is_pipeline = true;
                    let part = self.case(String::new())?;
                    case.texts.extend(part.texts);
                }
                "require" => self.requirement(&mut case.extensions),
                "version" | "output_color" | "active_stages" => {
                    self.words();
                }
                stage if PARTS.contains(&stage) => {
                    let text = self.text().ok_or_else(|| format!("`{stage}` has no text"))?;
                    case.texts.push((stage.to_owned(), text));
                }
                other => return Err(format!("`{other}` is not known")),
            }
        }
    }

    fn expectation(&mut self) -> Result<Expect, String> {
        match self.word()?.as_str() {
            "pass" => Ok(Expect::Pass),
            "build_successful" => Ok(Expect::Build),
            // Some implementations notice only when they link.
            "compile_fail" | "compile_or_link_fail" => Ok(Expect::CompileFail),
            "link_fail" | "validation_fail" => Ok(Expect::LinkFail),
            other => Err(format!("`expect {other}` is not known")),
        }
    }

    /// Such as `require extension { "NAME" | "OTHER" } in { vertex, fragment }`, of which the first name
    /// is taken.
    fn requirement(&mut self, extensions: &mut Vec<(String, Vec<String>)>) {
        let words = self.words();
        if words.first().is_none_or(|word| word != "extension") {
            return;
        }
        let mut names = words.iter().filter(|word| word.starts_with("GL_"));
        let stages = words.iter().skip_while(|word| *word != "in");
        let stages = stages.filter(|word| PARTS.contains(&word.as_str())).cloned().collect();
        if let Some(name) = names.next() {
            extensions.push((name.clone(), stages));
        }
    }

    /// The words and texts up to the next part of the case.
    fn words(&mut self) -> Vec<String> {
        let mut words: Vec<String> = Vec::new();
        let mut depth = 0_i32;
        let is_part = |token: &Token| match token {
            Token::Word(word) => PARTS.contains(&word.as_str()),
            Token::Text(_) => false,
        };
        while let Some(token) = self.tokens.next_if(|token| depth > 0 || !is_part(token)) {
            let (Token::Word(word) | Token::Text(word)) = token;
            depth += i32::from(word == "{") - i32::from(word == "}");
            words.push(word);
        }
        words
    }

    fn values(&mut self, values: &mut Vec<CaseValue>) -> Result<(), String> {
        self.expect("{")?;
        while !self.is_next("}") {
            let role = match self.word()?.as_str() {
                "input" => Role::Input,
                "output" => Role::Output,
                "uniform" => Role::Uniform,
                other => return Err(format!("`{other}` is no kind of value")),
            };
            let ty = self.word()?;
            let mut name = self.word()?;
            while !self.is_next("=") {
                name.push_str(&self.word()?);
            }
            self.expect("=")?;
            let rows = self.rows()?;
            self.expect(";")?;
            values.push(CaseValue { role, ty, name, rows });
        }
        self.expect("}")
    }

    fn rows(&mut self) -> Result<Vec<Vec<f64>>, String> {
        if !self.is_next("[") {
            return Ok(vec![self.numbers()?]);
        }
        self.expect("[")?;
        let mut rows = vec![self.numbers()?];
        while self.is_next("|") {
            self.expect("|")?;
            rows.push(self.numbers()?);
        }
        self.expect("]")?;
        Ok(rows)
    }

    /// The numbers of a literal or a constructor.
    fn numbers(&mut self) -> Result<Vec<f64>, String> {
        let word = self.word()?;
        if !self.is_next("(") {
            return Ok(vec![read_number(&word)?]);
        }
        self.expect("(")?;
        let mut numbers = self.numbers()?;
        while self.is_next(",") {
            self.expect(",")?;
            numbers.extend(self.numbers()?);
        }
        self.expect(")")?;
        let (columns, rows) = shape_of(&word).ok_or_else(|| format!("`{word}` is no type"))?;
        Ok(match numbers[..] {
            [one] if word.starts_with("mat") => {
                let is_diagonal = |at: u32| at / rows == at % rows;
                let all = 0..columns * rows;
                all.map(|at| if is_diagonal(at) { one } else { 0.0 }).collect()
            }
            [one] => vec![one; rows as usize],
            _ => numbers,
        })
    }
}

fn read_number(word: &str) -> Result<f64, String> {
    match word {
        "true" => return Ok(1.0),
        "false" => return Ok(0.0),
        _ => {}
    }
    let wrong = |_| format!("`{word}` is no number");
    if let Some(digits) = word.strip_prefix("0x") {
        let digits = digits.trim_end_matches(['u', 'U']);
        return u32::from_str_radix(digits, 16).map(f64::from).map_err(|_| wrong(()));
    }
    word.trim_end_matches(['u', 'U', 'f', 'F']).parse().map_err(|_| wrong(()))
}

/// The columns and rows of a type of GLSL. Scalars and vectors have one column.
pub fn shape_of(ty: &str) -> Option<(u32, u32)> {
    let digit = |text: &str| text.parse::<u32>().ok().filter(|size| (2..=4).contains(size));
    if let Some(size) = ty.strip_prefix("mat") {
        return match size.split_once('x') {
            Some((columns, rows)) => Some((digit(columns)?, digit(rows)?)),
            None => digit(size).map(|size| (size, size)),
        };
    }
    match ty {
        "float" | "int" | "uint" | "bool" => Some((1, 1)),
        _ => {
            let size = ty.trim_start_matches(['b', 'i', 'u']).strip_prefix("vec")?;
            digit(size).map(|size| (1, size))
        }
    }
}

fn split_tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(letter) = rest.chars().next() {
        let length = match letter {
            '#' => rest.find('\n').unwrap_or(rest.len()),
            '"' => {
                let (text, length) = quoted_text(rest);
                tokens.push(Token::Text(text));
                length
            }
            _ if letter.is_whitespace() => letter.len_utf8(),
            _ => {
                let length = word_length(rest).max(letter.len_utf8());
                tokens.push(Token::Word(rest[..length].to_owned()));
                length
            }
        };
        rest = &rest[length..];
    }
    tokens
}

/// A text between two quotes or two pairs of quotes, and its length with these. `\\\\` is one backslash.
fn quoted_text(rest: &str) -> (String, usize) {
    let quotes = if rest.starts_with("\"\"") { "\"\"" } else { "\"" };
    let inside = &rest[quotes.len()..];
    let end = inside.find(quotes).unwrap_or(inside.len());
    (inside[..end].replace("\\\\", "\\"), (quotes.len() * 2 + end).min(rest.len()))
}

/// The length of a name or a number; 0 for a mark. Names may have dots and dashes.
fn word_length(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let is_number = bytes.first().is_some_and(|byte| byte.is_ascii_digit() || *byte == b'-');
    let is_part = |at: usize, byte: u8| match byte {
        b'.' | b'_' => true,
        b'-' | b'+' if is_number => at == 0 || matches!(bytes.get(at - 1), Some(b'e' | b'E')),
        b'-' => at > 0,
        _ => byte.is_ascii_alphanumeric(),
    };
    bytes.iter().enumerate().take_while(|(at, byte)| is_part(*at, **byte)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = r##"
# a comment
group outer "A group"
    case first-one
        version 300 es
        require extension { "GL_A" | "GL_B" } in { vertex }
        values
        {
            input vec2 in0 = [ vec2(1.5, -2.0e1) | vec2(3.0) ];
            uniform int val[1].a = 0x10;
            output mat2 out0 = mat2(2.0);
            output bvec2 out1 = bvec2(true, false);
        }
        both ""
            #version 300 es
            a "quote" \\
        ""
    end
    case refused
        expect compile_fail
        values {}
        fragment "short"
    end
end
"##;

    #[test]
    fn cases_of_a_file() -> Result<(), String> {
        let cases = parse_cases("file", FILE)?;
        let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
        assert_eq!(names, ["file.outer.first-one", "file.outer.refused"]);
        let values = &cases[0].values;
        assert_eq!(values[0].rows, [[1.5, -20.0], [3.0, 3.0]]);
        assert_eq!((values[1].role, values[1].name.as_str()), (Role::Uniform, "val[1].a"));
        assert_eq!(values[1].rows, [[16.0]]);
        assert_eq!(values[2].rows, [[2.0, 0.0, 0.0, 2.0]]);
        assert_eq!(values[3].rows, [[1.0, 0.0]]);
        assert!(cases[0].texts[0].1.contains("a \"quote\" \\\n"));
        assert_eq!(cases[0].extensions, [("GL_A".to_owned(), vec!["vertex".to_owned()])]);
        assert_eq!(cases[1].expect, Expect::CompileFail);
        assert_eq!(cases[1].texts, [("fragment".to_owned(), "short".to_owned())]);
        Ok(())
    }

    #[test]
    fn what_is_not_known() {
        let wrong = parse_cases("file", "case a expect nothing end");
        assert_eq!(wrong, Err("file.a: `expect nothing` is not known".to_owned()));
    }

    #[test]
    fn shapes_of_types() {
        let shapes = ["float", "bvec3", "uvec2", "mat2x4", "mat3", "sampler2D"].map(shape_of);
        let expected = [(1, 1), (1, 3), (1, 2), (2, 4), (3, 3)].map(Some);
        assert_eq!(shapes[..5], expected);
        assert_eq!(shapes[5], None);
    }
}
