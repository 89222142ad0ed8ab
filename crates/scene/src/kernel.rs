//! Kernels of blurs.

/// The weights of a Gaussian, `exp(-i*i / (2 * variance))` over their sum, for i from `-radius` to
/// `radius`.
///
/// Parameters: `variance` in texels squared, above 0; 8 and a radius of 10 make the library's
/// `gaussian21`.
/// Returns: `2 * radius + 1` weights whose sum is 1.
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, variance shadow
/// mapping.
pub fn gaussian(radius: u32, variance: f64) -> Vec<f64> {
    let weight = |i: i64| (-(i * i) as f64 / (2.0 * variance)).exp();
    let radius = i64::from(radius);
    let sum: f64 = (-radius..=radius).map(weight).sum();
    (-radius..=radius).map(|i| weight(i) / sum).collect()
}
