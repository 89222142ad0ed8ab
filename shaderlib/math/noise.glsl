//! Noise for sampling: cheap, repeatable, and exact where it is made of integers.
//!
//! Made from `noise.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_MATH_NOISE_GLSL
#define LAMPLIGHT_MATH_NOISE_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// Interleaved gradient noise: neighbouring pixels get well-spread values.
///
/// Parameters: `pixel` framebuffer position, pixels, at least 0.
/// Returns: a number in [0, 1).
/// Source: Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014.
/// Edges: 0 at the origin; the pattern goes on over negative positions, and loses its spread beyond about 2^17 pixels.
/// Error model: absolute 80*2^-23*(0.067*pixel.x + 0.0058*pixel.y + 1), modulo 1.
float interleaved_gradient_noise(vec2 pixel) {
    return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
}

/// A permutation of the 32-bit numbers that looks random.
///
/// Parameters: `seed` any number.
/// Returns: a number of 32 bits; each output comes from one seed.
/// Source: Jarzynski, Olano, "Hash Functions for GPU Rendering", 2020: one step of a congruential generator, permuted as O'Neill's PCG.
/// Edges: none.
/// Error model: exact: integers modulo 2^32.
uint hash_pcg(uint seed) {
    uint state = seed * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

/// A seed for `hash_pcg` from a pixel.
///
/// Parameters: `pixel` framebuffer position, pixels, at least 0, of which fractions are dropped.
/// Returns: a number of 32 bits.
/// Source: the nested hash of Jarzynski, Olano, "Hash Functions for GPU Rendering", 2020.
/// Edges: a negative position counts as 0; indeterminate from 2^32 on.
/// Error model: exact.
uint pixel_seed(vec2 pixel) {
    return hash_pcg(uint(min(max(pixel.x, 0.0), 4294967040.0)) + hash_pcg(uint(min(max(pixel.y, 0.0), 4294967040.0))));
}

/// A number in [0, 1) from the upper 24 bits of a hash.
///
/// Parameters: `bits` a hash, as from `hash_pcg`.
/// Returns: a multiple of 2^-24 in [0, 1).
/// Source: a float holds 24 bits, so none of the values is rounded.
/// Edges: never 1.
/// Error model: exact.
float unit_float(uint bits) {
    return float(bits >> 8u) * 5.9604645e-8;
}

/// The recipe's random number: the fraction of a large sine.
///
/// It differs from `hash_pcg` in that its value depends on the driver: no bound holds for the sine of a large number.
///
/// Parameters: `seed` pixel position and number of the sample.
/// Returns: a number in [0, 1).
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, percentage closer filtering.
/// Edges: 0 for a zero seed.
/// Error model: none: any value in [0, 1) conforms.
float random_hpg(vec4 seed) {
    return fract(sin(dot(seed, vec4(12.9898, 78.233, 45.164, 94.673))) * 43758.5453);
}

/// A point of a spiral that fills the unit disk evenly.
///
/// Parameters: `i` number of the point, from 0 to `count - 1`; `count` how many points; `phi` turn of the whole spiral, any angle, radians.
/// Returns: a point at distance `sqrt((i + 0.5)/count)` from the origin, below 1.
/// Source: Vogel, "A Better Way to Construct the Sunflower Head", 1979: the golden angle, 2.399963 radians.
/// Edges: a `count` below 1 counts as 1; a negative `i` is the middle, and one from `count` on is outside the unit disk.
/// Error model: absolute 2^-11 (sine and cosine, as WGSL promises them) + 1.5*2^-23*(2.4*i + |phi|); the angle is reduced to [-pi, pi], outside of which no bound holds.
vec2 vogel_disk(int i, int count, float phi) {
    float turn = fract(float(i) * 0.38196601 + phi * 0.15915494);
    float angle = (turn - 0.5) * 6.2831853;
    float r = sqrt(max(float(i) + 0.5, 0.0) / float(max(count, 1)));
    return vec2(-cos(angle), -sin(angle)) * r;
}

/// A point of a sequence that fills the unit square evenly, however many points are taken of it.
///
/// Parameters: `i` index of the point.
/// Returns: two multiples of 2^-24 in [0, 1).
/// Source: Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018: 1/2 + i/p and 1/2 + i/p^2 modulo 1, with p^3 = p + 1, in integers modulo 2^32.
/// Edges: (0.5, 0.5) for 0.
/// Error model: exact.
vec2 r2_sequence(uint i) {
    return vec2(unit_float(2147483648u + i * 3242174889u), unit_float(2147483648u + i * 2447445414u));
}

/// Interleaved gradient noise that is another in each frame, for a filter over time.
///
/// Parameters: `pixel` framebuffer position, pixels, at least 0; `frame` number of the frame.
/// Returns: `interleaved_gradient_noise` at a pixel that moves by 5.588238 to the right and down in each of 64 frames, [0, 1).
/// Source: Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014; Wolfe, "Interleaved Gradient Noise: A Different Kind of Low Discrepancy Sequence", 2022, has the step.
/// Edges: `interleaved_gradient_noise` for a `frame` of 0; frames repeat after 64; negative positions of `pixel` as for `interleaved_gradient_noise`.
/// Error model: absolute 80*2^-23*(0.067*pixel.x + 0.0058*pixel.y + 28), modulo 1.
float ign_time(vec2 pixel, uint frame) {
    return interleaved_gradient_noise(pixel + 5.588238 * float(frame % 64u));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
