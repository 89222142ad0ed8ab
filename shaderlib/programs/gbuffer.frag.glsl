#version 450
//! The fragment stage of `gbuffer`. Bindings and locations are tabulated in gbuffer.wesl.
// Stage variables have prefixes: naga lets the members of a block hide globals of their names.

#include "../ambient/octahedral.glsl"
#include "../lighting/material.glsl"
#include "../math/safe.glsl"
#include "../surface/normal.glsl"

layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_color;
#if BASE_MAP || NORMAL_MAP
layout(location = 3) in vec2 in_uv;
#endif
#if NORMAL_MAP
layout(location = 5) in vec4 in_tangent;
#endif
layout(location = 6) flat in uint in_material;

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_surface;

#if BASE_MAP
layout(set = 1, binding = 1) uniform texture2D base_map;
#endif
#if NORMAL_MAP
layout(set = 1, binding = 2) uniform texture2D normal_map;
#endif
#if BASE_MAP || NORMAL_MAP
layout(set = 1, binding = 4) uniform sampler map_sampler;
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
}
