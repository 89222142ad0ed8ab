#version 450
//! The fragment stage of `forward`. Bindings and locations are tabulated in forward.wesl.
// Stage variables have prefixes: naga lets the members of a block hide globals of their names.

#include "../math/safe.glsl"
#include "forward/camera.glsl"

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
#elif OCCLUSION == OCCLUSION_SCREEN
layout(set = 1, binding = 7) uniform texture2D seen_occlusion;
#endif
#if OCCLUSION == OCCLUSION_SCREEN || CONTACT
layout(set = 1, binding = 8) uniform sampler open_sampler;
#endif

#if FOG != FOG_NONE
#include "../color/transfer.glsl"
#include "../fog/height.glsl"
#include "../fog/phase.glsl"

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

/// The colour of a point, faded with its distance from the viewer.
vec3 hazy(vec3 color, vec3 position) {
    vec3 eye = camera.world_from_view[3].xyz;
    float reach = distance(position, eye);
#if FOG == FOG_HEIGHT || FOG_SUN
    vec3 view = safe_normalize(position - eye, vec3(0.0));
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
#else
    float depth = fog_height(eye.y, view.y, reach, haze.density, haze.falloff, haze.base);
    return mix(air, color, fog_transmittance(depth));
#endif
}
#endif

#if CURVE != CURVE_NONE
#include "../color/tonemap.glsl"
#include "../color/transfer.glsl"

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
#else
    return uchimura(color);
#endif
}
#endif

#if LIGHTMAP
/// Light that was computed beforehand.
vec3 baked() {
    return texture(sampler2D(light_map, map_sampler), in_light_uv).rgb;
}
#endif

// Without lamps, ambient and baked light there is nothing to shade.
#define SHADES (LIGHTS != LIGHTS_NONE || AMBIENT != AMBIENT_NONE || LIGHTMAP)

#if !SHADES
#elif LIGHTS == LIGHTS_NONE
#include "forward/ambient.glsl"
#if AMBIENT == AMBIENT_IBL
#include "../ambient/ibl.glsl"
#include "forward/viewer.glsl"
#endif

/// The colour of the surface where no lamp shines.
vec3 shade(vec3 base) {
#if AMBIENT == AMBIENT_IBL
    vec3 n = safe_normalize(in_normal, vec3(0.0));
    vec3 mirrored = reflect(-towards_viewer(in_position), n);
    vec3 diffuse = texture(samplerCube(sky_diffuse, sky_sampler), n).rgb;
    vec3 specular = texture(samplerCube(sky_specular, sky_sampler), mirrored).rgb;
    return ibl_mix(base, diffuse, specular, surroundings.diffuse_share, surroundings.specular_share);
#elif AMBIENT != AMBIENT_NONE && LIGHTMAP
    return base * (ambient_light(safe_normalize(in_normal, vec3(0.0))) + baked());
#elif AMBIENT != AMBIENT_NONE
    return base * ambient_light(safe_normalize(in_normal, vec3(0.0)));
#else
    return base * baked();
#endif
}
#elif FREQUENCY == FREQUENCY_VERTEX
#include "../lighting/classic.glsl"
#include "forward/materials.glsl"

/// The colour of the surface, from the light summed up at the vertices.
vec3 shade(vec3 base) {
#if MATERIAL == MATERIAL_ARRAY
    Material material = materials.items[in_material];
#else
    Material material = materials.items[0];
#endif
    Accum sum = Accum(in_scattered, in_reflected);
#if LIGHTMAP
    sum.scattered += material.diffuse * baked();
#endif
    return resolve(base, material, sum);
}
#else
#include "../surface/normal.glsl"
#include "forward/lamps.glsl"
#include "forward/environment.glsl"
#if MATERIAL_MAPS
#include "forward/maps.glsl"
#endif

#if OCCLUSION != OCCLUSION_NONE
#include "../ambient/occlusion.glsl"

/// The open share of the surroundings, [0, 1].
float open_share() {
#if OCCLUSION == OCCLUSION_MAP
    return texture(sampler2D(occlusion_map, map_sampler), in_uv).x;
#else
    vec2 place = gl_FragCoord.xy / vec2(textureSize(sampler2D(seen_occlusion, open_sampler), 0));
    return textureLod(sampler2D(seen_occlusion, open_sampler), place, 0.0).x;
#endif
}
#endif

/// The colour of the surface.
vec3 shade(vec3 base) {
    Surface surface;
    surface.position = in_position;
    surface.normal = safe_normalize(in_normal, vec3(0.0));
#if TWO_SIDED
    surface.normal = flip_if_back(surface.normal, gl_FrontFacing);
#endif
#if CLEARCOAT
    vec3 coat_normal = surface.normal;
#endif
#if NORMAL_MAP
    vec3 texel = texture(sampler2D(normal_map, map_sampler), in_uv).xyz;
    surface.normal = perturb_normal(surface.normal, in_tangent, texel);
#endif
#if NEEDS_VIEW
    surface.view = towards_viewer(in_position);
#endif
#if MATERIAL == MATERIAL_ARRAY && TWO_SIDED
    surface.material = materials.items[material_index(int(in_material), gl_FrontFacing)];
#elif MATERIAL == MATERIAL_ARRAY
    surface.material = materials.items[in_material];
#else
    surface.material = materials.items[0];
#endif
#if METALLIC_ROUGHNESS
    Factors own = plain_factors();
#endif
#if MATERIAL_MAPS
    own = mapped_factors(own);
    vec4 rough_metal = texture(sampler2D(metallic_roughness_map, map_sampler), in_uv);
    own.metallic *= rough_metal.z;
    surface.material.roughness *= rough_metal.y;
    surface.material.emission *= texture(sampler2D(emission_map, map_sampler), in_uv).rgb;
#endif
#if OCCLUSION != OCCLUSION_NONE
    float open = open_share();
#if METALLIC_ROUGHNESS
    surface.material.ambient *= multibounce(open, base);
#else
    surface.material.ambient *= multibounce(open, base * surface.material.diffuse);
#endif
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
    surface.layered = brushed(surface.layered, in_tangent);
#endif
#if CLEARCOAT
    surface.layered = coated(surface.layered, coat_normal);
#endif
#if AREA == AREA_RECTANGLE && SPECULAR == SPECULAR_GGX
    surface.lobe = table_lobe(dot(surface.normal, surface.view), surface.material.roughness);
#endif
#if AREA == AREA_RECTANGLE && CLEARCOAT
    surface.coat_lobe = table_lobe(dot(coat_normal, surface.view), surface.layered.own.clearcoat_roughness);
#endif
    Accum sum = lit(surface);
#if LIGHTMAP && METALLIC_ROUGHNESS
    sum.scattered += baked();
#elif LIGHTMAP
    sum.scattered += surface.material.diffuse * baked();
#endif
#if METALLIC_ROUGHNESS
    Around around = light_around(surface, sum.scattered);
#if OCCLUSION != OCCLUSION_NONE && AMBIENT == AMBIENT_IBL
    around = occluded(around, surface.layered, open);
#endif
    return layered_ambient(surface.layered, around, surface.material.emission) + sum.reflected;
#else
#if OCCLUSION != OCCLUSION_NONE && AMBIENT == AMBIENT_IBL
    // The highlights of lamps are summed up, so only the mirrored environment loses by occlusion.
    float nv = dot(surface.normal, surface.view);
    surface.material.specular *= specular_occlusion(nv, open, highlight_alpha(surface.material));
#endif
#if AMBIENT == AMBIENT_IBL
    sum = add_environment(sum, surface);
#endif
    return resolve(base, surface.material, sum);
#endif
}
#endif

void main() {
    vec4 base = in_color;
#if BASE_MAP
    base *= texture(sampler2D(base_map, map_sampler), in_uv);
#endif
#if SHADES
    vec3 shaded = shade(base.rgb);
#else
    vec3 shaded = base.rgb;
#endif
#if FOG != FOG_NONE
    shaded = hazy(shaded, in_position);
#endif
#if CURVE != CURVE_NONE
    shaded = toned(shaded);
#endif
#if SATURATE
    shaded = saturate_color(shaded);
#endif
    out_color = vec4(shaded, base.a);
}
