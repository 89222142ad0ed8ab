#version 450
//! The fragment stage of `prefilter`, which `prefilter.wesl` describes.
//!
//! Made from `prefilter.wesl` by `cargo xtask docs`: edit that, not this file.

#if WHAT == WHAT_SH9
#include "../ambient/sh.glsl"
#endif
#if WHAT == WHAT_DFG
#include "../brdf/microfacet.glsl"
#include "../brdf/specular.glsl"
#endif
#if WHAT == WHAT_DIFFUSE || WHAT == WHAT_SPECULAR
#include "../lighting/area.glsl"
#endif
#if WHAT == WHAT_DIFFUSE || WHAT == WHAT_SH9 || WHAT == WHAT_SPECULAR
#include "../math/noise.glsl"
#endif
#if WHAT == WHAT_DIFFUSE || WHAT == WHAT_SPECULAR
#include "../math/safe.glsl"
#endif

layout(location = 0) in vec2 in_uv;

layout(location = 0) out vec4 out_color;

#if WHAT != WHAT_DFG
layout(set = 0, binding = 0) uniform textureCube environment;
layout(set = 0, binding = 1) uniform sampler environment_sampler;

/// What is made.
layout(std140, set = 0, binding = 2) uniform Lobe {
#if WHAT != WHAT_SH9
    /// The inverse of the face's projection times its view from the origin.
    mat4 world_from_clip;
    /// `specular`: perceptual, [0, 1].
    float roughness;
#endif
#if WHAT == WHAT_SH9
    /// Width of the window against ringing, bands: three or more; large ones leave all as it is.
    float window;
#endif
    /// Level of the environment that is read: a smaller image has less noise.
    float level;
} lobe;
#endif

#if WHAT == WHAT_DIFFUSE || WHAT == WHAT_SPECULAR
/// The unit direction through a point of the face.
vec3 direction_of(vec2 uv) {
    vec4 place = lobe.world_from_clip * vec4(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 1.0, 1.0);
    return safe_normalize(place.xyz / place.w, vec3(0.0, 0.0, 1.0));
}
#endif

#if WHAT != WHAT_DFG
/// The radiance from a direction.
vec3 radiance(vec3 direction) {
    return textureLod(samplerCube(environment, environment_sampler), direction, lobe.level).rgb;
}
#endif

#if WHAT == WHAT_DIFFUSE || WHAT == WHAT_SPECULAR
/// A vector about z as one about a unit normal.
vec3 turned(vec3 local, vec3 n) {
    vec3 t = any_tangent(n);
    return t * local.x + cross(n, t) * local.y + n * local.z;
}
#endif

#if WHAT != WHAT_DFG
/// How high a hemisphere is over a point of the spiral.
float height(uint i) {
    return sqrt(1.0 - (float(i) + 0.5) / float(SAMPLES));
}
#endif

#if WHAT == WHAT_DIFFUSE
/// The mean over directions that are as dense as the cosine is large.
vec3 diffuse_around(vec3 n) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < uint(SAMPLES); i++) {
        vec2 d = vogel_disk(int(i), SAMPLES, 0.0);
        sum += radiance(turned(vec3(d, height(i)), n));
    }
    return sum / float(SAMPLES);
}
#elif WHAT == WHAT_SH9
/// The integral of the radiance times a harmonic over the sphere, less what the window takes.
vec3 coefficient(uint index) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < uint(SAMPLES); i++) {
        float h = height(i);
        // The disk as a sphere: parts of the same area stay so.
        vec3 at = vec3(2.0 * h * vogel_disk(int(i), SAMPLES, 0.0), 2.0 * h * h - 1.0);
        float basis[9] = sh9_basis(at);
        sum += radiance(at) * basis[index];
    }
    float band = float(index > 0u) + float(index > 3u);
    return sum * (12.566371 / float(SAMPLES) * sh_window(band, lobe.window));
}
#elif WHAT == WHAT_SPECULAR
/// A facet of a rough surface about z: facets of GGX are those of a hemisphere, scaled by `alpha`.
vec3 facet(uint i, float alpha) {
    vec2 d = vogel_disk(int(i), SAMPLES, 0.0);
    return normalize(vec3(alpha * d, height(i)));
}
#endif

#if WHAT == WHAT_SPECULAR
/// The mean over what facets mirror to a viewer right above them, weighted by the cosine.
vec3 specular_around(vec3 n) {
    float alpha = lobe.roughness * lobe.roughness;
    vec3 sum = vec3(0.0);
    float all = 0.0;
    for (uint i = 0u; i < uint(SAMPLES); i++) {
        vec3 h = facet(i, alpha);
        vec3 l = reflect(vec3(0.0, 0.0, -1.0), h);
        float weight = max(l.z, 0.0);
        sum += weight * radiance(turned(l, n));
        all += weight;
    }
    // The first facets are nearly flat, so that there is always a weight.
    return sum / all;
}
#elif WHAT == WHAT_DFG
/// Scale and offset of the reflectance at normal incidence.
vec2 split_sum_of(float cosine, float roughness) {
    float alpha = roughness * roughness;
    float nv = max(cosine, 1e-3);
    vec3 v = vec3(sqrt(max(1.0 - nv * nv, 0.0)), 0.0, nv);
    // The viewer's masking G1 is 2*nv/seen.
    float seen = nv + sqrt(alpha * alpha + (1.0 - alpha * alpha) * nv * nv);
    vec2 sum = vec2(0.0);
    for (uint i = 0u; i < uint(SAMPLES); i++) {
        vec2 u = vec2(fract(float(i) * 0.38196601), (float(i) + 0.5) / float(SAMPLES));
        vec3 h = sample_ggx_visible(v, alpha, alpha, u);
        vec3 l = reflect(-v, h);
        float nl = max(l.z, 0.0);
        float share = 2.0 * nl * v_smith_ggx(nv, nl, alpha) * seen;
        float rim = f_schlick(vec3(0.0), 1.0, max(dot(v, h), 0.0)).x;
        sum += share * vec2(1.0 - rim, rim);
    }
    return sum / float(SAMPLES);
}
#endif

void main() {
#if WHAT == WHAT_DFG
    out_color = vec4(split_sum_of(in_uv.x, in_uv.y), 0.0, 1.0);
#elif WHAT == WHAT_SH9
    out_color = vec4(coefficient(uint(clamp(9.0 * in_uv.x, 0.0, 8.0))), 1.0);
#elif WHAT == WHAT_DIFFUSE
    out_color = vec4(diffuse_around(direction_of(in_uv)), 1.0);
#elif WHAT == WHAT_SPECULAR
    out_color = vec4(specular_around(direction_of(in_uv)), 1.0);
#endif
}
