//! Compares whole frames, lit without shadows, with the formulas of the light.

use glam::DVec3;
use lamplight::scene::{irradiance_sh9, sets};

use super::frames::{Bench, Fragment, close};
use super::{library, plan};

/// A property of the frames that an executor draws.
pub type Form = fn(&Bench<'_>) -> Result<(), String>;

pub const FORMS: &[(&str, Form)] = &[
    ("spot_edge", spot_edge),
    ("attenuation", attenuation),
    ("hemisphere", hemisphere),
    ("sh9", sh9),
    ("highlights", highlights),
];

/// The width and the height of a frame, in pixels.
const SIZE: u32 = 128;

/// A spot light with a hard edge that points straight down lights a disk on the floor. The radius
/// follows from its angle.
fn spot_edge(bench: &Bench<'_>) -> Result<(), String> {
    let (height, angle) = (4.0, 0.5_f64);
    let light = DVec3::new(0.3, height, 0.2);
    let numbers: super::frames::Numbers<'_> = &[
        ("light", "position", &light.to_array()),
        ("light", "axis", &[0.0, -1.0, 0.0]),
        ("light", "cutoff", &[angle.cos()]),
        ("light", "color", &[1.0; 3]),
    ];
    let plan = bench.plan(
        "ambient=none,attenuation=none,cone=hard,lights=spot,max_lights=1,specular=none",
        "floor",
        numbers,
    )?;
    let fragments = bench.fragments(&plan, SIZE)?;
    let (mut lit, mut widest) = (0, 0.0_f64);
    for fragment in &fragments {
        let cosine = (light - fragment.position).normalize().y;
        if (cosine - angle.cos()).abs() < 1e-5 {
            continue;
        }
        let inside = cosine > angle.cos();
        close("light", fragment.light(), if inside { cosine } else { 0.0 }, 1e-4)?;
        if inside {
            lit += 1;
            widest = widest.max((fragment.position - light).with_y(0.0).length());
        }
    }
    // A pixel is a tenth of a unit wide.
    let radius = height * angle.tan();
    if lit < 1000 || fragments.len() - lit < 1000 || widest > radius || widest < radius - 0.1 {
        return Err(format!(
            "{lit} of {} fragments in a disk of radius {widest}, which should be {radius}",
            fragments.len()
        ));
    }
    Ok(())
}

/// Each attenuation has the values of its formula on the whole floor, and falls along a line away
/// from the light.
fn attenuation(bench: &Bench<'_>) -> Result<(), String> {
    type Falloff = fn(f64) -> f64;
    const RANGE: f64 = 9.0;
    const FALLOFFS: [(&str, Falloff); 3] = [
        ("none", |_| 1.0),
        ("polynomial", |d| 1.0 / (1.0 + 0.3 * d + 0.1 * d * d)),
        ("inverse_square_window", |d| (1.0 - (d / RANGE).powi(4)).max(0.0).powi(2) / (d * d)),
    ];
    let light = DVec3::new(0.0, 1.5, 0.0);
    for (name, falloff) in FALLOFFS {
        let key =
            format!("ambient=none,attenuation={name},lights=point,max_lights=1,specular=none");
        let numbers: super::frames::Numbers<'_> = &[
            ("light", "position", &light.to_array()),
            ("light", "attenuation", &[1.0, 0.3, 0.1]),
            ("light", "range", &[RANGE]),
            ("light", "color", &[1.0; 3]),
        ];
        let fragments = bench.fragments(&bench.plan(&key, "floor", numbers)?, SIZE)?;
        for fragment in &fragments {
            let offset = light - fragment.position;
            close(name, fragment.light(), falloff(offset.length()) * offset.normalize().y, 1e-4)?;
        }
        let mut line: Vec<&Fragment> =
            fragments.iter().filter(|f| f.position.z.abs() < 0.1 && f.position.x > 0.0).collect();
        line.sort_by(|a, b| a.position.x.total_cmp(&b.position.x));
        let falls = line.windows(2).all(|pair| pair[1].light() <= pair[0].light() + 2e-3);
        if line.len() < 20 || !falls {
            return Err(format!("{name} does not fall along a line of {} fragments", line.len()));
        }
    }
    Ok(())
}

/// The share of the sky depends on the normal: it is 0.95 at 26 degrees from the pole, one half at
/// the horizon, and one quarter 30 degrees below it.
fn hemisphere(bench: &Bench<'_>) -> Result<(), String> {
    let (sky, ground) = (DVec3::new(0.2, 0.5, 1.0), DVec3::new(0.4, 0.3, 0.1));
    let numbers: super::frames::Numbers<'_> =
        &[("surroundings", "sky", &sky.to_array()), ("surroundings", "ground", &ground.to_array())];
    let fragments = bench
        .fragments(&bench.plan("ambient=hemisphere,lights=none", "spheres", numbers)?, SIZE)?;
    for fragment in &fragments {
        let wanted = fragment.base * ground.lerp(sky, 0.5 + 0.5 * fragment.normal.y);
        close("light", fragment.color.distance(wanted), 0.0, 1e-4)?;
    }
    for (height, share) in [(0.9, 0.95), (0.0, 0.5), (-0.5, 0.25)] {
        let nearest = fragments
            .iter()
            .min_by(|a, b| (a.normal.y - height).abs().total_cmp(&(b.normal.y - height).abs()));
        let found = nearest.ok_or("nothing was drawn")?;
        let weight =
            (found.color / found.base - ground).dot(sky - ground) / (sky - ground).length_squared();
        close(&format!("the sky's share where the normal's y is {height}"), weight, share, 0.01)?;
    }
    Ok(())
}

/// The safe form of the published preset for spherical harmonics: the irradiance depends on the normal
/// as the formula says, and has the recorded values for five of the six axes.
fn sh9(bench: &Bench<'_>) -> Result<(), String> {
    const AXES: [(DVec3, DVec3); 5] = [
        (DVec3::X, DVec3::new(0.705119, 0.669402, 0.628144)),
        (DVec3::NEG_X, DVec3::new(0.714593, 0.729672, 0.726441)),
        (DVec3::Y, DVec3::new(1.027822, 1.115161, 1.185534)),
        (DVec3::NEG_Y, DVec3::new(0.669539, 0.613045, 0.545154)),
        (DVec3::Z, DVec3::new(0.793449, 0.800246, 0.793947)),
    ];
    let preset =
        library().presets.iter().find(|preset| preset.name == "oglpg_7_14").ok_or("no preset")?;
    // As printed, the formula is computed for each vertex; the safe form computes it for fragments.
    let plan = plan(&preset.safe_form().ok_or("no safe form")?)?;
    let coefficients = plan.probe.ok_or("no light probe")?.map(DVec3::from_array);
    let fragments = bench.fragments(&plan, SIZE)?;
    for fragment in &fragments {
        let wanted = fragment.base * irradiance_sh9(fragment.normal, &coefficients);
        close("light", fragment.color.distance(wanted), 0.0, 1e-3)?;
    }
    for (axis, wanted) in AXES {
        let nearest =
            fragments.iter().max_by(|a, b| a.normal.dot(axis).total_cmp(&b.normal.dot(axis)));
        let found = nearest.ok_or("nothing was drawn")?;
        // The nearest fragment's normal is this far from the axis. The light may change that much.
        let missing = found.normal.dot(axis).clamp(-1.0, 1.0).acos();
        close(
            &format!("{axis}"),
            (found.color / found.base).distance(wanted),
            0.0,
            1e-3 + missing,
        )?;
        if missing > 0.4 {
            return Err(format!("no fragment looks along {axis}"));
        }
    }
    Ok(())
}

/// A lamp of colour 1 is the illuminance pi, so a BRDF gives pi times itself times n.l. That of
/// `blinn_phong_normalized` is (s + 8)/(8*pi) times the lobe of `blinn_phong`. That of `ggx` with a
/// roughness of 1 has no direction but in its visibility: D is 1/pi, and V is 1/(2*(n.l + n.v)).
fn highlights(bench: &Bench<'_>) -> Result<(), String> {
    const SHININESS: f64 = 16.0;
    let axis = DVec3::new(0.0, -0.8, -0.6);
    let drawn = |specular: &str| {
        let numbers: super::frames::Numbers<'_> = &[
            ("light", "axis", &axis.to_array()),
            ("light", "color", &[1.0; 3]),
            ("light", "strength", &[1.0]),
            ("material", "diffuse", &[0.0; 3]),
            ("material", "emission", &[0.0; 3]),
            ("material", "specular", &[1.0; 3]),
            ("material", "shininess", &[SHININESS]),
            ("material", "roughness", &[1.0]),
        ];
        let key = format!("ambient=none,lights=directional,max_lights=1,specular={specular}");
        let prepared = bench.prepared(&bench.plan(&key, "spheres", numbers)?, SIZE)?;
        bench.fragments_of(&prepared, SIZE)
    };
    let (lobes, normalized) = (drawn("blinn_phong")?, drawn("blinn_phong_normalized")?);
    let mut brightest = 0.0_f64;
    for (lobe, found) in lobes.iter().zip(&normalized) {
        let wanted = (SHININESS + 8.0) / 8.0 * found.normal.dot(-axis).max(0.0) * lobe.color.y;
        close("the normalized lobe", found.color.y, wanted, 1e-4)?;
        brightest = brightest.max(wanted);
    }
    if brightest < 1.0 {
        return Err(format!("no highlight is brighter than {brightest}"));
    }
    // The sum of both cosines follows from the colour, and with it the cosine of the viewer.
    let eye = sets::scene("spheres").ok_or("no scene")?.eye.position;
    let rough = drawn("ggx")?;
    let lit = rough.iter().filter(|f| f.normal.dot(-axis) > 0.3 && f.color.y > 0.05);
    let mut count = 0;
    for found in lit {
        let toward = found.normal.dot(-axis);
        let wanted = found.normal.dot((eye - found.position).normalize());
        // Outlines, where normals of corners point away from the viewer.
        if wanted > 0.1 {
            close("the viewer's cosine", toward / (2.0 * found.color.y) - toward, wanted, 1e-3)?;
            count += 1;
        }
    }
    if count < 1000 { Err(format!("{count} fragments are lit")) } else { Ok(()) }
}
