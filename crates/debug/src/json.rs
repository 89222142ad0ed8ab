//! Events as JSON, one object for each.

use lamplight_diagnostic::source::{SourceSet, Span};
use lamplight_eval::TextureRead;
use serde_json::{Value as Json, json};

use crate::mark::Mark;
use crate::record::{Change, Event, Outcome, Step};
use crate::subject::Subject;
use crate::text::StatementId;
use crate::value::number_json;

/// An event with the places of its statements.
pub fn event_json(subject: &Subject, sources: &SourceSet, event: &Event) -> Json {
    match event {
        Event::Call { function, depth, turns, arguments, marks } => {
            let name = subject.name_of(*function);
            json!({
                "event": "call",
                "function": name.name,
                "at": name.span.map(|span| place(sources, span)),
                "depth": depth,
                "turns": turns,
                "values": values(arguments),
                "marks": marks_json(marks),
            })
        }
        Event::Step(step) => step_json(subject, sources, step),
        Event::Left { statement, depth, turns, made } => json!({
            "event": "loop-end",
            "at": statement_place(subject, sources, *statement),
            "depth": depth,
            "turns": turns,
            "made": made,
        }),
    }
}

fn step_json(subject: &Subject, sources: &SourceSet, step: &Step) -> Json {
    let Step { statement, depth, function, turns, changes, outcomes, textures, marks } = step;
    json!({
        "event": "step",
        "at": statement_place(subject, sources, *statement),
        "function": subject.name_of(*function).name,
        "depth": depth,
        "turns": turns,
        "values": values(changes),
        "decided": outcomes.iter().map(|one| outcome_json(*one)).collect::<Vec<_>>(),
        "textures": textures.iter().map(texture_json).collect::<Vec<_>>(),
        "marks": marks_json(marks),
    })
}

/// A statement's place and text.
pub fn statement_place(
    subject: &Subject,
    sources: &SourceSet,
    statement: Option<StatementId>,
) -> Option<Json> {
    let statement = subject.statements.get(statement?)?;
    let mut found = place(sources, statement.span);
    found["text"] = json!(crate::table::statement_text(sources.text(statement.span)));
    Some(found)
}

fn place(sources: &SourceSet, span: Span) -> Json {
    let (line, column) = sources.position(span.source, span.start as usize);
    json!({ "file": sources.get(span.source).path, "line": line, "column": column })
}

fn values(changes: &[Change]) -> Vec<Json> {
    let value = |change: &Change| {
        let mut json = change.value.json();
        json["name"] = json!(change.name);
        json
    };
    changes.iter().map(value).collect()
}

fn outcome_json(outcome: Outcome) -> Json {
    match outcome {
        Outcome::Condition(holds) => json!({ "condition": holds }),
        Outcome::Case(word) => json!({ "case": word }),
        Outcome::Return => json!("return"),
        Outcome::Discard => json!("discard"),
    }
}

fn texture_json(read: &TextureRead) -> Json {
    let numbers = |all: &[f64]| all.iter().map(|one| number_json(*one)).collect::<Vec<_>>();
    let TextureRead { name, coordinate, level, reference, texels } = read;
    json!({
        "texture": name,
        "coordinate": numbers(coordinate),
        "level": level.map(number_json),
        "reference": reference.map(number_json),
        "texels": texels.iter().map(|texel| json!({
            "level": texel.level,
            "at": texel.at,
            "texel": numbers(&texel.texel),
        })).collect::<Vec<_>>(),
    })
}

fn marks_json(marks: &[Mark]) -> Vec<Json> {
    marks.iter().map(|mark| json!({ "mark": mark.name(), "text": mark.text() })).collect()
}
