//! The permutation that an editor shows.

use crate::failure::RequestError;
use serde_json::{Map, Value, json};

use super::place::Lines;
use super::{LanguageServer, look};
use lamplight_bundle::key;
use lamplight_permute::{Setting, constant};

const CHOOSE: &str = "lamplight.permutation";
const COMPOSED: &str = "lamplight.composed";
/// What `workspace/executeCommand` takes.
pub const COMMANDS: &[&str] = &[CHOOSE, COMPOSED];

/// `lamplight/permutation`: with `set`, such as `shadow=hard,fog`, chooses it for the package of
/// `uri`; always answers with the axes, features and what is chosen.
pub fn choose_permutation(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let document = server.document(parameters)?;
    let (root, path) = (document.root.clone(), document.path.clone());
    if let Some(text) = parameters.get("set").and_then(Value::as_str) {
        server.choices.insert(root.clone(), read_choice(text)?);
        server.forget(None);
    }
    let opened = server.opened(&root).ok_or(RequestError::Unreadable)?;
    let (settings, note) = look::module_settings(&opened, &path, &server.choice(&root));
    let programs = opened.manifest.iter().flat_map(|manifest| &manifest.programs);
    let axes = programs.flat_map(|program| program.space.axes()).map(|axis| {
        let values: Vec<String> = axis.values.iter().map(ToString::to_string).collect();
        (axis.name.clone(), json!({ "values": values, "doc": axis.doc }))
    });
    let features = opened.features.declared.iter().map(|(name, feature)| {
        (name.clone(), json!({ "values": ["false", "true"], "doc": feature.doc }))
    });
    let mut choices: Map<String, Value> = features.collect();
    choices.extend(axes);
    let values =
        settings.values.iter().map(|(name, value)| (name.clone(), json!(value.to_string())));
    Ok(json!({
        "permutation": note,
        "axes": choices,
        "values": values.collect::<Map<String, Value>>(),
    }))
}

/// What a key chooses. Besides axes, it may name features and constants.
fn read_choice(text: &str) -> Result<look::ChosenValues, String> {
    let one = |part: key::KeyPart<'_>| {
        let (name, value) = (part.axis.text, part.chosen());
        if name.is_empty() || value.is_empty() {
            return Err(format!("expected `axis=value`, or the name of a boolean axis: `{text}`"));
        }
        if name.starts_with("constants::") {
            constant::parse(value)?;
        }
        Ok((name.to_owned(), Setting::parse(value)))
    };
    key::parts(text).map(one).collect()
}

/// `workspace/executeCommand`: chooses a permutation, or returns the composed text.
pub fn execute_command(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let name = parameters
        .get("command")
        .and_then(Value::as_str)
        .ok_or(RequestError::Parameter("command"))?;
    let argument = |index: usize| parameters.pointer(&format!("/arguments/{index}")).cloned();
    let uri = argument(0).ok_or(RequestError::Parameter("arguments"))?;
    match name {
        CHOOSE => choose_permutation(server, &json!({ "uri": uri, "set": argument(1) })),
        COMPOSED => {
            let document = server.document(&json!({ "uri": uri }))?;
            let (root, path) = (document.root.clone(), document.path.clone());
            let mut opened = server.opened(&root).ok_or(RequestError::Unreadable)?;
            let (settings, _) = look::module_settings(&opened, &path, &server.choice(&root));
            let text = server
                .graph(&mut opened, &path)
                .and_then(|graph| look::composed_text(&graph, &settings));
            let first = |errors: Vec<lamplight_diagnostic::Diagnostic>| {
                errors.first().map_or("no module".to_owned(), |error| error.message.clone())
            };
            text.map(Value::String).map_err(|errors| RequestError::Refused(first(errors)))
        }
        _ => Err(RequestError::UnknownCommand(name.to_owned())),
    }
}

/// `textDocument/codeLens`: above each entry point its program's permutations.
pub fn code_lenses(server: &mut LanguageServer, parameters: &Value) -> Result<Value, RequestError> {
    let document = server.document(parameters)?;
    let uri = parameters.pointer("/textDocument/uri").cloned().unwrap_or_default();
    let (root, path) = (document.root.clone(), document.path.clone());
    let Some(opened) = server.opened(&root) else { return Ok(json!([])) };
    let Some(modules) = server.modules(&root) else { return Ok(json!([])) };
    let Some(node) = modules.node(&path) else { return Ok(json!([])) };
    let programs = opened.manifest.iter().flat_map(|manifest| &manifest.programs);
    let count: u128 = programs
        .filter(|program| program.files().any(|file| file.path == path))
        .map(|program| program.space.count())
        .sum();
    let title = match count {
        0 => "composed text".to_owned(),
        1 => "1 permutation: composed text".to_owned(),
        many => format!("{many} permutations: composed text"),
    };
    let module = &modules.graph.nodes[node as usize].module;
    let lines = Lines::new(&module.text);
    let entries = module.items.iter().filter(|item| item.entry);
    let lens = |item: &lamplight_syntax::wesl::Item| {
        let range = item.name_range.start as usize..item.name_range.end as usize;
        json!({
            "range": lines.range(range),
            "command": { "title": title, "command": COMPOSED, "arguments": [uri] },
        })
    };
    Ok(entries.map(lens).collect())
}
