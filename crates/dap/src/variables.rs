//! Scopes, variables as trees, and expressions.

use lamplight_debug::{Frame, Halt, Marked, Scalar, Seen, Value as Traced};
use lamplight_eval::{Shape, ShapePart, SlotKind, VariableKind, VariablePlace};
use serde_json::{Value, json};

use crate::answer::{Failed, Turn};
use crate::present::{number_rows, shown};
use crate::session::{Running, Session};

/// The most rows of one answer.
const ROWS: u32 = 1000;
/// The most values that the client may ask for while the run stands.
const MOST: usize = 1 << 16;

/// What the client may ask for by a number.
#[derive(Debug, Clone)]
pub(crate) enum Handle {
    /// Variables by their numbers.
    Group(Vec<usize>),
    /// A part of the memory: its name in expressions, its shape, place and first scalar.
    Part(Part),
    /// A value of an expression.
    Value(Traced),
    /// A number.
    Number(Scalar),
    /// All marks so far.
    Marks,
}

/// A part of the memory.
#[derive(Debug, Clone)]
pub(crate) struct Part {
    path: String,
    shape: Shape,
    place: VariablePlace,
    first: u32,
}

impl Part {
    fn read(&self, seen: &Seen<'_>) -> Traced {
        Traced::read_part(&self.shape, self.place, self.first, seen.memory)
    }

    /// Its parts by name; of an array those from a number on.
    fn parts(&self, start: u32, count: u32) -> Vec<(String, Self)> {
        let parts = self.shape.parts(start..start.saturating_add(count));
        parts.map(|part| (part.name.clone(), self.part(part))).collect()
    }

    fn part(&self, ShapePart { name, first, shape }: ShapePart) -> Self {
        let dot = if name.starts_with('[') { "" } else { "." };
        let path = format!("{}{dot}{name}", self.path);
        Self { path, shape, place: self.place, first: self.first.saturating_add(first) }
    }
}

impl Session {
    pub fn scopes(&mut self, turn: &Turn<'_>) -> Result<Value, Failed> {
        let frame = turn.number("frameId")?.ok_or("`scopes` asks for a `frameId`")?;
        let run = self.running_mut()?;
        let scopes = run.scopes_of(frame)?;
        let mut rows = Vec::new();
        for Scope { name, hint, has, count } in scopes {
            let reference = run.handle(has)?;
            rows.push(json!({
                "name": name, "presentationHint": hint, "variablesReference": reference,
                "namedVariables": count, "expensive": false,
            }));
        }
        Ok(json!({ "scopes": rows }))
    }

    pub fn variables(&mut self, turn: &Turn<'_>) -> Result<Value, Failed> {
        let number = |name: &str| turn.number(name).map(Option::unwrap_or_default);
        let (reference, start) = (number("variablesReference")?, number("start")?);
        let count = match number("count")? {
            0 => ROWS,
            count => count.min(ROWS),
        };
        let run = self.running_mut()?;
        let index = (reference as usize).checked_sub(1);
        let handle = index.and_then(|index| run.handles.get(index)).cloned();
        let handle = handle
            .ok_or("the run has moved since this value was shown: ask for its scope again")?;
        let rows = match handle {
            Handle::Group(variables) => run.group_rows(&variables)?,
            Handle::Part(part) => {
                let parts = part.parts(start, count);
                if parts.is_empty() {
                    let value = part.read(&run.replay.seen());
                    value.scalars.first().map_or(Vec::new(), number_rows)
                } else {
                    let rows = parts.into_iter().map(|(name, part)| run.part_row(&name, part));
                    rows.collect::<Result<_, _>>()?
                }
            }
            Handle::Value(value) => {
                let rows = value.parts().into_iter();
                rows.map(|(name, value)| run.value_row(&name, value)).collect::<Result<_, _>>()?
            }
            Handle::Number(scalar) => number_rows(&scalar),
            Handle::Marks => run.mark_rows(),
        };
        Ok(json!({ "variables": rows }))
    }

    pub fn evaluate(&mut self, turn: &Turn<'_>) -> Result<Value, Failed> {
        let text = turn.arguments.get("expression").and_then(Value::as_str).unwrap_or_default();
        let frame = turn.number("frameId")?;
        let run = self.running_mut()?;
        let mut row = run.expression_row(text.trim(), frame)?;
        let value = row["value"].take();
        if let Some(row) = row.as_object_mut() {
            row.remove("value");
            row.remove("name");
            row.insert("result".to_owned(), value);
        }
        Ok(row)
    }
}

/// A group of variables.
struct Scope {
    name: &'static str,
    /// What the protocol calls it.
    hint: &'static str,
    has: Handle,
    count: usize,
}

impl Running {
    /// The frame of a number; without one the innermost.
    fn frame(&self, id: Option<u32>) -> Result<(usize, Frame), Failed> {
        let frames = self.replay.seen().place.frames();
        let depth = match id {
            Some(id) => (id as usize).checked_sub(1),
            None => frames.len().checked_sub(1),
        };
        let found = depth.and_then(|depth| Some((depth, frames.get(depth)?.clone())));
        let words = "the stack has no such frame: it is another one after each step";
        found.ok_or_else(|| words.to_owned())
    }

    fn scopes_of(&self, id: u32) -> Result<Vec<Scope>, Failed> {
        let (depth, frame) = self.frame(Some(id))?;
        let (subject, place) = (self.replay.subject(), self.replay.seen().place);
        let visible = subject.visible(frame.function, frame.statement);
        let of = |kinds: &[VariableKind]| -> Vec<usize> {
            let kind = |index: usize| subject.program.variables().get(index).map(|one| one.kind);
            let all = visible.iter().copied();
            all.filter(|index| kind(*index).is_some_and(|kind| kinds.contains(&kind))).collect()
        };
        let is_top = depth + 1 == place.depth();
        let returned = match place.halt() {
            Halt::Returned(function) if is_top => Some(*function),
            Halt::End if is_top => Some(frame.function),
            _ => None,
        };
        let result = returned.and_then(|function| {
            let variables = subject.variables_of(function);
            { variables }.find(|(_, one)| one.kind == VariableKind::Result).map(|(index, _)| index)
        });
        let own = of(&[VariableKind::Let, VariableKind::Var]);
        let locals: Vec<usize> = result.into_iter().chain(own).collect();
        let groups = [
            ("Locals", "locals", locals),
            ("Parameters", "arguments", of(&[VariableKind::Parameter])),
            ("Module", "globals", of(&[VariableKind::Private])),
            ("Uniforms and buffers", "globals", of(&[VariableKind::Buffer])),
        ];
        let group = |(name, hint, variables): (_, _, Vec<usize>)| {
            let count = variables.len();
            Scope { name, hint, has: Handle::Group(variables), count }
        };
        let marks = place.marks().len();
        let marks = Scope { name: "Marks", hint: "marks", has: Handle::Marks, count: marks };
        let all = groups.into_iter().map(group).chain([marks]);
        Ok(all.filter(|scope| scope.count > 0).collect())
    }

    /// A number by which the client may ask for something.
    fn handle(&mut self, handle: Handle) -> Result<usize, Failed> {
        if self.handles.len() >= MOST {
            return Err(format!(
                "at most {MOST} values are shown at one place: make a step, or watch fewer"
            ));
        }
        self.handles.push(handle);
        Ok(self.handles.len())
    }

    fn group_rows(&mut self, all: &[usize]) -> Result<Vec<Value>, Failed> {
        let mut rows = Vec::new();
        for index in all {
            let subject = self.replay.subject();
            let Some(variable) = subject.program.variables().get(*index) else { continue };
            let (shape, place) = (variable.shape.clone(), variable.place);
            // No expression names what a function returned.
            let (name, path) = match (variable.kind, variable.function) {
                (VariableKind::Result, Some(function)) => {
                    (format!("{}() returned", subject.name_of(function).name), String::new())
                }
                _ => (variable.name.clone(), variable.name.clone()),
            };
            rows.push(self.part_row(&name, Part { path, shape, place, first: 0 })?);
        }
        Ok(rows)
    }

    fn part_row(&mut self, name: &str, part: Part) -> Result<Value, Failed> {
        let value = part.read(&self.replay.seen());
        let type_name = self.type_name(&part.shape);
        let mut row = json!({
            "name": name, "value": shown(&value, &type_name), "type": type_name,
            "presentationHint": { "attributes": ["readOnly"] },
        });
        if !part.path.is_empty() {
            row["evaluateName"] = json!(part.path);
        }
        if let Shape::Array(count, _) = part.shape {
            row["indexedVariables"] = json!(count);
        }
        let is_leaf = matches!(part.shape, Shape::Scalar(kind) if kind != SlotKind::Float);
        let reference = if is_leaf { 0 } else { self.handle(Handle::Part(part))? };
        row["variablesReference"] = json!(reference);
        Ok(row)
    }

    fn value_row(&mut self, name: &str, value: Traced) -> Result<Value, Failed> {
        let type_name = self.type_name(&value.shape);
        let text = shown(&value, &type_name);
        let reference = match (&value.shape, value.scalars.first()) {
            (Shape::Scalar(SlotKind::Float), Some(scalar)) => {
                self.handle(Handle::Number(*scalar))?
            }
            (Shape::Scalar(_), _) => 0,
            _ => self.handle(Handle::Value(value))?,
        };
        Ok(json!({
            "name": name, "value": text, "type": type_name, "variablesReference": reference,
            "presentationHint": { "attributes": ["readOnly"] },
        }))
    }

    fn type_name(&self, shape: &Shape) -> String {
        self.replay.subject().type_name(shape).unwrap_or_else(|| "struct".to_owned())
    }

    fn mark_rows(&self) -> Vec<Value> {
        let row = |marked: &Marked| {
            let subject = self.replay.subject();
            let statement = marked.statement.and_then(|id| subject.statements.get(id));
            let span = statement.map(|one| one.span).or(subject.name_of(marked.function).span);
            let place = span.map_or(String::new(), |span| {
                let line = self.sources.position(span.source, span.start as usize).0;
                format!("{}:{line}", self.sources.get(span.source).path)
            });
            json!({
                "name": place, "value": marked.mark.text(), "type": marked.mark.name(),
                "variablesReference": 0,
            })
        };
        self.replay.seen().place.marks().iter().map(row).collect()
    }

    /// The row of an expression in a frame: a variable and its parts, or what WGSL makes of it.
    fn expression_row(&mut self, text: &str, frame: Option<u32>) -> Result<Value, Failed> {
        let (_, frame) = self.frame(frame)?;
        let subject = self.replay.subject();
        let end = text.find(['.', '[']).unwrap_or(text.len());
        let visible = subject.visible(frame.function, frame.statement);
        let variables = subject.program.variables();
        let named = visible.iter().filter_map(|index| variables.get(*index));
        let part = { named }.find(|one| one.name == text[..end].trim()).and_then(|one| {
            let part = one.shape.follow(&text[end..]).ok()?;
            let path = format!("{}{}", one.name, part.name);
            Some(Part { path, shape: part.shape, place: one.place, first: part.first })
        });
        if let Some(part) = part {
            return self.part_row("", part);
        }
        let Self { replay, expressions, .. } = self;
        let value = expressions.value(&replay.seen(), (frame.function, frame.statement), text)?;
        self.value_row("", value)
    }
}
