//! Highlights: the classic lobes, and the terms of a microfacet BRDF (`d_ggx * v_smith_ggx * f_schlick`).

#ifndef LAMPLIGHT_BRDF_SPECULAR_GLSL
#define LAMPLIGHT_BRDF_SPECULAR_GLSL

#include "../math/safe.glsl"

/// Phong's lobe around the mirrored light.
float phong(vec3 n, vec3 l, vec3 v, float s) {
    if (!(dot(n, l) > 0.0)) {
        return 0.0;
    }
    return safe_pow(dot(reflect(-l, n), v), s);
}

/// Phong's lobe as the book's shadow example computes it.
float phong_oglpg_7_21(vec3 n, vec3 l, vec3 v, float s) {
    return max(pow(dot(v, reflect(-l, n)), s), 0.0);
}

/// Phong's lobe as Igalia's tutorial computes it.
float phong_igl(vec3 n, vec3 l, vec3 v, float s) {
    if (!(dot(n, l) >= 0.0)) {
        return 0.0;
    }
    return pow(max(dot(reflect(-l, n), v), 0.0), s);
}

/// Blinn's lobe with the half vector given.
float blinn_phong_half(vec3 n, vec3 h, float n_dot_l, float s) {
    if (!(n_dot_l > 0.0)) {
        return 0.0;
    }
    return safe_pow(dot(n, h), s);
}

/// Blinn's lobe around the half vector.
float blinn_phong(vec3 n, vec3 l, vec3 v, float s) {
    return blinn_phong_half(n, safe_normalize(l + v, vec3(0.0)), dot(n, l), s);
}

/// Blinn's lobe as the recipe computes it.
float blinn_phong_hpg(vec3 n, vec3 l, vec3 v, float s) {
    return max(0.0, pow(dot(n, normalize(l + v)), s));
}

/// Blinn's lobe scaled so that its energy hardly depends on the shininess.
float blinn_phong_normalized(vec3 n, vec3 l, vec3 v, float s) {
    // 1/(8*pi)
    return (s + 8.0) * 0.039788736 * blinn_phong(n, l, v, s);
}

/// The GGX distribution of microfacet normals, in the form that stays accurate for small alpha.
float d_ggx(float nh, float n_cross_h2, float alpha) {
    float a = nh * alpha;
    float k = alpha / max(n_cross_h2 + a * a, SMALLEST_NORMAL);
    return k * k * 0.31830989;
}

/// The height-correlated Smith visibility of GGX, divided by 4*nl*nv.
float v_smith_ggx(float nv, float nl, float alpha) {
    if (!(nv > 0.0 && nl > 0.0)) {
        return 0.0;
    }
    float a2 = alpha * alpha;
    float from_view = nl * sqrt(nv * nv * (1.0 - a2) + a2);
    float from_light = nv * sqrt(nl * nl * (1.0 - a2) + a2);
    return 0.5 / max(from_view + from_light, SMALLEST_NORMAL);
}

/// Schlick's approximation of Fresnel's reflectance.
vec3 f_schlick(vec3 f0, float f90, float vh) {
    float x = 1.0 - clamp(vh, 0.0, 1.0);
    float x2 = x * x;
    return f0 + (vec3(f90) - f0) * (x2 * x2 * x);
}

#endif
