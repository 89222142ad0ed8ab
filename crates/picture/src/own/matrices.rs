//! Matrices by their names: products of the steps between the object, the world, the view and clip
//! space.

use glam::{DMat3, DMat4};

use super::around::Around;
use super::shape::NumberType;
use super::words::{has_word, name_words};

const MODEL: &[&str] = &["model", "world", "object", "local", "m"];
const VIEW: &[&str] = &["view", "camera", "cam", "eye", "v"];
const PROJECTION: &[&str] = &["projection", "proj", "perspective", "clip", "p"];
const LIGHT: &[&str] = &["light", "lamp", "sun", "shadow", "caster"];
const INVERSE: &[&str] = &["inverse", "inv", "inverted"];
const NORMAL: &[&str] = &["normal", "n"];
/// Matrices that leave things as they are.
const IDENTITY: &[&str] = &["texture", "tex", "uv", "bone", "bones", "joint", "joints", "color"];
/// Words for the matrix that does all.
const WHOLE: &[&str] = &["transform", "matrix", "mat", "transformation"];

/// A space, from that of the object on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Space {
    Object,
    World,
    View,
    Clip,
}

/// A matrix with what it is, in words.
pub type NamedMatrix = (DMat4, String);

/// Whether a name is that of the product of model and view, as three.js has it.
pub fn is_model_view(name: &str) -> bool {
    let words = name_words(name);
    let has = |known| has_word(&words, known);
    has(MODEL) && has(VIEW) && !has(PROJECTION) && !has(NORMAL) && !has(INVERSE)
}

/// Whether matrices of these names leave out the view: there is a projection and a model, and nothing
/// in between.
pub fn lacks_view(names: &[&str]) -> bool {
    let has = |name: &str, known: &[&str]| has_word(&name_words(name), known);
    let is_step = |name: &str| has(name, PROJECTION) && !has(name, MODEL) && !has(name, LIGHT);
    let is_other = |name: &str| has(name, VIEW) || has(name, &["from"]);
    let any = |is: &dyn Fn(&str) -> bool| names.iter().any(|name| is(name));
    any(&is_step) && any(&|name| has(name, MODEL)) && !any(&is_other)
}

/// The numbers of a matrix, column by column, and what it is. `None` if its name says nothing.
pub fn matrix_numbers(
    block: &str,
    name: &str,
    ty: NumberType,
    around: &Around<'_>,
) -> Option<(Vec<f64>, String)> {
    let own = name_words(name);
    let both: Vec<String> = name_words(block).into_iter().chain(own.iter().cloned()).collect();
    let (matrix, text) = named_matrix(&own, around).or_else(|| named_matrix(&both, around))?;
    let columns = (0..ty.columns).map(|column| matrix.col(column).to_array());
    Some((columns.flat_map(|column| column[..ty.rows].to_vec()).collect(), text))
}

fn named_matrix(words: &[String], around: &Around<'_>) -> Option<NamedMatrix> {
    if has_word(words, IDENTITY) {
        return Some((DMat4::IDENTITY, "identity".to_owned()));
    }
    if let Some(matrix) = between_spaces(words, around) {
        return Some(matrix);
    }
    if has_word(words, LIGHT) {
        return Some(of_light(around));
    }
    let steps = [MODEL, VIEW, PROJECTION].map(|known| has_word(words, known));
    let is_inverse = has_word(words, INVERSE);
    // The inverse of the model's matrix, transposed, is the one for normals.
    if has_word(words, NORMAL) || (is_inverse && has_word(words, &["transpose", "transposed"])) {
        let is_plain = !steps.contains(&true);
        return Some(of_normals(steps[1] || is_plain && around.seen_normals, around));
    }
    let whole = has_word(words, WHOLE) && words.len() == 1;
    if !steps.contains(&true) && !whole {
        return None;
    }
    // Without a matrix of the view, that of the model leads there.
    let steps = [steps[0], steps[1] || steps[0] && around.seen_model, steps[2]];
    let taken: Vec<usize> = (0..3).filter(|step| whole || steps[*step]).collect();
    Some(product(&taken, is_inverse, around))
}

fn of_light(around: &Around<'_>) -> NamedMatrix {
    (around.light_from_world(), "projection * view of the light".to_owned())
}

fn of_normals(seen: bool, around: &Around<'_>) -> NamedMatrix {
    let (view, text) = match seen {
        true => (around.step(1), "normals to view space"),
        false => (DMat4::IDENTITY, "normals to world space"),
    };
    let turned = DMat3::from_mat4(view * around.step(0)).inverse().transpose();
    (DMat4::from_mat3(turned), text.to_owned())
}

/// The product of steps, the first one rightmost.
fn product(steps: &[usize], is_inverse: bool, around: &Around<'_>) -> NamedMatrix {
    let matrix = steps.iter().fold(DMat4::IDENTITY, |left, step| around.step(*step) * left);
    let names: Vec<&str> =
        steps.iter().rev().map(|step| ["model", "view", "projection"][*step]).collect();
    let text = names.join(" * ");
    match is_inverse {
        true => (matrix.inverse(), format!("inverse of {text}")),
        false => (matrix, text),
    }
}

/// `clip_from_world` and the like, as this library names matrices.
fn between_spaces(words: &[String], around: &Around<'_>) -> Option<NamedMatrix> {
    let at = words.iter().position(|word| word == "from")?;
    let [to, from] = [at.checked_sub(1)?, at + 1].map(|at| words.get(at).map(String::as_str));
    let (to, from) = (to?, from?);
    if NORMAL.contains(&to) {
        return Some(of_normals(false, around));
    }
    if LIGHT.contains(&to) {
        return Some(of_light(around));
    }
    let [to, from] = [to, from].map(space_of);
    let (to, from) = (to?, from?);
    let (low, high) = (from.min(to) as usize, from.max(to) as usize);
    let steps: Vec<usize> = (low..high).collect();
    Some(product(&steps, to < from, around))
}

fn space_of(word: &str) -> Option<Space> {
    Some(match word {
        "object" | "model" | "local" | "mesh" => Space::Object,
        "world" => Space::World,
        "view" | "camera" | "eye" => Space::View,
        "clip" | "projection" | "ndc" => Space::Clip,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DMat4};

    use super::{is_model_view, lacks_view, matrix_numbers};
    use crate::own::around::Around;
    use crate::own::around::tests::sample;
    use crate::own::shape::NumberType;

    /// Each name against the product that its books state.
    #[test]
    fn products_of_names() -> Result<(), String> {
        let around = sample();
        let (model, view, projection) = (around.step(0), around.step(1), around.step(2));
        assert!(model != DMat4::IDENTITY, "the object has a place of its own");
        let normal = DMat4::from_mat3(DMat3::from_mat4(model).inverse().transpose());
        for (block, name, expected) in [
            ("", "model", model),
            ("", "u_view", view),
            ("", "projection", projection),
            ("", "projectionMatrix", projection),
            ("", "modelViewMatrix", view * model),
            ("uniforms", "modelViewProjectionMatrix", projection * view * model),
            ("", "uMVP", projection * view * model),
            ("camera", "view_proj", projection * view),
            ("camera", "clip_from_world", projection * view),
            ("object", "world_from_object", model),
            ("camera", "world_from_view", view.inverse()),
            ("camera", "inverse_view", view.inverse()),
            ("", "normalMatrix", normal),
            ("", "u_worldInverseTranspose", normal),
            ("", "transform", projection * view * model),
            ("", "uvTransform", DMat4::IDENTITY),
        ] {
            let found = matrix_numbers(block, name, NumberType::of("mat4x4<f32>"), &around);
            let (found, _) = found.ok_or_else(|| format!("nothing for {name}"))?;
            let off = found.iter().zip(expected.to_cols_array());
            assert!(off.clone().all(|(a, b)| (a - b).abs() < 1e-9), "{name}: {found:?}");
        }
        assert_eq!(matrix_numbers("", "wobble", NumberType::of("mat4x4<f32>"), &around), None);
        Ok(())
    }

    /// Matrices of three columns, and what a name means beside others.
    #[test]
    fn products_beside_others() {
        let around = sample();
        let (model, view) = (around.step(0), around.step(1));
        let numbers = |name: &str, ty: &str, around: &Around<'_>| {
            let found = matrix_numbers("", name, NumberType::of(ty), around);
            found.map(|(numbers, _)| numbers).unwrap_or_default()
        };
        let close = |found: &[f64], expected: &[f64]| {
            found.len() == expected.len()
                && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9)
        };
        let normal = |matrix: DMat4| DMat3::from_mat4(matrix).inverse().transpose().to_cols_array();
        let found = numbers("normalMatrix", "mat3x3<f32>", &around);
        assert!(close(&found, &normal(model)), "{found:?}");
        let seen = Around { seen_normals: true, ..around.clone() };
        let found = numbers("normalMatrix", "mat3x3<f32>", &seen);
        assert!(close(&found, &normal(view * model)), "{found:?}");
        let seen = Around { seen_model: true, ..around.clone() };
        let found = numbers("model", "mat4x4<f32>", &seen);
        assert!(close(&found, &(view * model).to_cols_array()), "{found:?}");
        assert!(lacks_view(&["projection", "model"]));
        assert!(!lacks_view(&["projection", "view", "model"]));
        assert!(!lacks_view(&["uMVP", "model"]));
        assert!(is_model_view("modelViewMatrix") && !is_model_view("uMVP"));
    }
}
