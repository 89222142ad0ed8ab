//! The functions of formulas: the numeric built-in functions of WGSL in f64, and `dot_abs` and
//! `vec`.

use super::{FormulaFunction, map_components, zip_components};

const fn make_function(
    name: &'static str,
    arity: usize,
    apply: fn(&[Vec<f64>]) -> Vec<f64>,
) -> FormulaFunction {
    FormulaFunction { name, arity: Some(arity), apply }
}

/// Every function, by name.
pub const ALL: &[FormulaFunction] = &[
    make_function("abs", 1, |a| map_components(&a[0], f64::abs)),
    make_function("acos", 1, |a| map_components(&a[0], f64::acos)),
    make_function("asin", 1, |a| map_components(&a[0], f64::asin)),
    make_function("atan", 1, |a| map_components(&a[0], f64::atan)),
    make_function("atan2", 2, |a| zip_components(&a[0], &a[1], f64::atan2)),
    make_function("ceil", 1, |a| map_components(&a[0], f64::ceil)),
    make_function("clamp", 3, |a| {
        zip_components(&zip_components(&a[0], &a[1], f64::max), &a[2], f64::min)
    }),
    make_function("cos", 1, |a| map_components(&a[0], f64::cos)),
    make_function("cosh", 1, |a| map_components(&a[0], f64::cosh)),
    make_function("cross", 2, |a| cross(&a[0], &a[1])),
    make_function("degrees", 1, |a| map_components(&a[0], f64::to_degrees)),
    make_function("distance", 2, |a| vec![length(&minus(&a[0], &a[1]))]),
    make_function("dot", 2, |a| vec![times(&a[0], &a[1]).iter().sum()]),
    make_function("dot_abs", 2, |a| {
        vec![zip_components(&a[0], &a[1], |x, y| (x * y).abs()).iter().sum()]
    }),
    make_function("exp", 1, |a| map_components(&a[0], f64::exp)),
    make_function("exp2", 1, |a| map_components(&a[0], f64::exp2)),
    make_function("floor", 1, |a| map_components(&a[0], f64::floor)),
    make_function("fract", 1, |a| map_components(&a[0], |x| x - x.floor())),
    make_function("inverseSqrt", 1, |a| map_components(&a[0], |x| 1.0 / x.sqrt())),
    make_function("length", 1, |a| vec![length(&a[0])]),
    make_function("log", 1, |a| map_components(&a[0], f64::ln)),
    make_function("log2", 1, |a| map_components(&a[0], f64::log2)),
    make_function("max", 2, |a| zip_components(&a[0], &a[1], f64::max)),
    make_function("min", 2, |a| zip_components(&a[0], &a[1], f64::min)),
    make_function("mix", 3, |a| mix(&a[0], &a[1], &a[2])),
    make_function("normalize", 1, |a| map_components(&a[0], |x| x / length(&a[0]))),
    make_function("pow", 2, |a| zip_components(&a[0], &a[1], f64::powf)),
    make_function("radians", 1, |a| map_components(&a[0], f64::to_radians)),
    make_function("reflect", 2, |a| reflect(&a[0], &a[1])),
    make_function("round", 1, |a| map_components(&a[0], f64::round_ties_even)),
    make_function("saturate", 1, |a| map_components(&a[0], saturate)),
    make_function("select", 3, |a| if a[2][0] != 0.0 { a[1].clone() } else { a[0].clone() }),
    make_function("sign", 1, |a| {
        map_components(&a[0], |x| if x == 0.0 { 0.0 } else { x.signum() })
    }),
    make_function("sin", 1, |a| map_components(&a[0], f64::sin)),
    make_function("sinh", 1, |a| map_components(&a[0], f64::sinh)),
    make_function("smoothstep", 3, |a| smoothstep(&a[0], &a[1], &a[2])),
    make_function("sqrt", 1, |a| map_components(&a[0], f64::sqrt)),
    make_function("step", 2, |a| {
        zip_components(&a[0], &a[1], |edge, x| f64::from(u8::from(edge <= x)))
    }),
    make_function("tan", 1, |a| map_components(&a[0], f64::tan)),
    make_function("tanh", 1, |a| map_components(&a[0], f64::tanh)),
    make_function("trunc", 1, |a| map_components(&a[0], f64::trunc)),
    FormulaFunction { name: "vec", arity: None, apply: |a| a.concat() },
];

fn minus(a: &[f64], b: &[f64]) -> Vec<f64> {
    zip_components(a, b, |x, y| x - y)
}

fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    zip_components(a, b, |x, y| x * y)
}

fn saturate(x: f64) -> f64 {
    x.clamp(0.0, 1.0)
}

fn mix(a: &[f64], b: &[f64], t: &[f64]) -> Vec<f64> {
    zip_components(&times(a, &map_components(t, |t| 1.0 - t)), &times(b, t), |x, y| x + y)
}

/// `n` must be of unit length, as in WGSL.
fn reflect(i: &[f64], n: &[f64]) -> Vec<f64> {
    let along: f64 = times(i, n).iter().sum();
    minus(i, &map_components(n, |x| 2.0 * along * x))
}

fn smoothstep(low: &[f64], high: &[f64], x: &[f64]) -> Vec<f64> {
    let t =
        zip_components(&minus(x, low), &minus(high, low), |above, width| saturate(above / width));
    map_components(&t, |t| t * t * (3.0 - 2.0 * t))
}

fn length(a: &[f64]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn cross(a: &[f64], b: &[f64]) -> Vec<f64> {
    match (a, b) {
        ([a0, a1, a2], [b0, b1, b2]) => {
            vec![a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0]
        }
        _ => vec![f64::NAN; 3],
    }
}
