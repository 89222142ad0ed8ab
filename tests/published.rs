//! The library has functions that reproduce a published form exactly, besides safe functions for the
//! same purpose. Each pair is evaluated at an input where the two differ, in both languages, as
//! their documentation says.
//!
//! `pcf_random16_hpg` is not here, since it needs a shadow map: see `shadow::random_taps_shift`.

mod compared;
mod geometry;
mod hpg;
mod listing;
mod listings;
mod numbers;
mod oglpg;
mod page;
mod quantities;
mod sampling;
mod stated;
mod tutorials;

use std::process::Command;

use libtest_mimic::{Failed, Trial};

use crate::examples::run;

/// The safe form and its value, then the published form and its value.
const FORMS: &[(&str, f64, &str, f64)] = &[
    // In the published form, the caller must double the number of the pair. With the plain number,
    // the back material of one pair is the front material of the next.
    (
        "lighting::material::material_index(1, false)",
        3.0,
        "lighting::material::material_index_oglpg(1, false)",
        2.0,
    ),
    // At the edge of the cone, only the safe form is lit.
    (
        "lighting::spot::cone_hard(0.5, 0.5)",
        1.0,
        "lighting::spot::cone_hard_exclusive(0.5, 0.5)",
        0.0,
    ),
    // In the published forms, a light behind the surface has a highlight.
    (
        "brdf::specular::blinn_phong(vec3f(0, 0, 1), vec3f(0.8, 0, -0.6), vec3f(0, 0, 1), 2)",
        0.0,
        "brdf::specular::blinn_phong_hpg(vec3f(0, 0, 1), vec3f(0.8, 0, -0.6), vec3f(0, 0, 1), 2)",
        0.2,
    ),
    (
        "brdf::specular::phong(vec3f(0, 0, 1), vec3f(0.8, 0, -0.6), vec3f(-1, 0, 0), 2)",
        0.0,
        "brdf::specular::phong_oglpg_7_21(vec3f(0, 0, 1), vec3f(0.8, 0, -0.6), vec3f(-1, 0, 0), 2)",
        0.64,
    ),
    // In the published form, a light on the horizon is reflected.
    (
        "brdf::specular::phong(vec3f(0, 0, 1), vec3f(1, 0, 0), vec3f(-0.8, 0, 0.6), 2)",
        0.0,
        "brdf::specular::phong_igl(vec3f(0, 0, 1), vec3f(1, 0, 0), vec3f(-0.8, 0, 0.6), 2)",
        0.64,
    ),
    // In the published form, Lambert's term weakens the highlight; it is 0.6 here.
    (
        "0.33 * brdf::specular::blinn_phong(vec3f(0, 0, 1), vec3f(0.8, 0, 0.6), vec3f(-0.8, 0, 0.6), 50)",
        0.33,
        "lighting::classic::shade_ncl(vec3f(0), vec3f(1), vec3f(0, 0, 1), vec3f(0.8, 0, 0.6), vec3f(-0.8, 0, 0.6), 1).x",
        0.198,
    ),
    // At 60 degrees. The safe form, with the cosine, has the value of a numeric integral. The book
    // calls the other form analytic.
    (
        "ambient::hemisphere::hemisphere_weight(vec3f(0.8660254, 0.5, 0), vec3f(0, 1, 0))",
        0.75,
        "ambient::hemisphere::hemisphere_weight_sine(vec3f(0.8660254, 0.5, 0), vec3f(0, 1, 0))",
        0.5669873,
    ),
    // The published form takes the position of the sky's pole, not its direction. Here the pole is
    // beside the surface, at a right angle to the normal.
    (
        "ambient::hemisphere::hemisphere(vec3f(0, 1, 0), vec3f(0, 1, 0), vec3f(1), vec3f(0)).x",
        1.0,
        "ambient::hemisphere::hemisphere_oglpg(vec3f(0, 1, 0), vec3f(2, 2, 0), vec3f(0, 2, 0), vec3f(1), vec3f(0)).x",
        0.5,
    ),
    // The published form gives a brightness that is not linear in the distance.
    (
        "shadow::coord::linearize_depth(0.995, 0.1, 100) / 100",
        0.166_805_67,
        "shadow::coord::depth_view_igl(0.995)",
        0.5,
    ),
];

pub fn tests() -> Vec<Trial> {
    ["wesl", "glsl"]
        .into_iter()
        .map(|language| {
            Trial::test(format!("published::{language}"), move || forms_differ(language))
        })
        .chain(compared::tests())
        .chain(listings::tests())
        .chain(page::tests())
        .chain(quantities::tests())
        .chain(stated::tests())
        .collect()
}

fn forms_differ(language: &str) -> Result<(), Failed> {
    let expressions = FORMS.iter().flat_map(|(safe, _, published, _)| [safe, published]);
    let printed = run(Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(["eval", "--lang", language])
        .args(expressions))?;
    let values = printed
        .lines()
        .map(str::parse)
        .collect::<Result<Vec<f64>, _>>()
        .map_err(|error| format!("{error}:\n{printed}"))?;
    let expected: Vec<f64> =
        FORMS.iter().flat_map(|(_, safe, _, published)| [*safe, *published]).collect();
    let near = |(found, expected): (&f64, &f64)| (found - expected).abs() < 5e-6;
    if values.len() == expected.len() && values.iter().zip(&expected).all(near) {
        return Ok(());
    }
    Err(format!("found {values:?}, expected {expected:?}, in the order of `FORMS`").into())
}
