//! Against shadow acne: how far to move the compared depth towards the light, or the point out of the surface.
//!
//! Made from `bias.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_SHADOW_BIAS_GLSL
#define LAMPLIGHT_SHADOW_BIAS_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The depth moved towards the light by a constant.
///
/// Parameters: `d` depth, [0, 1] from near to far; `b` bias, in depth, at least 0, or negative for reversed depth.
/// Returns: `d - b`.
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, variance shadow mapping. The recipe adds 0.001 in normalised device coordinates, 0.0005 of a depth in [0, 1], to the stored depth.
/// Edges: neither `d`, `b` nor the result is clamped.
/// Error model: 1 ULP of the larger of `d` and `b`.
float constant_bias(float d, float b) {
    return d - b;
}

/// A bias that grows with the slope of the surface towards the light, up to a limit.
///
/// Parameters: `n_dot_l` cosine n.l, [-1, 1]; `b` bias at 45 degrees, in depth, at least 0; `limit` largest bias, in depth, at least 0.
/// Returns: `min(b*tan(acos(n.l)), limit)`, in [0, limit]: pass it to `constant_bias`.
/// Source: the slope factor of polygon offset, Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.18, in the receiver.
/// Edges: `limit` where `n_dot_l` is 0 or below: the light is at or behind the horizon; 0 for an `n_dot_l` above 1, and for a `b` of 0 or below in front of the horizon; but a `limit` of 0 or below is always the result.
/// Error model: 6 ULP.
float slope_bias(float n_dot_l, float b, float limit) {
    // The square as a product keeps its digits where the cosine is near 1.
    float rise = max(b, 0.0) * sqrt(max((1.0 - n_dot_l) * (1.0 + n_dot_l), 0.0));
    if (!(n_dot_l > 0.0 && rise < limit * n_dot_l)) {
        return limit;
    }
    return rise / n_dot_l;
}

/// The point moved out of the surface towards the light, more where light grazes it.
///
/// Light from behind moves the point out of the back, so that a leaf through which a lamp shines does not shadow itself.
///
/// Parameters: `p` the lit point, scene units; `n`, `l` unit, the space of `p`, `l` away from the surface; `texel` size of the map's texel at the point, scene units; `scale` texels to move at grazing light, at least 0.
/// Returns: `p + n*sign(n.l)*scale*texel*sin(n, l)`, scene units, for `shadow_coord`.
/// Source: Holbert, "Saying Goodbye to Shadow Acne", Game Developers Conference, 2011; the sign as in Unity Technologies, High Definition Render Pipeline, 2019.
/// Edges: `p` itself where the light is straight above or below, where `n` or `l` is zero, and where `texel` or `scale` is 0; along `n` where `l` is at right angles to it; a negative product of both moves the point away from the light.
/// Error model: absolute 2^-22*(|p| + scale*texel); the sine is the length of a cross product; either side where n.l is 0 but for rounding.
vec3 normal_offset(vec3 p, vec3 n, vec3 l, float texel, float scale) {
    float out_ = scale * texel * min(length(cross(n, l)), 1.0);
    return p + n * (dot(n, l) < 0.0 ? -out_ : out_);
}

/// The slope of the receiver's depth over the map, from screen-space derivatives.
///
/// Add `dot(slope, offset)` to the reference of a comparison at an offset in uv.
///
/// Parameters: `duv_dx`, `duv_dy` change of uv per pixel to the right and down; `dz` change of depth per pixel: x to the right, y down.
/// Returns: (dz/du, dz/dv), in depth per unit of uv.
/// Source: Isidoro, "Shadow Mapping: GPU-Based Tips and Techniques", Game Developers Conference, 2006: receiver plane depth bias.
/// Edges: zero where the surface is seen edge-on from the light: `duv_dx` and `duv_dy` are parallel, or one of them is zero; zero for a zero `dz`; components are clamped to [-1e30, 1e30].
/// Error model: absolute 2^-23*s*|dz|/|det|*(4 + 2*|duv_dx|*|duv_dy|/|det|), with s = |duv_dx| + |duv_dy|; the derivatives themselves have no bound.
vec2 receiver_plane(vec2 duv_dx, vec2 duv_dy, vec2 dz) {
    float det = duv_dx.x * duv_dy.y - duv_dx.y * duv_dy.x;
    if (!(abs(det) >= 1.0e-30)) {
        return vec2(0.0);
    }
    vec2 change = vec2(duv_dy.y * dz.x - duv_dx.y * dz.y, duv_dx.x * dz.y - duv_dy.x * dz.x) / det;
    return clamp(change, vec2(-1e30), vec2(1e30));
}

/// The size of a texel of a cube map with a depth.
///
/// Parameters: `d` distance of the point along the face's axis, scene units, at least 0; `size` texels across a face, above 0.
/// Returns: `2*d/size`, scene units: a face sees 90 degrees.
/// Source: the tangent of 45 degrees is 1.
/// Edges: a `size` below 1 counts as 1; 0 for a `d` of 0, and negative for a negative one.
/// Error model: 2.5 ULP.
float cube_texel(float d, float size) {
    return 2.0 * d / max(size, 1.0);
}

/// A bias for cube maps: the size of a texel times the slope of the surface, at most eight texels.
///
/// Parameters: `d` distance of the point along the face's axis, scene units, at least 0; `size` texels across a face, above 0; `n_dot_l` cosine n.l, [-1, 1].
/// Returns: `min(texel*tan(acos(n.l)), 8*texel)`, scene units: subtract it from the distance that is compared.
/// Source: the slope factor of `slope_bias`, over a texel of `cube_texel`.
/// Edges: eight texels where `n_dot_l` is 0 or below: the light is at or behind the horizon; 0 for an `n_dot_l` above 1 and for a `d` of 0 or less; a `size` below 1 counts as 1.
/// Error model: 9 ULP.
float cube_bias(float d, float size, float n_dot_l) {
    float texel = cube_texel(max(d, 0.0), size);
    return slope_bias(n_dot_l, texel, 8.0 * texel);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
