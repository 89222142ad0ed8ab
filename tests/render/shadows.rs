//! Compares shadows in whole frames with rays from fragments to the light.

use glam::{DMat4, DVec3};
use lamplight::scene::sets::{self, Scene};

use super::closed_forms::Form;
use super::frames::{Bench, Fragment, Numbers, uniform};

pub const FORMS: &[(&str, Form)] = &[
    ("shadow_octants", octants),
    ("shadow_border", border),
    ("shadow_acne", acne),
    ("shadow_penumbra", penumbra),
    ("shadow_softness", softness),
];

/// The width and the height of a frame, in pixels.
const SIZE: u32 = 128;
pub const DIRECTIONAL: &str =
    "ambient=none,lights=directional,max_lights=1,shadow_light=directional,specular=none";

/// The objects of the scene `casters`, in the form in which rays are tested against them.
pub struct Casters {
    floor_half: f64,
    ball: DVec3,
    object_from_box: DMat4,
    box_half: DVec3,
    ring: DVec3,
}

/// Whether an object blocks a ray. Near the edge of an object that is unclear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    Clear,
    Blocked,
    Unclear,
}

impl Casters {
    fn new(scene: &Scene) -> Self {
        let place = |index: usize| scene.objects[index].world_from_object;
        let extent = |index: usize| {
            scene.objects[index]
                .shape
                .vertices
                .iter()
                .map(|v| v.position)
                .reduce(DVec3::max)
                .unwrap()
        };
        Self {
            floor_half: extent(0).x,
            ball: place(1).transform_point3(DVec3::ZERO),
            object_from_box: place(2).inverse(),
            box_half: extent(2),
            ring: place(3).transform_point3(DVec3::ZERO),
        }
    }

    /// The distance at which a ray passes the centre of the ball, if it goes towards it.
    fn beside_ball(&self, from: DVec3, towards: DVec3) -> Option<f64> {
        let to = self.ball - from;
        (to.dot(towards) > 0.0).then(|| to.cross(towards).length())
    }

    fn of_ball(&self, from: DVec3, towards: DVec3, margin: f64) -> Way {
        match self.beside_ball(from, towards) {
            Some(distance) if distance < 1.0 - margin => Way::Blocked,
            Some(distance) if distance < 1.0 + margin => Way::Unclear,
            _ => Way::Clear,
        }
    }

    fn of_box(&self, from: DVec3, towards: DVec3, margin: f64) -> Way {
        let (from, ray) = (
            self.object_from_box.transform_point3(from),
            self.object_from_box.transform_vector3(towards),
        );
        let meets = |half: DVec3| {
            let (low, high) = ((-half - from) / ray, (half - from) / ray);
            let (enter, leave) = (low.min(high).max_element(), low.max(high).min_element());
            enter < leave && leave > 0.0
        };
        match (meets(self.box_half - margin), meets(self.box_half + margin)) {
            (true, _) => Way::Blocked,
            (false, true) => Way::Unclear,
            _ => Way::Clear,
        }
    }

    /// The ring lies within a ball around its centre. A ray that meets this ball is unclear.
    fn of_ring(&self, from: DVec3, towards: DVec3) -> Way {
        let to = self.ring - from;
        let near = to.cross(towards).length() < 1.1 && (to.dot(towards) > 0.0 || to.length() < 1.1);
        if near { Way::Unclear } else { Way::Clear }
    }

    fn of_floor(&self, from: DVec3, towards: DVec3, margin: f64) -> Way {
        if towards.y >= 0.0 {
            return Way::Clear;
        }
        if from.y < margin {
            // Near the floor, the place that is looked up in the map may be below the floor.
            return Way::Unclear;
        }
        let at = from - towards * (from.y / towards.y);
        let reach = at.x.abs().max(at.z.abs());
        if reach < self.floor_half - margin {
            Way::Blocked
        } else if reach < self.floor_half + margin {
            Way::Unclear
        } else {
            Way::Clear
        }
    }

    pub fn way(&self, fragment: &Fragment, towards: DVec3, margin: f64) -> Way {
        let from = fragment.position + fragment.normal * 1e-3;
        let ways = [
            self.of_floor(from, towards, margin),
            self.of_ball(from, towards, margin),
            self.of_box(from, towards, margin),
            self.of_ring(from, towards),
        ];
        // An object does not shadow itself here: only fragments that face the light are tested.
        let on_ball = from.distance(self.ball) < 1.02;
        let on_floor = fragment.position.y < 1e-3;
        let on_box = !on_floor
            && self.object_from_box.transform_point3(from).abs().cmple(self.box_half + 0.01).all();
        let wanted = [true, !on_ball, !on_box, true];
        let ways = || ways.iter().zip(wanted).filter(|(_, wanted)| *wanted).map(|(way, _)| *way);
        if ways().any(|way| way == Way::Blocked) {
            Way::Blocked
        } else if ways().any(|way| way == Way::Unclear) {
            Way::Unclear
        } else {
            Way::Clear
        }
    }
}

pub fn casters() -> Result<Casters, String> {
    sets::scene("casters").map(|scene| Casters::new(&scene)).ok_or_else(|| "no casters".to_owned())
}

/// The share of the light that a shadow leaves.
pub fn visibility(fragment: &Fragment, towards: DVec3) -> f64 {
    fragment.light() / fragment.normal.dot(towards)
}

/// With light from each of the eight octants, every fragment is lit or dark as its ray says.
fn octants(bench: &Bench<'_>) -> Result<(), String> {
    let casters = casters()?;
    for index in 0..8 {
        let sign = |bit: u32| if index & bit == 0 { 1.0 } else { -1.0 };
        let towards = DVec3::new(0.55 * sign(1), 0.75 * sign(2), 0.45 * sign(4)).normalize();
        let numbers: Numbers<'_> =
            &[("light", "axis", &(-towards).to_array()), ("light", "color", &[1.0; 3])];
        let prepared = bench.prepared(
            &bench.plan(&format!("{DIRECTIONAL},shadow=hard"), "casters", numbers)?,
            SIZE,
        )?;
        let margin = 3.0 * uniform(&prepared, "caster", "texel").ok_or("no texel")?;
        let (mut counts, mut wrong) = ([0, 0], Vec::new());
        for fragment in bench
            .fragments_of(&prepared, SIZE)?
            .iter()
            .filter(|fragment| fragment.normal.dot(towards) > 0.25)
        {
            let wanted = match casters.way(fragment, towards, margin) {
                Way::Unclear => continue,
                Way::Clear => 1,
                Way::Blocked => 0,
            };
            counts[wanted] += 1;
            if (visibility(fragment, towards) - wanted as f64).abs() > 0.01 {
                wrong.push(*fragment);
            }
        }
        // From below, the floor is in front of everything, so hardly anything is lit.
        let enough = counts[0] > 100 && (towards.y < 0.0 || counts[1] > 1000);
        if !wrong.is_empty() || !enough {
            let [dark, lit] = counts;
            return Err(format!(
                "light from {towards}: {dark} dark and {lit} lit fragments, wrong are {wrong:.3?}"
            ));
        }
    }
    Ok(())
}

/// The direction to the light in the tests below. The ball's shadow then falls only on the floor.
pub const TOWARDS: DVec3 = DVec3::new(-0.3, 0.8, 0.25);

/// The fragments of the floor that only the ball can shadow, each with its distance from the border
/// of the shadow and its visibility; and the size of a texel of the map.
fn around_ball(
    bench: &Bench<'_>,
    shadow: &str,
    more: Numbers<'_>,
) -> Result<(Vec<(f64, f64)>, f64), String> {
    let (measured, texel) = below_ball(bench, shadow, more)?;
    let without_way = measured.into_iter().map(|(distance, _, visible)| (distance, visible));
    Ok((without_way.collect(), texel))
}

/// Of a fragment, the distance from the border of the shadow, the distance to the ball's centre along
/// the direction of the light, and the visibility.
type BelowBall = (f64, f64, f64);

/// As [`around_ball`], with the distance to the ball's centre.
fn below_ball(
    bench: &Bench<'_>,
    shadow: &str,
    more: Numbers<'_>,
) -> Result<(Vec<BelowBall>, f64), String> {
    let (casters, towards) = (casters()?, TOWARDS.normalize());
    let axis = (-towards).to_array();
    let mut numbers: Vec<(&str, &str, &[f64])> =
        vec![("light", "axis", &axis), ("light", "color", &[1.0; 3])];
    numbers.extend(more);
    let plan = bench.plan(&format!("{DIRECTIONAL},shadow={shadow}"), "casters", &numbers)?;
    let prepared = bench.prepared(&plan, 2 * SIZE)?;
    let texel = uniform(&prepared, "caster", "texel").ok_or("no texel")?;
    let fragments = bench.fragments_of(&prepared, 2 * SIZE)?;
    let on_floor = fragments.iter().filter(|fragment| fragment.position.y.abs() < 1e-4);
    let alone = on_floor.filter(|fragment| {
        let others = [
            casters.of_box(fragment.position, towards, 0.5),
            casters.of_ring(fragment.position, towards),
        ];
        others == [Way::Clear; 2]
    });
    let measured = alone.filter_map(|fragment| {
        let distance = casters.beside_ball(fragment.position, towards)? - 1.0;
        let way = (casters.ball - fragment.position).dot(towards);
        Some((distance, way, visibility(fragment, towards)))
    });
    Ok((measured.collect(), texel))
}

/// The border of a hard shadow is at the ball's outline, within a texel of the map.
fn border(bench: &Bench<'_>) -> Result<(), String> {
    let numbers: Numbers<'_> = &[("depth_pass", "polygon_offset", &[1.0, 4.0])];
    let (measured, texel) = around_ball(bench, "hard", numbers)?;
    // The ball is a polyhedron, whose faces are this much inside of the sphere.
    let faces = 1.0 - (std::f64::consts::PI / 48.0).cos();
    let wrong = measured.iter().filter(|(distance, visible)| match distance {
        d if *d > texel => *visible < 0.99,
        d if *d < -texel - 2.0 * faces => *visible > 0.01,
        _ => false,
    });
    let (wrong, near) = (
        wrong.count(),
        measured.iter().filter(|(distance, _)| distance.abs() < 4.0 * texel).count(),
    );
    if wrong > 0 || near < 100 {
        return Err(format!(
            "{wrong} fragments are wrong, {near} are near the border, a texel is {texel}"
        ));
    }
    Ok(())
}

/// A plane that nothing shadows is lit everywhere, with each of the ways to avoid shadow acne.
/// Without any of them it is not.
fn acne(bench: &Bench<'_>) -> Result<(), String> {
    const WAYS: [(&str, Numbers<'_>); 5] = [
        ("nothing", &[("depth_pass", "polygon_offset", &[0.0, 0.0])]),
        (
            "a constant",
            &[("depth_pass", "polygon_offset", &[0.0, 0.0]), ("caster", "bias", &[0.01])],
        ),
        ("polygon offset", &[("depth_pass", "polygon_offset", &[2.0, 4.0])]),
        (
            "an offset along the normal",
            &[("depth_pass", "polygon_offset", &[0.0, 0.0]), ("caster", "normal_offset", &[3.0])],
        ),
        ("back faces alone", &[("depth_pass", "cull_front", &[1.0])]),
    ];
    let light = DVec3::new(-4.0, 5.0, -1.5);
    let axis = (DVec3::new(0.0, 0.0, 0.5) - light).normalize();
    let cutoff = 0.5_f64.cos();
    for (name, way) in WAYS {
        let (position, direction) = (light.to_array(), axis.to_array());
        let mut numbers: Vec<(&str, &str, &[f64])> = vec![
            ("light", "position", &position),
            ("light", "axis", &direction),
            ("light", "color", &[1.0; 3]),
        ];
        let cutoffs = [cutoff];
        numbers.push(("light", "cutoff", &cutoffs));
        numbers.extend(way);
        let key = "ambient=none,attenuation=none,cone=hard,lights=spot,max_lights=1,shadow=hard,specular=none";
        let fragments = bench.fragments(&bench.plan(key, "floor", &numbers)?, SIZE)?;
        let towards = |fragment: &Fragment| (light - fragment.position).normalize();
        let lit: Vec<&Fragment> = fragments
            .iter()
            .filter(|fragment| (-towards(fragment)).dot(axis) > cutoff + 1e-3)
            .collect();
        let dark =
            lit.iter().filter(|fragment| visibility(fragment, towards(fragment)) < 0.999).count();
        let fails = if name == "nothing" { dark < lit.len() / 20 } else { dark > 0 };
        if lit.len() < 1000 || fails {
            let found = format!("{dark} of {} fragments are in shadow", lit.len());
            return Err(format!("with {name}, {found}: expected none, with `nothing` 5 %"));
        }
    }
    Ok(())
}

/// Filtered shadows never get darker on the way from the dark to the lit side.
fn penumbra(bench: &Bench<'_>) -> Result<(), String> {
    for shadow in ["pcf_3x3", "pcf_5x5", "pcf_castano_5", "vsm"] {
        let (measured, texel) = around_ball(bench, shadow, &[])?;
        let step = if shadow == "vsm" { 2.0 * texel } else { texel };
        let bin = |index: i32| {
            let inside = measured
                .iter()
                .filter(|(distance, _)| (distance / step).floor() == f64::from(index));
            let values: Vec<f64> = inside.map(|(_, visible)| *visible).collect();
            (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
        };
        let means: Vec<f64> = (-14..14).filter_map(bin).collect();
        let rises = means.windows(2).all(|pair| pair[1] >= pair[0] - 0.02);
        let (first, last) =
            (means.first().copied().unwrap_or(1.0), means.last().copied().unwrap_or(0.0));
        let between = means.iter().filter(|mean| **mean > 0.02 && **mean < 0.98).count();
        if !rises || first > 0.05 || last < 0.95 || between < 3 {
            return Err(format!("{shadow} should rise from 0 to 1 over the border: {means:.3?}"));
        }
    }
    Ok(())
}

/// With `pcss`, the penumbra is as wide as the size of the light times the distance to the
/// occluder.
fn softness(bench: &Bench<'_>) -> Result<(), String> {
    /// A band around the border, wider than the penumbra.
    const BAND: f64 = 0.4;
    let spread = |size: f64, low: f64, high: f64| {
        let (measured, _) = below_ball(bench, "pcss", &[("caster", "light_size", &[size])])?;
        let near = measured
            .iter()
            .filter(|(distance, way, _)| distance.abs() < BAND && (low..high).contains(way));
        let products: Vec<f64> = near.map(|(_, _, visible)| visible * (1.0 - visible)).collect();
        if products.len() < 100 {
            return Err(format!("{} fragments have a way from {low} to {high}", products.len()));
        }
        // The integral of `v * (1 - v)` over a linear ramp from 0 to 1 is a sixth of its width.
        Ok(products.iter().sum::<f64>() / products.len() as f64 * 6.0 * 2.0 * BAND)
    };
    let (short, long) = (spread(0.3, 0.6, 0.85)?, spread(0.3, 1.35, 1.6)?);
    let sharp = spread(0.0, 1.35, 1.6)?;
    // What blocks light near the border is up to half a radius before the ball's middle.
    let is_wide = (0.6..2.0).contains(&(long / (0.3 * 1.475)));
    if !is_wide || long < 1.3 * short || long < 2.0 * sharp {
        return Err(format!("widths of {short:.3}, {long:.3}, and {sharp:.3} for a small light"));
    }
    Ok(())
}
