//! References and renames of GLSL names in all files of a package, and signatures and symbols.

use std::collections::BTreeMap;
use std::fs;

use libtest_mimic::Failed;
use serde_json::{Value, json};

use super::session::{MAIN, Session};
use super::{Outcome, expect};

const LAMP: &str = r#"#version 450
#include <lamplight/brdf/diffuse.glsl>
#include "tools/util.glsl"

layout(location = 0) in vec3 normal;
layout(location = 0) out vec4 colour;
uniform float age;

struct Lamp {
    vec3 place;
    float power;
};

#if FOG
float fade(float x) {
    return x;
}
#else
float fade(float x) {
    return halved(x);
}
#endif

void main() {
    vec3 up = vec3(0.0, 1.0, 0.0);
    Lamp lamp = Lamp(up, 2.0);
    float sum = lambert(normal, up) * lamp.power * LIMIT;
    for (int i = 0; i < 2; i++) sum += halved(sum);
    for (int i = 0; i < 2; i++)
        if (i > 0) sum += tuned(sum); else sum -= fade(float(i));
#if FOG
    float cone = 1.0;
#else
    float cone = 2.0;
#endif
    colour = vec4(sum, cone, lamp.place.x, age);
}
"#;

const UTIL: &str = "#include \"base.glsl\"\n// Half of it.\nfloat halved(float x) {\n    return x * HALF;\n}\n\nvec3 halved(vec3 x) {\n    return x * HALF;\n}\n\nfloat tuned(float x) {\n    return halved(x) * gain;\n}\n\n#define LIMIT 4.0\n#define DOUBLE(x, y) (scaled(x) + (y))\n";

const BASE: &str = "const float HALF = 0.5;\nconst float gain = 3.0;\nfloat scaled(float x) {\n    return x * 2.0;\n}\n";

/// Includes the same tools as the other file, and has a name of its own that is spelt alike.
const OTHER: &str = r#"#version 450
#include "tools/util.glsl"

layout(location = 0) out vec4 colour;

float fade(float x) {
    return halved(x);
}

void main() {
    float gain = gain * 2.0;
    colour = vec4(fade(gain), tuned(DOUBLE(1.0, 2.0)), 0.0, 1.0);
}
"#;

const FILES: [(&str, &str); 4] = [
    ("lamp.frag", LAMP),
    ("other.frag", OTHER),
    ("tools/util.glsl", UTIL),
    ("tools/base.glsl", BASE),
];

fn session() -> Result<Session, Failed> {
    let mut session = Session::new(MAIN)?;
    fs::create_dir(session.folder.path().join("tools"))?;
    for (path, text) in FILES {
        fs::write(session.folder.path().join(path), text)?;
    }
    for (path, text) in FILES {
        session.open(path, text)?;
    }
    Ok(session)
}

/// Parameters at the first place of some words in a file.
fn at(session: &Session, file: &str, words: &str, more: Value) -> Result<Value, Failed> {
    let (_, text) = FILES.iter().find(|(path, _)| *path == file).ok_or("no such file")?;
    let mut parameters = session.place(text, words, more)?;
    parameters["textDocument"]["uri"] = json!(session.uri(file)?);
    Ok(parameters)
}

/// The places of an answer, as `file:line` counted from 1.
fn places(session: &Session, found: &Value) -> Result<Vec<String>, Failed> {
    let root = session.uri("")?;
    let place = |found: &Value| {
        let uri = found["uri"].as_str().unwrap_or_default();
        let line = found["range"]["start"]["line"].as_u64().unwrap_or(0) + 1;
        format!("{}:{line}", uri.strip_prefix(&root).unwrap_or("lamplight"))
    };
    Ok(found.as_array().into_iter().flatten().map(place).collect())
}

/// Functions with all of their overloads, locals, members, macros, files and names of the library
/// are found in every file that is compiled with their declaration.
pub fn references() -> Outcome {
    let mut session = session()?;
    for (file, words, found) in [
        (
            "lamp.frag",
            "halved(sum",
            "lamp.frag:20 lamp.frag:28 other.frag:7 tools/util.glsl:3 tools/util.glsl:7 \
             tools/util.glsl:12",
        ),
        ("tools/base.glsl", "gain", "other.frag:11 tools/base.glsl:2 tools/util.glsl:12"),
        ("other.frag", "gain =", "other.frag:11 other.frag:12"),
        ("lamp.frag", "fade(float(", "lamp.frag:15 lamp.frag:19 lamp.frag:30"),
        ("other.frag", "fade(gain", "other.frag:6 other.frag:12"),
        ("lamp.frag", "power;", "lamp.frag:11 lamp.frag:27"),
        ("lamp.frag", "i > 0", "lamp.frag:29 lamp.frag:29 lamp.frag:29 lamp.frag:30 lamp.frag:30"),
        ("lamp.frag", "cone, lamp", "lamp.frag:32 lamp.frag:34 lamp.frag:36"),
        ("lamp.frag", "LIMIT", "lamp.frag:27 tools/util.glsl:15"),
        ("lamp.frag", "FOG", "lamp.frag:14 lamp.frag:31"),
        ("lamp.frag", "\"tools", "lamp.frag:3 other.frag:2"),
        ("lamp.frag", "vec4(sum", ""),
        ("lamp.frag", "location", ""),
    ] {
        let context = json!({ "context": { "includeDeclaration": true } });
        let parameters = at(&session, file, words, context)?;
        let answer = session.ask("textDocument/references", parameters)?;
        let answer = places(&session, &answer)?.join(" ");
        expect(answer == found, &(file, words, answer))?;
    }
    let context = json!({ "context": { "includeDeclaration": false } });
    let parameters = at(&session, "other.frag", "tuned(", context)?;
    let uses = session.ask("textDocument/references", parameters)?;
    let uses = places(&session, &uses)?;
    expect(uses == ["lamp.frag:30", "other.frag:12"], &uses)?;
    // The library's own modules use it too.
    let parameters = at(&session, "lamp.frag", "lambert(", json!({}))?;
    let library = session.ask("textDocument/references", parameters)?;
    let library = places(&session, &library)?;
    expect(library.starts_with(&["lamp.frag:27".to_owned()]), &library)?;
    expect(library.contains(&"lamplight:19".to_owned()) || library.len() > 1, &library)
}

/// The texts of all files with the edits of an answer made.
fn edited(session: &Session, answer: &Value) -> Result<BTreeMap<String, String>, Failed> {
    let mut texts = BTreeMap::new();
    for (path, text) in FILES {
        let mut text = text.to_owned();
        let edits = answer["changes"][session.uri(path)?].as_array().cloned().unwrap_or_default();
        for edit in edits.iter().rev() {
            let byte = |end: &str| {
                let place = &edit["range"][end];
                let line = place["line"].as_u64().unwrap_or(0) as usize;
                let column = place["character"].as_u64().unwrap_or(0) as usize;
                let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
                start + column
            };
            let range = byte("start")..byte("end");
            text.replace_range(range, edit["newText"].as_str().unwrap_or_default());
        }
        texts.insert(path.to_owned(), text);
    }
    Ok(texts)
}

/// The composed text of a file, with each setting of the axis.
fn composed(session: &mut Session, file: &str) -> Result<Vec<String>, Failed> {
    let uri = session.uri(file)?;
    let mut texts = Vec::new();
    for set in ["fog=false", "fog=true"] {
        session.ask("lamplight/permutation", json!({ "uri": uri, "set": set }))?;
        let command = json!({ "command": "lamplight.composed", "arguments": [uri] });
        let text = session.ask("workspace/executeCommand", command)?;
        // The library's comments have words of their own.
        let lines = text.as_str().ok_or("no text")?.lines();
        let lines: Vec<&str> = lines.filter(|line| !line.starts_with("//")).collect();
        texts.push(lines.join("\n"));
    }
    Ok(texts)
}

/// What a rename changes is the name alone: the composed text of each file, in each permutation,
/// is the one from before with the old word replaced.
pub fn rename() -> Outcome {
    let mut session = session()?;
    let mut before = BTreeMap::new();
    for file in ["lamp.frag", "other.frag"] {
        before.insert(file, composed(&mut session, file)?);
    }
    for (file, words, old, new) in [
        ("lamp.frag", "halved(sum", "halved", "half_of"),
        ("tools/util.glsl", "tuned", "tuned", "in_tune"),
        ("tools/base.glsl", "HALF", "HALF", "HALF_OF_IT"),
        ("lamp.frag", "fade(float(", "fade", "faded"),
        ("lamp.frag", "power;", "power", "strength"),
        ("lamp.frag", "place;", "place", "position"),
        ("lamp.frag", "Lamp {", "Lamp", "Lantern"),
        ("lamp.frag", "up = ", "up", "above"),
        ("lamp.frag", "sum = ", "sum", "whole"),
        ("lamp.frag", "cone = 1", "cone", "angle"),
        ("lamp.frag", "colour;", "colour", "shade"),
    ] {
        let place = at(&session, file, words, json!({ "newName": new }))?;
        let range = session.ask("textDocument/prepareRename", place.clone())?;
        expect(range["start"] == place["position"], &(words, range))?;
        let answer = session.ask("textDocument/rename", place)?;
        for (path, text) in edited(&session, &answer)? {
            session.open(&path, &text)?;
        }
        for (path, texts) in &before {
            let is_other = *path != "lamp.frag" && ["fade", "colour"].contains(&old);
            let replaced =
                |text: &String| if is_other { text.clone() } else { with_word(text, old, new) };
            let wanted: Vec<String> = texts.iter().map(replaced).collect();
            let found = composed(&mut session, path)?;
            expect(found == wanted, &(words, path, found, wanted))?;
        }
        for (path, text) in FILES {
            session.open(path, text)?;
        }
    }
    Ok(())
}

fn with_word(text: &str, old: &str, new: &str) -> String {
    let pieces = lamplight::parse::words::pieces(text);
    pieces.map(|piece| if piece.text == old { new } else { piece.text }).collect()
}

/// What cannot be renamed without knowing more is refused, with the reason.
pub fn refused() -> Outcome {
    let mut session = session()?;
    for (file, words, new, reason) in [
        ("lamp.frag", "lambert(", "lit", "name of another package"),
        ("lamp.frag", "main", "start", "entry point"),
        ("lamp.frag", "LIMIT", "MOST", "directive in `util.glsl:15`"),
        ("tools/base.glsl", "scaled", "grown", "directive in `util.glsl:16`"),
        ("lamp.frag", "FOG", "MIST", "axis"),
        ("lamp.frag", "age;", "time", "no `binding`"),
        ("lamp.frag", "vec4(sum", "four", "no file of the package declares it"),
        ("lamp.frag", "sum = ", "up", "already a name in `lamp.frag:25`"),
        ("lamp.frag", "sum = ", "dot", "a meaning for `dot`"),
        ("lamp.frag", "sum = ", "texture2D", "a meaning for `texture2D`"),
        ("lamp.frag", "sum = ", "1st", "not a name"),
        ("lamp.frag", "sum = ", "FOG", "the macro of an axis"),
        ("lamp.frag", "halved(sum", "gain", "already a name"),
    ] {
        let place = at(&session, file, words, json!({ "newName": new }))?;
        let answer = session.answer("textDocument/rename", place)?;
        let message = answer.as_ref().err().and_then(|error| error["message"].as_str());
        expect(message.is_some_and(|message| message.contains(reason)), &(words, new, answer))?;
    }
    refused_in(&mut session)
}

/// What a file must not have for a rename to be safe.
fn refused_in(session: &mut Session) -> Outcome {
    for (before, after, words, reason) in [
        ("struct Lamp", "struct Case { float power; };\nstruct Lamp", "power;", "members of"),
        ("struct Lamp", "struct Case { float x; };\nstruct Lamp", "x; }", "part of a vector"),
        ("struct Lamp", "#define JOIN(a) a##x\nstruct Lamp", "fade(float(", "with `##`"),
        ("struct Lamp", "#include \"gone.glsl\"\nstruct Lamp", "fade(float(", "`#include` in"),
        ("struct Lamp", "#if FOG\nstruct Lamp", "fade(float(", "fix this first"),
        (
            "    float cone = 1.0;\n#else",
            "    float gain = 1.0;\n#else\n    sum *= gain;",
            "gain = 1",
            "condition",
        ),
    ] {
        let text = LAMP.replacen(before, after, 1);
        session.open("lamp.frag", &text)?;
        let mut place = session.place(&text, words, json!({ "newName": "another" }))?;
        place["textDocument"]["uri"] = json!(session.uri("lamp.frag")?);
        let answer = session.answer("textDocument/rename", place)?;
        let message = answer.as_ref().err().and_then(|error| error["message"].as_str());
        expect(message.is_some_and(|message| message.contains(reason)), &(after, answer))?;
    }
    Ok(())
}

/// Signature help has every overload of a function, with the argument at the position; macros,
/// structs, and functions of the library have signatures too.
pub fn signature() -> Outcome {
    let mut session = session()?;
    for (file, words, labels, argument) in [
        ("lamp.frag", "up) * lamp", &["float lambert(vec3 n, vec3 l)"][..], 1),
        ("lamp.frag", "sum);\n    for", &["float halved(float x)", "vec3 halved(vec3 x)"], 0),
        ("lamp.frag", "2.0);", &["Lamp(vec3 place, float power)"], 1),
        ("other.frag", "2.0)", &["DOUBLE(x, y)"], 1),
    ] {
        let place = at(&session, file, words, json!({}))?;
        let answer = session.ask("textDocument/signatureHelp", place)?;
        let found = answer["signatures"].as_array().into_iter().flatten();
        let found: Vec<&str> = found.filter_map(|found| found["label"].as_str()).collect();
        expect(found == labels && answer["activeParameter"] == argument, &(words, answer))?;
    }
    Ok(())
}

/// Workspace symbols are the names of every file of the package, and of the library's files that
/// they include.
pub fn workspace() -> Outcome {
    let mut session = session()?;
    for (query, name, file) in [
        ("halv", "halved", "tools/util.glsl"),
        ("tune", "tuned", "tools/util.glsl"),
        ("gain", "gain", "tools/base.glsl"),
        ("lamp", "Lamp", "lamp.frag"),
        ("oren", "oren_nayar", "diffuse.glsl"),
    ] {
        let found = session.ask("workspace/symbol", json!({ "query": query }))?;
        let is_it = |found: &Value| {
            let uri = found["location"]["uri"].as_str().unwrap_or_default();
            found["name"] == name && uri.ends_with(file)
        };
        expect(found.as_array().into_iter().flatten().any(is_it), &(query, found))?;
    }
    Ok(())
}
