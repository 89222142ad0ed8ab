//! Against shadow acne: how far to move the compared depth towards the light, or the point out of the surface.

#ifndef LAMPLIGHT_SHADOW_BIAS_GLSL
#define LAMPLIGHT_SHADOW_BIAS_GLSL

/// The depth moved towards the light by a constant.
float constant_bias(float d, float b) {
    return d - b;
}

/// A bias that grows with the slope of the surface towards the light, up to a limit.
float slope_bias(float n_dot_l, float b, float limit) {
    if (!(n_dot_l > 0.0)) {
        return limit;
    }
    // The square as a product keeps its digits where the cosine is near 1.
    float sine = sqrt(max((1.0 - n_dot_l) * (1.0 + n_dot_l), 0.0));
    return min(b * sine / n_dot_l, limit);
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

#endif
