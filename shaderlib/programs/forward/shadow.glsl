//! The shadow of one lamp of `forward`. `lamps.glsl` includes it where `Surface` is known.

#ifndef LAMPLIGHT_PROGRAMS_FORWARD_SHADOW_GLSL
#define LAMPLIGHT_PROGRAMS_FORWARD_SHADOW_GLSL

#include "../../math/noise.glsl"
#include "../../shadow/bias.glsl"
#include "../../shadow/coord.glsl"
#if CASCADES
#include "camera.glsl"
#include "../cascades.glsl"
#endif

/// The light that casts the shadow, and how its map is read.
layout(std140, set = 0, binding = 4) uniform Caster {
    /// Spot and directional lights: projection times view of the shadow map.
    mat4 clip_from_world;
    /// Distances of the near and far plane of the map or of a cube's faces, in scene units: for point
    /// lights and for `pcss`.
    float near;
    float far;
    /// Which of the lamps, below `max_lights`.
    uint light;
    /// Points whose w in the light's clip space is at most this are lit.
    float min_w;
    /// Subtracted from the depth that is compared.
    float bias;
    /// How far the point is moved along its normal, in texels of the map.
    float normal_offset;
    /// Size of a texel in scene units: everywhere for directional lights, at distance 1 for others.
    float texel;
    /// `pcf_random16`, `pcf_vogel`: radius of the filter; `pcss`: its largest radius; in texels.
    float radius;
    /// `evsm`: the positive and the negative exponent; `esm`: the sharpness and 0; as in `moments`.
    vec2 exponents;
    /// `vsm`, `evsm`: see `shadow::moments`; `msm`: what `msm_visibility` calls bias.
    float min_variance;
    /// `vsm`, `evsm`: see `shadow::moments`.
    float bleed;
    /// `vsm`: least visibility.
    float least;
    /// `pcss`: width of a spot light in scene units; diameter over distance of a directional light.
    float light_size;
} caster;

#if !CASCADES
/// The point that is looked up: off the surface, so that it does not shadow itself.
vec3 receiver(Surface surface, Light light) {
#if SHADOW_LIGHT == SHADOW_LIGHT_DIRECTIONAL
    return normal_offset(surface.position, surface.normal, -light.axis, caster.texel, caster.normal_offset);
#else
    vec3 offset = light.position - surface.position;
    vec3 l = safe_normalize(offset, vec3(0.0));
    return normal_offset(surface.position, surface.normal, l, caster.texel * length(offset), caster.normal_offset);
#endif
}
#endif

#if SHADOW_LIGHT == SHADOW_LIGHT_POINT
#include "../../shadow/compare.glsl"

layout(set = 0, binding = 6) uniform textureCube shadow_cube;
layout(set = 0, binding = 7) uniform samplerShadow shadow_sampler;

/// How much of the shadow caster's light arrives; `pixel` is the place in the framebuffer.
float visibility(Surface surface, vec2 pixel) {
    Light light = lamps.lights[caster.light];
    vec3 offset = receiver(surface, light) - light.position;
    float depth = constant_bias(cube_depth(offset, caster.near, caster.far), caster.bias);
    return cube_compare(shadow_cube, shadow_sampler, offset, depth);
}
#else
#if CASCADES
/// Where the shadow map holds the point, the bias taken off its depth.
ShadowUv place_in_map(int part, Surface surface) {
    vec3 away = -lamps.lights[caster.light].axis;
    vec3 point = normal_offset(surface.position, surface.normal, away, cascades.texels[part], caster.normal_offset);
    ShadowUv at = project(shadow_coord(cascades.clip_from_world[part], point), caster.min_w);
#else
/// Where the shadow map holds the point, the bias taken off its depth.
ShadowUv place_in_map(Surface surface) {
    vec3 point = receiver(surface, lamps.lights[caster.light]);
    ShadowUv at = project(shadow_coord(caster.clip_from_world, point), caster.min_w);
#endif
    at.depth = constant_bias(at.depth, caster.bias);
    return at;
}

#if SHADOW == SHADOW_VSM || SHADOW == SHADOW_EVSM || SHADOW == SHADOW_ESM || SHADOW == SHADOW_MSM
#include "../../shadow/moments.glsl"

layout(set = 0, binding = 10) uniform texture2D shadow_moments;
layout(set = 0, binding = 11) uniform sampler moment_sampler;

/// How much of the shadow caster's light arrives; `pixel` is the place in the framebuffer.
float visibility(Surface surface, vec2 pixel) {
    ShadowUv at = place_in_map(surface);
    vec4 moments = texture(sampler2D(shadow_moments, moment_sampler), at.uv);
#if SHADOW == SHADOW_VSM
    float visible = vsm_visibility(moments.xy, at.depth, caster.min_variance, caster.least, caster.bleed);
#elif SHADOW == SHADOW_ESM
    float visible = esm_visibility(moments.x, at.depth, caster.exponents.x);
#elif SHADOW == SHADOW_MSM
    float visible = msm_visibility(moments, at.depth, caster.min_variance);
#else
    float visible = evsm_visibility(moments, at.depth, caster.exponents, caster.min_variance, caster.bleed);
#endif
    return at.inside ? visible : 1.0;
}
#else
#include "../../shadow/compare.glsl"

layout(set = 0, binding = 5) uniform texture2D shadow_map;
layout(set = 0, binding = 7) uniform samplerShadow shadow_sampler;
#if SHADOW == SHADOW_PCSS
#include "../../shadow/penumbra.glsl"

layout(set = 0, binding = 8) uniform texture2D shadow_depth;
layout(set = 0, binding = 9) uniform sampler depth_sampler;

/// Half of the width of a penumbra on the receiver, scene units.
float half_penumbra(float receiver, float blocker) {
#if SHADOW_LIGHT == SHADOW_LIGHT_DIRECTIONAL
    return 0.5 * pcss_width_directional(receiver, blocker, caster.light_size);
#else
    return 0.5 * pcss_width(receiver, blocker, caster.light_size);
#endif
}

/// The distance from a spot light, or from the near plane of a directional light's map, that a depth
/// of the map stands for.
///
/// The mean of perspective depths stands for the mean of the inverse distances. The width of a
/// penumbra is linear in the inverse distance of its blocker, so this gives the mean of the widths.
float light_distance(float depth) {
#if SHADOW_LIGHT == SHADOW_LIGHT_DIRECTIONAL
    return depth * (caster.far - caster.near);
#else
    return linearize_depth(depth, caster.near, caster.far);
#endif
}

/// Unit direction from the surface to the light that casts the shadow.
vec3 towards_caster(Surface surface) {
    Light light = lamps.lights[caster.light];
#if SHADOW_LIGHT == SHADOW_LIGHT_DIRECTIONAL
    return -light.axis;
#else
    return safe_normalize(light.position - surface.position, vec3(0.0));
#endif
}

/// A shadow that is sharp near its caster and soft far from it: Fernando, "Percentage-Closer Soft
/// Shadows", 2005.
float soft_shadow(Surface surface, ShadowUv at, float phi) {
    if (!at.inside) {
        return 1.0;
    }
    float receiver = light_distance(at.depth);
#if SHADOW_LIGHT == SHADOW_LIGHT_DIRECTIONAL
    float texel = caster.texel;
#else
    float texel = caster.texel * receiver;
#endif
    float widest = max(caster.radius, 1.0);
    // Nothing shadows the point from farther aside than something at the near plane could.
    float search = clamp(half_penumbra(receiver, light_distance(0.0)) / texel, 1.0, widest);
    float depth = mean_blocker(shadow_depth, depth_sampler, at, search, phi);
    if (!(depth < at.depth)) {
        return 1.0;
    }
    float blocker = light_distance(depth);
    float radius = clamp(half_penumbra(receiver, blocker) / texel, 1.0, widest);
    // The surface must not shadow itself within the filter, whose radius is known only now. Half of
    // the way to what shadows it is left.
    float way = at.depth - depth;
    float rise = way * radius * texel / max(receiver - blocker, 1e-6 * receiver);
    float bias = slope_bias(dot(surface.normal, towards_caster(surface)), rise, 0.5 * way);
    ShadowUv biased = ShadowUv(at.uv, constant_bias(at.depth, bias), true);
    return pcf_vogel(shadow_map, shadow_sampler, biased, 16, radius, phi);
}
#endif

#if CASCADES
/// How much of the shadow caster's light arrives; `pixel` is the place in the framebuffer.
float visibility(int part, Surface surface, vec2 pixel) {
    ShadowUv at = place_in_map(part, surface);
#else
/// How much of the shadow caster's light arrives; `pixel` is the place in the framebuffer.
float visibility(Surface surface, vec2 pixel) {
    ShadowUv at = place_in_map(surface);
#endif
#if SHADOW == SHADOW_PCF_VOGEL || SHADOW == SHADOW_PCSS
    float phi = 6.2831853 * interleaved_gradient_noise(pixel);
#endif
#if SHADOW == SHADOW_HARD
    return hard(shadow_map, shadow_sampler, at);
#elif SHADOW == SHADOW_PCF_3X3
    return pcf_3x3(shadow_map, shadow_sampler, at);
#elif SHADOW == SHADOW_PCF_5X5
    return pcf_5x5(shadow_map, shadow_sampler, at);
#elif SHADOW == SHADOW_PCF_CASTANO_5
    return pcf_castano_5(shadow_map, shadow_sampler, at);
#elif SHADOW == SHADOW_PCF_RANDOM16
    return pcf_random16(shadow_map, shadow_sampler, at, caster.radius, pixel);
#elif SHADOW == SHADOW_PCF_VOGEL
    return pcf_vogel(shadow_map, shadow_sampler, at, 16, caster.radius, phi);
#else
    return soft_shadow(surface, at, phi);
#endif
}
#endif
#endif

#if CONTACT
layout(set = 2, binding = 15) uniform texture2D seen_contact;

/// How much of the shadow caster's light passes what is near the point, as seen on the screen.
float contact_visibility(vec2 pixel) {
    vec2 place = pixel / vec2(textureSize(sampler2D(seen_contact, open_sampler), 0));
    return textureLod(sampler2D(seen_contact, open_sampler), place, 0.0).x;
}
#endif

#if CASCADES
/// How much of the shadow caster's light arrives, from the parts of the map that have the point.
float cascaded_visibility(Surface surface, vec2 pixel) {
    vec3 eye = camera.world_from_view[3].xyz;
    CascadePair pair = cascade_pair(dot(eye - surface.position, camera.world_from_view[2].xyz));
    // Beyond all parts, everything is lit.
    float visible = 1.0;
    if (pair.here < 4) {
        visible = visibility(pair.here, surface, pixel);
    }
    if (pair.share > 0.0) {
        float behind = 1.0;
        if (pair.next < 4) {
            behind = visibility(pair.next, surface, pixel);
        }
        visible = mix(visible, behind, pair.share);
    }
    return visible;
}
#endif

#endif
