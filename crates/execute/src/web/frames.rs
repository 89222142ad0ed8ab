//! Draws frames from the bytes of a bundle, through the scripts.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Map, Value, json};

use super::{WebApi, asked, executor_failed};
use crate::ShippedPair;
use crate::fixture::Fixture;
use crate::frame::{
    BindingPlace, Buffers, DrawItem, Drawing, Frame, Mesh, PipelineState, VertexAttribute,
};
use crate::shipped::{ColorFormat, Shipped};
use lamplight_bundle::{ClipSpace, FrontFace, Target};
use lamplight_diagnostic::{Diagnostic, codes};

/// The argument of the script's function `frames`.
///
/// # Errors
/// The drawing needs something that is not supported here.
pub fn frames_question(
    api: WebApi,
    pair: ShippedPair<'_>,
    drawing: &Drawing<'_>,
) -> Result<Value, Diagnostic> {
    for stage in [pair.vertex, pair.fragment] {
        if stage.target != api.target() {
            return Err(executor_failed(format!("this executor draws no {}", stage.target)));
        }
    }
    let lacks = pair.fragment.lacks_of_webgpu().filter(|_| api.target() == Target::WGSL);
    if let Some(reason) = lacks {
        return Err(Diagnostic::error(codes::EXECUTOR_LACKS, reason));
    }
    if drawing.state != PipelineState::default() || !drawing.levels.is_empty() {
        let message = "shipped texts are drawn without depth test, culling and smaller levels";
        return Err(executor_failed(message));
    }
    let formats = pair.fragment.targets().map_err(executor_failed)?;
    let places = read_places(pair);
    let fixtures: Vec<(BindingPlace, &Fixture)> =
        places.iter().filter_map(|place| Some((*place, &**drawing.fixtures.get(place)?))).collect();
    let views = drawing.views.iter().map(|view| {
        let items = drawing.items.iter();
        items.map(|item| buffers_json(drawing, view, item, &places)).collect::<Result<Vec<_>, _>>()
    });
    let views = views.collect::<Result<Vec<_>, _>>().map_err(executor_failed)?;
    let reversed = |clip: &ClipSpace| clip.front_face == FrontFace::Reversed;
    Ok(json!({
        "size": drawing.size,
        "formats": formats.iter().map(|one| *one == ColorFormat::Float).collect::<Vec<_>>(),
        "vertex": stage_json(pair.vertex),
        "fragment": stage_json(pair.fragment),
        "layout": layout_json(drawing, &places, &fixtures),
        "fixtures": fixtures.iter().map(|(place, one)| asked::fixture_json(*place, one)).collect::<Vec<_>>(),
        "units": units_json(pair),
        "blocks": blocks_json(pair).map_err(executor_failed)?,
        "reversed": pair.vertex.native.clip.as_ref().is_some_and(reversed),
        "meshes": drawing.items.iter().map(|item| mesh_json(item.mesh)).collect::<Vec<_>>(),
        "views": views,
    }))
}

/// The frames in an answer: the words of each target for each view.
pub fn frames_answer(said: &Value) -> Result<Vec<Frame>, String> {
    let list = |value: &Value| match value {
        Value::Array(list) => Ok(list.clone()),
        other => Err(format!("no frames: {other}")),
    };
    let frame = |said: &Value| {
        let targets =
            list(said)?.iter().map(asked::words_of_answer).collect::<Result<_, String>>()?;
        Ok(Frame { targets, depth: Vec::new(), detour: None })
    };
    list(said)?.iter().map(frame).collect()
}

fn stage_json(shipped: &Shipped) -> Value {
    json!({ "code": shipped.text(), "entry": shipped.native.entry_name })
}

/// The bindings of both stages.
fn read_places(pair: ShippedPair<'_>) -> BTreeSet<BindingPlace> {
    let stages = [pair.vertex, pair.fragment].into_iter();
    let bindings = stages.flat_map(|stage| &stage.reflection.bindings);
    bindings.map(|binding| (binding.group, binding.binding)).collect()
}

/// The layout of each bind group, by the group's index.
fn layout_json(
    drawing: &Drawing<'_>,
    places: &BTreeSet<BindingPlace>,
    fixtures: &[(BindingPlace, &Fixture)],
) -> Vec<Vec<Value>> {
    let filters = asked::are_filtered(fixtures.iter().map(|(_, fixture)| *fixture));
    let groups = places.iter().map(|(group, _)| group + 1).max().unwrap_or(0);
    let entry = |place: &BindingPlace| {
        let fixture = drawing.fixtures.get(place).map(|fixture| &**fixture);
        asked::layout_entry(*place, fixture, filters)
    };
    (0..groups)
        .map(|group| places.iter().filter(|place| place.0 == group).map(entry).collect())
        .collect()
}

/// The uniform buffers of an item in a view.
fn buffers_json(
    drawing: &Drawing<'_>,
    view: &Buffers,
    item: &DrawItem<'_>,
    places: &BTreeSet<BindingPlace>,
) -> Result<Value, String> {
    let mut found = Map::new();
    for place in places.iter().filter(|place| !drawing.fixtures.contains_key(place)) {
        let bytes = drawing.buffer(view, item, *place);
        let bytes = bytes.ok_or_else(|| format!("nothing is given for {place:?}"))?;
        found.insert(asked::binding_key(*place), asked::base64_of_bytes(bytes).into());
    }
    Ok(Value::Object(found))
}

/// The combined samplers of both stages of GLSL.
fn units_json(pair: ShippedPair<'_>) -> Vec<Value> {
    let stages = [pair.vertex, pair.fragment].into_iter();
    stages.flat_map(|stage| &stage.native.combined).map(asked::unit_json).collect()
}

/// The uniform blocks of both stages of GLSL by name, with a number for each group and binding.
fn blocks_json(pair: ShippedPair<'_>) -> Result<Vec<Value>, String> {
    let mut numbers: BTreeMap<BindingPlace, usize> = BTreeMap::new();
    let mut found = Vec::new();
    for stage in [pair.vertex, pair.fragment] {
        for place in stage.blocks() {
            let slots = &stage.native.slots;
            let slot = slots.iter().find(|slot| (slot.group, slot.binding) == place);
            let next = numbers.len();
            let number = *numbers.entry(place).or_insert(next);
            let name = slot.and_then(|slot| slot.name.as_deref());
            found.push(
                json!({ "name": name, "place": asked::binding_key(place), "number": number }),
            );
        }
    }
    Ok(found)
}

fn mesh_json(mesh: &Mesh) -> Value {
    let attribute = |(one, offset): (VertexAttribute, u64)| {
        json!({
            "shaderLocation": one.location,
            "offset": offset,
            // WebGPU calls `Float32x3` `float32x3`.
            "format": format!("{:?}", one.format).to_lowercase(),
            "words": one.format.words(),
        })
    };
    json!({
        "stride": mesh.stride(),
        "attributes": mesh.layout().into_iter().map(attribute).collect::<Vec<_>>(),
        "words": asked::base64_of_words(&mesh.words),
        "indices": asked::base64_of_words(&mesh.indices),
        "count": if mesh.indices.is_empty() { mesh.vertices() } else { mesh.indices.len() as u32 },
    })
}
