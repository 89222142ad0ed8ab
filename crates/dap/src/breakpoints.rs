//! Breakpoints: lines, conditions, counts of hits, and marks.

use lamplight_debug::{Expressions, Halt, Seen, StatementId};
use lamplight_diagnostic::source::SourceId;
use serde_json::{Value, json};

use crate::answer::{Failed, Host, Turn};
use crate::present::flat_text;
use crate::session::{Running, Session, reference_of};

/// The most breakpoints of one text.
const MOST: usize = 1000;

/// What the client wants in one text.
#[derive(Debug, Clone)]
pub(crate) struct Asked {
    path: Option<String>,
    reference: i64,
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
    /// Whether the run has come to it; with what it prints in the place of a stop.
    pub fn meets(
        &self,
        seen: &Seen<'_>,
        expressions: &mut Expressions,
    ) -> Result<Option<Option<String>>, Failed> {
        let is_here =
            *seen.place.halt() == Halt::Statement && seen.place.statement() == Some(self.statement);
        if !is_here || self.hits.is_some_and(|hits| !hits.meets(seen.place.runs(self.statement))) {
            return Ok(None);
        }
        let Some(frame) = seen.place.frames().last() else { return Ok(None) };
        let frame = (frame.function, frame.statement);
        if let Some(condition) = &self.condition {
            let value = expressions.value(seen, frame, condition)?;
            match value.scalars.as_slice() {
                [one] if one.kind == lamplight_eval::SlotKind::Bool => {
                    if one.word() == 0 {
                        return Ok(None);
                    }
                }
                _ => {
                    return Err(format!(
                        "`{condition}` is no condition, but {}",
                        value.type_text()
                    ));
                }
            }
        }
        let Some(log) = &self.log else { return Ok(Some(None)) };
        Ok(Some(Some(logged(log, |text| expressions.value(seen, frame, text)))))
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
        let path = turn.arguments.pointer("/source/path").and_then(Value::as_str);
        let reference = turn.arguments.pointer("/source/sourceReference").and_then(Value::as_i64);
        let (path, reference) = (path.map(str::to_owned), reference.unwrap_or(0));
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
        let is_same = |one: &Asked| match (&one.path, &path) {
            (Some(one), Some(other)) => turn.host.is_same(one, other),
            (None, None) => one.reference == reference,
            _ => false,
        };
        let old: Vec<Asked> = self.asked.iter().filter(|one| is_same(one)).cloned().collect();
        self.asked.retain(|one| !is_same(one));
        let numbers: Vec<i64> =
            old.iter().flat_map(|one| &one.breakpoints).map(|(id, _)| *id).collect();
        self.breakpoints.retain(|one| !numbers.contains(&one.id));
        let asked = Asked { path, reference, breakpoints };
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
            let line = wanted.get("line").and_then(Value::as_u64).unwrap_or(0) as u32;
            let found = match self.run.as_mut() {
                None => Err("no shader runs yet".to_owned()),
                Some(run) => run.place_breakpoint(
                    *id,
                    (asked, wanted),
                    line.saturating_add(1).saturating_sub(self.first_line),
                    host,
                ),
            };
            answers.push(match found {
                Ok(found) => {
                    let line = found.line + self.first_line - 1;
                    let source = self.run.as_ref().map(|run| run.source_json(found.source, host));
                    self.breakpoints.push(found);
                    json!({ "id": id, "verified": true, "line": line, "source": source })
                }
                Err(words) => {
                    json!({ "id": id, "verified": false, "line": line, "message": words })
                }
            });
        }
        answers
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
        let number = |name: &str| turn.arguments.get(name).and_then(Value::as_u64);
        let first =
            (number("line").unwrap_or(0) as u32).saturating_add(1).saturating_sub(self.first_line);
        let last = number("endLine")
            .map_or(first, |line| (line as u32).saturating_add(1).saturating_sub(self.first_line));
        let path = turn.arguments.pointer("/source/path").and_then(Value::as_str);
        let reference = turn.arguments.pointer("/source/sourceReference").and_then(Value::as_i64);
        let asked = Asked {
            path: path.map(str::to_owned),
            reference: reference.unwrap_or(0),
            breakpoints: Vec::new(),
        };
        let source = run.find_source(&asked, turn.host).ok_or_else(not_in_run)?;
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
        let place = |line: u32| json!({ "line": line + self.first_line - 1 });
        Ok(json!({ "breakpoints": lines.into_iter().map(place).collect::<Vec<_>>() }))
    }
}

fn not_in_run() -> Failed {
    "the shader does not read this file".to_owned()
}

impl Running {
    fn find_source(&self, asked: &Asked, host: &dyn Host) -> Option<SourceId> {
        let is_meant = |id: &SourceId| match &asked.path {
            Some(path) => {
                let own = host.path_of(self.sources.get(*id));
                own.is_some_and(|own| host.is_same(&own, path))
            }
            None => reference_of(*id) == asked.reference,
        };
        // Of several readings of one file, that which runs.
        let statements = &self.replay.subject().statements;
        let runs = |id: &SourceId| statements.from_line(*id, 0).is_some();
        let all: Vec<SourceId> =
            self.sources.iter().map(|(id, _)| id).filter(|id| is_meant(id)).collect();
        all.iter().copied().find(runs).or(all.first().copied())
    }

    fn place_breakpoint(
        &mut self,
        id: i64,
        (asked, wanted): (&Asked, &Value),
        line: u32,
        host: &dyn Host,
    ) -> Result<Breakpoint, Failed> {
        let source = self.find_source(asked, host).ok_or_else(not_in_run)?;
        let subject = self.replay.subject();
        let found = subject.statements.from_line(source, line);
        let statement = found.ok_or("no statement at this line or below runs")?;
        let line = subject.statements.get(statement).map_or(line, |one| one.line);
        let text = |name: &str| {
            let text = wanted.get(name).and_then(Value::as_str).map(str::trim);
            text.filter(|text| !text.is_empty()).map(str::to_owned)
        };
        let hits = text("hitCondition").map(|text| Hits::read(&text)).transpose()?;
        let condition = text("condition");
        if let Some(condition) = &condition {
            let function = subject.function_of(statement).ok_or("no function has this line")?;
            self.expressions.check(subject, (function, Some(statement)), condition)?;
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
