//! Light from a grid of probes with visibility, for `forward` with `ambient=ddgi`: each point takes
//! the light of the eight probes around it, and less of those that do not see it.
//!
//! The squares of the probes are in rows of their height: the probe x, y, z is in column `x +
//! counts.x*z` of row y. A square is the octahedron of `ambient::octahedral`, with a border of one
//! texel that repeats what is across its edges.
//!
//! Made from `probes.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_PROGRAMS_PROBES_GLSL
#define LAMPLIGHT_PROGRAMS_PROBES_GLSL

#if AMBIENT == AMBIENT_DDGI
#include "../ambient/ddgi.glsl"
#include "../ambient/octahedral.glsl"
#include "../math/safe.glsl"
#endif

#if AMBIENT == AMBIENT_DDGI
/// The grid, along the axes of the world.
layout(std140, set = 2, binding = 11) uniform Probes {
    /// Where the first probe is.
    vec3 origin;
    /// Texels along an edge of a square of `probe_light`, without the border.
    float light_side;
    /// Distances of neighbours, scene units, above 0.
    vec3 spacing;
    /// The same of `probe_depths`.
    float depth_side;
    /// How many along each axis, at least 2.
    uvec3 counts;
    /// How far off the surface a point is looked up, scene units.
    float bias;
} probes;

layout(set = 2, binding = 12) uniform texture2D probe_light;
layout(set = 2, binding = 13) uniform texture2D probe_depths;
layout(set = 2, binding = 14) uniform sampler probe_sampler;

/// Where a texture of squares has a probe's value in a direction.
vec2 probe_uv(vec3 probe, vec3 direction, float side) {
    vec3 counts = vec3(probes.counts);
    vec2 square = vec2(probe.x + counts.x * probe.z, probe.y);
    vec2 inside = 1.0 + (0.5 * octahedral_encode(direction) + 0.5) * side;
    return (square * (side + 2.0) + inside) / (vec2(counts.x * counts.z, counts.y) * (side + 2.0));
}

/// The light that falls onto a point with a unit normal, as a share of what a white surface shows.
vec3 probe_irradiance(vec3 position, vec3 normal) {
    vec3 point = position + normal * probes.bias;
    vec3 last = max(vec3(probes.counts), vec3(2.0)) - 1.0;
    vec3 place = clamp((point - probes.origin) / probes.spacing, vec3(0.0), last);
    vec3 base = min(floor(place), last - 1.0);
    vec3 share = place - base;
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (uint i = 0u; i < 8u; i++) {
        vec3 along = vec3(uvec3(i & 1u, (i >> 1u) & 1u, i >> 2u));
        vec3 probe = base + along;
        vec3 at = probes.origin + probe * probes.spacing;
        vec3 offset = point - at;
        vec3 parts = mix(1.0 - share, share, along);
        vec3 towards = safe_normalize(at - position, normal);
        vec2 place_of_depths = probe_uv(probe, offset, probes.depth_side);
        vec2 moments = textureLod(sampler2D(probe_depths, probe_sampler), place_of_depths, 0.0).xy;
        float weight = ddgi_weight(normal, towards, parts.x * parts.y * parts.z, moments.x, moments.y, length(offset));
        vec2 place_of_light = probe_uv(probe, normal, probes.light_side);
        vec3 light = textureLod(sampler2D(probe_light, probe_sampler), place_of_light, 0.0).rgb;
        sum += weight * light;
        total += weight;
    }
    return sum / total;
}
#endif

#endif
