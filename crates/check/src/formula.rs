//! The small language of case files: f64 formulas over the parameters of a function.
//!
//! Numbers, parameters by path (`light.kind`, `n.x`), `+ - * /`, comparisons and `&&`, `||` (1 or
//! 0), parentheses, and the functions of [`FUNCTIONS`]. An operation between a vector and a scalar
//! is done for each component. Formulas say where a comparison is too close to call (`near`), which
//! inputs are kept (`where`), what an error grows with (`scaled`), and what is expected
//! (`formula`). The functions are the numeric built-in functions of WGSL in f64, and `dot_abs` and
//! `vec`.

use lamplight_diagnostic::{Diagnostic, codes, nearest_name};
use lamplight_execute::kernel::TypeShape;
use lamplight_files::limits::{FORMULA_NESTING, FORMULA_PARTS};
use lamplight_syntax::words::{begins_word, continues_word, number_end};
use std::ops::Range;

/// A formula whose names are resolved to words of a row.
#[derive(Debug, Clone)]
pub enum Formula {
    Number(f64),
    /// First word and count.
    Words(usize, usize),
    Negated(Box<Formula>),
    Binary(&'static Operator, Box<Formula>, Box<Formula>),
    Call(&'static FormulaFunction, Vec<Formula>),
}

/// A binary operator: spelling, precedence, meaning.
type Operator = (&'static str, u8, fn(f64, f64) -> f64);

/// An operator stands before those that it begins with: `<=` before `<`.
const OPERATORS: &[Operator] = &[
    ("||", 1, |a, b| truth_value(a != 0.0 || b != 0.0)),
    ("&&", 2, |a, b| truth_value(a != 0.0 && b != 0.0)),
    ("<=", 3, |a, b| truth_value(a <= b)),
    (">=", 3, |a, b| truth_value(a >= b)),
    ("==", 3, |a, b| truth_value(a == b)),
    ("!=", 3, |a, b| truth_value(a != b)),
    ("<", 3, |a, b| truth_value(a < b)),
    (">", 3, |a, b| truth_value(a > b)),
    ("+", 4, |a, b| a + b),
    ("-", 4, |a, b| a - b),
    ("*", 5, |a, b| a * b),
    ("/", 5, |a, b| a / b),
];

/// A function that formulas may call.
#[derive(Debug)]
pub struct FormulaFunction {
    pub name: &'static str,
    /// Number of arguments; `None` for any, at least one.
    arity: Option<usize>,
    apply: fn(&[Vec<f64>]) -> Vec<f64>,
}

/// Every function, by name.
pub const FUNCTIONS: &[FormulaFunction] = ALL;

/// Why a text is not a formula, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mistake {
    /// Bytes of the text.
    pub range: Range<usize>,
    pub message: String,
    /// What would have been accepted.
    pub note: Option<String>,
}

impl From<(Range<usize>, String)> for Mistake {
    fn from((range, message): (Range<usize>, String)) -> Self {
        Self { range, message, note: None }
    }
}

impl Formula {
    /// Parses a text over named parameters.
    pub fn parse(text: &str, scope: &Scope<'_>) -> Result<Self, Mistake> {
        let mut parser = FormulaParser { text, at: 0, depth: 0, parts: 0, scope };
        let formula = parser.binary(0)?;
        parser.skip();
        if parser.at < text.len() {
            return Err(
                (parser.at..text.len(), "unexpected text after the formula".to_owned()).into()
            );
        }
        Ok(formula)
    }

    /// The components of the value for one row of words.
    pub fn eval(&self, row: &[f64]) -> Vec<f64> {
        match self {
            Self::Number(value) => vec![*value],
            Self::Words(first, count) => row[*first..first + count].to_vec(),
            Self::Negated(inner) => map_components(&inner.eval(row), |x| -x),
            Self::Binary(operator, left, right) => {
                zip_components(&left.eval(row), &right.eval(row), operator.2)
            }
            Self::Call(function, arguments) => (function.apply)(
                &arguments.iter().map(|argument| argument.eval(row)).collect::<Vec<_>>(),
            ),
        }
    }

    /// How many steps its evaluation takes.
    pub fn parts(&self) -> usize {
        match self {
            Self::Number(_) => 1,
            Self::Words(_, count) => 1 + count,
            Self::Negated(inner) => 1 + inner.parts(),
            Self::Binary(_, left, right) => 1 + left.parts() + right.parts(),
            Self::Call(_, arguments) => 1 + arguments.iter().map(Self::parts).sum::<usize>(),
        }
    }

    /// The first component of the value for one row of words.
    pub fn scalar(&self, row: &[f64]) -> f64 {
        self.eval(row).first().copied().unwrap_or(f64::NAN)
    }
}

/// Names and shapes of the parameters, in the order of their words in a row.
pub struct Scope<'a>(pub Vec<(&'a str, &'a TypeShape)>);

impl Scope<'_> {
    /// First word and shape of a path.
    pub fn find(&self, path: &[String]) -> Option<(usize, &TypeShape)> {
        let (name, rest) = path.split_first()?;
        let index = self.0.iter().position(|(known, _)| known == name)?;
        let first: u32 = self.0[..index].iter().map(|(_, shape)| shape.words()).sum();
        let (offset, part) = self.0[index].1.part(rest)?;
        Some(((first + offset) as usize, part))
    }

    /// First word and count of a path, which may end in a vector's component.
    fn words(&self, path: &[String]) -> Option<(usize, usize)> {
        if let Some((first, shape)) = self.find(path) {
            return Some((first, shape.words() as usize));
        }
        let (last, rest) = path.split_last()?;
        let index = "xyzw"
            .find(last.as_str())
            .or_else(|| "rgba".find(last.as_str()))
            .filter(|_| last.len() == 1)?;
        match self.find(rest)? {
            (first, TypeShape::Vector { size, .. }) if index < *size as usize => {
                Some((first + index, 1))
            }
            _ => None,
        }
    }

    /// An error for a path that is not there.
    pub fn unknown(&self, path: &str) -> Diagnostic {
        let names: Vec<_> = self.0.iter().map(|(name, _)| format!("`{name}`")).collect();
        Diagnostic::error(codes::CASE_INVALID, format!("the function has no parameter `{path}`"))
            .note(format!("its parameters are {}", names.join(", ")))
            .suggest(path, self.0.iter().map(|(name, _)| *name))
    }
}

struct FormulaParser<'a> {
    text: &'a str,
    at: usize,
    /// How deeply parentheses and operands nest here.
    depth: usize,
    /// How many operands and signs there are so far. This bounds the depth of the formula, which a
    /// chain of operators makes deep without nesting.
    parts: usize,
    scope: &'a Scope<'a>,
}

type ParsedFormula = Result<Formula, Mistake>;

impl FormulaParser<'_> {
    fn binary(&mut self, weakest: u8) -> ParsedFormula {
        self.depth += 1;
        if self.depth > FORMULA_NESTING {
            return Err((self.at..self.at, "the formula is nested too deeply".to_owned()).into());
        }
        let mut left = self.unary()?;
        while let Some(operator) = self.operator(weakest) {
            self.at += operator.0.len();
            left =
                Formula::Binary(operator, Box::new(left), Box::new(self.binary(operator.1 + 1)?));
        }
        self.depth -= 1;
        Ok(left)
    }

    fn operator(&mut self, weakest: u8) -> Option<&'static Operator> {
        self.skip();
        let rest = &self.text[self.at..];
        OPERATORS
            .iter()
            .find(|operator| rest.starts_with(operator.0))
            .filter(|operator| operator.1 >= weakest)
    }

    fn unary(&mut self) -> ParsedFormula {
        self.skip();
        self.parts += 1;
        if self.parts > FORMULA_PARTS {
            let message = format!("the formula has more than {FORMULA_PARTS} signs and operands");
            return Err((self.at..self.at, message).into());
        }
        match self.text[self.at..].chars().next() {
            Some('-') => {
                self.at += 1;
                Ok(Formula::Negated(Box::new(self.unary()?)))
            }
            Some('(') => {
                self.at += 1;
                let inner = self.binary(0)?;
                self.expect(')').map(|()| inner)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if begins_word(c) => self.name(),
            _ => Err((
                self.at..self.text.len(),
                "expected a number, a parameter or a function".to_owned(),
            )
                .into()),
        }
    }

    fn number(&mut self) -> ParsedFormula {
        let range = self.at..number_end(self.text, self.at);
        self.at = range.end;
        let text = &self.text[range.clone()];
        let number = text.parse().map(Formula::Number);
        number.map_err(|_| (range, format!("`{text}` is not a number")).into())
    }

    fn name(&mut self) -> ParsedFormula {
        let rest = &self.text[self.at..];
        let end = rest.find(|c: char| !(continues_word(c) || c == '.')).unwrap_or(rest.len());
        let (name, range) = (&rest[..end], self.at..self.at + end);
        self.at += end;
        self.skip();
        if self.text[self.at..].starts_with('(') {
            return self.call(name, range);
        }
        let path: Vec<String> = name.split('.').map(str::to_owned).collect();
        self.scope.words(&path).map(|(first, count)| Formula::Words(first, count)).ok_or_else(
            || {
                let known = nearest_name(name, self.scope.0.iter().map(|(name, _)| *name));
                (
                    range,
                    format!(
                        "there is no parameter `{name}`{}",
                        known.map_or(String::new(), |known| format!("; did you mean `{known}`?"))
                    ),
                )
                    .into()
            },
        )
    }

    fn call(&mut self, name: &str, range: Range<usize>) -> ParsedFormula {
        let Some(function) = FUNCTIONS.iter().find(|function| function.name == name) else {
            let known = nearest_name(name, FUNCTIONS.iter().map(|function| function.name));
            let known = known.map_or(String::new(), |known| format!("; did you mean `{known}`?"));
            let names: Vec<&str> = FUNCTIONS.iter().map(|function| function.name).collect();
            return Err(Mistake {
                range,
                message: format!("there is no function `{name}`{known}"),
                note: Some(format!("functions are {}", names.join(", "))),
            });
        };
        self.at += 1;
        let mut arguments = vec![self.binary(0)?];
        while self.expect(',').is_ok() {
            arguments.push(self.binary(0)?);
        }
        self.expect(')')?;
        match function.arity {
            Some(arity) if arity != arguments.len() => {
                Err((range, format!("`{name}` takes {arity} arguments, not {}", arguments.len()))
                    .into())
            }
            _ => Ok(Formula::Call(function, arguments)),
        }
    }

    fn expect(&mut self, wanted: char) -> Result<(), Mistake> {
        self.skip();
        if !self.text[self.at..].starts_with(wanted) {
            return Err((self.at..self.text.len(), format!("expected `{wanted}`")).into());
        }
        self.at += wanted.len_utf8();
        Ok(())
    }

    fn skip(&mut self) {
        self.at = self.text.len() - self.text[self.at..].trim_start().len();
    }
}

fn truth_value(value: bool) -> f64 {
    f64::from(u8::from(value))
}

fn map_components(a: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
    a.iter().map(|x| f(*x)).collect()
}

/// Applies `f` to each component. A scalar is used for every component. Of two vectors the shorter
/// one decides how many components there are.
fn zip_components(a: &[f64], b: &[f64], f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let count = match (a.len(), b.len()) {
        (1, n) | (n, 1) => n,
        (n, m) => n.min(m),
    };
    let pick = |v: &[f64], i: usize| v[if v.len() == 1 { 0 } else { i }];
    (0..count).map(|i| f(pick(a, i), pick(b, i))).collect()
}

const fn make_function(
    name: &'static str,
    arity: usize,
    apply: fn(&[Vec<f64>]) -> Vec<f64>,
) -> FormulaFunction {
    FormulaFunction { name, arity: Some(arity), apply }
}

/// Every function, by name.
const ALL: &[FormulaFunction] = &[
    make_function("abs", 1, |a| map_components(&a[0], f64::abs)),
    make_function("acos", 1, |a| map_components(&a[0], f64::acos)),
    make_function("asin", 1, |a| map_components(&a[0], f64::asin)),
    make_function("atan", 1, |a| map_components(&a[0], f64::atan)),
    make_function("atan2", 2, |a| zip_components(&a[0], &a[1], f64::atan2)),
    make_function("ceil", 1, |a| map_components(&a[0], f64::ceil)),
    make_function("clamp", 3, |a| {
        zip_components(&zip_components(&a[0], &a[1], f64::max), &a[2], f64::min)
    }),
    make_function("cos", 1, |a| map_components(&a[0], f64::cos)),
    make_function("cosh", 1, |a| map_components(&a[0], f64::cosh)),
    make_function("cross", 2, |a| cross(&a[0], &a[1])),
    make_function("degrees", 1, |a| map_components(&a[0], f64::to_degrees)),
    make_function("distance", 2, |a| vec![length(&minus(&a[0], &a[1]))]),
    make_function("dot", 2, |a| vec![times(&a[0], &a[1]).iter().sum()]),
    make_function("dot_abs", 2, |a| {
        vec![zip_components(&a[0], &a[1], |x, y| (x * y).abs()).iter().sum()]
    }),
    make_function("exp", 1, |a| map_components(&a[0], f64::exp)),
    make_function("exp2", 1, |a| map_components(&a[0], f64::exp2)),
    make_function("floor", 1, |a| map_components(&a[0], f64::floor)),
    make_function("fract", 1, |a| map_components(&a[0], |x| x - x.floor())),
    make_function("inverseSqrt", 1, |a| map_components(&a[0], |x| 1.0 / x.sqrt())),
    make_function("length", 1, |a| vec![length(&a[0])]),
    make_function("log", 1, |a| map_components(&a[0], f64::ln)),
    make_function("log2", 1, |a| map_components(&a[0], f64::log2)),
    make_function("max", 2, |a| zip_components(&a[0], &a[1], f64::max)),
    make_function("min", 2, |a| zip_components(&a[0], &a[1], f64::min)),
    make_function("mix", 3, |a| mix(&a[0], &a[1], &a[2])),
    make_function("normalize", 1, |a| map_components(&a[0], |x| x / length(&a[0]))),
    make_function("pow", 2, |a| zip_components(&a[0], &a[1], f64::powf)),
    make_function("radians", 1, |a| map_components(&a[0], f64::to_radians)),
    make_function("reflect", 2, |a| reflect(&a[0], &a[1])),
    make_function("round", 1, |a| map_components(&a[0], f64::round_ties_even)),
    make_function("saturate", 1, |a| map_components(&a[0], saturate)),
    make_function("select", 3, |a| if a[2][0] != 0.0 { a[1].clone() } else { a[0].clone() }),
    make_function("sign", 1, |a| {
        map_components(&a[0], |x| if x == 0.0 { 0.0 } else { x.signum() })
    }),
    make_function("sin", 1, |a| map_components(&a[0], f64::sin)),
    make_function("sinh", 1, |a| map_components(&a[0], f64::sinh)),
    make_function("smoothstep", 3, |a| smoothstep(&a[0], &a[1], &a[2])),
    make_function("sqrt", 1, |a| map_components(&a[0], f64::sqrt)),
    make_function("step", 2, |a| {
        zip_components(&a[0], &a[1], |edge, x| f64::from(u8::from(edge <= x)))
    }),
    make_function("tan", 1, |a| map_components(&a[0], f64::tan)),
    make_function("tanh", 1, |a| map_components(&a[0], f64::tanh)),
    make_function("trunc", 1, |a| map_components(&a[0], f64::trunc)),
    FormulaFunction { name: "vec", arity: None, apply: |a| a.concat() },
];

fn minus(a: &[f64], b: &[f64]) -> Vec<f64> {
    zip_components(a, b, |x, y| x - y)
}

fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    zip_components(a, b, |x, y| x * y)
}

fn saturate(x: f64) -> f64 {
    x.clamp(0.0, 1.0)
}

fn mix(a: &[f64], b: &[f64], t: &[f64]) -> Vec<f64> {
    zip_components(&times(a, &map_components(t, |t| 1.0 - t)), &times(b, t), |x, y| x + y)
}

/// `n` must be of unit length, as in WGSL.
fn reflect(i: &[f64], n: &[f64]) -> Vec<f64> {
    let along: f64 = times(i, n).iter().sum();
    minus(i, &map_components(n, |x| 2.0 * along * x))
}

fn smoothstep(low: &[f64], high: &[f64], x: &[f64]) -> Vec<f64> {
    let t =
        zip_components(&minus(x, low), &minus(high, low), |above, width| saturate(above / width));
    map_components(&t, |t| t * t * (3.0 - 2.0 * t))
}

fn length(a: &[f64]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn cross(a: &[f64], b: &[f64]) -> Vec<f64> {
    match (a, b) {
        ([a0, a1, a2], [b0, b1, b2]) => {
            vec![a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0]
        }
        _ => vec![f64::NAN; 3],
    }
}
