#version 450
//! The fragment stage of `deferred`, which `deferred.wesl` describes.
//!
//! Made from `deferred.wesl` by `cargo xtask docs`: edit that, not this file.

#if LIGHTS != LIGHTS_NONE
#include "../ambient/occlusion.glsl"
#endif
#include "../ambient/octahedral.glsl"
#if LIGHTS != LIGHTS_NONE
#include "../lighting/classic.glsl"
#endif
#if LIGHTS != LIGHTS_NONE && AREA == AREA_RECTANGLE && SPECULAR == SPECULAR_GGX
#include "areas.glsl"
#endif
#include "forward.glsl"
#if LIGHTS != LIGHTS_NONE && METALLIC_ROUGHNESS || LIGHTS != LIGHTS_NONE && SPECULAR == SPECULAR_GGX && !METALLIC_ROUGHNESS
#include "layers.glsl"
#endif

layout(location = 0) in vec2 in_uv;

layout(location = 0) out vec4 out_color;

#if LIGHTS != LIGHTS_NONE
/// The viewer, for places on the screen.
layout(std140, set = 2, binding = 1) uniform Eye {
    /// The inverse of the matrix that the surfaces were drawn with.
    mat4 world_from_clip;
} eye;
#endif

layout(set = 2, binding = 2) uniform texture2D surface_color;
layout(set = 2, binding = 3) uniform texture2D surface_normal;
#if LIGHTS != LIGHTS_NONE
layout(set = 2, binding = 4) uniform texture2D surface_depth;
#endif
layout(set = 2, binding = 5) uniform sampler surface_sampler;
#if METALLIC_ROUGHNESS
layout(set = 2, binding = 6) uniform texture2D surface_factors;
#endif

#if OCCLUSION == OCCLUSION_SCREEN
/// The open share of the surroundings, [0, 1].
float open_share(vec2 pixel) {
    vec2 place = pixel / vec2(textureSize(sampler2D(seen_occlusion, open_sampler), 0));
    return textureLod(sampler2D(seen_occlusion, open_sampler), place, 0.0).x;
}
#endif

#if LIGHTS != LIGHTS_NONE
/// The colour of the surface.
vec3 shade(vec3 base, vec3 normal, uint material) {
    float depth = textureLod(sampler2D(surface_depth, surface_sampler), in_uv, 0.0).x;
    vec4 place = eye.world_from_clip * vec4(2.0 * in_uv.x - 1.0, 1.0 - 2.0 * in_uv.y, depth, 1.0);
    Surface surface = zero_surface();
    surface.position = place.xyz / place.w;
    surface.normal = normal;
#if SPECULAR != SPECULAR_NONE || DIFFUSE == DIFFUSE_OREN_NAYAR || AMBIENT == AMBIENT_IBL
    surface.view = towards_viewer(surface.position);
#endif
#if MATERIAL == MATERIAL_ARRAY && TWO_SIDED
    surface.material = materials.items[min(material, 27u)];
#elif MATERIAL == MATERIAL_ARRAY
    surface.material = materials.items[min(material, 13u)];
#else
    surface.material = materials.items[0];
#endif
#if METALLIC_ROUGHNESS
    vec4 factors = textureLod(sampler2D(surface_factors, surface_sampler), in_uv, 0.0);
    surface.material.roughness = factors.y;
    Factors own = plain_factors();
    own.metallic = factors.x;
    surface.layered = layered(base, factors.y, surface.normal, surface.view, own);
#endif
#if OCCLUSION == OCCLUSION_SCREEN
    float open = open_share(gl_FragCoord.xy);
#endif
#if OCCLUSION == OCCLUSION_SCREEN && METALLIC_ROUGHNESS
    surface.material.ambient *= multibounce(open, base);
#elif OCCLUSION == OCCLUSION_SCREEN
    surface.material.ambient *= multibounce(open, base * surface.material.diffuse);
#endif
#if CASCADES
    surface.visibility = cascaded_visibility(surface, gl_FragCoord.xy);
#elif SHADOW != SHADOW_NONE
    surface.visibility = visibility(surface, gl_FragCoord.xy);
#endif
#if CONTACT
    surface.visibility *= contact_visibility(gl_FragCoord.xy);
#endif
#if SPECULAR == SPECULAR_GGX && !METALLIC_ROUGHNESS
    surface.facets = facets_of(surface.normal, surface.view, surface.material.roughness);
#endif
#if AREA == AREA_RECTANGLE && SPECULAR == SPECULAR_GGX
    surface.lobe = table_lobe(dot(surface.normal, surface.view), surface.material.roughness);
#endif
    Accum sum = lit(surface);
#if METALLIC_ROUGHNESS
    sum.scattered *= surface.material.ambient;
#endif
#if OCCLUSION == OCCLUSION_SCREEN && AMBIENT == AMBIENT_IBL && !METALLIC_ROUGHNESS
    // The highlights of lamps are summed up, so only the mirrored environment loses by occlusion.
    surface.material.specular *= specular_occlusion(dot(surface.normal, surface.view), open, highlight_alpha(surface.material));
#endif
#if AMBIENT == AMBIENT_IBL && !METALLIC_ROUGHNESS
    sum = add_environment(sum, surface);
#endif
#if METALLIC_ROUGHNESS && AMBIENT == AMBIENT_CONSTANT
    return layered_even(surface.layered, sum.scattered, surface.material.emission) + sum.reflected;
#elif METALLIC_ROUGHNESS && OCCLUSION == OCCLUSION_SCREEN && AMBIENT == AMBIENT_IBL
    Around around = occluded(light_around(surface, sum.scattered), surface.layered, open);
    return layered_ambient(surface.layered, around, surface.material.emission) + sum.reflected;
#elif METALLIC_ROUGHNESS
    return layered_ambient(surface.layered, light_around(surface, sum.scattered), surface.material.emission) + sum.reflected;
#else
    return resolve(base, surface.material, sum);
#endif
}
#endif

void main() {
    vec4 packed_normal = textureLod(sampler2D(surface_normal, surface_sampler), in_uv, 0.0);
    if (packed_normal.a < 0.5) {
        discard;
    }
    vec4 base = textureLod(sampler2D(surface_color, surface_sampler), in_uv, 0.0);
    vec3 normal = octahedral_decode(2.0 * packed_normal.xy - 1.0);
#if LIGHTS == LIGHTS_NONE
    vec3 color = base.rgb * ambient_light(normal);
#else
    vec3 color = shade(base.rgb, normal, uint(clamp(255.0 * packed_normal.z + 0.5, 0.0, 4294967040.0)));
#endif
    out_color = vec4(color, base.a);
}
