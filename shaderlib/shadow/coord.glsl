//! From a point to its place in a shadow map. Conventions of clip space and texture space are handled here and nowhere else.
//!
//! Made from `coord.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_SHADOW_COORD_GLSL
#define LAMPLIGHT_SHADOW_COORD_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// A point's place in a shadow map.
struct ShadowUv {
    /// Texture coordinates, origin at the map's first texel; [0, 1] inside.
    vec2 uv;
    /// Depth to compare with the map, [0, 1] from near to far.
    float depth;
    /// Whether the point is inside the light's frustum. Outside is lit.
    bool inside;
};

/// Whether texture coordinates are on the map.
///
/// Parameters: `uv` texture coordinates.
/// Returns: true where both are in [0, 1].
/// Source: stands in for a border colour, which not every target has.
/// Edges: the map's edges are on it; NaN is not.
/// Error model: exact.
bool is_on_map(vec2 uv) {
    return uv.x >= 0.0 && uv.x <= 1.0 && uv.y >= 0.0 && uv.y <= 1.0;
}

/// A point in the light's clip space.
///
/// Parameters: `m` the light's projection times its view, for column vectors; `p_world` the point, anywhere in world space, scene units.
/// Returns: clip coordinates, before the division by w.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.20; the bias matrix of example 7.19 is `project` here.
/// Edges: w is 0 or below at and behind a perspective light, which `project` finds; zero for an `m` of zeros.
/// Error model: absolute 4*2^-23*sum|m_ij*p_j| per component.
vec4 shadow_coord(mat4 m, vec3 p_world) {
    return m * vec4(p_world, 1.0);
}

/// The place in the shadow map of a point in clip space, for depths in [0, 1] and rows from the top.
///
/// This is the convention of WebGPU, Vulkan after its flipped viewport, Metal and Direct3D.
///
/// Parameters: `sc` clip coordinates from `shadow_coord`; `min_w` smallest light-space depth that can be shadowed, scene units for a perspective light, at least 0.
/// Returns: `uv = (0.5*x + 0.5, 0.5 - 0.5*y)` and `depth = z` after division by w; `inside` where uv and depth are in [0, 1] and `w > min_w`.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.19, for another clip space; the guard on w: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, shadow mapping (there 1, its near plane).
/// Edges: outside, with uv and depth 0, where the w of `sc` is at or below `min_w` (0 at least): behind the light.
/// Error model: absolute 4*2^-23*(|x/w| + 1), beside the error of `sc` divided by w.
ShadowUv project(vec4 sc, float min_w) {
    if (!(sc.w > max(min_w, SMALLEST_NORMAL))) {
        return ShadowUv(vec2(0.0), 0.0, false);
    }
    vec3 ndc = sc.xyz / sc.w;
    vec2 uv = vec2(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y);
    return ShadowUv(uv, ndc.z, is_on_map(uv) && ndc.z >= 0.0 && ndc.z <= 1.0);
}

/// The place in the shadow map of a point in OpenGL's clip space, depths from -1 to 1 and rows from the bottom.
///
/// Parameters: `sc` clip coordinates from `shadow_coord`, with OpenGL's projection; `min_w` as for `project`.
/// Returns: `uv = 0.5*xy + 0.5` and `depth = 0.5*z + 0.5` after division by w; `inside` as for `project`.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.19: the bias matrix.
/// Edges: as `project`.
/// Error model: that of `project`.
ShadowUv project_gl(vec4 sc, float min_w) {
    return project(vec4(sc.x, -sc.y, 0.5 * (sc.z + sc.w), sc.w), min_w);
}

/// The distance along the view axis that a perspective depth stands for.
///
/// Parameters: `d` depth, [0, 1] from near to far; `near`, `far` plane distances, scene units, above 0. For reversed depth swap the planes.
/// Returns: `near*far/(far - d*(far - near))`, scene units, between `near` and `far`.
/// Source: the inverse of a perspective projection to [0, 1]; stands for the depth view of Igalia, "Working with lights and shadows", part II.
/// Edges: never above 1e30, which is also the result beyond any far plane; 0 for a `near` or a `far` of 0 or below; a `d` outside [0, 1] is not clamped.
/// Error model: 6 ULP for d in [0, 1]; the depth's own error weighs far/near times as much near d = 1.
float linearize_depth(float d, float near, float far) {
    // The weighted sum does not cancel near d = 1, as far - d*(far - near) does.
    float product = max(near, 0.0) * max(far, 0.0);
    return product / max(far * (1.0 - d) + near * d, max(1e-30 * product, SMALLEST_NORMAL));
}

/// The brightness Igalia's tutorial shows for a depth.
///
/// It differs from `linearize_depth` in that it is not linear in distance: it magnifies the last hundredth of the depths.
///
/// Parameters: `d` depth, [0, 1] from near to far.
/// Returns: `1 - (1 - d)*100`: in [0, 1] for d in [0.99, 1], below 0 before.
/// Source: Igalia, "Working with lights and shadows", part II: the shadow map.
/// Edges: not clamped.
/// Error model: absolute 2^-23*(1 + 100*|1 - d|).
float depth_view_igl(float d) {
    return 1.0 - (1.0 - d) * 100.0;
}

/// The depth a perspective face of a cube map holds for an offset from the light.
///
/// Parameters: `offset` from the light to the point, in the cube's space, scene units; `near`, `far` plane distances of the faces, scene units, above 0.
/// Returns: depth, [0, 1] from near to far, for faces of 90 degrees and depths in [0, 1].
/// Source: Gerasimov, "Omnidirectional Shadow Mapping", GPU Gems, 2004, chapter 12: the largest component is the distance along the face's axis.
/// Edges: an `offset` nearer than `near`, a zero one too, counts as at `near`; a negative plane counts as 0: every depth is 1 for a `near` of 0, and 0 for a `far` of 0; never above 1e30, towards which depths beyond `near` rise where `far` is not beyond it.
/// Error model: absolute 6*2^-23*far/(far - near).
float cube_depth(vec3 offset, float near, float far) {
    float start = max(near, 0.0);
    float end = max(far, 0.0);
    float z = max(max(max(abs(offset.x), abs(offset.y)), abs(offset.z)), max(start, SMALLEST_NORMAL));
    return end / max(end - start, max(1e-30 * end, SMALLEST_NORMAL)) * ((z - start) / z);
}

/// The place in a paraboloid map of a point in front of the light: half of all directions in one texture.
///
/// Edges that are straight in the scene are bent in such a map, while triangles are drawn straight: it needs small ones.
///
/// Parameters: `p` from the light to the point, in a frame whose z is the map's axis, scene units.
/// Returns: texture coordinates of `p.xy/(|p| + p.z)`, rows from the top as for `project`, and the distance `|p|`, scene units. The half in front is the disk that fills the map.
/// Source: Brabec, Annen, Seidel, "Shadow Mapping for Hemispherical and Omnidirectional Light Sources", 2002.
/// Edges: points behind are outside of the disk, and straight behind at (2, 2); (2, 2, 0) for a zero vector.
/// Error model: absolute 8*2^-23/(1 + cos(a)) beside the distance's 2 ULP, with a the angle to z.
vec3 paraboloid_uv(vec3 p) {
    float d = length(p);
    float under = d + p.z;
    if (!(under > 1e-6 * d)) {
        return vec3(2.0, 2.0, d);
    }
    vec2 at = p.xy / under;
    return vec3(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y, d);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
