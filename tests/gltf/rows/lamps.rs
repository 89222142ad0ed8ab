//! KHR_lights_punctual, and cameras.

use serde_json::{Value, json};

use super::{Row, bulging, plain, row};
use crate::gltf::model::Model;

const TEXT: &str = "KHR_lights_punctual";

/// A model with one lamp.
fn lit(light: Value, place: Value) -> Model {
    let mut model = Model::new();
    model.add_material(plain(json!({})));
    model.add(bulging(), json!({}));
    model.add_lamp(light, place);
    model
}

/// The turn by an angle about x and then by one about y.
fn turned(x: f64, y: f64) -> Value {
    let turn = glam::DQuat::from_rotation_y(y) * glam::DQuat::from_rotation_x(x);
    json!(turn.to_array())
}

fn rows_first() -> Vec<Row> {
    vec![
        row("directional", TEXT, "lux, along -z of its node", || {
            lit(
                json!({ "type": "directional", "color": [1.0, 0.5, 0.2], "intensity": 2.5 }),
                json!({ "rotation": turned(-0.5, 0.6) }),
            )
        }),
        row("point", TEXT, "candela, by the square of the distance", || {
            lit(
                json!({ "type": "point", "intensity": 5.0 }),
                json!({ "translation": [0.3, -0.2, 0.8], "scale": [3.0, 3.0, 3.0] }),
            )
        }),
        row("range", TEXT, "ends at its range, by the recommended factor", || {
            lit(
                json!({ "type": "point", "intensity": 5.0, "range": 1.1 }),
                json!({ "translation": [0.3, -0.2, 0.7] }),
            )
        }),
        row("spot", TEXT, "between its angles, by the reference code", || {
            lit(
                json!({ "type": "spot", "intensity": 9.0,
                    "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.6 } }),
                json!({ "translation": [0.2, 0.5, 1.4], "rotation": turned(-0.3, 0.1) }),
            )
        }),
        row("spot_defaults", TEXT, "0 and a quarter of pi", || {
            lit(
                json!({ "type": "spot", "intensity": 9.0, "range": 4.0, "spot": {} }),
                json!({ "translation": [0.2, 0.3, 1.2], "rotation": turned(-0.2, 0.1) }),
            )
        }),
    ]
}

fn rows_second() -> Vec<Row> {
    vec![
        row("ten_lamps", TEXT, "all of ten", || {
            let mut model = lit(
                json!({ "type": "directional", "intensity": 0.3 }),
                json!({ "rotation": turned(-0.5, 0.6) }),
            );
            for index in 0..9 {
                let angle = 0.7 * f64::from(index);
                let kind = ["point", "spot"][index as usize % 2];
                model.add_lamp(
                    json!({ "type": kind, "intensity": 0.8, "color": [1.0, 0.1 * angle, 0.5],
                        "spot": { "innerConeAngle": 0.5, "outerConeAngle": 1.2 } }),
                    json!({ "translation": [angle.cos(), angle.sin(), 1.0] }),
                );
            }
            model
        }),
        row("lamp_in_hierarchy", TEXT, "at the place of its node in the world", || {
            let mut model = lit(
                json!({ "type": "spot", "intensity": 9.0, "spot": { "outerConeAngle": 0.7 } }),
                json!({ "translation": [0.2, 0.5, 1.0], "rotation": turned(-0.3, 0.1) }),
            );
            let last = model.document["nodes"].as_array().expect("nodes").len() - 1;
            model.document["scenes"][0]["nodes"].as_array_mut().expect("nodes").pop();
            model.add_node(json!({ "children": [last], "translation": [-0.3, 0.0, 0.2],
                "rotation": turned(0.1, -0.1), "scale": [1.0, 1.0, 1.2] }));
            model
        }),
        row("camera_perspective", "3.10.3.3", "`yfov`, with the node's place", || {
            let mut model = Model::of(bulging(), plain(json!({})));
            model.document["nodes"][0] = json!({ "camera": 0,
                "translation": [0.5, 0.6, 2.6], "rotation": turned(-0.25, 0.2) });
            model.document["cameras"][0]["perspective"]["yfov"] = json!(0.45);
            model
        }),
    ]
}

fn rows_third() -> Vec<Row> {
    const TEXT: &str = "3.10.3.4";
    vec![
        row("camera_orthographic", TEXT, "as a camera far away with a narrow angle", || {
            parallel(3.0)
        }),
        row("camera_orthographic_far", TEXT, "the distance of the camera changes nothing", || {
            parallel(200.0)
        }),
    ]
}

/// Seen by parallel rays from a distance.
fn parallel(distance: f64) -> Model {
    let mut model = Model::of(bulging(), plain(json!({})));
    model.document["nodes"][0]["translation"] = json!([0.0, 0.0, distance]);
    model.document["cameras"][0] = json!({ "type": "orthographic",
        "orthographic": { "xmag": 0.8, "ymag": 0.8, "znear": 0.1, "zfar": 500.0 } });
    model
}

pub fn rows() -> Vec<Row> {
    [rows_first(), rows_second(), rows_third()].concat()
}
