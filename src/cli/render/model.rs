//! `lamplight render --model`: what is drawn comes from a file.

use std::io::Write;
use std::path::Path;

use glam::DVec3;

use super::super::input::axis_value;
use super::super::terminal;
use super::{Arguments, Failure};
use crate::bundle::key::{IMPLIED, has_value};
use crate::limits::MODEL_BYTES;
use crate::model::{self, Lacks, Model, View};
use crate::permute::Setting;
use crate::picture::Plan;
use crate::picture::frame::Programs;
use crate::scene::sets::Scene;

/// From where the model is seen, as `--camera` says it.
pub fn parse_view(text: &str) -> Result<View, String> {
    if let Ok(index) = text.parse() {
        return Ok(View::Camera(index));
    }
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let numbers = numbers.unwrap_or_default();
    match numbers.as_slice() {
        [a, b, c, x, y, z] if numbers.iter().all(|number| number.is_finite()) => {
            let (position, target) = (DVec3::new(*a, *b, *c), DVec3::new(*x, *y, *z));
            match position == target {
                false => Ok(View::At(position, target)),
                true => Err("the camera is at the point that it looks at".to_owned()),
            }
        }
        _ => Err("expected the number of a camera, or six numbers: X,Y,Z,X,Y,Z".to_owned()),
    }
}

/// The model that is asked for; what is left out of it is listed on standard error.
pub fn read_model(arguments: &Arguments) -> Result<Option<Model>, Failure> {
    let Some(path) = &arguments.model else { return Ok(None) };
    let shown = path.display();
    let bytes = crate::input::read_file(path, MODEL_BYTES)
        .map_err(|error| Failure::input(format!("cannot read `{shown}`: {error}")))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let beside = |name: &str| {
        let bytes = crate::input::read_file(&folder.join(name), MODEL_BYTES);
        bytes.map_err(|error| format!("cannot read `{name}`: {error}"))
    };
    let model = model::read_model_beside(&bytes, arguments.camera.unwrap_or(View::Own), &beside)
        .map_err(|error| Failure::input(format!("`{shown}`: {error}")))?;
    for note in &model.notes {
        writeln!(terminal::stderr(), "note: `{shown}`: {note}")?;
    }
    Ok(Some(model))
}

/// The programs that light a model as its materials say.
const LIT: [&str; 2] = ["forward", "deferred"];

/// The permutation that shows a model. Axes that the user chose take precedence over those that the
/// model asks for.
pub fn model_plan(
    programs: &Programs,
    arguments: &Arguments,
    model: &Model,
) -> Result<Plan, Failure> {
    let name = arguments.program.as_deref().unwrap_or("forward");
    let program = programs.manifest().program(name).filter(|_| LIT.contains(&name));
    let Some(program) = program.filter(|_| arguments.preset.is_none()) else {
        return super::permutation_plan(programs, arguments);
    };
    let has = |axis: &str, value: &Setting| {
        program.space.axes().iter().any(|own| own.name == axis && own.ordinal(value).is_some())
    };
    let is_chosen =
        |axis: &str| arguments.input.chosen_axes().iter().any(|(chosen, _)| chosen == axis);
    let own = model.axes.iter().chain(&model.layers);
    let own = own
        .map(String::as_str)
        .filter(|value| axis_value(value).is_ok_and(|(axis, _)| !is_chosen(&axis)));
    let (own, lacking): (Vec<&str>, Vec<&str>) =
        own.partition(|value| axis_value(value).is_ok_and(|(axis, value)| has(&axis, &value)));
    let is_layer = |value: &str| model.layers.iter().any(|layer| layer == value);
    // The user's choices may exclude values that the model asks for. Each step keeps fewer of
    // these, until the constraints hold.
    let is_of_lamp = |value: &str| value.starts_with("attenuation=") || value.starts_with("cone=");
    let kept: [&dyn Fn(&str) -> bool; 7] = [
        &|_| true,
        &|value| !is_of_lamp(value),
        &|value| value != "dispersion=true",
        &|value| !matches!(value, "dispersion=true" | "occlusion=map"),
        &|value| !matches!(value, "dispersion=true" | "occlusion=map" | "material_maps=true"),
        &|value| !is_layer(value),
        &|value| !is_layer(value) && !is_of_lamp(value),
    ];
    for keeps in kept {
        let (set, left_out): (Vec<&str>, Vec<&str>) = own.iter().partition(|value| keeps(value));
        let set = set.into_iter().filter_map(|value| axis_value(value).ok());
        let set = set.chain(arguments.input.chosen_axes().iter().cloned()).collect();
        let chosen = Arguments { input: arguments.input.with_axes(set), ..arguments.clone() };
        if let Ok(plan) = super::permutation_plan(programs, &chosen) {
            report_omissions(&[left_out, lacking].concat())?;
            return Ok(plan);
        }
    }
    let plan = super::permutation_plan(programs, arguments)?;
    report_omissions(&[own, lacking].concat())?;
    Ok(plan)
}

/// The scene of a model for a permutation. A note on standard error names the textures that the
/// permutation cannot show.
pub fn model_scene(model: Model, plan: &Plan) -> Result<Scene, Failure> {
    let key = plan.last().map_or("", |pass| pass.key.as_str());
    let lacks = Lacks {
        maps: !has_value(key, "material_maps", IMPLIED),
        occlusion: !has_value(key, "occlusion", "map"),
    };
    let (scene, note) = model.scene_of(lacks);
    if let Some(note) = note {
        writeln!(terminal::stderr(), "note: {note}")?;
    }
    let is_forward = plan.last().is_some_and(|pass| pass.program == "forward");
    if !is_forward && scene.objects.iter().any(|object| object.is_blended) {
        let note = "surfaces that are blended by alpha are drawn as if they were opaque";
        writeln!(terminal::stderr(), "note: {note}")?;
    }
    Ok(scene)
}

/// Says on standard error which values of axes the model asks for and the permutation does not
/// have.
fn report_omissions(values: &[&str]) -> Result<(), Failure> {
    if !values.is_empty() {
        let values = values.join(", ");
        let note = "the model asks for values that the permutation cannot have";
        writeln!(terminal::stderr(), "note: {note}: {values}")?;
    }
    Ok(())
}
