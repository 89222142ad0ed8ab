#version 450
//! The fragment stage of `published`, which `published.wesl` describes.
//!
//! Made from `published.wesl` by `cargo xtask docs`: edit that, not this file.

#if EXAMPLE == EXAMPLE_OGLPG_7_13
#include "../ambient/ibl.glsl"
#endif
#include "../brdf/diffuse.glsl"
#include "../brdf/specular.glsl"
#include "../lighting/attenuation.glsl"
#include "../lighting/classic.glsl"
#include "../lighting/light.glsl"
#include "../lighting/material.glsl"
#include "../lighting/spot.glsl"
#if EXAMPLE == EXAMPLE_HPG_6_RANDOM
#include "../math/noise.glsl"
#endif
#if EXAMPLE == EXAMPLE_IGL_2_CUBE || EXAMPLE == EXAMPLE_IGL_2_SPOT || EXAMPLE == EXAMPLE_IGL_2_DIRECTIONAL
#include "../shadow/compare.glsl"
#include "../shadow/coord.glsl"
#endif
#if EXAMPLE == EXAMPLE_HPG_7
#include "../shadow/moments.glsl"
#endif
#include "../surface/view.glsl"
#include "published.glsl"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
#if EXAMPLE != EXAMPLE_OGLPG_7_12 && EXAMPLE != EXAMPLE_OGLPG_7_14
layout(location = 2) in vec4 in_color;
#endif
#if EXAMPLE == EXAMPLE_NCL_11_FLAT || EXAMPLE == EXAMPLE_NCL_11_GOURAUD || EXAMPLE == EXAMPLE_NCL_11_PHONG || EXAMPLE == EXAMPLE_NCL_11_LIGHTMAP || EXAMPLE == EXAMPLE_NCL_11_FURTHER_1 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_2 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_3 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_4
layout(location = 3) in vec2 in_uv;
#endif
#if EXAMPLE == EXAMPLE_NCL_11_LIGHTMAP
layout(location = 4) in vec2 in_light_uv;
#elif EXAMPLE == EXAMPLE_OGLPG_7_10 || EXAMPLE == EXAMPLE_OGLPG_7_11
layout(location = 6) flat in uint in_material;
#elif EXAMPLE == EXAMPLE_OGLPG_7_6
layout(location = 7) in vec3 in_light_direction;
#endif
#if EXAMPLE == EXAMPLE_OGLPG_7_6
layout(location = 8) in vec3 in_half_vector;
layout(location = 9) in float in_attenuation;
#elif EXAMPLE == EXAMPLE_OGLPG_7_12 || EXAMPLE == EXAMPLE_OGLPG_7_14
layout(location = 7) in vec3 in_lit;
#elif EXAMPLE == EXAMPLE_HPG_1_VERTEX
layout(location = 7) in vec4 in_lit;
#elif EXAMPLE == EXAMPLE_OGLPG_7_13
layout(location = 7) in vec3 in_mirrored;
#elif EXAMPLE == EXAMPLE_OGLPG_7_21
layout(location = 7) in vec3 in_world;
#elif EXAMPLE == EXAMPLE_NCL_11_FLAT || EXAMPLE == EXAMPLE_NCL_11_GOURAUD
layout(location = 7) in vec3 in_scattered;
#endif
#if EXAMPLE == EXAMPLE_NCL_11_FLAT || EXAMPLE == EXAMPLE_NCL_11_GOURAUD
layout(location = 8) in vec3 in_reflected;
#elif EXAMPLE == EXAMPLE_IGL_1_DIRECTIONAL || EXAMPLE == EXAMPLE_IGL_1_POINT || EXAMPLE == EXAMPLE_IGL_1_SPOT || EXAMPLE == EXAMPLE_IGL_1_MULTIPLE || EXAMPLE == EXAMPLE_IGL_2_SPOT || EXAMPLE == EXAMPLE_IGL_2_CUBE || EXAMPLE == EXAMPLE_IGL_2_DIRECTIONAL
layout(location = 7) in vec3 in_view;
#endif
#if EXAMPLE == EXAMPLE_OGLPG_7_21 || EXAMPLE == EXAMPLE_HPG_5 || EXAMPLE == EXAMPLE_HPG_6_3X3 || EXAMPLE == EXAMPLE_HPG_6_5X5 || EXAMPLE == EXAMPLE_HPG_6_RANDOM || EXAMPLE == EXAMPLE_HPG_7 || EXAMPLE == EXAMPLE_IGL_2_SPOT || EXAMPLE == EXAMPLE_IGL_2_DIRECTIONAL
layout(location = 10) in vec4 in_in_light;
#endif

layout(location = 0) out vec4 out_color;

layout(set = 0, binding = 5) uniform texture2D shadow_map;
layout(set = 0, binding = 6) uniform textureCube shadow_cube;
layout(set = 0, binding = 7) uniform samplerShadow shadow_sampler;
layout(set = 0, binding = 10) uniform texture2D shadow_moments;
layout(set = 0, binding = 11) uniform sampler moment_sampler;
layout(set = 0, binding = 12) uniform textureCube sky_diffuse;
layout(set = 0, binding = 13) uniform textureCube sky_specular;
layout(set = 0, binding = 14) uniform sampler sky_sampler;
layout(set = 1, binding = 1) uniform texture2D base_map;
layout(set = 1, binding = 3) uniform texture2D light_map;
layout(set = 1, binding = 4) uniform sampler map_sampler;

/// A light of the world in view space, as far as the listing reads it.
Light eye_light(Light light) {
    Light seen = light;
#if EXAMPLE != EXAMPLE_OGLPG_7_3
    seen.position = eye_point(light.position);
#endif
#if EXAMPLE == EXAMPLE_OGLPG_7_3 || EXAMPLE == EXAMPLE_OGLPG_7_5 || EXAMPLE == EXAMPLE_OGLPG_7_8 || EXAMPLE == EXAMPLE_OGLPG_7_10 || EXAMPLE == EXAMPLE_OGLPG_7_11 || EXAMPLE == EXAMPLE_HPG_4
    seen.axis = eye_direction(light.axis);
#endif
    return seen;
}

#if EXAMPLE == EXAMPLE_OGLPG_7_8 || EXAMPLE == EXAMPLE_OGLPG_7_10 || EXAMPLE == EXAMPLE_OGLPG_7_11
/// Example 7.8's loop over lamps of any kind, with the materials of examples 7.10 and 7.11.
vec4 many_lamps(
#if EXAMPLE != EXAMPLE_OGLPG_7_8
    Material material
#endif
) {
#if EXAMPLE == EXAMPLE_OGLPG_7_8
    float shininess = materials.items[0].shininess;
#else
    float shininess = material.shininess;
#endif
    Accum sum = Accum(vec3(0.0), vec3(0.0));
    for (uint i = 0u; i < min(lamps.count, 10u); i++) {
        Light light = eye_light(lamps.lights[i].light);
        LightSample lit = sample_light(light, in_position);
        vec3 half_vector = normalize(lit.l + view_infinite());
        if (light.kind == LIGHT_DIRECTIONAL) {
            half_vector = eye_direction(lamps.lights[i].half_vector);
        }
        float attenuation = lit.attenuation * lit.spot;
        float diffuse = lambert(in_normal, lit.l);
        float specular = blinn_phong_half(in_normal, half_vector, diffuse, shininess);
#if EXAMPLE == EXAMPLE_OGLPG_7_8
        sum = Accum(
            sum.scattered + (light.ambient + light.color * diffuse) * attenuation,
            sum.reflected + light.color * (specular * light.strength * attenuation)
        );
#else
        sum = accumulate(sum, material, light, lit, attenuation, diffuse, specular, 1.0);
#endif
    }
#if EXAMPLE == EXAMPLE_OGLPG_7_8
    vec3 rgb = in_color.rgb * sum.scattered + sum.reflected;
#else
    vec3 rgb = resolve(in_color.rgb, material, sum);
#endif
    return vec4(min(rgb, vec3(1.0)), in_color.a);
}
#endif

/// The place in the map and the depth that `textureProj` looks up, rows from the top.
vec3 projected(vec4 in_light) {
    vec3 ndc = in_light.xyz / in_light.w;
    return vec3(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y, ndc.z);
}

/// What OpenGL compares with the depths of the books' maps, whose numbers are fixed-point: so nothing
/// beyond the far plane is in shadow where the map is empty.
float fixed_point(float depth) {
    return clamp(depth, 0.0, 1.0);
}

/// The share of a filtered texel that is on the map and not on its border.
float share_on_map(vec2 uv, vec2 size) {
    vec2 inside = clamp(uv * size + 0.5, vec2(0.0), vec2(1.0)) * clamp((1.0 - uv) * size + 0.5, vec2(0.0), vec2(1.0));
    return inside.x * inside.y;
}

#if EXAMPLE == EXAMPLE_HPG_5 || EXAMPLE == EXAMPLE_HPG_6_3X3 || EXAMPLE == EXAMPLE_HPG_6_5X5 || EXAMPLE == EXAMPLE_HPG_6_RANDOM
/// One comparison with the map of the second book's recipes. Their border has the depth 1.
float compare_bordered(vec2 uv, float depth) {
    float visible = textureLod(sampler2DShadow(shadow_map, shadow_sampler), vec3(uv, fixed_point(depth)), 0.0);
    return mix(1.0, visible, share_on_map(uv, vec2(textureSize(sampler2DShadow(shadow_map, shadow_sampler), 0))));
}
#endif

#if EXAMPLE == EXAMPLE_HPG_5
/// The recipe's comparison with the nearest texel.
float shadow_of(vec4 in_light) {
    if (!(in_light.w > caster.min_w)) {
        return 1.0;
    }
    vec3 at = projected(in_light);
    vec2 size = vec2(textureSize(sampler2DShadow(shadow_map, shadow_sampler), 0));
    return compare_bordered((floor(at.xy * size) + 0.5) / size, at.z);
}
#elif EXAMPLE == EXAMPLE_HPG_6_3X3 || EXAMPLE == EXAMPLE_HPG_6_5X5
/// The recipe's grid of comparisons, two texels apart.
float shadow_of(vec4 in_light) {
    if (!(in_light.w > caster.min_w)) {
        return 1.0;
    }
#if EXAMPLE == EXAMPLE_HPG_6_3X3
    int reach = 1;
#else
    int reach = 2;
#endif
    vec3 at = projected(in_light);
    vec2 stride = 2.0 / vec2(textureSize(sampler2DShadow(shadow_map, shadow_sampler), 0));
    float sum = 0.0;
    for (int y = -reach; y <= reach; y++) {
        for (int x = -reach; x <= reach; x++) {
            sum += compare_bordered(at.xy + vec2(float(x), float(y)) * stride, at.z);
        }
    }
#if EXAMPLE == EXAMPLE_HPG_6_3X3
    return sum / 9.0;
#else
    return sum / 25.0;
#endif
}
#elif EXAMPLE == EXAMPLE_HPG_6_RANDOM
/// The recipe's sixteen comparisons at random places to one side.
float shadow_of(vec4 in_light, vec2 pixel) {
    if (!(in_light.w > caster.min_w)) {
        return 1.0;
    }
    vec3 at = projected(in_light);
    float sum = 0.0;
    for (int i = 0; i < 16; i++) {
        float across = 0.25 * random_hpg(vec4(pixel.x, pixel.y, pixel.x, float(i)));
        float up = 0.25 * random_hpg(vec4(pixel.y, pixel.x, pixel.y, float(i)));
        sum += compare_bordered(at.xy + vec2(across, -up) / in_light.w, at.z);
    }
    return sum / 16.0;
}
#elif EXAMPLE == EXAMPLE_HPG_7
/// The recipe's bound by Chebyshev.
float shadow_of(vec4 in_light) {
    if (!(in_light.w > caster.min_w)) {
        return 1.0;
    }
    vec3 at = projected(in_light);
    vec2 stored = textureLod(sampler2D(shadow_moments, moment_sampler), at.xy, 0.0).xy;
    vec2 moments = mix(vec2(1.0, 0.0), stored, share_on_map(at.xy, vec2(textureSize(sampler2D(shadow_moments, moment_sampler), 0))));
    return vsm_visibility(moments, at.z, caster.min_variance, caster.least, 0.0);
}
#elif EXAMPLE == EXAMPLE_NCL_11_PHONG || EXAMPLE == EXAMPLE_NCL_11_FURTHER_1 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_2 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_3 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_4
/// The light of a lamp as the tutorial's listing has it, or as its exercises ask for.
vec3 lit_ncl(vec3 base, Lamp lamp) {
    vec3 v = normalize(camera.world_from_view[3].xyz - in_position);
#if EXAMPLE != EXAMPLE_NCL_11_FURTHER_3
    vec3 offset = lamp.light.position - in_position;
#endif
#if EXAMPLE == EXAMPLE_NCL_11_FURTHER_3
    vec3 l = normalize(-lamp.light.axis);
#else
    vec3 l = normalize(offset);
#endif
#if EXAMPLE == EXAMPLE_NCL_11_FURTHER_3
    float attenuation = 1.0;
#elif EXAMPLE == EXAMPLE_NCL_11_FURTHER_4
    float attenuation = linear_radius(length(offset), lamp.light.range) * cone_hard_exclusive(dot(-l, lamp.light.axis), lamp.light.cutoff);
#else
    float attenuation = linear_radius(length(offset), lamp.light.range);
#endif
#if EXAMPLE != EXAMPLE_NCL_11_FURTHER_1
    return shade_ncl(base, lamp.light.color, in_normal, l, v, attenuation);
#else
    // What a black surface has is the highlight, here in a colour of its own.
    vec3 black = vec3(0.0);
    vec3 surface = shade_ncl(base, lamp.light.color, in_normal, l, v, attenuation) - shade_ncl(black, lamp.light.color, in_normal, l, v, attenuation);
    return surface + shade_ncl(black, lamp.specular, in_normal, l, v, attenuation);
#endif
}
#elif EXAMPLE == EXAMPLE_IGL_1_DIRECTIONAL || EXAMPLE == EXAMPLE_IGL_1_POINT || EXAMPLE == EXAMPLE_IGL_1_SPOT || EXAMPLE == EXAMPLE_IGL_1_MULTIPLE || EXAMPLE == EXAMPLE_IGL_2_SPOT || EXAMPLE == EXAMPLE_IGL_2_CUBE || EXAMPLE == EXAMPLE_IGL_2_DIRECTIONAL
/// The light of a lamp of any kind as the article has it. Its shadow and its cone leave the ambient
/// light, which fades with the distance.
vec3 lit_igl(Lamp lamp, float visibility) {
    Light light = lamp.light;
    Material material = materials.items[0];
    vec3 n = normalize(in_normal);
#if EXAMPLE == EXAMPLE_IGL_1_DIRECTIONAL || EXAMPLE == EXAMPLE_IGL_2_DIRECTIONAL
    vec3 l = normalize(-light.axis);
#elif EXAMPLE == EXAMPLE_IGL_1_MULTIPLE
    vec3 l = normalize(light.kind == LIGHT_DIRECTIONAL ? -light.axis : light.position - in_position);
#else
    vec3 l = normalize(light.position - in_position);
#endif
#if EXAMPLE == EXAMPLE_IGL_1_DIRECTIONAL || EXAMPLE == EXAMPLE_IGL_2_DIRECTIONAL
    float attenuation = 1.0;
#else
    float attenuation = polynomial(distance(light.position, in_position), light.attenuation);
#endif
#if EXAMPLE == EXAMPLE_IGL_1_MULTIPLE
    if (light.kind == LIGHT_DIRECTIONAL) {
        attenuation = 1.0;
    }
#endif
    // The article's highlight is about the light's own direction, which a point light does not have.
    vec3 back = l;
    float cone = 1.0;
#if EXAMPLE == EXAMPLE_IGL_1_SPOT || EXAMPLE == EXAMPLE_IGL_2_SPOT
    back = normalize(-light.axis);
    cone = cone_hard_exclusive(dot(l, back), light.cutoff);
#elif EXAMPLE == EXAMPLE_IGL_1_MULTIPLE
    if (light.kind == LIGHT_SPOT) {
        back = normalize(-light.axis);
        cone = cone_hard_exclusive(dot(l, back), light.cutoff);
    }
#endif
    vec3 diffuse = material.diffuse * in_color.rgb * light.color * lambert(n, l);
    vec3 ambient = material.ambient * in_color.rgb * light.ambient;
    vec3 specular = material.specular * lamp.specular * phong_igl(n, back, normalize(in_view), material.shininess);
    return (ambient + (diffuse + specular) * (cone * visibility)) * attenuation;
}
#endif

#if EXAMPLE == EXAMPLE_OGLPG_7_1
vec4 printed() {
    return in_color;
}
#elif EXAMPLE == EXAMPLE_OGLPG_7_2
vec4 printed() {
    return min(in_color * vec4(surroundings.color, 1.0), vec4(1.0));
}
#elif EXAMPLE == EXAMPLE_OGLPG_7_3 || EXAMPLE == EXAMPLE_OGLPG_7_4 || EXAMPLE == EXAMPLE_OGLPG_7_5 || EXAMPLE == EXAMPLE_OGLPG_7_6
vec4 printed() {
    Lamp lamp = lamps.lights[0];
#if EXAMPLE != EXAMPLE_OGLPG_7_6
    Light light = eye_light(lamp.light);
#endif
#if EXAMPLE == EXAMPLE_OGLPG_7_3
    LightSample lit = sample_directional(light);
#elif EXAMPLE == EXAMPLE_OGLPG_7_4
    LightSample lit = sample_point(light, in_position);
#elif EXAMPLE == EXAMPLE_OGLPG_7_5
    LightSample lit = sample_spot(light, in_position);
#else
    LightSample lit = LightSample(in_light_direction, 0.0, in_attenuation, 1.0);
#endif
#if EXAMPLE == EXAMPLE_OGLPG_7_3
    vec3 half_vector = eye_direction(lamp.half_vector);
#elif EXAMPLE == EXAMPLE_OGLPG_7_6
    vec3 half_vector = in_half_vector;
#else
    vec3 half_vector = normalize(lit.l + view_infinite());
#endif
    float attenuation = lit.attenuation * lit.spot;
    float diffuse = lambert(in_normal, lit.l);
    float specular = blinn_phong_half(in_normal, half_vector, diffuse, materials.items[0].shininess) * lamp.light.strength;
    vec3 scattered = surroundings.color + lamp.light.color * (diffuse * attenuation);
    vec3 reflected = lamp.light.color * (specular * attenuation);
    return vec4(min(in_color.rgb * scattered + reflected, vec3(1.0)), in_color.a);
}
#elif EXAMPLE == EXAMPLE_OGLPG_7_8
vec4 printed() {
    return many_lamps();
}
#elif EXAMPLE == EXAMPLE_OGLPG_7_10
vec4 printed() {
    return many_lamps(materials.items[in_material]);
}
#elif EXAMPLE == EXAMPLE_OGLPG_7_11
vec4 printed(bool front) {
    return many_lamps(materials.items[material_index_oglpg(int(in_material), front)]);
}
#elif EXAMPLE == EXAMPLE_OGLPG_7_12 || EXAMPLE == EXAMPLE_OGLPG_7_14
vec4 printed() {
    return vec4(in_lit, 1.0);
}
#elif EXAMPLE == EXAMPLE_OGLPG_7_13
vec4 printed() {
    vec3 diffuse = texture(samplerCube(sky_diffuse, sky_sampler), normalize(in_normal)).rgb;
    vec3 specular = texture(samplerCube(sky_specular, sky_sampler), normalize(in_mirrored)).rgb;
    return vec4(ibl_mix(in_color.rgb, diffuse, specular, surroundings.diffuse_share, surroundings.specular_share), 1.0);
}
#elif EXAMPLE == EXAMPLE_OGLPG_7_21
vec4 printed() {
    Material material = materials.items[0];
    vec3 base = in_color.rgb;
    // The normal is in view space, and the direction to the light in the world.
    vec3 l = normalize(lamps.lights[0].light.position - in_world);
    vec3 v = -normalize(in_position);
    // The sampler repeats the texels of the edge.
    vec3 at = projected(in_in_light);
    float f = textureLod(sampler2DShadow(shadow_map, shadow_sampler), vec3(at.xy, fixed_point(at.z)), 0.0);
    return vec4(
        shade_oglpg_7_21(base * material.ambient, base * material.diffuse, material.specular, material.shininess, in_normal, l, v, f),
        1.0
    );
}
#elif EXAMPLE == EXAMPLE_HPG_1_VERTEX
vec4 printed() {
    return in_lit;
}
#elif EXAMPLE == EXAMPLE_HPG_1_FRAGMENT
vec4 printed() {
    return near_lamp(normalize(in_normal), in_position, in_color.rgb);
}
#elif EXAMPLE == EXAMPLE_HPG_2
vec4 printed() {
    return lambert(in_normal, eye_direction(-lamps.lights[0].light.axis)) * vec4(in_color.rgb, 1.0);
}
#elif EXAMPLE == EXAMPLE_HPG_4
vec4 printed() {
    Light light = eye_light(lamps.lights[0].light);
    LightSample lit = sample_point(light, in_position);
    float c = dot(-lit.l, normalize(light.axis));
    float cone = cone_hard_exclusive(c, light.cutoff) * cone_exponent(c, light.cutoff, light.exponent);
    // The recipe writes nothing outside of the cone.
    return (lambert(in_normal, lit.l) * cone * lit.attenuation) * vec4(in_color.rgb, 1.0);
}
#elif EXAMPLE == EXAMPLE_HPG_3 || EXAMPLE == EXAMPLE_HPG_5 || EXAMPLE == EXAMPLE_HPG_6_3X3 || EXAMPLE == EXAMPLE_HPG_6_5X5 || EXAMPLE == EXAMPLE_HPG_6_RANDOM || EXAMPLE == EXAMPLE_HPG_7
vec4 printed() {
    Light light = eye_light(lamps.lights[0].light);
    LightSample lit = sample_point(light, in_position);
    float diffuse = lambert(in_normal, lit.l) * lit.attenuation;
#if EXAMPLE == EXAMPLE_HPG_7
    diffuse *= shadow_of(in_in_light);
#elif EXAMPLE == EXAMPLE_HPG_6_RANDOM
    diffuse *= shadow_mix(shadow_of(in_in_light, gl_FragCoord.xy), light.shadow_strength);
#elif EXAMPLE != EXAMPLE_HPG_3
    diffuse *= shadow_mix(shadow_of(in_in_light), light.shadow_strength);
#endif
    return diffuse * vec4(in_color.rgb, 1.0);
}
#elif EXAMPLE == EXAMPLE_NCL_11_FLAT || EXAMPLE == EXAMPLE_NCL_11_GOURAUD
vec4 printed() {
    // The listing passes the colour of the vertices on, and does not read it.
    vec4 base = texture(sampler2D(base_map, map_sampler), in_uv);
    return vec4(base.rgb * in_scattered + in_reflected, base.a);
}
#elif EXAMPLE == EXAMPLE_NCL_11_LIGHTMAP
vec4 printed() {
    vec4 base = in_color * texture(sampler2D(base_map, map_sampler), in_uv);
    return vec4(base.rgb * texture(sampler2D(light_map, map_sampler), in_light_uv).rgb, base.a);
}
#elif EXAMPLE == EXAMPLE_NCL_11_PHONG || EXAMPLE == EXAMPLE_NCL_11_FURTHER_1 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_2 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_3 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_4
vec4 printed() {
    vec4 base = texture(sampler2D(base_map, map_sampler), in_uv);
#if EXAMPLE == EXAMPLE_NCL_11_FURTHER_2
    vec3 color = vec3(0.0);
    for (uint i = 0u; i < min(lamps.count, 4u); i++) {
        color += lit_ncl(base.rgb, lamps.lights[i]);
    }
    return vec4(color, base.a);
#else
    return vec4(lit_ncl(base.rgb, lamps.lights[0]), base.a);
#endif
}
#else
vec4 printed() {
    vec3 color = vec3(0.0);
#if EXAMPLE == EXAMPLE_IGL_1_MULTIPLE
    for (uint i = 0u; i < min(lamps.count, 10u); i++) {
        color += lit_igl(lamps.lights[i], 1.0);
    }
#elif EXAMPLE == EXAMPLE_IGL_2_CUBE
    vec3 offset = in_position - lamps.lights[0].light.position;
    float depth = cube_depth(offset, caster.near, caster.far) - caster.bias;
    color = lit_igl(lamps.lights[0], cube_compare(shadow_cube, shadow_sampler, offset, depth));
#elif EXAMPLE == EXAMPLE_IGL_2_SPOT || EXAMPLE == EXAMPLE_IGL_2_DIRECTIONAL
    ShadowUv at = project(in_in_light, 0.0);
    at.depth -= caster.bias;
    color = lit_igl(lamps.lights[0], hard(shadow_map, shadow_sampler, at));
#else
    color = lit_igl(lamps.lights[0], 1.0);
#endif
    return vec4(color, 1.0);
}
#endif

void main() {
#if EXAMPLE == EXAMPLE_OGLPG_7_11
    out_color = printed(gl_FrontFacing);
#else
    out_color = printed();
#endif
}
