//! What the stages of `published` share, which `published.wesl` describes.
//!
//! Made from `published.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_PROGRAMS_PUBLISHED_GLSL
#define LAMPLIGHT_PROGRAMS_PUBLISHED_GLSL

#if EXAMPLE == EXAMPLE_HPG_1_VERTEX || EXAMPLE == EXAMPLE_HPG_1_FRAGMENT
#include "../brdf/diffuse.glsl"
#include "../brdf/specular.glsl"
#endif
#include "../lighting/light.glsl"
#include "../lighting/material.glsl"

/// A light with what the listings know of it beside the library's own numbers.
struct Lamp {
    /// Its `color` is that of the diffuse light.
    Light light;
    /// Linear colour of the light in highlights.
    vec3 specular;
    /// Unit, in the world: where a directional light has its highlight.
    vec3 half_vector;
};

/// The viewer.
layout(std140, set = 0, binding = 0) uniform Camera {
    mat4 clip_from_world;
    /// Its third column points behind the viewer, its fourth is the viewer's position.
    mat4 world_from_view;
} camera;

/// The lights, of which the first `count` shine.
layout(std140, set = 0, binding = 1) uniform Lamps {
    uint count;
#if EXAMPLE == EXAMPLE_OGLPG_7_8 || EXAMPLE == EXAMPLE_OGLPG_7_10 || EXAMPLE == EXAMPLE_OGLPG_7_11 || EXAMPLE == EXAMPLE_IGL_1_MULTIPLE
    Lamp lights[10];
#elif EXAMPLE == EXAMPLE_NCL_11_FURTHER_2
    Lamp lights[4];
#else
    Lamp lights[1];
#endif
} lamps;

/// Light from everywhere; the same as in `forward`.
layout(std140, set = 0, binding = 2) uniform Surroundings {
    /// `oglpg_7_2` to `oglpg_7_6`: ambient light.
    vec3 color;
    /// `oglpg_7_14`: factor.
    float scale;
    /// `oglpg_7_12`: the light from the side of the lamp.
    vec3 sky;
    /// `oglpg_7_13`: share of the diffuse environment, [0, 1].
    float diffuse_share;
    /// `oglpg_7_12`: the light from the other side.
    vec3 ground;
    /// `oglpg_7_13`: share of the specular environment, [0, 1].
    float specular_share;
    /// Not read.
    vec3 up;
    /// `oglpg_7_14`: L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
    vec3 sh[9];
} surroundings;

/// The light that casts the shadow, and how its map is read; the same as in `forward`.
layout(std140, set = 0, binding = 4) uniform Caster {
    mat4 clip_from_world;
    float near;
    float far;
    uint light;
    /// `hpg_*`: points whose w in the light's clip space is at most this are lit.
    float min_w;
    /// `igl_2_*`: subtracted from the depth that is compared.
    float bias;
    float normal_offset;
    float texel;
    float radius;
    vec2 exponents;
    /// `hpg_7`: least variance.
    float min_variance;
    float bleed;
    /// `hpg_7`: least visibility.
    float least;
    float light_size;
} caster;

/// Materials in one array: pairs of front and back with `oglpg_7_11`.
layout(std140, set = 1, binding = 0) uniform Materials {
#if EXAMPLE == EXAMPLE_OGLPG_7_11
    Material items[28];
#elif EXAMPLE == EXAMPLE_OGLPG_7_10
    Material items[14];
#else
    Material items[1];
#endif
} materials;

/// What is drawn.
layout(std140, set = 2, binding = 0) uniform Object {
    mat4 world_from_object;
    /// The inverse transpose of the former, for normals.
    mat4 normal_from_object;
    /// Multiplied with the vertex colours.
    vec4 color;
} object;

/// A direction of the world in view space.
vec3 eye_direction(vec3 direction) {
    mat3 axes = mat3(camera.world_from_view[0].xyz, camera.world_from_view[1].xyz, camera.world_from_view[2].xyz);
    return transpose(axes) * direction;
}

/// A point of the world in view space.
vec3 eye_point(vec3 point) {
    return eye_direction(point - camera.world_from_view[3].xyz);
}

/// A point of the object in the world.
vec3 world_point(vec3 point) {
    return (object.world_from_object * vec4(point, 1.0)).xyz;
}

#if EXAMPLE == EXAMPLE_HPG_1_VERTEX || EXAMPLE == EXAMPLE_HPG_1_FRAGMENT
/// The first recipe's light. The same numbers are a place in the space of each object, so each
/// object has the lamp at the same place beside it.
vec4 near_lamp(vec3 n, vec3 position, vec3 base) {
    vec3 l = normalize(eye_point(world_point(lamps.lights[0].light.position)) - position);
    vec3 v = normalize(-position);
    float specular = blinn_phong_hpg(n, l, v, materials.items[0].shininess);
    return lambert(n, l) * vec4(base, 1.0) + specular * vec4(materials.items[0].specular, 1.0);
}
#endif

#endif
