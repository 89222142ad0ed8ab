#version 450
//! The fragment stage of `gtao`, which `gtao.wesl` describes.
//!
//! Made from `gtao.wesl` by `cargo xtask docs`: edit that, not this file.

#include "../ambient/occlusion.glsl"
#if NORMALS != NORMALS_DEPTH
#include "../ambient/octahedral.glsl"
#endif
#include "../math/noise.glsl"
#include "../math/safe.glsl"

layout(location = 0) in vec2 in_uv;

layout(location = 0) out vec4 out_color;

layout(set = 0, binding = 0) uniform texture2D depth_buffer;
layout(set = 0, binding = 1) uniform sampler depth_sampler;

/// How places on the screen and in the view's space belong together.
layout(std140, set = 0, binding = 2) uniform Screen {
    /// The projection that the depths were drawn with.
    mat4 clip_from_view;
    /// Its inverse.
    mat4 view_from_clip;
    /// `normals=gbuffer`: the view.
    mat4 view_from_world;
} screen;

/// How far horizons reach.
layout(std140, set = 0, binding = 3) uniform Horizon {
    /// Farthest distance of what hides light, scene units.
    float radius;
    /// Share of the radius, [0, 1), from which on what hides light counts less.
    float falloff;
} horizon;

#if NORMALS == NORMALS_GBUFFER
layout(set = 0, binding = 4) uniform texture2D surface_normal;
#endif

/// The point that the viewer sees at a place on the screen, in the view's space.
vec3 seen_at(vec2 uv) {
    float depth = textureLod(sampler2D(depth_buffer, depth_sampler), uv, 0.0).x;
    vec4 place = screen.view_from_clip * vec4(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, depth, 1.0);
    return place.xyz / place.w;
}

#if NORMALS == NORMALS_DEPTH
/// A unit normal that points to the viewer.
vec3 faced(vec3 across, vec3 p) {
    vec3 n = safe_normalize(across, vec3(0.0, 0.0, 1.0));
    return dot(n, p) > 0.0 ? -n : n;
}
#endif

/// The middle of a texel, where the depth is that of the place.
vec2 texel_centre(vec2 uv) {
    vec2 size = vec2(textureSize(sampler2D(depth_buffer, depth_sampler), 0));
    return (floor(uv * size) + 0.5) / size;
}

/// The cosine between the view's direction and the horizon on one side.
float highest(vec2 uv, vec3 p, vec3 v, vec2 side, float jitter) {
    float top = -1.0;
    for (uint i = 0u; i < uint(STEPS); i++) {
        // More steps near the point, where the horizon changes most.
        float t = (float(i) + 0.25 + 0.5 * jitter) / float(STEPS);
        vec3 offset = seen_at(texel_centre(uv + side * t * t)) - p;
        float far = length(offset);
        float fade = clamp((horizon.radius - far) / max(horizon.radius * (1.0 - horizon.falloff), 1e-6), 0.0, 1.0);
        // The point itself hides nothing.
        top = max(top, far > 1e-5 ? mix(-1.0, dot(offset, v) / max(far, 1e-6), fade) : -1.0);
    }
    return clamp(top, -1.0, 1.0);
}

/// The open share of one slice: the plane through the view's direction and a direction on the screen.
float slice_open(vec2 uv, vec3 p, vec3 n, vec3 v, vec2 direction, vec2 reach, float jitter) {
    vec3 along = vec3(direction, 0.0);
    vec3 across = safe_normalize(cross(along, v), vec3(0.0, 1.0, 0.0));
    vec3 flat_normal = n - across * dot(n, across);
    float length_in_slice = length(flat_normal);
    vec3 tangent = along - v * dot(along, v);
    float cosine = clamp(dot(flat_normal, v) / max(length_in_slice, 1e-6), -1.0, 1.0);
    float gamma = dot(tangent, flat_normal) < 0.0 ? -acos(cosine) : acos(cosine);
    float right = acos(highest(uv, p, v, direction * reach, jitter));
    float left = -acos(highest(uv, p, v, -direction * reach, jitter));
    return length_in_slice * (gtao_arc(right, gamma) + gtao_arc(left, gamma));
}

void main() {
    vec3 p = seen_at(in_uv);
#if NORMALS == NORMALS_GBUFFER
    vec4 texel = textureLod(sampler2D(surface_normal, depth_sampler), in_uv, 0.0);
    if (texel.a < 0.5) {
        discard;
    }
#endif
#if NORMALS == NORMALS_DEPTH
    vec3 n = faced(cross(dFdx(p), dFdy(p)), p);
#else
    vec3 n = (screen.view_from_world * vec4(octahedral_decode(2.0 * texel.xy - 1.0), 0.0)).xyz;
#endif
    vec3 v = safe_normalize(-p, vec3(0.0, 0.0, 1.0));
    // The radius on the screen, in texture coordinates.
    vec2 reach = 0.5 * horizon.radius / max(-p.z, 1e-4) * vec2(screen.clip_from_view[0].x, -screen.clip_from_view[1].y);
    float turn = interleaved_gradient_noise(gl_FragCoord.xy);
    float open = 0.0;
    for (uint i = 0u; i < uint(SLICES); i++) {
        float phi = 3.1415927 * (float(i) + turn) / float(SLICES);
        open += slice_open(in_uv, p, n, v, vec2(cos(phi), sin(phi)), reach, turn);
    }
    float share = clamp(open / float(SLICES), 0.0, 1.0);
    out_color = vec4(vec3(share), 1.0);
}
