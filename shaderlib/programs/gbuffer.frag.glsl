#version 450
//! The fragment stage of `gbuffer`, which `gbuffer.wesl` describes.
//!
//! Made from `gbuffer.wesl` by `cargo xtask docs`: edit that, not this file.

#include "../ambient/octahedral.glsl"
#if METALLIC_ROUGHNESS && !TWO_SIDED || TWO_SIDED
#include "../lighting/material.glsl"
#endif
#include "../math/safe.glsl"
#if TWO_SIDED || NORMAL_MAP
#include "../surface/normal.glsl"
#endif
#if METALLIC_ROUGHNESS
#include "layers.glsl"
#endif

layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_color;
#if BASE_MAP || NORMAL_MAP || METALLIC_ROUGHNESS_MAP
layout(location = 3) in vec2 in_uv;
#endif
#if NORMAL_MAP
layout(location = 5) in vec4 in_tangent;
#endif
layout(location = 6) flat in uint in_material;

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_surface;
#if METALLIC_ROUGHNESS
layout(location = 2) out vec4 out_factors;
#endif

#if METALLIC_ROUGHNESS
/// Materials in one array: pairs of front and back with `two_sided`.
layout(std140, set = 1, binding = 0) uniform Materials {
#if TWO_SIDED
    Material items[28];
#else
    Material items[14];
#endif
} materials;
#endif

#if BASE_MAP
layout(set = 1, binding = 1) uniform texture2D base_map;
#endif
#if NORMAL_MAP
layout(set = 1, binding = 2) uniform texture2D normal_map;
#endif
#if BASE_MAP || NORMAL_MAP || METALLIC_ROUGHNESS_MAP
layout(set = 1, binding = 4) uniform sampler map_sampler;
#endif
#if METALLIC_ROUGHNESS_MAP
layout(set = 2, binding = 7) uniform texture2D metallic_roughness_map;
#endif

#if METALLIC_ROUGHNESS
/// The share of metal and the perceptual roughness, as `forward` has them.
vec2 metal_and_roughness(uint material) {
#if TWO_SIDED
    float roughness = materials.items[min(material, 27u)].roughness;
#else
    float roughness = materials.items[min(material, 13u)].roughness;
#endif
#if !METALLIC_ROUGHNESS_MAP
    return vec2(layers.metallic, roughness);
#else
    vec4 texel = texture(sampler2D(metallic_roughness_map, map_sampler), in_uv);
    return vec2(layers.metallic * texel.z, roughness * texel.y);
#endif
}
#endif

void main() {
#if BASE_MAP
    vec4 base = in_color * texture(sampler2D(base_map, map_sampler), in_uv);
#else
    vec4 base = in_color;
#endif
    vec3 normal = normalize_or_zero(in_normal);
#if TWO_SIDED
    normal = flip_if_back(normal, gl_FrontFacing);
#endif
#if TWO_SIDED && NORMAL_MAP
    // Behind, the tangent and, by its sign, the bitangent turn with the normal, as in `forward`.
    vec4 tangent = gl_FrontFacing ? in_tangent : -in_tangent;
#elif NORMAL_MAP
    vec4 tangent = in_tangent;
#endif
#if NORMAL_MAP
    normal = perturb_normal(normal, tangent, texture(sampler2D(normal_map, map_sampler), in_uv).xyz);
#endif
#if TWO_SIDED
    float material = float(material_index(int(in_material), gl_FrontFacing));
#else
    float material = float(in_material);
#endif
#if !METALLIC_ROUGHNESS
    out_color = base;
    out_surface = vec4(0.5 + 0.5 * octahedral_encode(normal), material / 255.0, 1.0);
#else
    vec4 surface = vec4(0.5 + 0.5 * octahedral_encode(normal), material / 255.0, 1.0);
    out_color = base;
    out_surface = surface;
    out_factors = vec4(metal_and_roughness(uint(clamp(material, 0.0, 4294967040.0))), 0.0, 1.0);
#endif
}
