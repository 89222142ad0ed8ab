//! Diffuse reflection. `lambert`, `half_lambert`, `wrap` and `oren_nayar` are shares of a white Lambert surface:
//! the cosine is in them, 1/pi is not. `burley` takes cosines and is a BRDF: 1/pi is in it, the cosine is not.

#ifndef LAMPLIGHT_BRDF_DIFFUSE_GLSL
#define LAMPLIGHT_BRDF_DIFFUSE_GLSL

/// Lambert's cosine.
float lambert(vec3 n, vec3 l) {
    return max(dot(n, l), 0.0);
}

/// Lambert's cosine moved to [0, 1] and squared, so that the dark side keeps some shape.
float half_lambert(vec3 n, vec3 l) {
    float x = 0.5 * dot(n, l) + 0.5;
    return x * x;
}

/// Lambert's cosine wrapped around the terminator.
float wrap(vec3 n, vec3 l, float w) {
    float amount = max(w, 0.0);
    return max((dot(n, l) + amount) / (1.0 + amount), 0.0);
}

/// Diffuse reflection of a rough surface of Lambert facets, in the authors' short form.
float oren_nayar(vec3 n, vec3 l, vec3 v, float sigma) {
    float nl = dot(n, l);
    if (!(nl > 0.0)) {
        return 0.0;
    }
    float nv = max(dot(n, v), 0.0);
    float s2 = sigma * sigma;
    float a = 1.0 - 0.5 * s2 / (s2 + 0.33);
    float b = 0.45 * s2 / (s2 + 0.09);
    // cos(phi)*sin(theta_l)*sin(theta_v), without an angle.
    float s = max(dot(l, v) - nl * nv, 0.0);
    return nl * a + b * s * (nl / max(nl, nv));
}

/// Disney's diffuse BRDF: Lambert with a retroreflective rim that grows with roughness.
float burley(float nl, float nv, float lh, float roughness) {
    float rise = 2.0 * roughness * lh * lh - 0.5;
    float x = 1.0 - clamp(nl, 0.0, 1.0);
    float y = 1.0 - clamp(nv, 0.0, 1.0);
    float x2 = x * x;
    float y2 = y * y;
    return (1.0 + rise * (x2 * x2 * x)) * (1.0 + rise * (y2 * y2 * y)) * 0.31830989;
}

#endif
