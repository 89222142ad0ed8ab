//! Dense keys that never change: a lock file keeps the ordinal of every axis and value there
//! ever was.
//!
//! ```text
//! # Ordinals of axes and values. Commit this file; lines are only ever appended.
//! forward max_lights 4 1 10
//! forward shadow none hard vsm
//! forward two_sided false true
//! forward shadow + evsm
//! ```
//!
//! A line is one digit of the mixed-radix number that a point of the program is; the program's
//! first line is the least significant. The digit 0 of an axis's first line is its default when the
//! axis was added, so the points that existed before keep their numbers. Values that are added
//! later (`+`) are a digit of their own, in which 0 means "none of these". So no earlier radix
//! changes. Axes and values that no longer exist keep their digits.

use std::collections::BTreeMap;
use std::fmt;

use super::Setting;
use super::axis::Axis;
use super::key::Assignment;
use super::space::Space;
use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

const HEADER: &str =
    "# Ordinals of axes and values. Commit this file; lines are only ever appended.";

/// The digits of every program.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Lock {
    lines: Vec<LockDigit>,
}

/// One line of the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LockDigit {
    program: String,
    pub axis: String,
    /// Whether the digit 0 means none of these values, rather than the first.
    added: bool,
    values: Vec<Setting>,
}

impl LockDigit {
    pub fn radix(&self) -> u128 {
        self.values.len() as u128 + u128::from(self.added)
    }

    /// The digit's value where the axis has that setting; 0 where it is not one of these.
    fn of(&self, setting: &Setting) -> u128 {
        self.values
            .iter()
            .position(|known| known == setting)
            .map_or(0, |place| place as u128 + u128::from(self.added))
    }

    /// The setting that a value of the digit stands for.
    pub fn setting(&self, digit: u128) -> Option<&Setting> {
        self.values.get(usize::try_from(digit.checked_sub(u128::from(self.added))?).ok()?)
    }
}

/// Reads a lock file that is in the set.
pub fn parse(sources: &SourceSet, id: SourceId) -> Result<Lock, Diagnostics> {
    let mut lock = Lock::default();
    let mut problems = Vec::new();
    let mut start = 0;
    for line in sources.get(id).text.split_inclusive('\n') {
        let text = line.trim();
        let span = Span::new(id, start..start + line.trim_end().len());
        start += line.len();
        if text.is_empty() || text.starts_with('#') {
            continue;
        }
        match read_digit(&lock, text) {
            Ok(digit) => lock.lines.push(digit),
            Err(message) => problems
                .push(Diagnostic::error(codes::LOCK_SYNTAX, message).at(span, "in this line")),
        }
    }
    if problems.is_empty() { Ok(lock) } else { Err(problems) }
}

fn read_digit(before: &Lock, line: &str) -> Result<LockDigit, String> {
    let mut words = line.split_whitespace();
    let (Some(program), Some(axis)) = (words.next(), words.next()) else {
        return Err("expected `PROGRAM AXIS VALUES`".to_owned());
    };
    let mut words = words.peekable();
    let added = words.next_if_eq(&"+").is_some();
    let values: Vec<Setting> = words.map(Setting::parse).collect();
    let mut known: Vec<&Setting> = before
        .digits(program)
        .filter(|(_, digit)| digit.axis == axis)
        .flat_map(|(_, digit)| &digit.values)
        .collect();
    if added == known.is_empty() {
        return Err(if added {
            format!("axis `{axis}` has no line before this one")
        } else {
            format!("axis `{axis}` has a line already; values are added with `+`")
        });
    }
    known.extend(&values);
    let twice = (1..known.len())
        .find(|at| known[..*at].contains(&known[*at]))
        .map(|at| known[at].to_string());
    match twice {
        Some(value) => Err(format!("axis `{axis}` has the value `{value}` twice")),
        None if values.is_empty() => Err(format!("axis `{axis}` has no values here")),
        None => Ok(LockDigit { program: program.to_owned(), axis: axis.to_owned(), added, values }),
    }
}

impl Lock {
    /// Whether it has an axis of the program.
    pub fn has(&self, program: &str) -> bool {
        self.lines.iter().any(|line| line.program == program)
    }

    /// The lock with whatever of the program's axes and values it lacks appended.
    pub fn extended(&self, program: &str, space: &Space) -> Self {
        let mut lock = self.clone();
        for axis in space.axes() {
            let known: Vec<&Setting> = self
                .digits(program)
                .filter(|(_, digit)| digit.axis == axis.name)
                .flat_map(|(_, digit)| &digit.values)
                .collect();
            let values: Vec<Setting> =
                in_order(axis).filter(|value| !known.contains(value)).cloned().collect();
            if !values.is_empty() {
                lock.lines.push(LockDigit {
                    program: program.to_owned(),
                    axis: axis.name.clone(),
                    added: !known.is_empty(),
                    values,
                });
            }
        }
        lock
    }

    /// The number of a point. `None` if the lock lacks one of its values (extend it first) or
    /// has more digits than fit.
    pub fn dense(&self, program: &str, space: &Space, point: &Assignment) -> Option<u128> {
        let settings: BTreeMap<&str, &Setting> = space
            .axes()
            .iter()
            .enumerate()
            .map(|(index, axis)| (axis.name.as_str(), space.value(index, point)))
            .collect();
        let mut placed = 0;
        let mut dense = 0u128;
        for (weight, digit) in self.digits(program) {
            let Some(setting) = settings.get(digit.axis.as_str()) else { continue };
            placed += usize::from(digit.values.contains(setting));
            dense = digit.of(setting).checked_mul(weight?)?.checked_add(dense)?;
        }
        (placed == settings.len()).then_some(dense)
    }

    /// The point with a number. `None` if there is no such point, or if one of its axes or values
    /// no longer exists.
    pub fn point(&self, program: &str, space: &Space, dense: u128) -> Option<Assignment> {
        let mut settings: BTreeMap<&str, &Setting> = BTreeMap::new();
        let mut covered = Some(1);
        for (weight, digit) in self.digits(program) {
            let value = dense / weight? % digit.radix();
            covered = weight?.checked_mul(digit.radix());
            if value > 0 || !digit.added {
                settings.insert(&digit.axis, digit.setting(value)?);
            }
        }
        if covered.is_some_and(|covered| dense >= covered) {
            return None;
        }
        let ordinals = space
            .axes()
            .iter()
            .map(|axis| Some(axis.ordinal(settings.get(axis.name.as_str())?)? as u8));
        let point = Assignment(ordinals.collect::<Option<_>>()?);
        (self.dense(program, space, &point) == Some(dense)).then_some(point)
    }

    /// The digits of a program with their weights; `None` for a weight beyond 128 bits.
    pub fn digits<'a>(
        &'a self,
        program: &'a str,
    ) -> impl Iterator<Item = (Option<u128>, &'a LockDigit)> {
        self.lines.iter().filter(move |digit| digit.program == program).scan(
            Some(1u128),
            |weight, digit| {
                let own = *weight;
                *weight = own.and_then(|own| own.checked_mul(digit.radix()));
                Some((own, digit))
            },
        )
    }
}

/// The values of an axis, its default first.
fn in_order(axis: &Axis) -> impl Iterator<Item = &Setting> {
    let default = &axis.values[axis.default];
    std::iter::once(default).chain(axis.values.iter().filter(move |value| *value != default))
}

impl fmt::Display for Lock {
    /// The text of the file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{HEADER}")?;
        for LockDigit { program, axis, added, values } in &self.lines {
            let values: Vec<String> = values.iter().map(ToString::to_string).collect();
            writeln!(f, "{program} {axis}{} {}", if *added { " +" } else { "" }, values.join(" "))?;
        }
        Ok(())
    }
}
