//! Text that is being typed: a bracket, a quote or a comment that is not closed costs the statement
//! that it stands in, and nothing else.

use std::collections::BTreeMap;

use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use crate::editor::{Editor, expect, position};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("lsp::definitions_beside_open_brackets", definitions),
        Trial::test("lsp::symbols_beside_open_brackets", symbols),
        Trial::test("lsp::typing_of_arguments", arguments),
        Trial::test("lsp::errors_of_open_brackets", errors),
    ]
}

const MODULE: &str = "\
import package::util::{half, third as part};

const FAR: f32 = 100.0;
override SCALE: f32 = 1.0;
@group(0) @binding(0) var<uniform> light: Light;

/// A lamp.
struct Light {
    place: vec3f,
    extent: f32,
}

fn falloff(distance: f32, reach: f32) -> f32 {
    let near = distance / reach;
    var left = 1.0 - near * near;
    // INSERTED
    for (var i = 0; i < 4; i++) {
        left += half(near) * f32(i);
    }
    if left > FAR {
        let most = FAR;
        return most * SCALE;
    } else {
        left = part(left);
    }
    return left;
}

@if(SOFT)
fn shade(lamp: Light, at: vec3f) -> f32 {
    let way = lamp.place - at;
    switch i32(way.x) {
        case 1: {
            return falloff(length(way), lamp.extent);
        }
        default: {}
    }
    return falloff(1.0, light.extent);
}

@fragment
fn main(@location(0) at: vec3f) -> @location(0) vec4f {
    let shade = falloff(at.x, at.y);
    return vec4f(shade);
}
";

const UTIL: &str =
    "fn half(x: f32) -> f32 { return x * 0.5; }\nfn third(x: f32) -> f32 { return x / 3.0; }\n";

/// What is written where the comment says so.
const INSERTED: &[&str] = &[
    "let zz = ",
    "foo.",
    "let zz = near",
    "@",
    "array<",
    "max(1.0,",
    "if (near > 1.0) {",
    "}",
    "left[",
    "/*",
    "\"",
    "near ? left : reach",
    "for (var j = 0;",
    "let zz = max(half(near, {",
];

/// The names whose definitions are asked for: every word of the text that one of its packages
/// declares.
const NAMES: &[&str] = &[
    "half", "third", "part", "FAR", "SCALE", "light", "Light", "falloff", "distance", "reach",
    "near", "left", "most", "lamp", "way", "shade", "at",
];

/// Each place of a name with its line, its column and the definition that is found.
fn definitions_of(text: &str) -> Result<BTreeMap<(u64, u64), Value>, Failed> {
    let mut editor =
        Editor::new(&[("main.wesl", text), ("util.wesl", UTIL), ("lamplight.toml", "")])?;
    editor.open("main.wesl")?;
    let mut found = BTreeMap::new();
    let uri = editor.uri("main.wesl")?;
    for word in lamplight_syntax::words::words(text).filter(|word| NAMES.contains(&word.text)) {
        let is_member = text[..word.at].ends_with('.');
        if is_member {
            continue;
        }
        let at = position(text, word.at);
        let place = json!({ "textDocument": { "uri": uri }, "position": at });
        let answer = editor.ask("textDocument/definition", place)?;
        let key = (at["line"].as_u64().unwrap_or(0), at["character"].as_u64().unwrap_or(0));
        let file = answer[0]["uri"].as_str().unwrap_or_default().rsplit('/').next();
        found.insert(key, json!([file, answer[0]["range"]["start"]]));
    }
    Ok(found)
}

/// The line of the inserted text.
fn inserted_line() -> u64 {
    MODULE.lines().position(|line| line.contains("INSERTED")).unwrap_or(0) as u64
}

fn with_inserted(text: &str) -> String {
    MODULE.replace("// INSERTED", text)
}

/// Every name outside of the inserted line leads where it led before, also in the same function.
fn definitions() -> Result<(), Failed> {
    let intact = definitions_of(MODULE)?;
    expect(intact.len() > 45 && intact.values().all(|place| !place[0].is_null()), &intact)?;
    let mut lost = Vec::new();
    for inserted in INSERTED {
        let mut found = definitions_of(&with_inserted(inserted))?;
        found.retain(|(line, _), _| *line != inserted_line());
        for (place, definition) in &intact {
            if found.get(place) != Some(definition) {
                lost.push(format!(
                    "`{inserted}`: {place:?} had {definition}, has {:?}",
                    found.get(place)
                ));
            }
        }
    }
    expect(lost.is_empty(), &lost)
}

/// The outline has every declaration, whatever is open in one of them.
fn symbols() -> Result<(), Failed> {
    let names = ["FAR", "SCALE", "light", "Light", "falloff", "shade", "main"];
    for inserted in INSERTED {
        let text = with_inserted(inserted);
        let mut editor = Editor::new(&[("main.wesl", &text), ("util.wesl", UTIL)])?;
        editor.open("main.wesl")?;
        let uri = editor.uri("main.wesl")?;
        let place = json!({ "textDocument": { "uri": uri } });
        let found = editor.ask("textDocument/documentSymbol", place)?;
        let found: Vec<&str> = found
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(|item| item["name"].as_str())
            .collect();
        expect(found == names, &(inserted, found))?;
    }
    Ok(())
}

/// What is typed in the place of the comment, up to the cursor, a name that must be offered, and a
/// name that must not.
const TYPED: &[(&str, &str, &str)] = &[
    ("let z = max(ne", "near", "most"),
    ("let z = max(half(le", "left", "way"),
    ("max(1.0, FA", "FAR", "near"),
    ("if (ne", "near", "shade"),
    ("left[re", "reach", "near"),
    ("left = max(light.", "extent", "near"),
    ("let z = \"ne", "near", "most"),
];

/// What the server answers at the end of what is typed.
fn asked_behind(typed: &str, method: &str) -> Result<Value, Failed> {
    let text = with_inserted(typed);
    let mut editor = Editor::new(&[("main.wesl", &text), ("util.wesl", UTIL)])?;
    editor.open("main.wesl")?;
    let end = text.find(typed).ok_or("not inserted")? + typed.len();
    let place = json!({
        "textDocument": { "uri": editor.uri("main.wesl")? },
        "position": position(&text, end),
    });
    editor.ask(method, place)
}

/// While arguments are typed, locals and members are offered, and the function that is called is
/// known.
fn arguments() -> Result<(), Failed> {
    for (typed, offered, other) in TYPED {
        let found = asked_behind(typed, "textDocument/completion")?;
        let items = if found.is_array() { &found } else { &found["items"] };
        let labels: Vec<&str> = items
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(|item| item["label"].as_str())
            .collect();
        expect(labels.contains(offered) && !labels.contains(other), &(typed, labels))?;
    }
    let typed = "let z = falloff(max(1.0, 2.0), ";
    let found = asked_behind(typed, "textDocument/signatureHelp")?;
    let label = found["signatures"][0]["label"].as_str().unwrap_or_default();
    expect(label.contains("falloff(distance: f32") && found["activeParameter"] == 1, &found)
}

/// What is open is told once, where it is.
fn errors() -> Result<(), Failed> {
    for inserted in INSERTED {
        let text = with_inserted(inserted);
        let mut editor = Editor::new(&[("main.wesl", &text), ("util.wesl", UTIL)])?;
        editor.open("main.wesl")?;
        let shown = editor.shown()?;
        let own = shown.iter().find(|(path, _)| path == "main.wesl").ok_or("nothing is shown")?;
        let errors: Vec<&Value> = own.1.iter().filter(|found| found["severity"] == 1).collect();
        expect(errors.len() == 1, &(inserted, errors))?;
    }
    Ok(())
}
