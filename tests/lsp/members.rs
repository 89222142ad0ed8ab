//! Members of structs in WESL.

use serde_json::{Value, json};

use super::session::Session;
use super::{Outcome, expect};

const TEXT: &str = "import package::lamp::Lamp;

@fragment
fn fs_main() -> @location(0) vec4f {
    let lamp = Lamp(vec3f(1.0), 2.0);
    return vec4f(lamp.power * lamp.up.x);
}
";

const LAMP: &str = "/* a: b */
struct Lamp {
    // power: none
    @align(16) up: vec3f,
    /* none: f32, /* nested */ near: f32, */
    power: f32, /* x: y */
}

struct Other {
    power: array<vec4<f32>, 4>,
    far: f32,
}

fn far_of(other: Other) -> f32 {
    return other.far;
}
";

/// A name behind a point leads to the members of the structs that the module names.
pub fn found() -> Outcome {
    let mut session = Session::new(TEXT)?;
    session.open("lamp.wesl", LAMP)?;
    let lamp = session.uri("lamp.wesl")?;
    for (words, line, character) in [("power", 5, 4), ("up.x", 3, 15)] {
        let found = session.at("textDocument/definition", TEXT, words, json!({}))?;
        let start = json!({ "line": line, "character": character });
        let is_it = found[0]["uri"] == json!(lamp) && found[0]["range"]["start"] == start;
        expect(is_it && found.as_array().map(Vec::len) == Some(1), &found)?;
    }
    let hover = session.at("textDocument/hover", TEXT, "power", json!({}))?;
    let text = hover["contents"]["value"].as_str().unwrap_or_default();
    expect(text == "```wgsl\npower: f32\n```\n`package::lamp::Lamp`", &hover)?;
    let hover = session.at("textDocument/hover", TEXT, "up.x", json!({}))?;
    let text = hover["contents"]["value"].as_str().unwrap_or_default();
    expect(text.contains("up: vec3f\n"), &hover)?;
    let swizzle = session.at("textDocument/hover", TEXT, "x);", json!({}))?;
    expect(swizzle == Value::Null, &swizzle)?;
    // Where no struct is named that has the member, every struct counts.
    let text = TEXT.replace("lamp.power", "lamp.far");
    session.change(&text)?;
    let far = session.at("textDocument/definition", &text, "far", json!({}))?;
    expect(far[0]["range"]["start"] == json!({ "line": 10, "character": 4 }), &far)?;
    // Comments nest, so a comment goes on after one in it.
    let text = TEXT.replace("lamp.power", "lamp.near");
    session.change(&text)?;
    let near = session.at("textDocument/hover", &text, "near", json!({}))?;
    expect(near == Value::Null, &near)
}
