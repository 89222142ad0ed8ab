#version 450
//! The fragment stage of `gbuffer`. Bindings and locations are tabulated in gbuffer.wesl.
// Stage variables have prefixes: naga lets the members of a block hide globals of their names.

#include "../ambient/octahedral.glsl"
#include "../lighting/material.glsl"
#include "../math/safe.glsl"
#if METALLIC_ROUGHNESS
#include "forward/factors.glsl"
#include "forward/materials.glsl"
#endif
#include "../surface/normal.glsl"

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
    float roughness = materials.items[min(material, uint(MATERIALS - 1))].roughness;
#if METALLIC_ROUGHNESS_MAP
    vec4 texel = texture(sampler2D(metallic_roughness_map, map_sampler), in_uv);
    return vec2(layers.metallic * texel.z, roughness * texel.y);
#else
    return vec2(layers.metallic, roughness);
#endif
}
#endif

void main() {
    vec4 base = in_color;
#if BASE_MAP
    base *= texture(sampler2D(base_map, map_sampler), in_uv);
#endif
    vec3 normal = safe_normalize(in_normal, vec3(0.0));
#if TWO_SIDED
    normal = flip_if_back(normal, gl_FrontFacing);
#endif
#if NORMAL_MAP
    vec3 texel = texture(sampler2D(normal_map, map_sampler), in_uv).xyz;
    normal = perturb_normal(normal, in_tangent, texel);
#endif
#if TWO_SIDED
    float material = float(material_index(int(in_material), gl_FrontFacing));
#else
    float material = float(in_material);
#endif
    out_color = base;
    out_surface = vec4(0.5 + 0.5 * octahedral_encode(normal), material / 255.0, 1.0);
#if METALLIC_ROUGHNESS
    out_factors = vec4(metal_and_roughness(uint(material)), 0.0, 1.0);
#endif
}
