#version 450
//! The fragment stage of `forward`, which `forward.wesl` describes.
//!
//! Made from `forward.wesl` by `cargo xtask docs`: edit that, not this file.

#if LIGHTS == LIGHTS_NONE && AMBIENT == AMBIENT_IBL
#include "../ambient/ibl.glsl"
#endif
#if FREQUENCY != FREQUENCY_VERTEX && LIGHTS != LIGHTS_NONE
#include "../ambient/occlusion.glsl"
#endif
#if CURVE != CURVE_NONE
#include "../color/tonemap.glsl"
#endif
#if FOG == FOG_LINEAR || FOG == FOG_EXP2 || CURVE == CURVE_REINHARD || CURVE == CURVE_ACES
#include "../color/transfer.glsl"
#endif
#if FOG == FOG_HEIGHT
#include "../fog/height.glsl"
#endif
#if FOG != FOG_NONE && FOG_SUN
#include "../fog/phase.glsl"
#endif
#include "../lighting/classic.glsl"
#include "../lighting/material.glsl"
#include "../math/safe.glsl"
#if FREQUENCY != FREQUENCY_VERTEX && LIGHTS != LIGHTS_NONE
#include "../surface/normal.glsl"
#include "areas.glsl"
#endif
#include "forward.glsl"
#if MATERIAL_MAPS || FREQUENCY != FREQUENCY_VERTEX && LIGHTS != LIGHTS_NONE
#include "layers.glsl"
#endif

layout(location = 0) in vec3 in_position;
#if FREQUENCY == FREQUENCY_FRAGMENT
layout(location = 1) in vec3 in_normal;
#elif FREQUENCY == FREQUENCY_FLAT
layout(location = 1) flat in vec3 in_normal;
#endif
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
layout(location = 6) flat in uint in_material;
#endif
#if FREQUENCY == FREQUENCY_VERTEX
layout(location = 7) in vec3 in_scattered;
layout(location = 8) in vec3 in_reflected;
#endif

layout(location = 0) out vec4 out_color;

#if FOG != FOG_NONE
/// The fog that colours fade into with distance.
layout(std140, set = 0, binding = 3) uniform Haze {
    vec3 color;
    /// `exp2`, `height`: per scene unit.
    float density;
    /// `linear`: distances at which the fog begins and at which it hides everything, in scene units.
    float start;
    float end;
    /// `height`: where the fog has its density, y in the world.
    float base;
    /// `height`: how fast it thins above, per scene unit.
    float falloff;
    /// `fog_sun`: the sun's light on a surface across its direction, times the share that fog scatters.
    vec3 sun;
    /// `fog_sun`: mean cosine of the angle by which fog turns light, (-1, 1).
    float forwardness;
    /// `fog_sun`: unit, in the world.
    vec3 to_sun;
} haze;
#endif

#if BASE_MAP
layout(set = 1, binding = 1) uniform texture2D base_map;
#endif
#if NORMAL_MAP
layout(set = 1, binding = 2) uniform texture2D normal_map;
#endif
#if LIGHTMAP
layout(set = 1, binding = 3) uniform texture2D light_map;
#endif
#if BASE_MAP || NORMAL_MAP || LIGHTMAP || MATERIAL_MAPS || OCCLUSION == OCCLUSION_MAP
layout(set = 1, binding = 4) uniform sampler map_sampler;
#endif
#if OCCLUSION == OCCLUSION_MAP
layout(set = 1, binding = 6) uniform texture2D occlusion_map;
#endif
#if MATERIAL_MAPS
layout(set = 2, binding = 7) uniform texture2D metallic_roughness_map;
layout(set = 2, binding = 8) uniform texture2D emission_map;
layout(set = 2, binding = 9) uniform texture2D specular_map;
#endif
#if MATERIAL_MAPS && CLEARCOAT
layout(set = 2, binding = 1) uniform texture2D clearcoat_map;
#endif
#if MATERIAL_MAPS && SHEEN
layout(set = 2, binding = 2) uniform texture2D sheen_map;
#endif
#if MATERIAL_MAPS && IRIDESCENCE
layout(set = 2, binding = 3) uniform texture2D iridescence_map;
#endif
#if MATERIAL_MAPS && ANISOTROPY
layout(set = 2, binding = 4) uniform texture2D anisotropy_map;
#endif
#if MATERIAL_MAPS && (TRANSMISSION || VOLUME)
layout(set = 2, binding = 5) uniform texture2D transmission_map;
#endif
#if MATERIAL_MAPS && DIFFUSE_TRANSMISSION
layout(set = 2, binding = 6) uniform texture2D diffuse_transmission_map;
#endif

#if FOG != FOG_NONE
/// The colour of a point, faded with its distance from the viewer.
vec3 hazy(vec3 color, vec3 position) {
    vec3 eye = camera.world_from_view[3].xyz;
    float reach = distance(position, eye);
#if FOG == FOG_HEIGHT || FOG_SUN
    vec3 view = normalize_or_zero(position - eye);
#endif
#if FOG_SUN
    vec3 air = haze.color + haze.sun * hg(dot(haze.to_sun, view), haze.forwardness);
#else
    vec3 air = haze.color;
#endif
#if FOG == FOG_LINEAR
    return mix(air, color, fog_linear(reach, haze.start, haze.end));
#elif FOG == FOG_EXP2
    return mix(air, color, fog_exp2(reach, haze.density));
#elif FOG == FOG_HEIGHT
    float depth = fog_height(eye.y, view.y, reach, haze.density, haze.falloff, haze.base);
    return mix(air, color, fog_transmittance(depth));
#endif
}
#endif

#if CURVE != CURVE_NONE
/// What the display should show of the light: linear, [0, 1].
vec3 toned(vec3 color) {
#if CURVE == CURVE_REINHARD
    return tonemap_reinhard(color);
#elif CURVE == CURVE_ACES
    return tonemap_aces(color);
#elif CURVE == CURVE_ACES_HILL
    return aces_hill(color);
#elif CURVE == CURVE_AGX
    return agx(color);
#elif CURVE == CURVE_HABLE
    return hable(color);
#elif CURVE == CURVE_NEUTRAL
    return neutral(color);
#elif CURVE == CURVE_UCHIMURA
    return uchimura(color);
#endif
}
#endif

#if MATERIAL_MAPS
/// The factors, multiplied with the textures of the extensions.
Factors mapped_factors(Factors plain, vec2 uv) {
    Factors own = plain;
    vec4 reflecting = texture(sampler2D(specular_map, map_sampler), uv);
    own.specular_color *= reflecting.rgb;
    own.specular *= reflecting.a;
#if CLEARCOAT
    vec4 coat = texture(sampler2D(clearcoat_map, map_sampler), uv);
    own.clearcoat *= coat.x;
    own.clearcoat_roughness *= coat.y;
#endif
#if SHEEN
    vec4 fibres = texture(sampler2D(sheen_map, map_sampler), uv);
    own.sheen_color *= fibres.rgb;
    own.sheen_roughness *= fibres.a;
#endif
#if IRIDESCENCE
    vec4 film = texture(sampler2D(iridescence_map, map_sampler), uv);
    own.iridescence *= film.x;
    own.iridescence_thickness = mix(layers.iridescence_least, own.iridescence_thickness, film.y);
#endif
#if ANISOTROPY
    vec4 brush = texture(sampler2D(anisotropy_map, map_sampler), uv);
    // The factor turns the direction of the texture.
    vec2 way = 2.0 * brush.xy - 1.0;
    vec2 turn = own.anisotropy_direction;
    vec3 turned = vec3(turn.x * way.x - turn.y * way.y, turn.y * way.x + turn.x * way.y, 0.0);
    own.anisotropy_direction = safe_normalize(turned, vec3(1.0, 0.0, 0.0)).xy;
    own.anisotropy *= brush.z;
#endif
#if TRANSMISSION || VOLUME
    vec4 passing = texture(sampler2D(transmission_map, map_sampler), uv);
#if TRANSMISSION
    own.transmission *= passing.x;
#endif
#if VOLUME
    own.thickness *= passing.y;
#endif
#endif
#if DIFFUSE_TRANSMISSION
    vec4 leaf = texture(sampler2D(diffuse_transmission_map, map_sampler), uv);
    own.diffuse_transmission_color *= leaf.rgb;
    own.diffuse_transmission *= leaf.a;
#endif
    return own;
}
#endif

#if OCCLUSION == OCCLUSION_MAP
/// The open share of the surroundings, [0, 1].
float open_share() {
    return texture(sampler2D(occlusion_map, map_sampler), in_uv).x;
}
#elif OCCLUSION == OCCLUSION_SCREEN
float open_share() {
    vec2 place = gl_FragCoord.xy / vec2(textureSize(sampler2D(seen_occlusion, open_sampler), 0));
    return textureLod(sampler2D(seen_occlusion, open_sampler), place, 0.0).x;
}
#endif

#if LIGHTMAP
/// Light that was computed beforehand.
vec3 baked(vec2 uv) {
    return texture(sampler2D(light_map, map_sampler), uv).rgb;
}
#endif

#if LIGHTS == LIGHTS_NONE && AMBIENT == AMBIENT_IBL
/// The colour of the surface where no lamp shines.
vec3 shade(vec3 base) {
    vec3 normal = normalize_or_zero(in_normal);
    vec3 mirrored = reflect(-towards_viewer(in_position), normal);
    vec3 diffuse = texture(samplerCube(sky_diffuse, sky_sampler), normal).rgb;
    vec3 specular = texture(samplerCube(sky_specular, sky_sampler), mirrored).rgb;
    return ibl_mix(base, diffuse, specular, surroundings.diffuse_share, surroundings.specular_share);
}
#elif LIGHTS == LIGHTS_NONE && (AMBIENT != AMBIENT_NONE || LIGHTMAP)
vec3 shade(vec3 base) {
#if AMBIENT == AMBIENT_NONE
    vec3 light = baked(in_light_uv);
#elif LIGHTMAP
    vec3 light = ambient_light(normalize_or_zero(in_normal)) + baked(in_light_uv);
#else
    vec3 light = ambient_light(normalize_or_zero(in_normal));
#endif
    return base * light;
}
#elif FREQUENCY == FREQUENCY_VERTEX
/// The colour of the surface, from the light summed up at the vertices.
vec3 shade(vec3 base) {
#if MATERIAL == MATERIAL_ARRAY
    Material material = materials.items[in_material];
#else
    Material material = materials.items[0];
#endif
    Accum sum = Accum(in_scattered, in_reflected);
#if LIGHTMAP
    sum.scattered += material.diffuse * baked(in_light_uv);
#endif
    return resolve(base, material, sum);
}
#elif LIGHTS != LIGHTS_NONE
/// The colour of the surface.
vec3 shade(
    vec3 base
#if TWO_SIDED
    , bool front
#endif
) {
    Surface surface = zero_surface();
    surface.position = in_position;
    surface.normal = normalize_or_zero(in_normal);
#if TWO_SIDED
    surface.normal = flip_if_back(surface.normal, front);
#endif
#if TWO_SIDED && (NORMAL_MAP || ANISOTROPY)
    // Behind, the normal that a map bends is the opposite of that in front, as in Khronos Group's glTF
    // Sample Renderer: the tangent and, by its sign, the bitangent turn with the normal.
    vec4 tangent = front ? in_tangent : -in_tangent;
#elif NORMAL_MAP || ANISOTROPY
    vec4 tangent = in_tangent;
#endif
#if CLEARCOAT
    vec3 coat_normal = surface.normal;
#endif
#if NORMAL_MAP
    surface.normal = perturb_normal(surface.normal, tangent, texture(sampler2D(normal_map, map_sampler), in_uv).xyz);
#endif
#if SPECULAR != SPECULAR_NONE || DIFFUSE == DIFFUSE_OREN_NAYAR || AMBIENT == AMBIENT_IBL
    surface.view = towards_viewer(in_position);
#endif
#if MATERIAL == MATERIAL_ARRAY && TWO_SIDED
    surface.material = materials.items[material_index(int(in_material), front)];
#elif MATERIAL == MATERIAL_ARRAY
    surface.material = materials.items[in_material];
#else
    surface.material = materials.items[0];
#endif
#if METALLIC_ROUGHNESS
    Factors own = plain_factors();
#endif
#if MATERIAL_MAPS
    own = mapped_factors(own, in_uv);
    vec4 rough_metal = texture(sampler2D(metallic_roughness_map, map_sampler), in_uv);
    own.metallic *= rough_metal.z;
    surface.material.roughness *= rough_metal.y;
    surface.material.emission *= texture(sampler2D(emission_map, map_sampler), in_uv).rgb;
#endif
#if OCCLUSION != OCCLUSION_NONE
    float open = open_share();
#endif
#if OCCLUSION != OCCLUSION_NONE && METALLIC_ROUGHNESS
    surface.material.ambient *= multibounce(open, base);
#elif OCCLUSION != OCCLUSION_NONE
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
#if METALLIC_ROUGHNESS
    surface.layered = layered(base, surface.material.roughness, surface.normal, surface.view, own);
#endif
#if ANISOTROPY
    surface.layered = brushed(surface.layered, tangent);
#endif
#if CLEARCOAT
    surface.layered = coated(surface.layered, coat_normal);
#endif
#if SPECULAR == SPECULAR_GGX && !METALLIC_ROUGHNESS
    surface.facets = facets_of(surface.normal, surface.view, surface.material.roughness);
#endif
#if AREA == AREA_RECTANGLE && SPECULAR == SPECULAR_GGX
    surface.lobe = table_lobe(dot(surface.normal, surface.view), surface.material.roughness);
#endif
#if AREA == AREA_RECTANGLE && CLEARCOAT
    surface.coat_lobe = table_lobe(dot(coat_normal, surface.view), surface.layered.own.clearcoat_roughness);
#endif
    Accum sum = lit(surface);
#if METALLIC_ROUGHNESS
    sum.scattered *= surface.material.ambient;
#endif
#if LIGHTMAP && METALLIC_ROUGHNESS
    sum.scattered += baked(in_light_uv);
#elif LIGHTMAP
    sum.scattered += surface.material.diffuse * baked(in_light_uv);
#endif
#if OCCLUSION != OCCLUSION_NONE && AMBIENT == AMBIENT_IBL && !METALLIC_ROUGHNESS
    // The highlights of lamps are summed up, so only the mirrored environment loses by occlusion.
    surface.material.specular *= specular_occlusion(dot(surface.normal, surface.view), open, highlight_alpha(surface.material));
#endif
#if AMBIENT == AMBIENT_IBL && !METALLIC_ROUGHNESS
    sum = add_environment(sum, surface);
#endif
#if METALLIC_ROUGHNESS && AMBIENT == AMBIENT_CONSTANT
    return layered_even(surface.layered, sum.scattered, surface.material.emission) + sum.reflected;
#elif METALLIC_ROUGHNESS && OCCLUSION != OCCLUSION_NONE && AMBIENT == AMBIENT_IBL
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
#if BASE_MAP
    vec4 base = in_color * texture(sampler2D(base_map, map_sampler), in_uv);
#else
    vec4 base = in_color;
#endif
#if LIGHTS == LIGHTS_NONE && AMBIENT == AMBIENT_NONE && !LIGHTMAP
    vec3 color = base.rgb;
#elif TWO_SIDED
    vec3 color = shade(base.rgb, gl_FrontFacing);
#else
    vec3 color = shade(base.rgb);
#endif
#if FOG != FOG_NONE
    color = hazy(color, in_position);
#endif
#if CURVE != CURVE_NONE
    color = toned(color);
#endif
#if ALPHA_TEST
    if (base.a < 0.5) {
        discard;
    }
#endif
    out_color = vec4(color, base.a);
}
