//! Textures of a glTF surface, for `forward` with `material_maps`. Their channels are tabulated in
//! forward.wesl.

#ifndef LAMPLIGHT_PROGRAMS_FORWARD_MAPS_GLSL
#define LAMPLIGHT_PROGRAMS_FORWARD_MAPS_GLSL

#include "../../math/safe.glsl"
#include "../layers.glsl"

layout(set = 2, binding = 7) uniform texture2D metallic_roughness_map;
layout(set = 2, binding = 8) uniform texture2D emission_map;
layout(set = 2, binding = 9) uniform texture2D specular_map;
#if CLEARCOAT
layout(set = 2, binding = 1) uniform texture2D clearcoat_map;
#endif
#if SHEEN
layout(set = 2, binding = 2) uniform texture2D sheen_map;
#endif
#if IRIDESCENCE
layout(set = 2, binding = 3) uniform texture2D iridescence_map;
#endif
#if ANISOTROPY
layout(set = 2, binding = 4) uniform texture2D anisotropy_map;
#endif
#if TRANSMISSION || VOLUME
layout(set = 2, binding = 5) uniform texture2D transmission_map;
#endif
#if DIFFUSE_TRANSMISSION
layout(set = 2, binding = 6) uniform texture2D diffuse_transmission_map;
#endif

/// The factors, multiplied with the textures of the extensions.
Factors mapped_factors(Factors plain) {
    Factors own = plain;
    vec4 reflecting = texture(sampler2D(specular_map, map_sampler), in_uv);
    own.specular_color *= reflecting.rgb;
    own.specular *= reflecting.a;
#if CLEARCOAT
    vec4 coat = texture(sampler2D(clearcoat_map, map_sampler), in_uv);
    own.clearcoat *= coat.x;
    own.clearcoat_roughness *= coat.y;
#endif
#if SHEEN
    vec4 fibres = texture(sampler2D(sheen_map, map_sampler), in_uv);
    own.sheen_color *= fibres.rgb;
    own.sheen_roughness *= fibres.a;
#endif
#if IRIDESCENCE
    vec4 film = texture(sampler2D(iridescence_map, map_sampler), in_uv);
    own.iridescence *= film.x;
    own.iridescence_thickness = mix(layers.iridescence_least, own.iridescence_thickness, film.y);
#endif
#if ANISOTROPY
    vec4 brush = texture(sampler2D(anisotropy_map, map_sampler), in_uv);
    // The factor turns the direction of the texture.
    vec2 way = 2.0 * brush.xy - 1.0;
    vec2 turn = own.anisotropy_direction;
    vec3 turned = vec3(turn.x * way.x - turn.y * way.y, turn.y * way.x + turn.x * way.y, 0.0);
    own.anisotropy_direction = safe_normalize(turned, vec3(1.0, 0.0, 0.0)).xy;
    own.anisotropy *= brush.z;
#endif
#if TRANSMISSION || VOLUME
    vec4 passing = texture(sampler2D(transmission_map, map_sampler), in_uv);
#if TRANSMISSION
    own.transmission *= passing.x;
#endif
#if VOLUME
    own.thickness *= passing.y;
#endif
#endif
#if DIFFUSE_TRANSMISSION
    vec4 leaf = texture(sampler2D(diffuse_transmission_map, map_sampler), in_uv);
    own.diffuse_transmission_color *= leaf.rgb;
    own.diffuse_transmission *= leaf.a;
#endif
    return own;
}

#endif
