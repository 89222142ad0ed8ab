//! `lamplight render --model`: what is drawn comes from a file.

use std::io::Write;

use glam::DVec3;

use super::super::input::axis_value;
use super::super::terminal;
use super::{Arguments, Failure};
use crate::limits::MODEL_BYTES;
use crate::model::{self, Model, View};
use crate::picture::Plan;
use crate::picture::frame::Programs;

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
                true => Err("the viewer stands where it looks".to_owned()),
            }
        }
        _ => Err("expected the number of a camera, or six numbers: X,Y,Z,X,Y,Z".to_owned()),
    }
}

/// The model that is asked for; what is left out of it is said on standard error.
pub fn read_model(arguments: &Arguments) -> Result<Option<Model>, Failure> {
    let Some(path) = &arguments.model else { return Ok(None) };
    let shown = path.display();
    let bytes = crate::input::read_file(path, MODEL_BYTES)
        .map_err(|error| Failure::input(format!("cannot read `{shown}`: {error}")))?;
    let model = model::read_model(&bytes, arguments.camera.unwrap_or(View::Own))
        .map_err(|error| Failure::input(format!("`{shown}`: {error}")))?;
    for note in &model.notes {
        writeln!(terminal::stderr(), "note: `{shown}`: {note}")?;
    }
    Ok(Some(model))
}

/// The permutation that shows a model: that of the user, whose axes go before the model's own.
pub fn model_plan(
    programs: &Programs,
    arguments: &Arguments,
    model: &Model,
) -> Result<Plan, Failure> {
    let is_forward = arguments.program.as_deref().is_none_or(|program| program == "forward");
    if !is_forward || arguments.preset.is_some() {
        return super::permutation_plan(programs, arguments);
    }
    let is_chosen = |axis: &str| arguments.set.iter().any(|(chosen, _)| chosen == axis);
    let with = |own: &mut dyn Iterator<Item = &String>| {
        let own = own.filter_map(|axis| axis_value(axis).ok());
        let free = own.filter(|(axis, _)| !is_chosen(axis));
        let set = free.chain(arguments.set.iter().cloned()).collect();
        super::permutation_plan(programs, &Arguments { set, ..arguments.clone() })
    };
    // What the user chose may exclude what the model would have.
    with(&mut model.axes.iter().chain(&model.layers))
        .or_else(|_| {
            let layers = model.layers.iter().filter(|axis| *axis != "dispersion=true");
            with(&mut model.axes.iter().chain(layers))
        })
        .or_else(|_| with(&mut model.axes.iter()))
        .or_else(|_| super::permutation_plan(programs, arguments))
}
