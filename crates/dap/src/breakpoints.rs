//! Breakpoints: lines, conditions, counts of hits, and marks.

use lamplight_debug::{Expressions, Halt, Seen, StatementId};
use lamplight_diagnostic::source::SourceId;
use serde_json::{Value, json};

use crate::answer::{Failed, Host, Turn};
use crate::numbers::{Counting, number_of};
use crate::present::flat_text;
use crate::session::{Running, Session};
use crate::texts::AskedText;

/// The most breakpoints of one text.
const MOST: usize = 1000;

/// What the client wants in one text.
#[derive(Debug, Clone)]
pub(crate) struct Asked {
    text: AskedText,
    /// Each with its number.
    breakpoints: Vec<(i64, Value)>,
}

/// A breakpoint at a statement.
#[derive(Debug, Clone)]
pub(crate) struct Breakpoint {
    pub id: i64,
    pub line: u32,
    source: SourceId,
    statement: StatementId,
    condition: Option<String>,
    hits: Option<Hits>,
    /// What is printed in the place of a stop.
    log: Option<String>,
}

/// What a breakpoint does where the run is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Effect {
    /// Nothing.
    None,
    /// It stops the run.
    Stop,
    /// It prints this, and the run goes on.
    Print(String),
}

/// After how many runs of its line a breakpoint stops.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hits {
    Exactly(u32),
    Above(u32),
    AtLeast(u32),
    Below(u32),
    AtMost(u32),
    Each(u32),
}

impl Hits {
    /// `5`, `== 5`, `> 5`, `>= 5`, `< 5`, `<= 5` or `% 5`.
    fn read(text: &str) -> Result<Self, Failed> {
        let text = text.trim();
        type Form = (&'static str, fn(u32) -> Hits);
        const FORMS: [Form; 7] = [
            ("==", Hits::Exactly),
            (">=", Hits::AtLeast),
            ("<=", Hits::AtMost),
            (">", Hits::Above),
            ("<", Hits::Below),
            ("=", Hits::Exactly),
            ("%", Hits::Each),
        ];
        let form = FORMS.iter().find_map(|(sign, make)| Some((text.strip_prefix(sign)?, *make)));
        let (number, make) = form.unwrap_or((text, Hits::Exactly));
        let number: Option<u32> = number.trim().parse().ok();
        match number.map(make) {
            None | Some(Self::Each(0)) => Err(format!(
                "`{text}` is no count of hits: expected a number, or one after `>`, `>=`, `<`, `<=` or `%`"
            )),
            Some(hits) => Ok(hits),
        }
    }

    fn meets(self, runs: u32) -> bool {
        match self {
            Self::Exactly(wanted) => runs == wanted,
            Self::Above(wanted) => runs > wanted,
            Self::AtLeast(wanted) => runs >= wanted,
            Self::Below(wanted) => runs < wanted,
            Self::AtMost(wanted) => runs <= wanted,
            Self::Each(wanted) => runs.is_multiple_of(wanted),
        }
    }
}

impl Breakpoint {
    /// What it does where the run is.
    ///
    /// # Errors
    /// Why its condition has no value, in words.
    pub fn effect(&self, seen: &Seen<'_>, expressions: &mut Expressions) -> Result<Effect, Failed> {
        let is_here =
            *seen.place.halt() == Halt::Statement && seen.place.statement() == Some(self.statement);
        if !is_here || self.hits.is_some_and(|hits| !hits.meets(seen.place.runs(self.statement))) {
            return Ok(Effect::None);
        }
        let Some(frame) = seen.place.frames().last() else { return Ok(Effect::None) };
        let frame = (frame.function, frame.statement);
        if let Some(condition) = &self.condition
            && !expressions.holds(seen, frame, condition)?
        {
            return Ok(Effect::None);
        }
        let print = |log| logged(log, |text| expressions.value(seen, frame, text));
        Ok(self.log.as_deref().map(print).map_or(Effect::Stop, Effect::Print))
    }
}

/// A message in which expressions in braces are replaced by their values.
fn logged(
    text: &str,
    mut value: impl FnMut(&str) -> Result<lamplight_debug::Value, String>,
) -> String {
    let (mut out, mut rest) = (String::new(), text);
    while let Some((before, after)) = rest.split_once('{') {
        let Some((expression, behind)) = after.split_once('}') else { break };
        out += before;
        out += &match value(expression) {
            Ok(value) => flat_text(&value),
            Err(words) => format!("{{{expression}: {words}}}"),
        };
        rest = behind;
    }
    out + rest
}

impl Session {
    pub fn set_breakpoints(&mut self, turn: &mut Turn<'_>) -> Result<Value, Failed> {
        let text = turn.asked_text()?;
        let wanted = turn.arguments.get("breakpoints").and_then(Value::as_array);
        let wanted = wanted.map_or(&[][..], Vec::as_slice);
        if wanted.len() > MOST {
            return Err(format!("one text has at most {MOST} breakpoints"));
        }
        let mut breakpoints = Vec::new();
        for one in wanted {
            self.numbered += 1;
            breakpoints.push((self.numbered, one.clone()));
        }
        let is_same = |one: &Asked| one.text.is_same(&text, turn.host);
        let old: Vec<Asked> = self.asked.iter().filter(|one| is_same(one)).cloned().collect();
        self.asked.retain(|one| !is_same(one));
        let numbers: Vec<i64> =
            old.iter().flat_map(|one| &one.breakpoints).map(|(id, _)| *id).collect();
        self.breakpoints.retain(|one| !numbers.contains(&one.id));
        let asked = Asked { text, breakpoints };
        let answers = self.verify(&asked, turn.host);
        self.asked.push(asked);
        Ok(json!({ "breakpoints": answers }))
    }

    /// Finds the places of what was asked for before there was a run.
    pub fn verify_earlier(&mut self, turn: &mut Turn<'_>) {
        self.breakpoints.clear();
        let asked = std::mem::take(&mut self.asked);
        for one in &asked {
            for answer in self.verify(one, turn.host) {
                turn.event("breakpoint", json!({ "reason": "changed", "breakpoint": answer }));
            }
        }
        self.asked = asked;
    }

    fn verify(&mut self, asked: &Asked, host: &dyn Host) -> Vec<Value> {
        let mut answers = Vec::new();
        for (id, wanted) in &asked.breakpoints {
            answers.push(match self.place_breakpoint(*id, &asked.text, wanted, host) {
                Ok(found) => {
                    let line = self.counting.line(found.line);
                    let source = self.run.as_ref().map(|run| run.source_json(found.source, host));
                    self.breakpoints.push(found);
                    json!({ "id": id, "verified": true, "line": line, "source": source })
                }
                Err(words) => {
                    let line = wanted.get("line").filter(|line| line.is_number());
                    json!({ "id": id, "verified": false, "line": line, "message": words })
                }
            });
        }
        answers
    }

    fn place_breakpoint(
        &mut self,
        id: i64,
        text: &AskedText,
        wanted: &Value,
        host: &dyn Host,
    ) -> Result<Breakpoint, Failed> {
        let counting = self.counting;
        let run = self.run.as_mut().ok_or("no shader runs yet")?;
        let line = read_line(wanted, "line", counting)?.ok_or("a breakpoint has a `line`")?;
        run.place_breakpoint((id, wanted), run.find_source(text, host)?, line)
    }

    pub fn set_marks(&mut self, turn: &Turn<'_>) -> Result<Value, Failed> {
        let names = turn.arguments.get("filters").and_then(Value::as_array);
        let options = turn.arguments.get("filterOptions").and_then(Value::as_array);
        let plain = names.into_iter().flatten().filter_map(Value::as_str);
        let others = options.into_iter().flatten();
        let others = others.filter_map(|one| one.get("filterId").and_then(Value::as_str));
        let asked: Vec<String> = plain.chain(others).map(str::to_owned).collect();
        let is_known =
            |name: &String| lamplight_debug::Mark::KINDS.iter().any(|(known, _)| known == name);
        let answers: Vec<Value> = asked
            .iter()
            .map(|name| match is_known(name) {
                true => json!({ "verified": true }),
                false => {
                    json!({ "verified": false, "message": format!("no mark is named `{name}`") })
                }
            })
            .collect();
        self.marks = asked.into_iter().filter(is_known).collect();
        Ok(json!({ "breakpoints": answers }))
    }

    /// The lines of a part of a text at which a run can stop.
    pub fn breakpoint_locations(&self, turn: &Turn<'_>) -> Result<Value, Failed> {
        let run = self.running()?;
        let line = |name: &str| read_line(turn.arguments, name, self.counting);
        let first = line("line")?.ok_or("`breakpointLocations` asks for a `line`")?;
        let last = line("endLine")?.unwrap_or(first);
        let source = run.find_source(&turn.asked_text()?, turn.host)?;
        let statements = &run.replay.subject().statements;
        let mut lines: Vec<u32> = statements
            .all()
            .iter()
            .zip(0..)
            .filter(|(one, id)| one.span.source == source && statements.runs(*id))
            .map(|(one, _)| one.line)
            .filter(|line| (first..=last).contains(line))
            .collect();
        lines.sort_unstable();
        lines.dedup();
        let place = |line: u32| json!({ "line": self.counting.line(line) });
        Ok(json!({ "breakpoints": lines.into_iter().map(place).collect::<Vec<_>>() }))
    }
}

/// A line of the client, from 1.
fn read_line(object: &Value, name: &str, counting: Counting) -> Result<Option<u32>, Failed> {
    number_of(object, name)?.map(|line| counting.read_line(line)).transpose()
}

impl Running {
    fn place_breakpoint(
        &mut self,
        (id, wanted): (i64, &Value),
        source: SourceId,
        line: u32,
    ) -> Result<Breakpoint, Failed> {
        let subject = self.replay.subject();
        let found = subject.statements.from_line(source, line);
        let statement = found.ok_or("the shader runs no statement at this line or below")?;
        let line = subject.statements.get(statement).map_or(line, |one| one.line);
        let text = |name: &str| {
            let text = wanted.get(name).and_then(Value::as_str).map(str::trim);
            text.filter(|text| !text.is_empty()).map(str::to_owned)
        };
        let hits = text("hitCondition").map(|text| Hits::read(&text)).transpose()?;
        let condition = text("condition");
        if let Some(condition) = &condition {
            let function = subject.function_of(statement).ok_or("no function has this line")?;
            self.expressions.check_condition(subject, (function, Some(statement)), condition)?;
        }
        let log = text("logMessage");
        Ok(Breakpoint { id, line, source, statement, condition, hits, log })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_of_hits() {
        let stops = |text: &str| -> Vec<u32> {
            let hits = Hits::read(text).unwrap();
            (1..=6).filter(|runs| hits.meets(*runs)).collect()
        };
        assert_eq!(stops("3"), [3]);
        assert_eq!(stops(" == 3"), [3]);
        assert_eq!(stops("> 4"), [5, 6]);
        assert_eq!(stops(">=4"), [4, 5, 6]);
        assert_eq!(stops("<2"), [1]);
        assert_eq!(stops("<= 2"), [1, 2]);
        assert_eq!(stops("%2"), [2, 4, 6]);
        for wrong in ["", "many", "% 0", "-1", "1.5"] {
            assert!(Hits::read(wrong).is_err(), "{wrong}");
        }
    }
}
