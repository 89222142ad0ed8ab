//! The field of light probes of a scene, for `ambient=ddgi`.

use glam::DVec3;

use super::lamps::Shining;
use super::values::{UniformValues, vector_of, vector_values};
use lamplight_scenes::sets::{Object, TextureMap};
use lamplight_scenes::{Look, PROBE_SIDES, ProbeField, ProbeGrid, Surfaces};

impl UniformValues<'_> {
    /// The light and the depths of all probes, computed on first use.
    fn probe_field(&self) -> &ProbeField {
        self.probes.get_or_init(|| {
            let surfaces = Surfaces::with_looks(self.scene, |object| self.look(object));
            let lamps = self.shining();
            let direct = |at: DVec3, normal: DVec3| direct_light(&lamps, &surfaces, at, normal);
            ProbeField::new(
                self.probe_grid(),
                &surfaces,
                &direct,
                self.scene.probes.unwrap_or_default().beyond,
            )
        })
    }

    /// The colours of an object that its uniforms have.
    fn look(&self, object: &Object) -> Look {
        let index = object.material_index as usize * if self.lit.needs.sides { 2 } else { 1 };
        let index = if self.lit.needs.material_array { index } else { 0 };
        let numbers = |path: &str| vector_of(&self.object(object, path).unwrap_or_default());
        let material = |field| numbers(&format!("materials.items[{index}].{field}"));
        let own = Look::of(object);
        Look {
            color: numbers("object.color").unwrap_or(own.color),
            diffuse: material("diffuse").unwrap_or(own.diffuse),
            emission: material("emission").unwrap_or(own.emission),
        }
    }

    fn probe_grid(&self) -> ProbeGrid {
        let points = self.scene.points();
        let low = points.iter().copied().reduce(DVec3::min).unwrap_or(DVec3::NEG_ONE);
        let high = points.iter().copied().reduce(DVec3::max).unwrap_or(DVec3::ONE);
        ProbeGrid::within(low, high, self.scene.probes.unwrap_or_default().counts)
    }

    /// The numbers of a field of the block `probes`.
    pub(super) fn probe_number(&self, field: &str) -> Option<Vec<f64>> {
        let grid = self.probe_grid();
        Some(match field {
            "origin" => vector_values(grid.origin),
            "spacing" => vector_values(grid.spacing),
            "counts" => grid.counts.map(f64::from).to_vec(),
            "bias" => vec![grid.bias],
            "light_side" => vec![PROBE_SIDES.0 as f64],
            "depth_side" => vec![PROBE_SIDES.1 as f64],
            _ => return None,
        })
    }

    /// A texture of the probes, by the name of its binding.
    pub(super) fn probe_map(&self, name: &str) -> Option<TextureMap> {
        match name {
            "probe_light" => Some(self.probe_field().light_map()),
            "probe_depths" => Some(self.probe_field().depth_map()),
            _ => None,
        }
    }
}

/// The light of all lamps that arrives at a point of a surface, with shadows. If a white diffuse
/// surface gets light of 1, it shows the colour 1.
fn direct_light(lamps: &[Shining], surfaces: &Surfaces, at: DVec3, normal: DVec3) -> DVec3 {
    let light = lamps.iter().map(|lamp| {
        let (color, from) = lamp.arriving(at);
        let cosine = normal.dot((from - at).normalize_or_zero());
        let is_lit = cosine > 0.0 && color != DVec3::ZERO && surfaces.is_clear(at, from);
        if is_lit { color * cosine } else { DVec3::ZERO }
    });
    light.sum()
}
