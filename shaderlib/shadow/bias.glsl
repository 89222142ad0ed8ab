//! Against shadow acne: how far to move the compared depth towards the light, or the point out of the surface.

#ifndef LAMPLIGHT_SHADOW_BIAS_GLSL
#define LAMPLIGHT_SHADOW_BIAS_GLSL

/// The depth moved towards the light by a constant.
float constant_bias(float d, float b) {
    return d - b;
}

/// A bias that grows with the slope of the surface towards the light, up to a limit.
float slope_bias(float n_dot_l, float b, float limit) {
    // The square as a product keeps its digits where the cosine is near 1.
    float rise = b * sqrt(max((1.0 - n_dot_l) * (1.0 + n_dot_l), 0.0));
    if (!(n_dot_l > 0.0 && rise < limit * n_dot_l)) {
        return limit;
    }
    return rise / n_dot_l;
}

/// The point moved out of the surface, more where light grazes it.
vec3 normal_offset(vec3 p, vec3 n, vec3 l, float texel, float scale) {
    return p + n * (scale * texel * length(cross(n, l)));
}

/// The slope of the receiver's depth over the map, from screen-space derivatives.
vec2 receiver_plane(vec2 duv_dx, vec2 duv_dy, vec2 dz) {
    float det = duv_dx.x * duv_dy.y - duv_dx.y * duv_dy.x;
    if (!(abs(det) >= 1.0e-30)) {
        return vec2(0.0);
    }
    return vec2(duv_dy.y * dz.x - duv_dx.y * dz.y, duv_dx.x * dz.y - duv_dy.x * dz.x) / det;
}

/// The size of a texel of a cube map with a depth.
///
/// Parameters: `d` distance of the point along the face's axis, scene units, at least 0; `size` texels across a face, above 0.
/// Returns: `2*d/size`, scene units: a face sees 90 degrees.
/// Source: the tangent of 45 degrees is 1.
/// Edges: a size below 1 counts as 1.
/// Error model: 2.5 ULP.
float cube_texel(float d, float size) {
    return 2.0 * d / max(size, 1.0);
}

/// A bias for cube maps: what the surface's slope makes of a texel's size, up to eight texels.
///
/// Parameters: `d` distance of the point along the face's axis, scene units, at least 0; `size` texels across a face, above 0; `n_dot_l` cosine n.l, [-1, 1].
/// Returns: `min(texel*tan(acos(n.l)), 8*texel)`, scene units: subtract it from the distance that is compared.
/// Source: the slope factor of `slope_bias`, over a texel of `cube_texel`.
/// Edges: eight texels where the light is at or behind the horizon; 0 for a distance of 0 or less.
/// Error model: 9 ULP.
float cube_bias(float d, float size, float n_dot_l) {
    float texel = cube_texel(max(d, 0.0), size);
    return slope_bias(n_dot_l, texel, 8.0 * texel);
}

#endif
