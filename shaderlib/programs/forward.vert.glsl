#version 450
//! The vertex stage of `forward`, which `forward.wesl` describes.
//!
//! Made from `forward.wesl` by `cargo xtask docs`: edit that, not this file.

#if FREQUENCY == FREQUENCY_VERTEX
#include "../lighting/classic.glsl"
#include "../math/safe.glsl"
#endif
#if NORMAL_MAP || ANISOTROPY
#include "../surface/normal.glsl"
#endif
#include "forward.glsl"
#if FREQUENCY == FREQUENCY_VERTEX && SPECULAR == SPECULAR_GGX && !METALLIC_ROUGHNESS
#include "layers.glsl"
#endif

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_color;
#if BASE_MAP || NORMAL_MAP || MATERIAL_MAPS || OCCLUSION == OCCLUSION_MAP
layout(location = 3) in vec2 in_uv;
#endif
#if LIGHTMAP
layout(location = 4) in vec2 in_light_uv;
#endif
#if NORMAL_MAP || ANISOTROPY
layout(location = 5) in vec4 in_tangent;
#endif
#if MATERIAL == MATERIAL_ARRAY
layout(location = 6) in uint in_material;
#endif

layout(location = 0) out vec3 out_position;
#if FREQUENCY == FREQUENCY_FRAGMENT
layout(location = 1) out vec3 out_normal;
#elif FREQUENCY == FREQUENCY_FLAT
layout(location = 1) flat out vec3 out_normal;
#endif
layout(location = 2) out vec4 out_color;
#if BASE_MAP || NORMAL_MAP || MATERIAL_MAPS || OCCLUSION == OCCLUSION_MAP
layout(location = 3) out vec2 out_uv;
#endif
#if LIGHTMAP
layout(location = 4) out vec2 out_light_uv;
#endif
#if NORMAL_MAP || ANISOTROPY
layout(location = 5) out vec4 out_tangent;
#endif
#if MATERIAL == MATERIAL_ARRAY
layout(location = 6) flat out uint out_material;
#endif
#if FREQUENCY == FREQUENCY_VERTEX
layout(location = 7) out vec3 out_scattered;
layout(location = 8) out vec3 out_reflected;
#endif

/// What is drawn.
layout(std140, set = 2, binding = 0) uniform Object {
    /// It may mirror. Then fronts are clockwise, which the engine tells the rasteriser.
    mat4 world_from_object;
    /// The inverse transpose of the former, for normals.
    mat4 normal_from_object;
    /// Multiplied with the vertex colours.
    vec4 color;
} object;

void main() {
    vec4 position = object.world_from_object * vec4(in_position, 1.0);
    vec3 normal = (object.normal_from_object * vec4(in_normal, 0.0)).xyz;
    gl_Position = camera.clip_from_world * position;
    out_position = position.xyz;
#if FREQUENCY != FREQUENCY_VERTEX
    out_normal = normal;
#endif
    out_color = in_color * object.color;
#if BASE_MAP || NORMAL_MAP || MATERIAL_MAPS || OCCLUSION == OCCLUSION_MAP
    out_uv = in_uv;
#endif
#if LIGHTMAP
    out_light_uv = in_light_uv;
#endif
#if NORMAL_MAP || ANISOTROPY
    out_tangent = world_tangent(in_tangent, object.world_from_object);
#endif
#if MATERIAL == MATERIAL_ARRAY
    out_material = in_material;
#endif
#if FREQUENCY == FREQUENCY_VERTEX
    Surface surface = zero_surface();
    surface.position = position.xyz;
    surface.normal = normalize_or_zero(normal);
#if SPECULAR != SPECULAR_NONE || DIFFUSE == DIFFUSE_OREN_NAYAR
    surface.view = towards_viewer(position.xyz);
#endif
#if MATERIAL == MATERIAL_ARRAY
    surface.material = materials.items[in_material];
#else
    surface.material = materials.items[0];
#endif
#if SPECULAR == SPECULAR_GGX && !METALLIC_ROUGHNESS
    surface.facets = facets_of(surface.normal, surface.view, surface.material.roughness);
#endif
    Accum sum = lit(surface);
    out_scattered = sum.scattered;
    out_reflected = sum.reflected;
#endif
}
