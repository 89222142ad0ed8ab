//! Compares the maps that `prefilter` computes from an environment with quadratures in f64.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DMat3, DMat4, DVec3};
use lamplight::bundle::Language;
use lamplight::execute::Session;
use lamplight::picture::{Linear, Plan, Shot, Surroundings, prepare_passes};
use lamplight::scene::{Clip, Depth, directions, perspective, sets, sh9_project};
use libtest_mimic::Trial;

use super::{BACKENDS, library, on_device, rendered, shot};

/// Texels along an edge of the frames.
const SIZE: u32 = 16;
/// The roughness of `pictures.toml`, and the width of its window in bands.
const ROUGHNESS: f64 = 0.4;
const WINDOW: f64 = 4.0;
/// The largest error of the maps, as a share of the brightest value: 256 directions, and an
/// environment of 64 texels along an edge.
const OF_MAPS: f64 = 0.01;
/// The largest error of the table, which is a sum over 256 facets that the viewer sees.
const OF_TABLE: f64 = 0.005;
/// The table is compared from this roughness and this cosine on. Sharper lobes need more steps than
/// the quadrature has.
const FROM: f64 = 0.25;
/// Rows of the quadrature over the sphere, and steps of the one over the hemisphere.
const ROWS: usize = 128;
const STEPS: usize = 200;

type Check = fn(&dyn Session, Language) -> Result<(), String>;

pub fn tests() -> Vec<Trial> {
    let checks: [(&str, Check); 4] =
        [("specular", specular), ("diffuse", diffuse), ("sh9", harmonics), ("dfg", split_sum)];
    let on = |(backend, language): (&'static str, Language)| {
        checks.into_iter().map(move |(name, check)| {
            Trial::test(format!("render/prefilter_is_the_integral/{name}/{backend}"), move || {
                on_device(backend, |painter| check(painter, language))
            })
        })
    };
    BACKENDS.into_iter().flat_map(on).collect()
}

fn drawn(painter: &dyn Session, language: Language, what: &str) -> Result<Linear, String> {
    let programs = &library().programs;
    let key = format!("samples=256,what={what}").replace(",what=specular", "");
    let plan = Plan::of_key(programs, "prefilter", &key).map_err(rendered)?;
    let surroundings = Surroundings::Formula(smooth_sky);
    let shot = Shot { surroundings, ..shot([SIZE; 2], 1, language) };
    let prepared = prepare_passes(painter, programs, &plan, &shot).map_err(rendered)?;
    prepared.photograph(painter, &shot).map_err(rendered)
}

/// An environment that differs in every direction. It has no small bright lamps, so that a few
/// directions are enough.
fn smooth_sky(at: DVec3) -> DVec3 {
    DVec3::new(0.6 + 0.4 * at.x, 0.5 + 0.5 * at.y * at.z, 0.2 + 0.7 * at.z * at.z)
}

/// The values of a frame by pixel.
fn pixels(frame: &Linear) -> Result<Vec<([f64; 2], DVec3)>, String> {
    let all = (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y)));
    let pixel = |(x, y)| {
        let uv = [x, y].map(|place| (f64::from(place) + 0.5) / f64::from(SIZE));
        frame.drawn(x, y).map(|value| (uv, value)).ok_or(format!("nothing at {x}, {y}"))
    };
    all.map(pixel).collect()
}

/// Fails unless each pixel of a frame has the mean of the environment. `weight` is the weight of a
/// direction by the cosine of its angle to the pixel's direction.
fn mean(frame: &Linear, weight: impl Fn(f64) -> f64) -> Result<(), String> {
    let eye = sets::scene("screen").ok_or("no scene")?.eye;
    let turned = DMat4::from_mat3(DMat3::from_mat4(eye.view()));
    let projection = perspective(eye.fov_y, 1.0, eye.near, eye.far, Clip::Wgpu, Depth::Normal);
    let from_clip = (projection * turned).inverse();
    let seen: Vec<(DVec3, f64, DVec3)> =
        directions(ROWS).into_iter().map(|(at, angle)| (at, angle, smooth_sky(at))).collect();
    let (mut brightest, mut worst) = (0.0_f64, 0.0_f64);
    for ([u, v], found) in pixels(frame)? {
        let n = from_clip.project_point3(DVec3::new(2.0 * u - 1.0, 1.0 - 2.0 * v, 1.0)).normalize();
        let (mut sum, mut all) = (DVec3::ZERO, 0.0);
        for (at, angle, radiance) in &seen {
            let share = weight(n.dot(*at).max(0.0)) * angle;
            sum += *radiance * share;
            all += share;
        }
        brightest = brightest.max((sum / all).max_element());
        worst = worst.max((found - sum / all).abs().max_element());
    }
    println!("the largest error is {:.4} of the brightest value", worst / brightest);
    // A NaN is not near.
    let is_near = worst <= OF_MAPS * brightest;
    if is_near { Ok(()) } else { Err(format!("off by {worst}, the brightest is {brightest}")) }
}

fn diffuse(painter: &dyn Session, language: Language) -> Result<(), String> {
    mean(&drawn(painter, language, "diffuse")?, |cosine| cosine)
}

/// The viewer is right above the surface, so that facets are half way between it and the light.
fn specular(painter: &dyn Session, language: Language) -> Result<(), String> {
    let a2 = ROUGHNESS.powi(4);
    let weight = |cosine: f64| {
        let nh2 = 0.5 + 0.5 * cosine;
        if cosine > 0.0 { cosine / (nh2 * (a2 - 1.0) + 1.0).powi(2) } else { 0.0 }
    };
    mean(&drawn(painter, language, "specular")?, weight)
}

/// Each column has the integral of the environment times a spherical harmonic, times the window's
/// factor for its band.
fn harmonics(painter: &dyn Session, language: Language) -> Result<(), String> {
    let sky = directions(ROWS).into_iter().map(|(at, angle)| (at, angle, smooth_sky(at)));
    let mut expected = sh9_project(sky);
    for (index, coefficient) in expected.iter_mut().enumerate() {
        let band = [0.0, 1.0, 1.0, 1.0].get(index).copied().unwrap_or(2.0);
        *coefficient *= (FRAC_PI_2 * band / WINDOW).cos().powi(2);
    }
    let largest = expected.iter().map(|one| one.abs().max_element()).fold(0.0, f64::max);
    let (mut worst, mut seen) = (0.0_f64, [false; 9]);
    for ([u, _], found) in pixels(&drawn(painter, language, "sh9")?)? {
        let column = (9.0 * u) as usize;
        seen[column] = true;
        let error = (found - expected[column]).abs().max_element();
        let is_near = error <= OF_MAPS * largest;
        if !is_near {
            return Err(format!("column {column}: {found}, expected {}", expected[column]));
        }
        worst = worst.max(error);
    }
    println!("the largest error is {:.4} of the largest coefficient", worst / largest);
    if seen == [true; 9] { Ok(()) } else { Err("some columns are missing".into()) }
}

fn split_sum(painter: &dyn Session, language: Language) -> Result<(), String> {
    let (mut worst, mut count) = (0.0_f64, 0);
    for ([nv, roughness], found) in pixels(&drawn(painter, language, "dfg")?)? {
        if roughness < FROM || nv < FROM {
            continue;
        }
        let (scale, offset) = albedo(nv, roughness.powi(2));
        let error = (found - DVec3::new(scale, offset, 0.0)).abs().max_element();
        let is_near = error <= OF_TABLE;
        if !is_near {
            let what = format!("expected {scale}, {offset}, found {found}");
            return Err(format!("n.v {nv}, roughness {roughness}: {what}"));
        }
        (worst, count) = (worst.max(error), count + 1);
    }
    println!("{count} texels, the largest error is {worst:.5}");
    if count >= 100 { Ok(()) } else { Err(format!("{count} texels were compared")) }
}

/// The integral of `D V nl` over all directions of the light, as the scale and the offset of
/// Schlick's F0.
fn albedo(nv: f64, alpha: f64) -> (f64, f64) {
    let (v, a2) = (DVec3::new((1.0 - nv * nv).sqrt(), 0.0, nv), alpha * alpha);
    let masked = |c: f64, other: f64| other * (c * c * (1.0 - a2) + a2).sqrt();
    let (mut scale, mut offset) = (0.0, 0.0);
    for i in 0..STEPS {
        let theta = FRAC_PI_2 * (i as f64 + 0.5) / STEPS as f64;
        for j in 0..STEPS {
            let phi = TAU * (j as f64 + 0.5) / STEPS as f64;
            let (sin, nl) = theta.sin_cos();
            let l = DVec3::new(sin * phi.cos(), sin * phi.sin(), nl);
            let h = (l + v).normalize();
            let d = a2 / (PI * (h.z * h.z * (a2 - 1.0) + 1.0).powi(2));
            let visible = 0.5 / (masked(nv, nl) + masked(nl, nv));
            let share = d * visible * nl * sin * FRAC_PI_2 * TAU / (STEPS * STEPS) as f64;
            let rim = (1.0 - v.dot(h)).powi(5);
            scale += share * (1.0 - rim);
            offset += share * rim;
        }
    }
    (scale, offset)
}
