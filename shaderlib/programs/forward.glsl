//! What the stages of `forward` share, which `forward.wesl` describes.
//!
//! Made from `forward.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_PROGRAMS_FORWARD_GLSL
#define LAMPLIGHT_PROGRAMS_FORWARD_GLSL

#if AMBIENT == AMBIENT_HEMISPHERE
#include "../ambient/hemisphere.glsl"
#endif
#if BOX_PROJECTION || METALLIC_ROUGHNESS && AMBIENT == AMBIENT_IBL
#include "../ambient/ibl.glsl"
#endif
#if OCCLUSION != OCCLUSION_NONE && METALLIC_ROUGHNESS
#include "../ambient/occlusion.glsl"
#endif
#if AMBIENT == AMBIENT_SH9
#include "../ambient/sh.glsl"
#endif
#if LIGHTS != LIGHTS_NONE
#include "../brdf/diffuse.glsl"
#endif
#if SPECULAR == SPECULAR_GGX && AREA == AREA_RECTANGLE
#include "../brdf/energy.glsl"
#endif
#if LIGHTS != LIGHTS_NONE
#include "../brdf/specular.glsl"
#endif
#if ATTENUATION != ATTENUATION_POLYNOMIAL || LIGHTS != LIGHTS_NONE
#include "../lighting/attenuation.glsl"
#endif
#if LIGHTS != LIGHTS_NONE
#include "../lighting/classic.glsl"
#endif
#include "../lighting/light.glsl"
#if LIGHTS != LIGHTS_NONE || OCCLUSION != OCCLUSION_NONE && !METALLIC_ROUGHNESS
#include "../lighting/material.glsl"
#endif
#if CONE != CONE_EXPONENT || LIGHTS != LIGHTS_NONE
#include "../lighting/spot.glsl"
#endif
#if SHADOW_LIGHT != SHADOW_LIGHT_POINT && (SHADOW == SHADOW_PCF_VOGEL || SHADOW == SHADOW_PCSS)
#include "../math/noise.glsl"
#endif
#include "../math/safe.glsl"
#include "../shadow/bias.glsl"
#include "../shadow/compare.glsl"
#include "../shadow/coord.glsl"
#include "../shadow/moments.glsl"
#if SHADOW == SHADOW_PCSS
#include "../shadow/penumbra.glsl"
#endif
#include "areas.glsl"
#if CASCADES
#include "cascades.glsl"
#endif
#if LIGHTS != LIGHTS_NONE && CLUSTERED
#include "clusters.glsl"
#endif
#if SPECULAR == SPECULAR_GGX || TRANSMISSION && AMBIENT != AMBIENT_NONE && AMBIENT != AMBIENT_CONSTANT || METALLIC_ROUGHNESS
#include "layers.glsl"
#endif
#if LIGHTS != LIGHTS_NONE && AMBIENT == AMBIENT_DDGI || METALLIC_ROUGHNESS && AMBIENT == AMBIENT_DDGI
#include "probes.glsl"
#endif
#if LIGHTS != LIGHTS_NONE && (PROFILE == PROFILE_IES || PROFILE == PROFILE_COOKIE)
#include "profiles.glsl"
#endif

/// The viewer.
layout(std140, set = 0, binding = 0) uniform Camera {
    mat4 clip_from_world;
    /// Its third column points behind the viewer, its fourth is the viewer's position.
    mat4 world_from_view;
} camera;

#if LIGHTS != LIGHTS_NONE
/// The lights, of which the first `count` shine.
layout(std140, set = 0, binding = 1) uniform Lamps {
    uint count;
    Light lights[MAX_LIGHTS];
} lamps;
#endif

#if AMBIENT != AMBIENT_NONE && AMBIENT != AMBIENT_DDGI
/// Light from everywhere: each value of `ambient` reads what it needs.
layout(std140, set = 0, binding = 2) uniform Surroundings {
    /// `constant`: added to the ambient light of the lamps.
    vec3 color;
    /// `sh9`: factor, 1/pi for coefficients of radiance.
    float scale;
    /// `hemisphere`: the light from the side of `up`.
    vec3 sky;
    /// `ibl`: share of the diffuse environment, [0, 1].
    float diffuse_share;
    /// `hemisphere`: the light from the other side.
    vec3 ground;
    /// `ibl`: share of the specular environment, [0, 1].
    float specular_share;
    /// `hemisphere`: unit, in the world.
    vec3 up;
    /// `sh9`: L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
    vec3 sh[9];
} surroundings;
#endif

#if SHADOW != SHADOW_NONE
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
    /// How far the point is moved along its normal, to the side of the lamp, in texels of the map.
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
#endif

#if SHADOW != SHADOW_NONE && SHADOW != SHADOW_VSM && SHADOW != SHADOW_EVSM && SHADOW != SHADOW_ESM && SHADOW != SHADOW_MSM && SHADOW_LIGHT != SHADOW_LIGHT_POINT
layout(set = 0, binding = 5) uniform texture2D shadow_map;
#endif
#if SHADOW_LIGHT == SHADOW_LIGHT_POINT
layout(set = 0, binding = 6) uniform textureCube shadow_cube;
#endif
#if SHADOW != SHADOW_NONE && SHADOW != SHADOW_VSM && SHADOW != SHADOW_EVSM && SHADOW != SHADOW_ESM && SHADOW != SHADOW_MSM
layout(set = 0, binding = 7) uniform samplerShadow shadow_sampler;
#endif
#if SHADOW == SHADOW_PCSS
layout(set = 0, binding = 8) uniform texture2D shadow_depth;
layout(set = 0, binding = 9) uniform sampler depth_sampler;
#elif SHADOW == SHADOW_VSM || SHADOW == SHADOW_EVSM || SHADOW == SHADOW_ESM || SHADOW == SHADOW_MSM
layout(set = 0, binding = 10) uniform texture2D shadow_moments;
#endif
#if SHADOW == SHADOW_VSM || SHADOW == SHADOW_EVSM || SHADOW == SHADOW_ESM || SHADOW == SHADOW_MSM
layout(set = 0, binding = 11) uniform sampler moment_sampler;
#endif
#if AMBIENT == AMBIENT_IBL
layout(set = 0, binding = 12) uniform textureCube sky_diffuse;
layout(set = 0, binding = 13) uniform textureCube sky_specular;
layout(set = 0, binding = 14) uniform sampler sky_sampler;
#endif
#if OCCLUSION == OCCLUSION_SCREEN
layout(set = 1, binding = 7) uniform texture2D seen_occlusion;
#endif
#if OCCLUSION == OCCLUSION_SCREEN || CONTACT
layout(set = 1, binding = 8) uniform sampler open_sampler;
#endif
#if CONTACT
layout(set = 2, binding = 15) uniform texture2D seen_contact;
#endif

#if BOX_PROJECTION
/// The walls that the specular environment shows, as a box along the axes of the world.
layout(std140, set = 0, binding = 15) uniform Room {
    vec3 low;
    vec3 high;
    /// Where the environment was seen from.
    vec3 centre;
} room;
#endif

#if LIGHTS != LIGHTS_NONE
/// Materials in one array: pairs of front and back with `two_sided`.
layout(std140, set = 1, binding = 0) uniform Materials {
#if MATERIAL == MATERIAL_ARRAY && TWO_SIDED
    Material items[28];
#elif MATERIAL == MATERIAL_ARRAY
    Material items[14];
#else
    Material items[1];
#endif
} materials;
#endif

#if LIGHTS != LIGHTS_NONE && AREA != AREA_NONE
/// The extents of the lamps, in their order.
layout(std140, set = 1, binding = 9) uniform Areas {
    Area items[MAX_LIGHTS];
} areas;
#endif

#if LIGHTS != LIGHTS_NONE && (PROFILE == PROFILE_IES || PROFILE == PROFILE_COOKIE)
/// The profiles of the lamps, in their order.
layout(std140, set = 1, binding = 12) uniform Profiles {
    Profile items[MAX_LIGHTS];
} profiles;
#endif

#if OCCLUSION != OCCLUSION_NONE && !METALLIC_ROUGHNESS
/// The squared roughness of the highlight, for how wide it mirrors the surroundings.
float highlight_alpha(Material material) {
#if SPECULAR == SPECULAR_GGX
    return material.roughness * material.roughness;
#else
    // The width of the lobe of Blinn and Phong.
    return sqrt(2.0 / (max(material.shininess, 0.0) + 2.0));
#endif
}
#endif

#if OCCLUSION != OCCLUSION_NONE && METALLIC_ROUGHNESS
/// The light around a layered surface without what is hidden of the mirrored environment. What falls
/// onto its front has lost that already, by the share of ambient light of its material.
Around occluded(Around around, Layered at, float open) {
    Around seen = around;
    seen.mirrored *= specular_occlusion(dot(at.normal, at.view), open, at.roughness * at.roughness);
#if CLEARCOAT
    float rough = at.own.clearcoat_roughness;
    seen.coated *= specular_occlusion(dot(at.coat_normal, at.view), open, rough * rough);
#endif
    return seen;
}
#endif

#if LIGHTS != LIGHTS_NONE
/// A point of a surface, as light meets it.
struct Surface {
    vec3 position;
    vec3 normal;
#if SPECULAR != SPECULAR_NONE || DIFFUSE == DIFFUSE_OREN_NAYAR || AMBIENT == AMBIENT_IBL
    /// Towards the viewer.
    vec3 view;
#endif
    Material material;
#if SHADOW != SHADOW_NONE
    /// How much of the shadow caster's light arrives.
    float visibility;
#endif
#if SPECULAR == SPECULAR_GGX && !METALLIC_ROUGHNESS
    /// The facets of the highlight.
    Facets facets;
#endif
#if METALLIC_ROUGHNESS
    /// What `metallic_roughness` makes of the material.
    Layered layered;
#endif
#if AREA == AREA_RECTANGLE && SPECULAR == SPECULAR_GGX
    /// The microfacets as linearly transformed cosines, and those of the coat.
    mat3 lobe;
#endif
#if AREA == AREA_RECTANGLE && CLEARCOAT
    mat3 coat_lobe;
#endif
};

/// Zero in every member of `Surface`.
Surface zero_surface() {
    Surface zero;
    zero.position = vec3(0.0);
    zero.normal = vec3(0.0);
#if SPECULAR != SPECULAR_NONE || DIFFUSE == DIFFUSE_OREN_NAYAR || AMBIENT == AMBIENT_IBL
    zero.view = vec3(0.0);
#endif
    zero.material = Material(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
#if SHADOW != SHADOW_NONE
    zero.visibility = 0.0;
#endif
#if SPECULAR == SPECULAR_GGX && !METALLIC_ROUGHNESS
    zero.facets = Facets(vec3(0.0), 0.0, 0.0, 0.0, 0.0);
#endif
#if METALLIC_ROUGHNESS
    zero.layered = zero_layered();
#endif
#if AREA == AREA_RECTANGLE && SPECULAR == SPECULAR_GGX
    zero.lobe = mat3(0.0);
#endif
#if AREA == AREA_RECTANGLE && CLEARCOAT
    zero.coat_lobe = mat3(0.0);
#endif
    return zero;
}
#endif

#if LIGHTS == LIGHTS_MIXED && (ATTENUATION != ATTENUATION_POLYNOMIAL || CONE != CONE_EXPONENT)
/// The direction to a lamp of any kind and its distance, the factors 1; all 0 for a lamp that is off.
LightSample towards_lamp(Light light, vec3 position) {
    if (light.kind != LIGHT_DIRECTIONAL && light.kind != LIGHT_POINT && light.kind != LIGHT_SPOT) {
        return LightSample(vec3(0.0), 0.0, 0.0, 0.0);
    }
    vec3 offset = light.kind == LIGHT_DIRECTIONAL ? -light.axis : light.position - position;
    float d2 = dot(offset, offset);
    float inverse_ = inversesqrt(max(d2, SMALLEST_NORMAL));
    return LightSample(offset * inverse_, d2 * inverse_, 1.0, 1.0);
}
#endif

#if ATTENUATION != ATTENUATION_POLYNOMIAL
/// The falloff of this permutation in place of the polynomial.
float falloff(Light light, LightSample arriving) {
#if LIGHTS == LIGHTS_MIXED
    if (light.kind != LIGHT_POINT && light.kind != LIGHT_SPOT) {
        return arriving.attenuation;
    }
#endif
#if ATTENUATION == ATTENUATION_NONE
    return 1.0;
#elif ATTENUATION == ATTENUATION_INVERSE_SQUARE_WINDOW
    float d2 = arriving.distance * arriving.distance;
    float inv_range2 = 0.0;
    if (light.range > 0.0) {
        inv_range2 = 1.0 / (light.range * light.range);
    }
    // A light of one centimetre, where a scene unit is a metre.
    return inverse_square(d2, 0.0001) * window(d2, inv_range2);
#elif ATTENUATION == ATTENUATION_RANGE_GLTF
    return inverse_square(arriving.distance * arriving.distance, 0.0001) * range_gltf(arriving.distance, light.range);
#endif
}
#endif

#if CONE != CONE_EXPONENT
/// The cone of this permutation in place of the power of the cosine.
float cone(Light light, LightSample arriving) {
#if LIGHTS == LIGHTS_MIXED
    if (light.kind != LIGHT_SPOT) {
        return arriving.spot;
    }
#endif
#if CONE == CONE_HARD
    return cone_hard(dot(-arriving.l, light.axis), light.cutoff);
#elif CONE == CONE_SMOOTH
    return cone_smooth(dot(-arriving.l, light.axis), light.inner, light.outer);
#elif CONE == CONE_CONE_SCALE_OFFSET
    float scale = 1.0 / max(light.inner - light.outer, 0.001);
    return cone_scale_offset(dot(-arriving.l, light.axis), scale, -light.outer * scale);
#endif
}
#endif

#if LIGHTS != LIGHTS_NONE
/// What of a lamp arrives at a point.
LightSample sample_lamp(Light light, vec3 position) {
#if LIGHTS == LIGHTS_DIRECTIONAL
    // The axis is unit, so it needs no `sample_directional`.
    LightSample arriving = LightSample(-light.axis, 0.0, 1.0, 1.0);
#elif LIGHTS == LIGHTS_POINT
    LightSample arriving = sample_point(light, position);
#elif LIGHTS == LIGHTS_SPOT
    LightSample arriving = sample_spot(light, position);
#endif
#if LIGHTS == LIGHTS_MIXED && ATTENUATION == ATTENUATION_POLYNOMIAL && CONE == CONE_EXPONENT
    LightSample arriving = sample_light(light, position);
#elif LIGHTS == LIGHTS_MIXED
    LightSample arriving = towards_lamp(light, position);
#endif
#if ATTENUATION != ATTENUATION_POLYNOMIAL
    arriving.attenuation = falloff(light, arriving);
#elif LIGHTS == LIGHTS_MIXED && CONE != CONE_EXPONENT
    if (light.kind != LIGHT_DIRECTIONAL) {
        arriving.attenuation *= polynomial(arriving.distance, light.attenuation);
    }
#endif
#if CONE != CONE_EXPONENT
    arriving.spot = cone(light, arriving);
#elif LIGHTS == LIGHTS_MIXED && ATTENUATION != ATTENUATION_POLYNOMIAL
    if (light.kind == LIGHT_SPOT) {
        arriving.spot = cone_exponent(dot(-arriving.l, light.axis), light.cutoff, light.exponent);
    }
#endif
    return arriving;
}

/// How much of a lamp's ambient colour counts.
float ambient_share(Light light, LightSample arriving) {
#if AMBIENT != AMBIENT_CONSTANT
    return 0.0;
#elif AMBIENT_ATTENUATED
    return arriving.attenuation * arriving.spot;
#elif LIGHTS == LIGHTS_MIXED
    return light.kind == LIGHT_OFF ? 0.0 : 1.0;
#else
    return 1.0;
#endif
}

/// How much light from the direction `l` the surface scatters.
float diffuse_share(Surface surface, vec3 l) {
#if DIFFUSE == DIFFUSE_LAMBERT
    return lambert(surface.normal, l);
#elif DIFFUSE == DIFFUSE_HALF_LAMBERT
    return half_lambert(surface.normal, l);
#elif DIFFUSE == DIFFUSE_WRAP
    return wrap(surface.normal, l, surface.material.wrap);
#elif DIFFUSE == DIFFUSE_OREN_NAYAR
    return oren_nayar(surface.normal, l, surface.view, surface.material.sigma);
#endif
}

/// How much light from the direction `l` the surface reflects towards the viewer.
float specular_share(Surface surface, vec3 l) {
#if SPECULAR == SPECULAR_NONE || SPECULAR == SPECULAR_GGX
    return 0.0;
#elif SPECULAR == SPECULAR_PHONG
    return phong(surface.normal, l, surface.view, surface.material.shininess);
#elif SPECULAR == SPECULAR_BLINN_PHONG
    return blinn_phong(surface.normal, l, surface.view, surface.material.shininess);
#elif SPECULAR == SPECULAR_BLINN_PHONG_NORMALIZED
    return 3.14159265 * lambert(surface.normal, l) * blinn_phong_normalized(surface.normal, l, surface.view, surface.material.shininess);
#endif
}
#endif

#if SPECULAR == SPECULAR_GGX
/// The microfacet highlight, times pi and n.l.
vec3 ggx(Surface surface, vec3 l) {
    HalfWay half_ = half_way(l, surface.view);
    vec3 f0 = surface.material.specular;
    return facets(surface.facets, dot(surface.normal, l), half_) * (f0 + (vec3(1.0) - f0) * half_.rim);
}
#endif

#if LIGHTS != LIGHTS_NONE && AREA != AREA_NONE
/// Whether the lamp has an area: a light of one direction has none.
bool has_area(Light light) {
#if LIGHTS == LIGHTS_MIXED
    return light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT;
#else
    return true;
#endif
}

/// How much light of a lamp with an area falls onto the surface.
float fallen_share(Surface surface, Light light, LightSample arriving, uint i) {
    if (!has_area(light)) {
        return lambert(surface.normal, arriving.l);
    }
    return area_share(areas.items[i], surface.normal, surface.position, light.position);
}
#endif

#if AREA != AREA_NONE && SPECULAR == SPECULAR_GGX
/// The microfacet highlight of a lamp with an area.
vec3 area_highlight(Surface surface, Light light, LightSample arriving, uint i) {
    if (!has_area(light)) {
        return ggx(surface, arriving.l);
    }
#if AREA == AREA_RECTANGLE
    vec2 dfg = dfg_approx(dot(surface.normal, surface.view), surface.material.roughness);
    vec3 albedo = 3.14159265 * (surface.material.specular * dfg.x + dfg.y);
    return albedo * reflected_rectangle(areas.items[i], surface.normal, surface.view, surface.position, light.position, surface.lobe);
#else
    float roughness = surface.material.roughness;
    Seen seen = seen_lamp(areas.items[i], surface.normal, surface.view, surface.position, light.position, roughness);
    return seen.gain * ggx(surface, seen.l);
#endif
}
#endif

#if AREA == AREA_RECTANGLE && METALLIC_ROUGHNESS
/// The light of a lamp with an area, of colour 1, that leaves a layered surface towards the viewer.
vec3 layered_lamp(Surface surface, Light light, LightSample arriving, uint i) {
    if (!has_area(light)) {
        return layered_light(surface.layered, arriving.l, light.strength);
    }
    // Lobes take in the light of a rectangle as they take in that of the surroundings.
    vec3 view = surface.view;
    float factor = 3.14159265 * light.strength;
    Around around = Around(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    around.front = vec3(area_share(areas.items[i], surface.normal, surface.position, light.position));
    around.mirrored = vec3(
        factor * reflected_rectangle(areas.items[i], surface.normal, view, surface.position, light.position, surface.lobe)
    );
#if CLEARCOAT
    vec3 coat_normal = surface.layered.coat_normal;
    around.coated = vec3(
        factor * reflected_rectangle(areas.items[i], coat_normal, view, surface.position, light.position, surface.coat_lobe)
    );
#endif
    return layered_ambient(surface.layered, around, vec3(0.0));
}
#elif AREA != AREA_NONE && METALLIC_ROUGHNESS
vec3 layered_lamp(Surface surface, Light light, LightSample arriving, uint i) {
    if (!has_area(light)) {
        return layered_light(surface.layered, arriving.l, light.strength);
    }
    Layered at = surface.layered;
    float fallen = area_share(areas.items[i], surface.normal, surface.position, light.position);
    Seen base = seen_lamp(areas.items[i], surface.normal, surface.view, surface.position, light.position, at.roughness);
#if !CLEARCOAT
    Seen coat = base;
#else
    Seen coat = seen_lamp(areas.items[i], at.coat_normal, at.view, surface.position, light.position, surface.layered.own.clearcoat_roughness);
#endif
    return layered_area_light(at, fallen, base, coat, light.strength);
}
#endif

#if LIGHTS != LIGHTS_NONE
/// The sums with the light of one lamp.
Accum add_lamp(Accum sum, Surface surface, uint i) {
#if PROFILE == PROFILE_IES || PROFILE == PROFILE_COOKIE
    Light light = lamps.lights[i];
#else
    Light light = lamps.lights[i];
#endif
    LightSample arriving = sample_lamp(light, surface.position);
#if PROFILE == PROFILE_IES || PROFILE == PROFILE_COOKIE
    light.color *= profile_factor(profiles.items[i], light, arriving.l, surface.position);
#endif
    float ambient = ambient_share(light, arriving);
#if !METALLIC_ROUGHNESS && AREA == AREA_NONE
    float diffuse = diffuse_share(surface, arriving.l);
#elif !METALLIC_ROUGHNESS
    float diffuse = fallen_share(surface, light, arriving, i);
#endif
#if !METALLIC_ROUGHNESS
    float specular = specular_share(surface, arriving.l);
#endif
#if SHADOW == SHADOW_NONE
    float visibility = 1.0;
#else
    float visibility = i == caster.light ? shadow_mix(surface.visibility, light.shadow_strength) : 1.0;
#endif
#if SPECULAR != SPECULAR_GGX
    return accumulate(sum, surface.material, light, arriving, ambient, diffuse, specular, visibility);
#elif METALLIC_ROUGHNESS
    vec3 radiance = light.color * (arriving.attenuation * arriving.spot * visibility);
#if AREA == AREA_NONE
    return Accum(
        sum.scattered + light.ambient * ambient,
        sum.reflected + radiance * layered_light(surface.layered, arriving.l, light.strength)
    );
#else
    return Accum(
        sum.scattered + light.ambient * ambient,
        sum.reflected + radiance * layered_lamp(surface, light, arriving, i)
    );
#endif
#else
    Accum next = accumulate(sum, surface.material, light, arriving, ambient, diffuse, specular, visibility);
    vec3 radiance = light.color * (arriving.attenuation * arriving.spot * visibility * light.strength);
#if AREA == AREA_NONE
    next.reflected += radiance * ggx(surface, arriving.l);
#else
    next.reflected += radiance * area_highlight(surface, light, arriving, i);
#endif
    return next;
#endif
}
#endif

#if AMBIENT == AMBIENT_CONSTANT || AMBIENT == AMBIENT_HEMISPHERE || AMBIENT == AMBIENT_SH9
/// Light from everywhere, onto a surface of this unit normal.
vec3 ambient_light(vec3 normal) {
#if AMBIENT == AMBIENT_CONSTANT
    return surroundings.color;
#elif AMBIENT == AMBIENT_HEMISPHERE
    return hemisphere(normal, surroundings.up, surroundings.sky, surroundings.ground);
#elif AMBIENT == AMBIENT_SH9
    return surroundings.scale * sh9_irradiance_clamped(normal, surroundings.sh);
#endif
}
#endif

#if LIGHTS != LIGHTS_NONE
/// The sums of the light that leaves the point towards the viewer, without that of the environment maps. With
/// `metallic_roughness`, `scattered` is the light from around, not yet multiplied by the share of the material.
Accum lit(Surface surface) {
#if AMBIENT == AMBIENT_NONE || AMBIENT == AMBIENT_IBL
    Accum sum = Accum(vec3(0.0), vec3(0.0));
#elif AMBIENT == AMBIENT_DDGI
    Accum sum = Accum(probe_irradiance(surface.position, surface.normal), vec3(0.0));
#else
    Accum sum = Accum(ambient_light(surface.normal), vec3(0.0));
#endif
#if !METALLIC_ROUGHNESS && AMBIENT != AMBIENT_NONE && AMBIENT != AMBIENT_IBL
    sum.scattered *= surface.material.ambient;
#endif
#if CLUSTERED
    uvec2 list = lamp_list(surface.position, camera.clip_from_world, camera.world_from_view);
    for (uint k = 0u; k < list.y; k++) {
        uint i = listed_lamp(list.x + k);
        if (i < min(lamps.count, uint(MAX_LIGHTS))) {
            sum = add_lamp(sum, surface, i);
        }
    }
#elif METALLIC_ROUGHNESS && MAX_LIGHTS == 1
    // Compilers unroll the loop only if its body is small, which that of the layers is not.
    if (lamps.count > 0u) {
        sum = add_lamp(sum, surface, 0u);
    }
#else
    for (uint i = 0u; i < min(lamps.count, uint(MAX_LIGHTS)); i++) {
        sum = add_lamp(sum, surface, i);
    }
#endif
    return sum;
}
#endif

#if SHADOW == SHADOW_PCSS
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
    return normalize_or_zero(light.position - surface.position);
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

#if SHADOW != SHADOW_NONE && SHADOW_LIGHT == SHADOW_LIGHT_DIRECTIONAL && !CASCADES
/// The point that is looked up: off the surface on the lamp's side, so that it does not shadow itself.
vec3 receiver(Surface surface, Light light) {
    return normal_offset(surface.position, surface.normal, -light.axis, caster.texel, caster.normal_offset);
}
#elif SHADOW != SHADOW_NONE && !CASCADES
vec3 receiver(Surface surface, Light light) {
    vec3 offset = light.position - surface.position;
    vec3 l = normalize_or_zero(offset);
    return normal_offset(surface.position, surface.normal, l, caster.texel * length(offset), caster.normal_offset);
}
#endif

#if SHADOW != SHADOW_NONE && SHADOW_LIGHT != SHADOW_LIGHT_POINT
/// Where the shadow map holds the point, the bias taken off its depth.
ShadowUv place_in_map(
#if CASCADES
    int part,
#endif
    Surface surface
) {
#if CASCADES
    vec3 away = -lamps.lights[caster.light].axis;
    vec3 point = normal_offset(surface.position, surface.normal, away, cascades.texels[part], caster.normal_offset);
#else
    vec3 point = receiver(surface, lamps.lights[caster.light]);
#endif
#if CASCADES
    ShadowUv at = project(shadow_coord(cascades.clip_from_world[part], point), caster.min_w);
#else
    ShadowUv at = project(shadow_coord(caster.clip_from_world, point), caster.min_w);
#endif
    at.depth = constant_bias(at.depth, caster.bias);
    return at;
}
#endif

#if SHADOW_LIGHT == SHADOW_LIGHT_POINT
/// How much of the shadow caster's light arrives; `pixel` is the place in the framebuffer.
float visibility(Surface surface, vec2 pixel) {
    Light light = lamps.lights[caster.light];
    vec3 offset = receiver(surface, light) - light.position;
    float depth = constant_bias(cube_depth(offset, caster.near, caster.far), caster.bias);
    return cube_compare(shadow_cube, shadow_sampler, offset, depth);
}
#elif SHADOW == SHADOW_VSM || SHADOW == SHADOW_EVSM || SHADOW == SHADOW_ESM || SHADOW == SHADOW_MSM
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
#elif SHADOW != SHADOW_NONE
float visibility(
#if CASCADES
    int part,
#endif
    Surface surface,
    vec2 pixel
) {
#if CASCADES
    ShadowUv at = place_in_map(part, surface);
#else
    ShadowUv at = place_in_map(surface);
#endif
#if SHADOW == SHADOW_PCF_VOGEL || SHADOW == SHADOW_PCSS
    float phi = 6.2831853 * interleaved_gradient_noise(pixel);
#elif SHADOW == SHADOW_HARD
    return hard(shadow_map, shadow_sampler, at);
#elif SHADOW == SHADOW_PCF_3X3
    return pcf_3x3(shadow_map, shadow_sampler, at);
#elif SHADOW == SHADOW_PCF_5X5
    return pcf_5x5(shadow_map, shadow_sampler, at);
#elif SHADOW == SHADOW_PCF_CASTANO_5
    return pcf_castano_5(shadow_map, shadow_sampler, at);
#elif SHADOW == SHADOW_PCF_RANDOM16
    return pcf_random16(shadow_map, shadow_sampler, at, caster.radius, pixel);
#endif
#if SHADOW == SHADOW_PCF_VOGEL
    return pcf_vogel(shadow_map, shadow_sampler, at, 16, caster.radius, phi);
#elif SHADOW == SHADOW_PCSS
    return soft_shadow(surface, at, phi);
#endif
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

#if CONTACT
/// How much of the shadow caster's light passes what is near the point, as seen on the screen.
float contact_visibility(vec2 pixel) {
    vec2 place = pixel / vec2(textureSize(sampler2D(seen_contact, open_sampler), 0));
    return textureLod(sampler2D(seen_contact, open_sampler), place, 0.0).x;
}
#endif

#if BOX_PROJECTION
/// Where the environment has what is seen from a point in a direction.
vec3 towards_wall(Surface surface, vec3 direction) {
    return box_project(direction, surface.position, room.low, room.high, room.centre);
}
#endif

#if AMBIENT == AMBIENT_IBL && LIGHTS != LIGHTS_NONE
/// The sums with the light of the environment maps.
Accum add_environment(Accum sum, Surface surface) {
    vec3 diffuse = texture(samplerCube(sky_diffuse, sky_sampler), surface.normal).rgb;
#if BOX_PROJECTION
    vec3 mirrored = towards_wall(surface, reflect(-surface.view, surface.normal));
    vec3 specular = texture(samplerCube(sky_specular, sky_sampler), mirrored).rgb;
#else
    vec3 specular = texture(samplerCube(sky_specular, sky_sampler), reflect(-surface.view, surface.normal)).rgb;
#endif
    return Accum(
        sum.scattered + surface.material.ambient * diffuse * surroundings.diffuse_share,
        sum.reflected + surface.material.specular * specular * surroundings.specular_share
    );
}
#endif

#if METALLIC_ROUGHNESS && AMBIENT != AMBIENT_NONE && AMBIENT != AMBIENT_CONSTANT
/// The light of the surroundings on a side of the surface.
vec3 surrounding_light(Surface surface, vec3 normal) {
#if AMBIENT == AMBIENT_IBL
    vec3 light = texture(samplerCube(sky_diffuse, sky_sampler), normal).rgb * surroundings.diffuse_share;
#elif AMBIENT == AMBIENT_DDGI
    vec3 light = probe_irradiance(surface.position, normal);
#else
    vec3 light = ambient_light(normal);
#endif
    return surface.material.ambient * light;
}

/// The light of the surroundings from a direction, blurred by a roughness if they have that.
vec3 seen_light(Surface surface, vec3 direction, float roughness) {
#if AMBIENT != AMBIENT_IBL
    return surrounding_light(surface, direction);
#else
    float level = prefilter_lod(roughness, layers.sky_levels);
#if BOX_PROJECTION
    return textureLod(samplerCube(sky_specular, sky_sampler), towards_wall(surface, direction), level).rgb * surroundings.specular_share;
#else
    return textureLod(samplerCube(sky_specular, sky_sampler), direction, level).rgb * surroundings.specular_share;
#endif
#endif
}
#endif

#if TRANSMISSION && AMBIENT != AMBIENT_NONE && AMBIENT != AMBIENT_CONSTANT
/// The light of the surroundings that is seen through the surface.
vec3 light_through(Surface surface) {
    mat3 directions = through_directions(surface.layered);
    float roughness = through_roughness(surface.layered);
#if !DISPERSION
    return seen_light(surface, directions[1], roughness);
#else
    return vec3(
        seen_light(surface, directions[0], roughness).x,
        seen_light(surface, directions[1], roughness).y,
        seen_light(surface, directions[2], roughness).z
    );
#endif
}
#endif

#if METALLIC_ROUGHNESS
/// The light around a layered surface. `scattered` is what falls onto the viewer's side of it
/// without that of the environment maps.
Around light_around(Surface surface, vec3 scattered) {
    Around around = Around(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
#if AMBIENT == AMBIENT_IBL
    around.front = scattered + surrounding_light(surface, surface.normal);
#else
    around.front = scattered;
#endif
#if AMBIENT == AMBIENT_NONE || AMBIENT == AMBIENT_CONSTANT
#if AMBIENT == AMBIENT_NONE
    // What was computed beforehand has no direction.
    vec3 everywhere = vec3(0.0);
#else
    vec3 everywhere = scattered;
#endif
    around.mirrored = everywhere;
#if DIFFUSE_TRANSMISSION
    around.back = everywhere;
#endif
#if CLEARCOAT
    around.coated = everywhere;
#endif
#if TRANSMISSION
    around.through = everywhere;
#endif
#else
    around.mirrored = seen_light(surface, mirrored_direction(surface.layered), surface.layered.roughness);
#if DIFFUSE_TRANSMISSION
    around.back = surrounding_light(surface, -surface.normal);
#endif
#if CLEARCOAT
    around.coated = seen_light(surface, reflect(-surface.view, surface.layered.coat_normal), surface.layered.own.clearcoat_roughness);
#endif
#if TRANSMISSION
    around.through = light_through(surface);
#endif
#endif
    return around;
}
#endif

#if SPECULAR != SPECULAR_NONE || DIFFUSE == DIFFUSE_OREN_NAYAR || AMBIENT == AMBIENT_IBL
/// Unit direction from a point to the viewer.
vec3 towards_viewer(vec3 position) {
    return normalize_or_zero(camera.world_from_view[3].xyz - position);
}
#endif

#endif
