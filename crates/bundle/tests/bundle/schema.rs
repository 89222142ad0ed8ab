//! Manifests follow their published schema.

use lamplight_bundle::{SCHEMA, write_directory};
use serde_json::Value;

use super::{Outcome, check, small};

pub fn schema() -> Outcome {
    let folder = tempfile::tempdir()?;
    write_directory(&small(), folder.path())?;
    let schema: Value = serde_json::from_str(SCHEMA)?;
    let manifest: Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("manifest.json"))?)?;
    conforms(&schema, &schema, &manifest, "manifest")
}

/// Checks a value against a schema, for the part of JSON Schema that the published schema uses.
pub fn conforms(root: &Value, schema: &Value, value: &Value, place: &str) -> Outcome {
    if let Some(name) = schema["$ref"].as_str() {
        return conforms(
            root,
            root.pointer(&name[1..]).ok_or_else(|| format!("{place}: no definition `{name}`"))?,
            value,
            place,
        );
    }
    let is_type = match schema["type"].as_str() {
        Some("object") => value.is_object(),
        Some("array") => value.is_array(),
        Some("string") => value.is_string(),
        Some("integer") => value.is_u64(),
        Some("boolean") => value.is_boolean(),
        _ => true,
    };
    check(is_type, &format!("{place} has the wrong type"))?;
    check(
        schema.get("const").is_none_or(|only| only == value),
        &format!("{place} is {value}, the schema allows only {}", schema["const"]),
    )?;
    check(
        schema["enum"].as_array().is_none_or(|known| known.contains(value)),
        &format!("{place} is {value}, the schema allows {}", schema["enum"]),
    )?;
    for name in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
        check(value.get(name).is_some(), &format!("{place} has no {name}"))?;
    }
    for (name, member) in value.as_object().into_iter().flatten() {
        let known = schema["properties"].get(name).unwrap_or(&schema["additionalProperties"]);
        check(known != &Value::Bool(false), &format!("{place} has an unknown member {name}"))?;
        conforms(root, known, member, &format!("{place}.{name}"))?;
    }
    value
        .as_array()
        .into_iter()
        .flatten()
        .try_for_each(|item| conforms(root, &schema["items"], item, place))
}
