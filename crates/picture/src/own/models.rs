//! Models that have names: single shapes, and the scenes of the pictures.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use lamplight_scenes::Shape;
use lamplight_scenes::sets::{self, Eye, Scene};

use super::around::LAMP;
use crate::sketch::{MODELS, turned_eye, white_object};

/// The model or scene of that name.
pub fn named_scene(name: &str) -> Option<Scene> {
    let shape = MODELS.iter().find(|(known, _)| *known == name);
    shape.map(|(_, shape)| scene_of(shape())).or_else(|| sets::scene(name))
}

/// The names of models, then those of scenes.
pub fn model_names() -> impl Iterator<Item = &'static str> + Clone {
    MODELS.iter().map(|(name, _)| *name).chain(sets::ALL.iter().map(|set| set.name))
}

/// The sphere, which is drawn where nobody chooses a model.
pub fn default_scene() -> Scene {
    let (_, sphere) = MODELS[0];
    scene_of(sphere())
}

/// The model or scene of that name, as a viewer sees it who has walked around it and up, by angles in
/// radians, with the light at a place.
pub fn turned_scene(name: &str, turn: [f64; 2], lamp: DVec3) -> Option<Scene> {
    let mut scene = named_scene(name)?;
    let is_model = MODELS.iter().any(|(known, _)| *known == name);
    scene.eye = if is_model { turned_eye(turn) } else { scene.eye.turned(turn) };
    if let Some(light) = scene.lamps.first_mut().filter(|_| is_model) {
        light.position = lamp;
    }
    Some(scene)
}

fn scene_of(shape: Shape) -> Scene {
    Scene::of_model(vec![white_object(shape)], eye(), vec![LAMP])
}

/// The viewer: a little to the left and above, so that a cube shows three of its sides.
fn eye() -> Eye {
    turned_eye([-0.5, 0.3 * FRAC_PI_2])
}

#[cfg(test)]
mod tests {
    use super::{model_names, named_scene};

    #[test]
    fn models_by_name() {
        for name in ["sphere", "cube", "plane", "torus", "vase", "casters"] {
            assert!(model_names().any(|known| known == name), "{name}");
            let scene = named_scene(name);
            assert!(scene.is_some_and(|scene| !scene.objects.is_empty()), "{name}");
        }
        assert!(named_scene("shpere").is_none());
    }
}
