//! Directions as points of a square: the octahedron unfolded, for probes and for normals in two numbers.
//!
//! Made from `octahedral.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_AMBIENT_OCTAHEDRAL_GLSL
#define LAMPLIGHT_AMBIENT_OCTAHEDRAL_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The point of the square that stands for a direction.
///
/// Parameters: `n` direction, any length.
/// Returns: the point, each coordinate in [-1, 1]: the upper half is the inner diamond.
/// Source: Cigolle, Donow, Evangelakos, Mara, McGuire, Meyer, "A Survey of Efficient Representations for Independent Unit Vectors", 2014, section 3.1.
/// Edges: the sign of 0 counts as positive; (0, 0) for a zero vector.
/// Error model: absolute 4*2^-23.
vec2 octahedral_encode(vec3 n) {
    // A sixteenth, so that the sum stays below 2^126, beyond which GPUs may divide to 0.
    vec3 m = 0.0625 * n;
    float sum = abs(m.x) + abs(m.y) + abs(m.z);
    if (!(sum > 6.25e-32)) {
        return vec2(0.0);
    }
    vec2 e = m.xy / sum;
    if (m.z >= 0.0) {
        return e;
    }
    vec2 side = vec2(e.x >= 0.0 ? 1.0 : -1.0, e.y >= 0.0 ? 1.0 : -1.0);
    return (vec2(1.0) - abs(e.yx)) * side;
}

/// The direction that a point of the square stands for.
///
/// Parameters: `e` point, each coordinate in [-1, 1].
/// Returns: unit vector.
/// Source: Cigolle, Donow, Evangelakos, Mara, McGuire, Meyer, "A Survey of Efficient Representations for Independent Unit Vectors", 2014, section 3.1.
/// Edges: points beyond the square are clamped to it; the sign of 0 counts as positive.
/// Error model: absolute 4*2^-23.
vec3 octahedral_decode(vec2 e) {
    vec2 at = clamp(e, vec2(-1.0), vec2(1.0));
    float height = 1.0 - abs(at.x) - abs(at.y);
    vec2 side = vec2(at.x >= 0.0 ? 1.0 : -1.0, at.y >= 0.0 ? 1.0 : -1.0);
    vec2 folded = at - side * max(-height, 0.0);
    return normalize(vec3(folded, height));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
