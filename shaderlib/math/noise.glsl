//! Noise for sampling: cheap, repeatable, and exact where it is made of integers.

#ifndef LAMPLIGHT_MATH_NOISE_GLSL
#define LAMPLIGHT_MATH_NOISE_GLSL

/// Interleaved gradient noise: neighbouring pixels get well-spread values.
float interleaved_gradient_noise(vec2 pixel) {
    return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
}

/// A permutation of the 32-bit numbers that looks random.
uint hash_pcg(uint seed) {
    uint state = seed * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

/// A seed for `hash_pcg` from a pixel.
uint pixel_seed(vec2 pixel) {
    return hash_pcg(uint(max(pixel.x, 0.0)) + hash_pcg(uint(max(pixel.y, 0.0))));
}

/// A number in [0, 1) from the upper 24 bits of a hash.
float unit_float(uint bits) {
    return float(bits >> 8u) * 5.9604645e-8;
}

/// The recipe's random number: the fraction of a large sine.
float random_hpg(vec4 seed) {
    return fract(sin(dot(seed, vec4(12.9898, 78.233, 45.164, 94.673))) * 43758.5453);
}

/// A point of a spiral that fills the unit disk evenly.
vec2 vogel_disk(int i, int count, float phi) {
    float turn = fract(float(i) * 0.38196601 + phi * 0.15915494);
    float angle = (turn - 0.5) * 6.2831853;
    float r = sqrt((float(i) + 0.5) / float(max(count, 1)));
    return vec2(-cos(angle), -sin(angle)) * r;
}

#endif
