#version 450
//! The vertex stage of `published`, which `published.wesl` describes.
//!
//! Made from `published.wesl` by `cargo xtask docs`: edit that, not this file.

#if EXAMPLE == EXAMPLE_OGLPG_7_12
#include "../ambient/hemisphere.glsl"
#endif
#if EXAMPLE == EXAMPLE_OGLPG_7_14
#include "../ambient/sh.glsl"
#endif
#if EXAMPLE == EXAMPLE_OGLPG_7_6 || EXAMPLE == EXAMPLE_NCL_11_FLAT || EXAMPLE == EXAMPLE_NCL_11_GOURAUD
#include "../lighting/attenuation.glsl"
#endif
#if EXAMPLE == EXAMPLE_NCL_11_FLAT || EXAMPLE == EXAMPLE_NCL_11_GOURAUD
#include "../lighting/classic.glsl"
#include "../lighting/light.glsl"
#endif
#include "../shadow/coord.glsl"
#if EXAMPLE == EXAMPLE_OGLPG_7_6
#include "../surface/view.glsl"
#endif
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
layout(location = 6) in uint in_material;
#elif EXAMPLE == EXAMPLE_NCL_11_FLAT
layout(location = 7) in vec3 in_middle;
#endif

layout(location = 0) out vec3 out_position;
layout(location = 1) out vec3 out_normal;
#if EXAMPLE != EXAMPLE_OGLPG_7_12 && EXAMPLE != EXAMPLE_OGLPG_7_14
layout(location = 2) out vec4 out_color;
#endif
#if EXAMPLE == EXAMPLE_NCL_11_FLAT || EXAMPLE == EXAMPLE_NCL_11_GOURAUD || EXAMPLE == EXAMPLE_NCL_11_PHONG || EXAMPLE == EXAMPLE_NCL_11_LIGHTMAP || EXAMPLE == EXAMPLE_NCL_11_FURTHER_1 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_2 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_3 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_4
layout(location = 3) out vec2 out_uv;
#endif
#if EXAMPLE == EXAMPLE_NCL_11_LIGHTMAP
layout(location = 4) out vec2 out_light_uv;
#elif EXAMPLE == EXAMPLE_OGLPG_7_10 || EXAMPLE == EXAMPLE_OGLPG_7_11
layout(location = 6) flat out uint out_material;
#elif EXAMPLE == EXAMPLE_OGLPG_7_6
layout(location = 7) out vec3 out_light_direction;
#endif
#if EXAMPLE == EXAMPLE_OGLPG_7_6
layout(location = 8) out vec3 out_half_vector;
layout(location = 9) out float out_attenuation;
#elif EXAMPLE == EXAMPLE_OGLPG_7_12 || EXAMPLE == EXAMPLE_OGLPG_7_14
layout(location = 7) out vec3 out_lit;
#elif EXAMPLE == EXAMPLE_HPG_1_VERTEX
layout(location = 7) out vec4 out_lit;
#elif EXAMPLE == EXAMPLE_OGLPG_7_13
layout(location = 7) out vec3 out_mirrored;
#elif EXAMPLE == EXAMPLE_OGLPG_7_21
layout(location = 7) out vec3 out_world;
#elif EXAMPLE == EXAMPLE_NCL_11_FLAT || EXAMPLE == EXAMPLE_NCL_11_GOURAUD
layout(location = 7) out vec3 out_scattered;
#endif
#if EXAMPLE == EXAMPLE_NCL_11_FLAT || EXAMPLE == EXAMPLE_NCL_11_GOURAUD
layout(location = 8) out vec3 out_reflected;
#elif EXAMPLE == EXAMPLE_IGL_1_DIRECTIONAL || EXAMPLE == EXAMPLE_IGL_1_POINT || EXAMPLE == EXAMPLE_IGL_1_SPOT || EXAMPLE == EXAMPLE_IGL_1_MULTIPLE || EXAMPLE == EXAMPLE_IGL_2_SPOT || EXAMPLE == EXAMPLE_IGL_2_CUBE || EXAMPLE == EXAMPLE_IGL_2_DIRECTIONAL
layout(location = 7) out vec3 out_view;
#endif
#if EXAMPLE == EXAMPLE_OGLPG_7_21 || EXAMPLE == EXAMPLE_HPG_5 || EXAMPLE == EXAMPLE_HPG_6_3X3 || EXAMPLE == EXAMPLE_HPG_6_5X5 || EXAMPLE == EXAMPLE_HPG_6_RANDOM || EXAMPLE == EXAMPLE_HPG_7 || EXAMPLE == EXAMPLE_IGL_2_SPOT || EXAMPLE == EXAMPLE_IGL_2_DIRECTIONAL
layout(location = 10) out vec4 out_in_light;
#endif

/// A normal of the object in the world, as long as the inverse transpose makes it.
vec3 world_normal(vec3 normal) {
    return (object.normal_from_object * vec4(normal, 0.0)).xyz;
}

void main() {
    vec3 world = world_point(in_position);
    out_position = vec3(0.0);
    out_normal = vec3(0.0);
    gl_Position = camera.clip_from_world * vec4(world, 1.0);
#if EXAMPLE != EXAMPLE_OGLPG_7_12 && EXAMPLE != EXAMPLE_OGLPG_7_14
    out_color = in_color * object.color;
#endif
#if EXAMPLE == EXAMPLE_NCL_11_FLAT || EXAMPLE == EXAMPLE_NCL_11_GOURAUD || EXAMPLE == EXAMPLE_NCL_11_PHONG || EXAMPLE == EXAMPLE_NCL_11_LIGHTMAP || EXAMPLE == EXAMPLE_NCL_11_FURTHER_1 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_2 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_3 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_4
    out_uv = in_uv;
#endif
#if EXAMPLE == EXAMPLE_NCL_11_LIGHTMAP
    out_light_uv = in_light_uv;
#endif
#if EXAMPLE == EXAMPLE_OGLPG_7_11
    // Pairs of materials are numbered by the application: by their fronts.
    out_material = 2u * in_material;
#elif EXAMPLE == EXAMPLE_OGLPG_7_10
    out_material = in_material;
#elif EXAMPLE == EXAMPLE_OGLPG_7_21 || EXAMPLE == EXAMPLE_HPG_5 || EXAMPLE == EXAMPLE_HPG_6_3X3 || EXAMPLE == EXAMPLE_HPG_6_5X5 || EXAMPLE == EXAMPLE_HPG_6_RANDOM || EXAMPLE == EXAMPLE_HPG_7 || EXAMPLE == EXAMPLE_IGL_2_SPOT || EXAMPLE == EXAMPLE_IGL_2_DIRECTIONAL
    out_in_light = shadow_coord(caster.clip_from_world, world);
#endif
#if EXAMPLE == EXAMPLE_OGLPG_7_1 || EXAMPLE == EXAMPLE_OGLPG_7_2 || EXAMPLE == EXAMPLE_OGLPG_7_3 || EXAMPLE == EXAMPLE_OGLPG_7_4 || EXAMPLE == EXAMPLE_OGLPG_7_5 || EXAMPLE == EXAMPLE_OGLPG_7_8 || EXAMPLE == EXAMPLE_OGLPG_7_10 || EXAMPLE == EXAMPLE_OGLPG_7_11
    // What the listing interpolates: positions and normals in view space.
    out_position = eye_point(world);
    out_normal = normalize(eye_direction(world_normal(in_normal)));
#elif EXAMPLE == EXAMPLE_OGLPG_7_6
    // The same, with the directions of the light. The listing subtracts the vertex as it is given, so
    // everything is in the space of the object.
    mat4 turned = object.normal_from_object;
    mat3 back = transpose(mat3(turned[0].xyz, turned[1].xyz, turned[2].xyz));
    vec3 light = back * (lamps.lights[0].light.position - object.world_from_object[3].xyz);
    vec3 offset = light - in_position;
    float d = length(offset);
    vec3 eye = back * (camera.world_from_view * vec4(view_infinite(), 0.0)).xyz;
    out_position = in_position;
    out_normal = normalize(in_normal);
    out_light_direction = offset / d;
    out_attenuation = polynomial(d, lamps.lights[0].light.attenuation);
    out_half_vector = normalize(out_light_direction + eye);
#elif EXAMPLE == EXAMPLE_OGLPG_7_12
    // The same, with the light of the two hemispheres. Their pole is the place of a lamp.
    out_position = eye_point(world);
    out_normal = normalize(eye_direction(world_normal(in_normal)));
    out_lit = hemisphere_oglpg(out_normal, out_position, eye_point(lamps.lights[0].light.position), surroundings.sky, surroundings.ground);
#elif EXAMPLE == EXAMPLE_OGLPG_7_13
    // The same, with the mirrored direction of the viewer.
    out_position = eye_point(world);
    out_normal = normalize(eye_direction(world_normal(in_normal)));
    out_mirrored = reflect(out_position, out_normal);
#elif EXAMPLE == EXAMPLE_OGLPG_7_14
    // The same, with the light of the nine coefficients.
    out_position = eye_point(world);
    out_normal = normalize(eye_direction(world_normal(in_normal)));
    out_lit = sh9_irradiance(out_normal, surroundings.sh) * surroundings.scale;
#elif EXAMPLE == EXAMPLE_OGLPG_7_21
    // The same, with the normal turned by model and view, and not normalised.
    out_position = eye_point(world);
    out_world = world;
    out_normal = eye_direction((object.world_from_object * vec4(in_normal, 0.0)).xyz);
#elif EXAMPLE == EXAMPLE_HPG_1_FRAGMENT || EXAMPLE == EXAMPLE_HPG_2 || EXAMPLE == EXAMPLE_HPG_3 || EXAMPLE == EXAMPLE_HPG_4 || EXAMPLE == EXAMPLE_HPG_5 || EXAMPLE == EXAMPLE_HPG_6_3X3 || EXAMPLE == EXAMPLE_HPG_6_5X5 || EXAMPLE == EXAMPLE_HPG_6_RANDOM || EXAMPLE == EXAMPLE_HPG_7
    // The same, with normals as the normal matrix makes them.
    out_position = eye_point(world);
    out_normal = eye_direction(world_normal(in_normal));
#elif EXAMPLE == EXAMPLE_HPG_1_VERTEX
    // The same, with the light of the lamp.
    out_position = eye_point(world);
    out_normal = normalize(eye_direction(world_normal(in_normal)));
    out_lit = near_lamp(out_normal, out_position, out_color.rgb);
#elif EXAMPLE == EXAMPLE_NCL_11_PHONG || EXAMPLE == EXAMPLE_NCL_11_LIGHTMAP || EXAMPLE == EXAMPLE_NCL_11_FURTHER_1 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_2 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_3 || EXAMPLE == EXAMPLE_NCL_11_FURTHER_4
    // Places and normals in the world.
    out_position = world;
    out_normal = normalize(world_normal(normalize(in_normal)));
#elif EXAMPLE == EXAMPLE_NCL_11_FLAT || EXAMPLE == EXAMPLE_NCL_11_GOURAUD
    // The same, with the light, of the corner or of the whole face.
    out_normal = normalize(world_normal(normalize(in_normal)));
#if EXAMPLE == EXAMPLE_NCL_11_FLAT
    out_position = world_point(in_middle);
#else
    out_position = world;
#endif
    // The light is linear in the colour of the surface: what a black one has is the highlight.
    Light lamp = lamps.lights[0].light;
    vec3 offset = lamp.position - out_position;
    vec3 l = normalize(offset);
    vec3 v = normalize(camera.world_from_view[3].xyz - out_position);
    float attenuation = linear_radius(length(offset), lamp.range);
    out_reflected = shade_ncl(vec3(0.0), lamp.color, out_normal, l, v, attenuation);
    out_scattered = shade_ncl(vec3(1.0), lamp.color, out_normal, l, v, attenuation) - out_reflected;
#else
    // The same, with the direction to the viewer.
    out_position = world;
    out_normal = normalize(world_normal(in_normal));
    out_view = normalize(camera.world_from_view[3].xyz - world);
#endif
}
