//! Names of GLSL: in a file of a package, and those of the library and of the package that it
//! includes.

use std::fs;

use serde_json::{Value, json};

use super::session::{MAIN, Session};
use super::{Outcome, expect, labels};
use libtest_mimic::Failed;

const TEXT: &str = r#"#version 450
#include <lamplight/brdf/diffuse.glsl>
#include "tools/util.glsl"

layout(location = 0) in vec3 normal;
layout(location = 0) out vec4 colour;

struct Lamp {
    vec3 place;
    float power;
};

#if FOG
float fade(float x) {
    return x;
}
#endif

void main() {
    vec3 up = vec3(0.0, 1.0, 0.0), down = -up;
    Lamp lamp = Lamp(up, 2.0);
    float sum = lambert(normal, up) * lamp.power;
    for (int i = 0; i < 2; i++) {
        float part = halved(sum);
        sum += part;
    }
    colour = vec4(sum, LIMIT, dot(up, down), 1.0);
}
"#;

const TOOLS: &str = "// Half of it.\nfloat halved(float x) {\n    return x * 0.5;\n}\n\nvec3 halved(vec3 x) {\n    return x * 0.5;\n}\n\n#define LIMIT 4.0\n";

/// A session whose package has the files above.
fn session() -> Result<Session, Failed> {
    let mut session = Session::new(MAIN)?;
    let tools = session.folder.path().join("tools");
    fs::create_dir(&tools)?;
    fs::write(tools.join("util.glsl"), TOOLS)?;
    session.open("lamp.frag", TEXT)?;
    Ok(session)
}

/// Asks about the first place of some words in the file.
fn ask(session: &mut Session, method: &str, text: &str, words: &str) -> Result<Value, Failed> {
    let mut parameters = session.place(text, words, json!({}))?;
    parameters["textDocument"]["uri"] = json!(session.uri("lamp.frag")?);
    session.ask(method, parameters)
}

pub fn hover() -> Outcome {
    let mut session = session()?;
    let mut hover = |words: &str| -> Result<String, Failed> {
        let found = ask(&mut session, "textDocument/hover", TEXT, words)?;
        Ok(found["contents"]["value"].as_str().unwrap_or_default().to_owned())
    };
    let library = hover("lambert(normal")?;
    expect(library.contains("float lambert(vec3 n, vec3 l)"), &library)?;
    expect(library.contains("**Error model**") && library.contains("#include <"), &library)?;
    let own = hover("halved(sum")?;
    expect(own.contains("Half of it.") && own.contains("float halved(float x)"), &own)?;
    expect(own.contains("vec3 halved(vec3 x)") && !own.contains("return"), &own)?;
    let local = hover("up) * lamp")?;
    expect(local == "```glsl\nvec3 up\n```", &local)?;
    let member = hover("power;\n    for")?;
    expect(member.contains("float power;"), &member)?;
    let input = hover("normal, up")?;
    expect(input.contains("in vec3 normal"), &input)?;
    let defined = hover("LIMIT")?;
    expect(defined.contains("#define LIMIT 4.0"), &defined)?;
    let axis = hover("FOG")?;
    expect(axis.contains("Far things fade."), &axis)?;
    let file = hover("tools/util")?;
    expect(file.contains("tools/util.glsl"), &file)?;
    let built_in = hover("vec4(sum")?;
    expect(built_in.is_empty(), &built_in)
}

pub fn definition() -> Outcome {
    let mut session = session()?;
    let util = session.uri("tools/util.glsl")?;
    let here = session.uri("lamp.frag")?;
    let mut definition = |words: &str| -> Result<(String, Value), Failed> {
        let found = ask(&mut session, "textDocument/definition", TEXT, words)?;
        let uri = found[0]["uri"].as_str().unwrap_or_default().to_owned();
        Ok((uri, found[0]["range"]["start"].clone()))
    };
    let place = |line: u32, character: u32| json!({ "line": line, "character": character });
    for (words, uri, start) in [
        ("halved(sum", &util, place(1, 6)),
        ("LIMIT", &util, place(9, 8)),
        ("\"tools", &util, place(0, 0)),
        ("down), 1", &here, place(19, 35)),
        ("part;\n", &here, place(23, 14)),
        ("i < 2", &here, place(22, 13)),
        ("lamp.power", &here, place(20, 9)),
        ("power;\n    for", &here, place(9, 10)),
        ("Lamp(up", &here, place(7, 7)),
        ("normal, up", &here, place(4, 29)),
    ] {
        let found = definition(words)?;
        expect(found == (uri.clone(), start), &(words, found))?;
    }
    // A module of the library is a file that the editor can open.
    let (uri, start) = definition("lambert(normal")?;
    let text = fs::read_to_string(uri.trim_start_matches("file://"))?;
    let line = start["line"].as_u64().unwrap_or(0) as usize;
    expect(text.lines().nth(line).is_some_and(|line| line.starts_with("float lambert(")), &uri)
}

pub fn completion() -> Outcome {
    let complete = |before: &str, written: &str| -> Result<Value, Failed> {
        let mut session = session()?;
        let text = TEXT.replacen(before, &format!("{written}¤{before}"), 1);
        let uri = session.uri("lamp.frag")?;
        let change = json!({
            "textDocument": { "uri": uri, "version": 2 },
            "contentChanges": [{ "text": text.replace('¤', "") }],
        });
        session.notify("textDocument/didChange", change)?;
        ask(&mut session, "textDocument/completion", &text, "¤")
    };
    let locals = complete("    colour =", "    u")?;
    expect(labels(&locals).contains(&"up"), &labels(&locals))?;
    let gone = complete("    colour =", "    par")?;
    expect(!labels(&gone).contains(&"part"), &labels(&gone))?;
    let included = complete("    colour =", "    sum = hal")?;
    expect(labels(&included).contains(&"halved"), &labels(&included))?;
    let library = complete("    colour =", "    sum = blinn_ph")?;
    let all = library.as_array().into_iter().flatten();
    let entry = all.into_iter().find(|entry| entry["label"] == "blinn_phong");
    let edit = entry.map(|entry| entry["additionalTextEdits"][0].clone()).unwrap_or_default();
    let include = "#include <lamplight/brdf/specular.glsl>\n";
    expect(edit["newText"] == include && edit["range"]["start"]["line"] == 3, &library)?;
    let members = complete("power;\n    for", "")?;
    expect(labels(&members) == ["place", "power"], &labels(&members))?;
    let axes = complete("FOG\n", "")?;
    expect(["FOG", "CONE_SOFT"].iter().all(|name| labels(&axes).contains(name)), &labels(&axes))?;
    let paths = complete("brdf/diffuse.glsl>", "")?;
    expect(labels(&paths).contains(&"brdf/"), &labels(&paths))?;
    let built_in = complete("    colour =", "    smooths")?;
    expect(labels(&built_in) == ["smoothstep"], &labels(&built_in))
}

pub fn symbols() -> Outcome {
    let mut session = session()?;
    let document = json!({ "textDocument": { "uri": session.uri("lamp.frag")? } });
    let found = session.ask("textDocument/documentSymbol", document)?;
    let found = found.as_array().into_iter().flatten();
    let names: Vec<&str> = found.filter_map(|found| found["name"].as_str()).collect();
    expect(names == ["normal", "colour", "Lamp", "fade", "main"], &names)
}

/// The outline (`documentSymbol`) of each of the library's modules has every name that the
/// catalogue lists for it. A request for half of a file is answered too.
pub fn library() -> Outcome {
    use lamplight::source::Files as _;
    let known = lamplight::catalogue::library_modules(lamplight::LIBRARY_FILES);
    let mut session = session()?;
    for module in &known {
        let path = format!("{}.glsl", module.path.replace("::", "/"));
        let text = lamplight::LIBRARY_FILES.read(&path).ok().flatten().ok_or("unreadable")?;
        let name = path.replace('/', "_");
        session.open(&name, &text)?;
        let document = json!({ "textDocument": { "uri": session.uri(&name)? } });
        let found = session.ask("textDocument/documentSymbol", document.clone())?;
        let found: Vec<&Value> = found.as_array().into_iter().flatten().collect();
        let expected = module.items.iter().filter(|item| item.glsl.is_some());
        for item in expected {
            expect(found.iter().any(|found| found["name"] == *item.name), &(&path, &item.name))?;
        }
        let half = text.floor_char_boundary(text.len() / 2);
        session.open(&name, &text[..half])?;
        session.ask("textDocument/documentSymbol", document.clone())?;
        session.notify("textDocument/didClose", document)?;
    }
    Ok(())
}
