//! Built-in functions and operators, each as an expression of one number.

/// An expression of x, its meaning as a function of Rust, and the range of x.
pub type One = (&'static str, fn(f64) -> f64, f64, f64);

/// The expressions that are swept.
pub const ONE: &[One] = &[
    ("-x", |x| -x, -10.0, 10.0),
    ("abs(x)", f64::abs, -10.0, 10.0),
    ("saturate(x)", |x| x.clamp(0.0, 1.0), -3.0, 3.0),
    ("sin(x)", f64::sin, -3.0, 3.0),
    ("cos(x)", f64::cos, -3.0, 3.0),
    ("tan(x)", f64::tan, -1.5, 1.5),
    ("sinh(x)", f64::sinh, -5.0, 5.0),
    ("cosh(x)", f64::cosh, -5.0, 5.0),
    ("tanh(x)", f64::tanh, -5.0, 5.0),
    ("asin(x)", f64::asin, -1.0, 1.0),
    ("acos(x)", f64::acos, -1.0, 1.0),
    ("atan(x)", f64::atan, -9.0, 9.0),
    ("asinh(x)", f64::asinh, -9.0, 9.0),
    ("acosh(x)", f64::acosh, 1.0, 9.0),
    ("atanh(x)", f64::atanh, -0.99, 0.99),
    ("radians(x)", f64::to_radians, -360.0, 360.0),
    ("degrees(x)", f64::to_degrees, -7.0, 7.0),
    ("ceil(x)", f64::ceil, -7.0, 7.0),
    ("floor(x)", f64::floor, -7.0, 7.0),
    ("round(x)", f64::round_ties_even, -7.0, 7.0),
    ("trunc(x)", f64::trunc, -7.0, 7.0),
    ("fract(x)", |x| x - x.floor(), -7.0, 7.0),
    ("exp(x)", f64::exp, -20.0, 20.0),
    ("exp2(x)", f64::exp2, -20.0, 20.0),
    ("log(x)", f64::ln, 1e-3, 50.0),
    ("log2(x)", f64::log2, 1e-3, 50.0),
    ("sign(x)", |x| if x == 0.0 { 0.0 } else { x.signum() }, -2.0, 2.0),
    ("sqrt(x)", f64::sqrt, 0.0, 100.0),
    ("inverseSqrt(x)", |x| 1.0 / x.sqrt(), 1e-3, 100.0),
    ("quantizeToF16(x)", quantized, -100.0, 100.0),
    ("x + 0.1", |x| x + f64::from(0.1f32), -5.0, 5.0),
    ("x - 0.7", |x| x - f64::from(0.7f32), -5.0, 5.0),
    ("x * 1.7", |x| x * f64::from(1.7f32), -5.0, 5.0),
    ("1.7 / x", |x| f64::from(1.7f32) / x, 0.1, 5.0),
    ("x % 0.75", |x| x % 0.75, -5.0, 5.0),
    ("min(x, 1.5) + max(x, 0.25)", |x| x.min(1.5) + x.max(0.25), -5.0, 5.0),
    ("clamp(x, -1.5, 2.5)", |x| x.clamp(-1.5, 2.5), -5.0, 5.0),
    ("step(0.5, x)", |x| f64::from(u8::from(x >= 0.5)), -5.0, 5.0),
    ("atan2(x, 2.0)", |x| x.atan2(2.0), -5.0, 5.0),
    ("atan2(x, -2.0)", |x| x.atan2(-2.0), 0.1, 5.0),
    ("pow(x, 32.0)", |x| x.powf(32.0), 0.01, 1.0),
    ("pow(x, 4096.0)", |x| x.powf(4096.0), 0.9, 1.0),
    ("pow(2.0, x)", |x| x.exp2(), -9.0, 9.0),
    ("mix(2.0, 5.0, x)", |x| 2.0 * (1.0 - x) + 5.0 * x, -1.0, 2.0),
    ("smoothstep(0.25, 0.75, x)", |x| smooth((x - 0.25) / 0.5), -0.5, 1.5),
    ("fma(x, 3.0, 0.5)", |x| x * 3.0 + 0.5, -5.0, 5.0),
    ("ldexp(x, 3)", |x| x * 8.0, -5.0, 5.0),
    ("frexp(x).fract", |x| fraction(x), 0.01, 20.0),
    ("f32(frexp(x).exp)", |x| x.log2().floor() + 1.0, 0.01, 20.0),
    ("modf(x).fract", |x| x.fract(), -5.0, 5.0),
    ("modf(x).whole", |x| x.trunc(), -5.0, 5.0),
    ("length(vec3f(x, 2.0, -3.0))", |x| (x * x + 13.0).sqrt(), -5.0, 5.0),
    ("normalize(vec2f(x, 2.0)).x", |x| x / (x * x + 4.0).sqrt(), -5.0, 5.0),
    ("dot(vec2f(x, 2.0), vec2f(3.0, x))", |x| 5.0 * x, -5.0, 5.0),
    (
        "distance(vec2f(x, 2.0), vec2f(3.0, x))",
        |x| ((x - 3.0).powi(2) + (2.0 - x).powi(2)).sqrt(),
        -5.0,
        5.0,
    ),
    ("x * x * x - 2.0 * x", |x| x * x * x - 2.0 * x, -5.0, 5.0),
];

fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn fraction(x: f64) -> f64 {
    x / (x.log2().floor() + 1.0).exp2()
}

/// A number rounded to the eleven significant bits of f16. It is above the subnormals of f16.
fn quantized(x: f64) -> f64 {
    if x == 0.0 {
        return x;
    }
    let unit = (x.abs().log2().floor() - 10.0).exp2();
    (x / unit).round_ties_even() * unit
}
