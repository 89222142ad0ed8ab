//! The lamps of `forward`, and what they do to a surface: in the vertex stage with
//! `frequency=vertex`, else in the fragment stage.

#ifndef LAMPLIGHT_PROGRAMS_FORWARD_LAMPS_GLSL
#define LAMPLIGHT_PROGRAMS_FORWARD_LAMPS_GLSL

#include "../../lighting/classic.glsl"
#include "ambient.glsl"
#include "materials.glsl"
#include "viewer.glsl"
#if AREA != AREA_NONE
#include "../../brdf/energy.glsl"
#include "../areas.glsl"
#endif
#if METALLIC_ROUGHNESS
#include "../layers.glsl"
#endif
#if PROFILE != PROFILE_NONE
#include "../profiles.glsl"
#endif
#if CLUSTERED
#include "../clusters.glsl"
#include "camera.glsl"
#endif

/// The lights, of which the first `count` shine.
layout(std140, set = 0, binding = 1) uniform Lamps {
    uint count;
    Light lights[MAX_LIGHTS];
} lamps;

/// A point of a surface, as light meets it.
struct Surface {
    vec3 position;
    vec3 normal;
#if NEEDS_VIEW
    /// Towards the viewer.
    vec3 view;
#endif
    Material material;
#if SHADOW != SHADOW_NONE
    /// How much of the shadow caster's light arrives.
    float visibility;
#endif
#if METALLIC_ROUGHNESS
    /// What `metallic_roughness` makes of the material.
    Layered layered;
#endif
#if AREA == AREA_RECTANGLE && SPECULAR == SPECULAR_GGX
    /// The microfacets as linearly transformed cosines.
    mat3 lobe;
#endif
#if AREA == AREA_RECTANGLE && CLEARCOAT
    /// The same of the coat.
    mat3 coat_lobe;
#endif
};

#if SHADOW != SHADOW_NONE
#include "shadow.glsl"
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
#elif ATTENUATION == ATTENUATION_LINEAR_RADIUS
    return linear_radius(arriving.distance, light.range);
#else
    float d2 = arriving.distance * arriving.distance;
    float inv_range2 = 0.0;
    if (light.range > 0.0) {
        inv_range2 = 1.0 / (light.range * light.range);
    }
    // A light of one centimetre, where a scene unit is a metre.
    return inverse_square(d2, 0.0001) * window(d2, inv_range2);
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
#else
    return cone_smooth(dot(-arriving.l, light.axis), light.inner, light.outer);
#endif
}
#endif

#if SPECULAR == SPECULAR_GGX
/// The microfacet highlight, times n.l.
vec3 ggx(Surface surface, vec3 l) {
    vec3 n = surface.normal;
    vec3 h = safe_normalize(l + surface.view, n);
    vec3 n_cross_h = cross(n, h);
    float alpha = surface.material.roughness * surface.material.roughness;
    float nl = clamp(dot(n, l), 0.0, 1.0);
    float nv = clamp(dot(n, surface.view), 0.0, 1.0);
    float lobe = d_ggx(clamp(dot(n, h), 0.0, 1.0), dot(n_cross_h, n_cross_h), alpha) * v_smith_ggx(nv, nl, alpha);
    return nl * lobe * f_schlick(surface.material.specular, 1.0, dot(surface.view, h));
}
#endif

/// What of a lamp arrives at a point.
LightSample sample_lamp(Light light, vec3 position) {
#if LIGHTS == LIGHTS_DIRECTIONAL
    LightSample arriving = sample_directional(light);
#elif LIGHTS == LIGHTS_POINT
    LightSample arriving = sample_point(light, position);
#elif LIGHTS == LIGHTS_SPOT
    LightSample arriving = sample_spot(light, position);
#else
    LightSample arriving = sample_light(light, position);
#endif
#if ATTENUATION != ATTENUATION_POLYNOMIAL
    arriving.attenuation = falloff(light, arriving);
#endif
#if CONE != CONE_EXPONENT
    arriving.spot = cone(light, arriving);
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
#else
    return oren_nayar(surface.normal, l, surface.view, surface.material.sigma);
#endif
}

/// How much light from the direction `l` the surface reflects towards the viewer.
float specular_share(Surface surface, vec3 l) {
#if SPECULAR == SPECULAR_PHONG
    return phong(surface.normal, l, surface.view, surface.material.shininess);
#elif SPECULAR == SPECULAR_BLINN_PHONG
    return blinn_phong(surface.normal, l, surface.view, surface.material.shininess);
#elif SPECULAR == SPECULAR_BLINN_PHONG_NORMALIZED
    return blinn_phong_normalized(surface.normal, l, surface.view, surface.material.shininess);
#else
    return 0.0;
#endif
}

#if AREA != AREA_NONE
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

#if AREA != AREA_NONE && METALLIC_ROUGHNESS
/// The light of a lamp with an area, of colour 1, that leaves a layered surface towards the viewer.
vec3 layered_lamp(Surface surface, Light light, LightSample arriving, uint i) {
    if (!has_area(light)) {
        return layered_light(surface.layered, arriving.l, light.strength);
    }
    vec3 n = surface.normal;
    vec3 view = surface.view;
    vec3 p = surface.position;
#if AREA == AREA_RECTANGLE
    // Lobes take in the light of a rectangle as they take in that of the surroundings.
    float factor = 3.14159265 * light.strength;
    Around around;
    around.front = vec3(area_share(areas.items[i], n, p, light.position));
    around.mirrored = vec3(factor * reflected_rectangle(areas.items[i], n, view, p, light.position, surface.lobe));
#if CLEARCOAT
    vec3 coat_normal = surface.layered.coat_normal;
    around.coated = vec3(factor * reflected_rectangle(areas.items[i], coat_normal, view, p, light.position, surface.coat_lobe));
#endif
    return layered_ambient(surface.layered, around, vec3(0.0));
#else
    Layered at = surface.layered;
    Seen base = seen_lamp(areas.items[i], n, view, p, light.position, at.roughness);
#if CLEARCOAT
    Seen coat = seen_lamp(areas.items[i], at.coat_normal, at.view, p, light.position, at.own.clearcoat_roughness);
#else
    Seen coat = base;
#endif
    return layered_area_light(at, area_share(areas.items[i], n, p, light.position), base, coat, light.strength);
#endif
}
#elif AREA != AREA_NONE && SPECULAR == SPECULAR_GGX
/// The microfacet highlight of a lamp with an area.
vec3 area_highlight(Surface surface, Light light, LightSample arriving, uint i) {
    if (!has_area(light)) {
        return ggx(surface, arriving.l);
    }
    vec3 n = surface.normal;
    float roughness = surface.material.roughness;
#if AREA == AREA_RECTANGLE
    vec2 dfg = dfg_approx(dot(n, surface.view), roughness);
    vec3 albedo = surface.material.specular * dfg.x + dfg.y;
    return albedo * reflected_rectangle(areas.items[i], n, surface.view, surface.position, light.position, surface.lobe);
#else
    Seen seen = seen_lamp(areas.items[i], n, surface.view, surface.position, light.position, roughness);
    return seen.gain * ggx(surface, seen.l);
#endif
}
#endif

/// The sums with the light of one lamp.
Accum add_lamp(Accum sum, Surface surface, uint i) {
    Light light = lamps.lights[i];
    LightSample arriving = sample_lamp(light, surface.position);
#if PROFILE != PROFILE_NONE
    light.color *= profile_factor(profiles.items[i], light, arriving.l, surface.position);
#endif
    float ambient = ambient_share(light, arriving);
#if !METALLIC_ROUGHNESS
#if AREA == AREA_NONE
    float diffuse = diffuse_share(surface, arriving.l);
#else
    float diffuse = fallen_share(surface, light, arriving, i);
#endif
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
    return Accum(
        sum.scattered + light.ambient * surface.material.ambient * ambient,
#if AREA == AREA_NONE
        sum.reflected + radiance * layered_light(surface.layered, arriving.l, light.strength)
#else
        sum.reflected + radiance * layered_lamp(surface, light, arriving, i)
#endif
    );
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

/// The sums of the light that leaves the point towards the viewer, without that of the environment maps.
Accum lit(Surface surface) {
#if AMBIENT == AMBIENT_NONE || AMBIENT == AMBIENT_IBL
    Accum sum = Accum(vec3(0.0), vec3(0.0));
#elif AMBIENT == AMBIENT_DDGI
    Accum sum = Accum(surface.material.ambient * probe_irradiance(surface.position, surface.normal), vec3(0.0));
#else
    Accum sum = Accum(surface.material.ambient * ambient_light(surface.normal), vec3(0.0));
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
