//! Arguments that contradict what the comment above a function says of its parameters: constants
//! outside the range, degrees where a cosine or radians are meant, lengths where a square is meant,
//! vectors that are not of unit length.
//!
//! Only functions are looked at whose comment has the library's form, with a section `Parameters:`. So
//! a function of another project never gives a warning by its name.

mod constant;
mod docs;

use lamplight_compose::Composed;
use lamplight_diagnostic::{Code, Diagnostic, Diagnostics, codes};
use lamplight_rules::{Declared, Head, Lookup, Piece, Place};
use lamplight_validate as validate;

use constant::{constant_value, length_of};
use docs::{Documented, Unit, documented};

/// What a comment on a line, or on the line above it, begins with to turn a lint off there: the names of
/// lints follow.
const ALLOW: &str = "lamplight: allow ";

/// How far from 1 the length of a constant vector may be: four digits are often written.
const LENGTH: f64 = 1e-3;

/// The arguments of a text in WGSL that contradict documentation.
pub fn contradictions(composed: &Composed) -> Diagnostics {
    if !composed.text.contains("Parameters:") && !may_have_degrees(&composed.text) {
        return Diagnostics::new();
    }
    validate::on_large_stack(|| contradictions_of(composed))
}

fn may_have_degrees(text: &str) -> bool {
    ANGLES.iter().any(|name| text.contains(&format!("{name}(")))
}

/// The heads of functions that have documentation of their parameters, with it.
fn documented_heads<'t>(text: &str, lookup: &Lookup<'t>) -> Vec<(Head<'t>, String)> {
    let heads = lookup.heads().into_iter();
    heads
        .map(|head| (comment_above(text, head.place), head))
        .filter(|(comment, _)| comment.contains("Parameters:"))
        .map(|(comment, head)| (head, comment))
        .collect()
}

/// What documentation says of a parameter that is a number.
#[derive(Debug, Clone, PartialEq)]
pub struct DocumentedParameter {
    /// The function's name in the text.
    pub function: String,
    /// The parameter's name.
    pub name: String,
    /// The words, as they stand.
    pub words: String,
    /// The least and the largest value.
    pub range: [f64; 2],
    /// Whether the least value is outside itself.
    pub is_open: bool,
}

impl DocumentedParameter {
    /// Whether a value is in the range.
    pub fn has(&self, value: f64) -> bool {
        let [least, most] = self.range;
        docs::Range { least, most, is_open: self.is_open }.has(value)
    }
}

/// The parameters of a text in WGSL of which documentation gives the range.
pub fn documented_parameters(text: &str) -> Vec<DocumentedParameter> {
    if !text.contains("Parameters:") {
        return Vec::new();
    }
    validate::on_large_stack(|| {
        let Some(lookup) = Lookup::read(text) else { return Vec::new() };
        let mut found = Vec::new();
        for (head, comment) in documented_heads(text, &lookup) {
            for parameter in &head.parameters {
                let of = documented(&comment, parameter.name);
                let Some(Documented { words, range, unit, .. }) = of else { continue };
                // That a number is a cosine is a range too.
                let cosines = docs::Range { least: -1.0, most: 1.0, is_open: false };
                let range = range.or((unit == Some(Unit::Cosine)).then_some(cosines));
                let Some(range) = range else { continue };
                found.push(DocumentedParameter {
                    function: head.name.to_owned(),
                    name: parameter.name.to_owned(),
                    words,
                    range: [range.least, range.most],
                    is_open: range.is_open,
                });
            }
        }
        found
    })
}

fn contradictions_of(composed: &Composed) -> Diagnostics {
    let text = &composed.text;
    let Some(lookup) = Lookup::read(text) else { return Diagnostics::new() };
    let heads = documented_heads(text, &lookup);
    let mut found = Diagnostics::new();
    for (place, name, arguments) in lookup.calls() {
        let call = Call { composed, lookup: &lookup, name, arguments: &arguments };
        found.extend(call.angle().filter(|_| !is_allowed(text, place, "argument-unit")));
        let Some((head, comment)) = heads.iter().find(|(head, _)| head.name == name) else {
            continue;
        };
        let own = call.of_documented(head, comment);
        found.extend(own.into_iter().filter(|one| !is_allowed(text, place, one.code.name)));
    }
    found
}

/// The lines of documentation above a function.
fn comment_above(text: &str, name: Place) -> String {
    let start = text[..name.start as usize].rfind('\n').map_or(0, |at| at + 1);
    let lines = text[..start].lines().rev();
    let mut comment: Vec<&str> =
        lines.take_while(|line| line.trim_start().starts_with("///")).collect();
    comment.reverse();
    comment.join("\n")
}

/// Whether a comment on the line of a place, or on the line above it, turns a lint off.
fn is_allowed(text: &str, place: Place, lint: &str) -> bool {
    let start = text[..place.start as usize].rfind('\n').map_or(0, |at| at + 1);
    let end = text[start..].find('\n').map_or(text.len(), |at| start + at);
    let before = text[..start].strip_suffix('\n').unwrap_or_default();
    let above = before.rsplit('\n').next().unwrap_or_default();
    [&text[start..end], above].into_iter().any(|line| {
        let comment = line.split_once("//").map_or("", |(_, comment)| comment);
        let names = comment.split_once(ALLOW).map_or("", |(_, names)| names);
        names.split([',', ' ']).any(|name| name == lint)
    })
}

/// Functions of the language that take an angle.
const ANGLES: [&str; 3] = ["cos", "sin", "tan"];

/// Angles in degrees that people write, and hardly mean in radians.
const DEGREES: [f64; 18] = [
    15.0, 30.0, 45.0, 60.0, 75.0, 90.0, 120.0, 135.0, 150.0, 180.0, 210.0, 225.0, 240.0, 270.0,
    300.0, 315.0, 330.0, 360.0,
];

/// A call, and the text that it is in.
struct Call<'c> {
    composed: &'c Composed,
    lookup: &'c Lookup<'c>,
    name: &'c str,
    arguments: &'c [Place],
}

impl Call<'_> {
    fn text(&self, place: Place) -> &str {
        self.composed.text.get(place.range()).unwrap_or_default()
    }

    fn constant(&self, place: Place) -> Option<f64> {
        match constant_value(&self.composed.text, self.lookup, place)?.as_slice() {
            [number] => Some(*number),
            _ => None,
        }
    }

    fn warn(&self, code: &'static Code, place: Place, message: String, label: &str) -> Diagnostic {
        let warning = Diagnostic::warning(code, message);
        match self.composed.map.lookup(place.range()) {
            Some(span) => warning.at(span, label),
            None => warning,
        }
    }

    /// `cos(30.0)`.
    fn angle(&self) -> Option<Diagnostic> {
        let ([argument], true) = (self.arguments, ANGLES.contains(&self.name)) else { return None };
        let value = self.constant(*argument)?;
        if !DEGREES.contains(&value.abs())
            || !self.text(*argument).contains(|one: char| one.is_ascii_digit())
        {
            return None;
        }
        let (name, text) = (self.name, self.text(*argument));
        let message = format!("`{name}` takes radians, and `{text}` looks like degrees");
        let warning = self.warn(codes::ARGUMENT_UNIT, *argument, message, "degrees?");
        Some(allowing(warning.note(format!("help: write `{name}(radians({text}))`"))))
    }

    fn of_documented(&self, head: &Head<'_>, comment: &str) -> Diagnostics {
        let parameters = head.parameters.iter().zip(self.arguments);
        let mut found = Diagnostics::new();
        for (parameter, argument) in parameters {
            let Some(documented) = documented(comment, parameter.name) else { continue };
            let one = self
                .unit(parameter, *argument, &documented)
                .or_else(|| self.range(parameter, *argument, &documented))
                .or_else(|| self.order(head, parameter, *argument, &documented))
                .or_else(|| self.length(parameter, *argument, &documented));
            found.extend(one.map(|one| {
                let documented = format!("documented: `{}` {}", parameter.name, documented.words);
                allowing(one.note(documented))
            }));
        }
        found
    }

    /// A number of another unit.
    fn unit(
        &self,
        parameter: &Declared<'_>,
        argument: Place,
        documented: &Documented,
    ) -> Option<Diagnostic> {
        let (message, help) = self.other_unit(argument, documented.unit?)?;
        let label = format!("given for `{}`", parameter.name);
        let warning = self.warn(codes::ARGUMENT_UNIT, argument, message, &label);
        Some(warning.note(format!("help: write `{help}`")))
    }

    /// What is wrong with an argument that should have a unit, and what to write.
    fn other_unit(&self, argument: Place, unit: Unit) -> Option<(String, String)> {
        let text = self.text(argument);
        Some(match unit {
            Unit::Cosine => {
                let value = self.constant(argument).filter(|value| value.abs() > 1.0)?;
                let help = match DEGREES.contains(&value.abs()) || value.abs() > 7.0 {
                    true => format!("cos(radians({text}))"),
                    false => format!("cos({text})"),
                };
                (format!("a cosine is in [-1, 1], and `{text}` is not one"), help)
            }
            Unit::Radians => match self.called(argument, "degrees") {
                Some(inner) => (format!("radians are meant, and `{text}` are degrees"), inner),
                None => {
                    self.constant(argument).filter(|value| DEGREES.contains(&value.abs()))?;
                    let message = format!("radians are meant, and `{text}` looks like degrees");
                    (message, format!("radians({text})"))
                }
            },
            Unit::Degrees => {
                let inner = self.called(argument, "radians")?;
                (format!("degrees are meant, and `{text}` are radians"), inner)
            }
            Unit::SquaredDistance => {
                let squared = self.squared(argument)?;
                (format!("the square of a distance is meant, and `{text}` is a distance"), squared)
            }
            Unit::Distance => {
                let vector = self.squared_vector(argument)?;
                (
                    format!("a distance is meant, and `{text}` is a square"),
                    format!("length({vector})"),
                )
            }
        })
    }

    /// The vector whose square an argument is.
    fn squared_vector(&self, argument: Place) -> Option<&str> {
        let Piece::Call { name: "dot", arguments } = self.followed(argument)? else { return None };
        let [one, other] = arguments.as_slice() else { return None };
        (self.text(*one) == self.text(*other)).then(|| self.text(*one))
    }

    /// What an argument is, if it is a name that a `let` declares.
    fn followed(&self, argument: Place) -> Option<Piece<'_>> {
        self.piece_followed(argument).map(|(_, piece)| piece)
    }

    fn piece_followed(&self, argument: Place) -> Option<(Place, Piece<'_>)> {
        let piece = self.lookup.piece(&argument.range())?;
        match piece {
            Piece::Name(name) => match self.lookup.declared(name, argument.start as usize)? {
                Declared { keyword: "let", value: Some(value), .. } => {
                    Some((value, self.lookup.piece(&value.range())?))
                }
                _ => Some((argument, piece)),
            },
            Piece::Parenthesized(inner) => Some((inner, self.lookup.piece(&inner.range())?)),
            piece => Some((argument, piece)),
        }
    }

    /// The argument of the function that an argument calls.
    fn called(&self, argument: Place, function: &str) -> Option<String> {
        match self.followed(argument)? {
            Piece::Call { name, arguments } if name == function => {
                arguments.first().map(|one| self.text(*one).to_owned())
            }
            _ => None,
        }
    }

    /// The square of a length.
    fn squared(&self, argument: Place) -> Option<String> {
        let Piece::Call { name, arguments } = self.followed(argument)? else { return None };
        match (name, arguments.as_slice()) {
            ("length", [vector]) => {
                let vector = self.text(*vector);
                Some(format!("dot({vector}, {vector})"))
            }
            ("distance", [_, _]) => {
                let text = self.text(argument);
                Some(format!("{text} * {text}"))
            }
            _ => None,
        }
    }

    /// A constant outside the range.
    fn range(
        &self,
        parameter: &Declared<'_>,
        argument: Place,
        documented: &Documented,
    ) -> Option<Diagnostic> {
        let range = documented.range?;
        let values = constant_value(&self.composed.text, self.lookup, argument)?;
        let outside = values.into_iter().find(|value| !range.has(*value))?;
        let text = self.text(argument);
        let message = format!(
            "`{}` of `{}` is {}, and `{text}` is not",
            parameter.name,
            self.name,
            range.text()
        );
        let label = format!("given for `{}`", parameter.name);
        let warning = self.warn(codes::ARGUMENT_RANGE, argument, message, &label);
        let nearest = outside.clamp(range.least, range.most);
        Some(match range.is_open && nearest == range.least {
            true => warning.note(format!("help: write a number above {nearest}")),
            false => warning.note(format!("help: the nearest value is `{nearest:?}`")),
        })
    }

    /// A constant that is not above the one that it must be above.
    fn order(
        &self,
        head: &Head<'_>,
        parameter: &Declared<'_>,
        argument: Place,
        documented: &Documented,
    ) -> Option<Diagnostic> {
        let other = documented.above.as_deref()?;
        let at = head.parameters.iter().position(|one| one.name == other)?;
        let below = *self.arguments.get(at)?;
        if self.constant(argument)? > self.constant(below)? {
            return None;
        }
        let (text, less) = (self.text(argument), self.text(below));
        let message = format!("`{}` must be above `{other}`, and is not", parameter.name);
        let label = format!("given for `{}`", parameter.name);
        let warning = self.warn(codes::ARGUMENT_RANGE, argument, message, &label);
        Some(warning.note(format!("help: exchange `{text}` and `{less}`")))
    }

    /// A vector that is not of length 1: a constant one, or the difference of two positions.
    fn length(
        &self,
        parameter: &Declared<'_>,
        argument: Place,
        documented: &Documented,
    ) -> Option<Diagnostic> {
        let is_vector = parameter.of_type.is_some_and(|of| self.text(of).starts_with("vec"));
        if !documented.is_unit || !is_vector {
            return None;
        }
        let text = self.text(argument);
        let label = format!("given for `{}`", parameter.name);
        let message = match constant_value(&self.composed.text, self.lookup, argument) {
            Some(values) if values.len() == 3 && (length_of(&values) - 1.0).abs() > LENGTH => {
                format!("`{}` has length 1, and `{text}` has not", parameter.name)
            }
            Some(_) => return None,
            None => {
                let (place, piece) = self.piece_followed(argument)?;
                let Piece::Binary { operator: "-", left, right } = piece else { return None };
                if !self.is_position(left) || !self.is_position(right) {
                    return None;
                }
                let difference = self.text(place);
                format!("`{}` has length 1, and `{difference}` is a difference", parameter.name)
            }
        };
        let warning = self.warn(codes::ARGUMENT_LENGTH, argument, message, &label);
        let is_zero = constant_value(&self.composed.text, self.lookup, argument)
            .is_some_and(|values| length_of(&values) == 0.0);
        Some(match is_zero {
            true => warning.note("help: a vector of zeros has no direction"),
            false => warning.note(format!("help: write `normalize({text})`")),
        })
    }

    /// A name or a member: a product may be what makes a difference a unit vector, as in a reflection.
    fn is_position(&self, place: Place) -> bool {
        match self.lookup.piece(&place.range()) {
            Some(Piece::Name(_)) => true,
            Some(Piece::Member { base, .. } | Piece::Index { base, .. }) => self.is_position(base),
            _ => false,
        }
    }
}

fn allowing(warning: Diagnostic) -> Diagnostic {
    let name = warning.code.name;
    warning.note(format!("`// {ALLOW}{name}` on this line or the one above turns it off"))
}
