//! What is around a shader while it is drawn: the viewer, the light, the object and the time.

use glam::{DMat4, DVec3};

use lamplight_scene::{Clip, Depth, perspective};
use lamplight_scenes::sets::{Eye, Lamp, LampKind, Object};

use crate::Shot;
use crate::values::eye_projection_for;

/// Everything that defaults are computed from.
#[derive(Debug, Clone)]
pub struct Around<'a> {
    pub eye: Eye,
    pub lamps: &'a [Lamp],
    pub world_from_object: DMat4,
    /// The clip space of the author's API.
    pub clip: Clip,
    /// Seconds.
    pub time: f64,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Whether the matrix for normals leads to view space, as where the stage knows only the product
    /// of model and view.
    pub seen_normals: bool,
    /// Whether the matrix of the model leads to view space, as where the stage knows a projection and
    /// no view.
    pub seen_model: bool,
}

/// The light where a model has none: above the viewer, to the right.
pub const LAMP: Lamp = Lamp {
    color: DVec3::ONE,
    position: DVec3::new(1.0, 3.0, 4.0),
    target: DVec3::ZERO,
    half_angle: 0.4,
    kind: LampKind::Point,
};

impl Around<'_> {
    /// The lamp of that number; beyond the last one the first.
    pub fn lamp(&self, index: usize) -> Lamp {
        self.lamps.get(index).or(self.lamps.first()).copied().unwrap_or(LAMP)
    }

    /// The step from the object to the world, from there to the view, and from there to clip space.
    pub fn step(&self, step: usize) -> DMat4 {
        match step {
            0 => self.world_from_object,
            1 => self.eye.view(),
            _ => self.projection(),
        }
    }

    fn projection(&self) -> DMat4 {
        eye_projection_for(&self.eye, self.size.map(|side| side.max(1)), self.clip)
    }

    /// From the world to the clip space of a shadow map of the first lamp.
    pub fn light_from_world(&self) -> DMat4 {
        let lamp = self.lamp(0);
        let reach = lamp.reach().max(1e-3);
        let view = lamplight_scene::look_at(lamp.position, lamp.target, DVec3::Y);
        perspective(1.0, 1.0, 0.1 * reach, 3.0 * reach, self.clip, Depth::Normal) * view
    }

    /// The same for another object.
    #[must_use]
    pub fn of_object(&self, object: &Object) -> Self {
        Self { world_from_object: object.world_from_object, ..self.clone() }
    }
}

/// What a picture of a size shows at a time.
pub fn around_of<'a>(
    eye: Eye,
    lamps: &'a [Lamp],
    clip: Clip,
    time: f64,
    shot: &Shot,
) -> Around<'a> {
    let (world_from_object, size) = (DMat4::IDENTITY, shot.size);
    let (seen_normals, seen_model) = (false, false);
    Around { eye, lamps, world_from_object, clip, time, size, seen_normals, seen_model }
}

#[cfg(test)]
pub mod tests {
    use super::{Around, LAMP};
    use glam::{DMat4, DVec3};
    use lamplight_scene::Clip;
    use lamplight_scenes::sets::Eye;

    /// A viewer, a light, and an object that is turned and scaled.
    pub fn sample() -> Around<'static> {
        let (position, target) = (DVec3::new(1.0, 2.0, 4.0), DVec3::new(0.0, 0.5, 0.0));
        Around {
            eye: Eye { position, target, fov_y: 0.8, near: 0.5, far: 20.0 },
            lamps: &[LAMP],
            world_from_object: DMat4::from_rotation_y(0.5)
                * DMat4::from_scale(DVec3::new(1.0, 2.0, 1.0)),
            clip: Clip::Wgpu,
            time: 1.5,
            size: [64, 32],
            seen_normals: false,
            seen_model: false,
        }
    }
}
