//! The JSON document of a model. What it needs of extensions and versions is checked before anything
//! else. What glTF allows and the crate that reads it does not is changed or let through: animations
//! whose channels have no node, scenes without nodes, accessors without a buffer view, and positions
//! without bounds.

use std::collections::{BTreeMap, BTreeSet};

use gltf::json::validation::{Error, Validate};
use gltf::json::{Path, Root};
use serde::Deserialize;
use serde_json::value::RawValue;
use serde_json::{Map, Value};

/// Extensions that are read.
const READ: [&str; 19] = [
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
];

/// Extensions that say what else could be shown. A model that requires them can be drawn without:
/// with its default materials, and at rest.
const OPTIONAL: [&str; 3] = ["KHR_animation_pointer", "KHR_materials_variants", "KHR_xmp_json_ld"];

/// Extensions of which much of a model may consist, with what to do without them.
const ADVICE: [(&str, &str); 5] = [
    ("KHR_draco_mesh_compression", COMPRESSED),
    ("KHR_meshopt_compression", COMPRESSED),
    ("EXT_meshopt_compression", COMPRESSED),
    ("KHR_texture_basisu", "its images are KTX 2 with Basis Universal; export them as PNG or JPEG"),
    ("MSFT_texture_dds", "its images are DDS; export them as PNG or JPEG"),
];

/// glTF-Transform decodes both compressions and does not write them again.
const COMPRESSED: &str = "its meshes are compressed; export it without compression, or convert it: \
    `gltf-transform cp IN.glb OUT.glb`";

/// Whether an extension is read.
pub fn is_read(extension: &str) -> bool {
    READ.contains(&extension)
}

/// The parts of a document that are checked first.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Head {
    asset: Version,
    #[serde(default)]
    extensions_used: Vec<String>,
    #[serde(default)]
    extensions_required: Vec<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Version {
    version: String,
    min_version: Option<String>,
}

/// Reads a document. What of it is ignored is added to the notes.
///
/// # Errors
/// In words, with the place in the document: it needs a version or an extension that is not read, or
/// it is broken.
pub fn read_document(json: &[u8], notes: &mut BTreeSet<String>) -> Result<gltf::Document, String> {
    let head: Head = serde_json::from_slice(json).map_err(|error| error.to_string())?;
    check_version(&head.asset)?;
    check_extensions(&head, notes)?;
    let changed = without_animations(json, notes)?;
    let root: Root = serde_json::from_slice(changed.as_deref().unwrap_or(json))
        .map_err(|error| error.to_string())?;
    check_compression(&root)?;
    check_root(&root)?;
    note_textures(&root, notes);
    Ok(gltf::Document::from_json_without_validation(root))
}

/// glTF 2.0, 3.2: a loader must refuse a `minVersion` that is newer than what it reads, and without
/// one every minor version of 2 can be read.
fn check_version(asset: &Version) -> Result<(), String> {
    let number = |text: &str| {
        let (major, minor) = text.split_once('.')?;
        Some((major.parse::<u32>().ok()?, minor.parse::<u32>().ok()?))
    };
    let known = |field: &str, text: &str| {
        let wrong = || format!("asset.{field}: expected a version such as 2.0, found `{text}`");
        number(text).ok_or_else(wrong)
    };
    if let Some(text) = &asset.min_version
        && known("minVersion", text)? > (2, 0)
    {
        return Err(format!("asset.minVersion: it needs glTF {text}, and 2.0 is read"));
    }
    match known("version", &asset.version)? {
        (2, _) => Ok(()),
        _ => Err(format!("asset.version: glTF {} is not read, only 2.0", asset.version)),
    }
}

fn check_extensions(head: &Head, notes: &mut BTreeSet<String>) -> Result<(), String> {
    let advice = |name: &str| ADVICE.iter().find(|known| known.0 == name).map(|known| known.1);
    let needed = |name: &&String| !is_read(name) && !OPTIONAL.contains(&name.as_str());
    let needed: Vec<String> = head
        .extensions_required
        .iter()
        .filter(needed)
        .map(|name| match advice(name) {
            Some(advice) => format!("`{name}` is not read: {advice}"),
            None => format!("`{name}` is not read"),
        })
        .collect();
    if !needed.is_empty() {
        return Err(format!("extensionsRequired: {}", needed.join("; ")));
    }
    let ignored = head.extensions_used.iter().filter(|name| !is_read(name));
    notes.extend(ignored.map(|name| ignored_extension(name)));
    Ok(())
}

/// The note on an extension that is not read.
pub fn ignored_extension(name: &str) -> String {
    format!("ignored, since no program supports it: {name}")
}

/// The document without animations, which are not drawn, and with empty lists for scenes that have
/// no nodes. `None` if that is the document itself.
fn without_animations(
    json: &[u8],
    notes: &mut BTreeSet<String>,
) -> Result<Option<Vec<u8>>, String> {
    let broken = |error: serde_json::Error| error.to_string();
    let mut parts: BTreeMap<String, Box<RawValue>> =
        serde_json::from_slice(json).map_err(broken)?;
    let animations = parts.remove("animations");
    if animations.is_some() {
        notes.insert("animations are ignored: the model is drawn at rest".to_owned());
    }
    let scenes = parts.get("scenes").map(|text| serde_json::from_str(text.get()));
    let mut scenes: Vec<Map<String, Value>> =
        scenes.transpose().map_err(broken)?.unwrap_or_default();
    let is_whole = scenes.iter().all(|scene| scene.contains_key("nodes"));
    if animations.is_none() && is_whole {
        return Ok(None);
    }
    for scene in &mut scenes {
        scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
    if !scenes.is_empty() {
        let text = serde_json::to_string(&scenes).and_then(RawValue::from_string);
        parts.insert("scenes".to_owned(), text.map_err(broken)?);
    }
    serde_json::to_vec(&parts).map(Some).map_err(broken)
}

/// Refuses meshes that are only there in compressed form, though they need not be by the list of
/// required extensions.
fn check_compression(root: &Root) -> Result<(), String> {
    const DRACO: &str = "KHR_draco_mesh_compression";
    for (mesh, own) in root.meshes.iter().enumerate() {
        for (part, primitive) in own.primitives.iter().enumerate() {
            let extensions = primitive.extensions.as_ref();
            if !extensions.is_some_and(|all| all.others.contains_key(DRACO)) {
                continue;
            }
            let accessors = primitive.attributes.values().filter_map(|at| root.get(*at));
            let mut plain = accessors.filter(|own| own.buffer_view.is_some());
            if plain.next().is_none() {
                return Err(format!(
                    "meshes[{mesh}].primitives[{part}]: `{DRACO}` is not read: {COMPRESSED}"
                ));
            }
        }
    }
    Ok(())
}

/// Textures whose only image is one of an extension are white.
fn note_textures(root: &Root, notes: &mut BTreeSet<String>) {
    for (index, texture) in root.textures.iter().enumerate() {
        if texture.source.value() != u32::MAX as usize {
            continue;
        }
        let names = texture.extensions.iter().flat_map(|all| all.others.keys());
        let names: Vec<&str> = names.map(String::as_str).collect();
        if names.iter().any(|name| is_read(name)) {
            continue;
        }
        let why = match names.as_slice() {
            [] => "it has no image".to_owned(),
            _ => format!("its only image is that of {}", names.join(", ")),
        };
        notes.insert(format!("textures[{index}] is ignored: {why}"));
    }
}

/// Checks all numbers that lead from one part of the document to another, and all names.
fn check_root(root: &Root) -> Result<(), String> {
    const SHOWN: usize = 4;
    let mut problems = Vec::new();
    root.validate(root, Path::new, &mut |path, problem| {
        let path = path();
        if !is_allowed(path.as_str(), problem) && problems.len() < SHOWN {
            problems.push(format!("{path}: {problem}"));
        }
    });
    if problems.is_empty() { Ok(()) } else { Err(problems.join("; ")) }
}

/// Whether glTF allows what the crate reports, or it does no harm. Required extensions are checked
/// before. An accessor without a view has zeros.
fn is_allowed(path: &str, problem: Error) -> bool {
    let is_accessor = path.starts_with("accessors[") && path.ends_with("].bufferView");
    let is_bound = path.ends_with("[\"POSITION\"].min") || path.ends_with("[\"POSITION\"].max");
    match problem {
        Error::Unsupported => path.starts_with("extensionsRequired["),
        Error::Missing => is_accessor || is_bound,
        Error::IndexOutOfBounds | Error::Invalid | Error::Oversize => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn read(document: &Value) -> (Result<gltf::Document, String>, BTreeSet<String>) {
        let mut notes = BTreeSet::new();
        (read_document(document.to_string().as_bytes(), &mut notes), notes)
    }

    fn refusal(document: &Value) -> String {
        read(document).0.err().unwrap_or_default()
    }

    #[test]
    fn newer_minor_versions_are_read_unless_needed() {
        let version = |version: &str| json!({ "asset": { "version": version } });
        assert!(read(&version("2.1")).0.is_ok());
        assert!(refusal(&version("1.0")).contains("asset.version: glTF 1.0"));
        assert!(refusal(&version("two")).contains("asset.version: expected a version"));
        let needs = json!({ "asset": { "version": "2.1", "minVersion": "2.1" } });
        assert!(refusal(&needs).contains("asset.minVersion: it needs glTF 2.1"));
        let old = json!({ "asset": { "version": "2.1", "minVersion": "2.0" } });
        assert!(read(&old).0.is_ok());
    }

    #[test]
    fn extensions_are_named_before_other_problems() {
        let asset = json!({ "version": "2.0" });
        let document = json!({ "asset": asset, "scene": 7,
            "extensionsRequired": ["KHR_texture_basisu", "EXT_unheard_of"] });
        let found = refusal(&document);
        assert!(found.contains("`KHR_texture_basisu` is not read: its images are KTX"), "{found}");
        assert!(found.contains("`EXT_unheard_of` is not read"), "{found}");
    }

    #[test]
    fn names_that_are_not_read_are_noted() {
        let document = json!({ "asset": { "version": "2.0" }, "extensionsUsed":
            ["KHR_lights_punctual", "KHR_materials_variants", "EXT_unheard_of"],
            "extensionsRequired": ["KHR_lights_punctual", "KHR_materials_variants"] });
        let (found, notes) = read(&document);
        assert!(found.is_ok(), "{found:?}");
        let named = |name: &str| notes.iter().any(|note| note.ends_with(name));
        assert!(named("EXT_unheard_of") && named("KHR_materials_variants"), "{notes:?}");
        assert!(!named("KHR_lights_punctual"), "{notes:?}");
    }

    #[test]
    fn channels_need_no_node_and_scenes_no_nodes() {
        let document = json!({ "asset": { "version": "2.0" }, "scenes": [{ "name": "empty" }],
            "animations": [{ "channels": [{ "sampler": 0, "target": { "path": "pointer" } }],
                "samplers": [] }] });
        let (found, notes) = read(&document);
        assert_eq!(
            found.map(|document| document.scenes().count()),
            Ok(1).map_err(|()| String::new())
        );
        assert!(notes.iter().any(|note| note.starts_with("animations are ignored")), "{notes:?}");
    }

    #[test]
    fn meshes_in_compressed_form_alone_are_refused() {
        let document = json!({ "asset": { "version": "2.0" },
            "accessors": [{ "componentType": 5126, "count": 3, "type": "VEC3" }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 },
                "extensions": { "KHR_draco_mesh_compression": { "bufferView": 0 } } }] }] });
        assert!(refusal(&document).contains("meshes[0].primitives[0]: `KHR_draco"));
    }
}
