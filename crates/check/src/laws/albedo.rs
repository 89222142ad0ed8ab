//! Directional albedo by quadrature: the share of the light from one direction that a surface
//! reflects to all directions. It works for functions of cosines and for functions of directions.
//!
//! The factors' parameters are found by name. Those of the geometry (`nl nv nh lh vh lv th bh tl bl
//! tv bv n_cross_h2 mu cos_theta`, or the directions `n l v h`) come from the rule, the others from
//! the case's row, or as formulas from `with`. `n` is z, the tangent x, the bitangent y; `view`
//! names the case's parameter that is the cosine n.v, `azimuth` turns the viewer about the normal.
//! `mu` is v.h, `cos_theta` -l.v.
//!
//! | `over` | the integral is |
//! |---|---|
//! | `l` | product * n.l over the hemisphere of `l` |
//! | `h` | product * n.h over the hemisphere of `h`: 1 for a distribution of normals |
//! | `below` | product * -n.l over the other hemisphere of `l` |
//! | `sphere` | product over all directions `l`, without a cosine |
//!
//! A narrow lobe needs `peak`, a formula for its width alpha. Half vectors are then distributed as
//! those of GGX with that width.

use std::f64::consts::PI;

use super::factor::{Factor, Formulas};
use super::integral::{MOST_CALLS, MOST_ROWS};
use crate::cases::{FormulaText, Rows};
use crate::formula::Scope;
use lamplight_diagnostic::Diagnostic;
use lamplight_scene::quadrature::gauss_legendre;

/// How an albedo is integrated, and what it must be.
#[derive(Debug, Clone)]
pub struct Albedo {
    pub over: Over,
    /// The parameter of the case that is the cosine n.v.
    pub view: String,
    /// Angle of the viewer about the normal from the tangent, radians.
    pub azimuth: f64,
    /// The width of the lobe around the half vector.
    pub peak: Option<FormulaText>,
    /// Formulas for parameters that neither the geometry nor the case has.
    pub with: Formulas,
    /// The component of the function's value and of the product that is compared. Without it, all
    /// components are.
    pub component: Option<usize>,
    /// Steps in the cosine. There are twice as many azimuths.
    pub steps: usize,
    pub within: f64,
    pub wanted: IntegralValue,
}

/// The directions that are integrated over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    Light,
    Half,
    /// Below the horizon: light that passes through.
    Below,
    Sphere,
}

/// What the integral must be.
#[derive(Debug, Clone)]
pub enum IntegralValue {
    /// The value of the case's function.
    Own,
    Exactly(FormulaText),
    AtMost(FormulaText),
}

type Vec3 = [f64; 3];

#[derive(Debug, Clone, Copy)]
struct CallDirections {
    l: Vec3,
    v: Vec3,
    h: Vec3,
}

/// A cosine of the geometry by the name that parameters have for it.
type Cosine = (&'static str, fn(&CallDirections) -> f64);

const COSINES: &[Cosine] = &[
    ("nl", |g| g.l[2]),
    ("nv", |g| g.v[2]),
    ("nh", |g| g.h[2]),
    ("lh", |g| dot(g.l, g.h)),
    ("vh", |g| dot(g.v, g.h)),
    ("mu", |g| dot(g.v, g.h)),
    ("lv", |g| dot(g.l, g.v)),
    ("cos_theta", |g| -dot(g.l, g.v)),
    ("th", |g| g.h[0]),
    ("bh", |g| g.h[1]),
    ("tl", |g| g.l[0]),
    ("bl", |g| g.l[1]),
    ("tv", |g| g.v[0]),
    ("bv", |g| g.v[1]),
    ("n_cross_h2", |g| g.h[0] * g.h[0] + g.h[1] * g.h[1]),
];

/// A direction by the name that parameters have for it.
type Direction = (&'static str, fn(&CallDirections) -> Vec3);

const DIRECTIONS: &[Direction] =
    &[("n", |_| [0.0, 0.0, 1.0]), ("l", |g| g.l), ("v", |g| g.v), ("h", |g| g.h)];

impl Albedo {
    /// The indices of the rows of the case that are integrated.
    pub fn chosen(&self, rows: &Rows) -> Vec<usize> {
        let most = MOST_ROWS.min(MOST_CALLS / self.calls()).max(1);
        let count = rows.len().min(most);
        (0..count).map(|index| index * rows.len() / count.max(1)).collect()
    }

    /// How many calls one row takes.
    pub fn calls(&self) -> usize {
        2 * self.steps * self.steps
    }

    /// The calls of a factor for the chosen rows of the case, whose parameters are in `case`.
    pub fn rows(
        &self,
        rows: &Rows,
        case: &Scope<'_>,
        factor: &Scope<'_>,
        span: lamplight_diagnostic::source::Span,
    ) -> Result<Rows, Diagnostic> {
        let factor = Factor::new(case, factor, &self.with, span)?;
        let mut words = Vec::new();
        for row in self.chosen(rows) {
            for (geometry, _) in self.nodes(rows.row(row), case)? {
                factor.push_call(&mut words, rows.row(row), |name| geometry.value(name))?;
            }
        }
        Ok(Rows::of(words, factor.kinds()))
    }

    /// The directions and weights of the rule for one row. Calls without weight are included.
    fn nodes(
        &self,
        row: &[f64],
        case: &Scope<'_>,
    ) -> Result<Vec<(CallDirections, f64)>, Diagnostic> {
        let nv = self.cosine_to_viewer(row, case);
        let sine = (1.0 - nv * nv).max(0.0).sqrt();
        let v = [sine * self.azimuth.cos(), sine * self.azimuth.sin(), nv];
        let peak = self.peak.as_ref().map(|peak| peak.bind(case)).transpose()?;
        let alpha = peak.map(|peak| peak.scalar(row));
        let directions = match alpha {
            Some(alpha) => about_half(self.steps, alpha),
            None => even_directions(self.steps, if self.over == Over::Sphere { -1.0 } else { 0.0 }),
        };
        let node = |(direction, weight)| match (self.over, alpha) {
            (Over::Half, _) => facet_call(v, direction, weight),
            (Over::Light, Some(_)) => mirrored_call(v, direction, weight),
            (Over::Light, None) => light_call(v, direction, weight * direction[2]),
            (Over::Below, _) => light_call(v, direction.map(|x| -x), weight * direction[2]),
            (Over::Sphere, _) => light_call(v, direction, weight),
        };
        Ok(directions.into_iter().map(node).collect())
    }

    fn cosine_to_viewer(&self, row: &[f64], case: &Scope<'_>) -> f64 {
        let found = case.find(std::slice::from_ref(&self.view));
        found.and_then(|(first, _)| row.get(first)).copied().unwrap_or(1.0).clamp(0.0, 1.0)
    }

    /// The integrals of one component for the chosen rows; `values` has one value for each call.
    pub fn sums(
        &self,
        rows: &Rows,
        case: &Scope<'_>,
        values: &[f64],
    ) -> Result<Vec<f64>, Diagnostic> {
        let mut sums = Vec::new();
        for (row, values) in self.chosen(rows).into_iter().zip(values.chunks(self.calls())) {
            let nodes = self.nodes(rows.row(row), case)?;
            let weighted = |((_, weight), value): (&(CallDirections, f64), &f64)| {
                if *weight == 0.0 { 0.0 } else { weight * value }
            };
            sums.push(nodes.iter().zip(values).map(weighted).sum());
        }
        Ok(sums)
    }
}

impl CallDirections {
    /// A cosine or a direction by the name of a parameter.
    fn value(&self, name: &str) -> Option<Vec<f64>> {
        let cosine = COSINES.iter().find(|(known, _)| *known == name);
        let direction = DIRECTIONS.iter().find(|(known, _)| *known == name);
        cosine
            .map(|(_, cosine)| vec![cosine(self)])
            .or_else(|| direction.map(|(_, direction)| direction(self).to_vec()))
    }
}

/// Evenly spaced azimuths, and Gauss-Legendre in the cosine from `low` to 1, with their solid
/// angles.
fn even_directions(steps: usize, low: f64) -> Vec<(Vec3, f64)> {
    ring_directions(steps, |x| (low + (1.0 - low) * x, 1.0 - low))
}

/// Half vectors distributed as those of GGX of width alpha: tan^2 = alpha^2*u/(1 - u).
fn about_half(steps: usize, alpha: f64) -> Vec<(Vec3, f64)> {
    ring_directions(steps, |u| {
        let tan2 = alpha * alpha * u / (1.0 - u);
        let cosine = 1.0 / (1.0 + tan2).sqrt();
        (cosine, 0.5 * cosine.powi(3) * alpha * alpha / (1.0 - u).powi(2))
    })
}

/// Directions at evenly spaced azimuths, with their solid angles. `cosine` maps [0, 1] to the
/// cosine of the polar angle and its derivative.
fn ring_directions(steps: usize, cosine: impl Fn(f64) -> (f64, f64)) -> Vec<(Vec3, f64)> {
    let azimuths = 2 * steps;
    let mut found = Vec::new();
    for (x, weight) in gauss_legendre(steps) {
        let (z, slope) = cosine(0.5 * (x + 1.0));
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let solid = 0.5 * weight * slope * 2.0 * PI / azimuths as f64;
        for step in 0..azimuths {
            let (sin, cos) = (2.0 * PI * (step as f64 + 0.5) / azimuths as f64).sin_cos();
            found.push(([radius * cos, radius * sin, z], solid));
        }
    }
    found
}

/// The geometry of a call for a direction of the light.
fn light_call(v: Vec3, l: Vec3, weight: f64) -> (CallDirections, f64) {
    let sum = [0, 1, 2].map(|index| l[index] + v[index]);
    let length = dot(sum, sum).sqrt().max(1e-12);
    (CallDirections { l, v, h: sum.map(|value| value / length) }, weight)
}

/// The geometry of a call for the light that `h` mirrors towards the viewer. The solid angle is
/// that of `h`, and dl = 4*(v.h)*dh.
fn mirrored_call(v: Vec3, h: Vec3, weight: f64) -> (CallDirections, f64) {
    let vh = dot(v, h);
    let l = [0, 1, 2].map(|index| 2.0 * vh * h[index] - v[index]);
    let seen = vh > 0.0 && l[2] > 0.0;
    (CallDirections { l, v, h }, if seen { weight * 4.0 * vh * l[2] } else { 0.0 })
}

/// The geometry of a call for `h` as the normal of a microfacet, whose weight has the factor n.h.
fn facet_call(v: Vec3, h: Vec3, weight: f64) -> (CallDirections, f64) {
    let (geometry, _) = mirrored_call(v, h, weight);
    (geometry, weight * h[2])
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
