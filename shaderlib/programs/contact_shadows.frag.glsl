#version 450
//! The fragment stage of `contact_shadows`, which `contact_shadows.wesl` describes.
//!
//! Made from `contact_shadows.wesl` by `cargo xtask docs`: edit that, not this file.

#if JITTER
#include "../math/noise.glsl"
#endif
#include "../math/safe.glsl"
#include "../shadow/contact.glsl"
#include "../shadow/coord.glsl"

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
    /// Its planes, in scene units; swapped for reversed depth.
    float near;
    float far;
} screen;

/// The light, and the march towards it.
layout(std140, set = 0, binding = 3) uniform March {
    /// A light that has a place: its position and 1; one that has none: unit, towards it, and 0; in
    /// the view's space.
    vec4 lamp;
    /// Length of the march, scene units.
    float reach;
    /// Least distance behind a surface that is in its shadow, scene units.
    float bias;
    /// What surfaces are taken to be deep, scene units.
    float thickness;
    /// Width of the fade at the edges, in parts of the screen.
    float border;
} march;

void main() {
    float depth = textureLod(sampler2D(depth_buffer, depth_sampler), in_uv, 0.0).x;
    vec4 place = screen.view_from_clip * vec4(2.0 * in_uv.x - 1.0, 1.0 - 2.0 * in_uv.y, depth, 1.0);
    vec3 start = place.xyz / place.w;
    // A light without a place has the same direction everywhere, and no point lies behind it.
    vec3 offset = march.lamp.xyz - march.lamp.w * start;
    vec3 l = normalize_or_zero(offset);
    float reach = march.lamp.w > 0.0 ? min(march.reach, length(offset)) : march.reach;
#if JITTER
    float jitter = interleaved_gradient_noise(gl_FragCoord.xy);
#else
    float jitter = 0.5;
#endif
    float visible = 1.0;
    for (uint i = 0u; i < uint(STEPS); i++) {
        vec3 point = march_point(start, l, reach, i, uint(STEPS), jitter);
        ShadowUv at = project(shadow_coord(screen.clip_from_view, point), 0.0);
        float seen = textureLod(sampler2D(depth_buffer, depth_sampler), at.uv, 0.0).x;
        float surface = linearize_depth(seen, screen.near, screen.far);
        if (at.inside && contact_hit(-point.z, surface, march.bias, march.thickness)) {
            visible = min(visible, 1.0 - edge_fade(at.uv, march.border));
        }
    }
    out_color = vec4(vec3(visible), 1.0);
}
