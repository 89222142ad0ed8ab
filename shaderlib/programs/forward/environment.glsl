//! The environment maps of `forward`, added to the light of its lamps.

#ifndef LAMPLIGHT_PROGRAMS_FORWARD_ENVIRONMENT_GLSL
#define LAMPLIGHT_PROGRAMS_FORWARD_ENVIRONMENT_GLSL

#include "lamps.glsl"

#if BOX_PROJECTION
#include "../../ambient/ibl.glsl"

/// The walls that the specular environment shows, as a box along the axes of the world.
layout(std140, set = 0, binding = 15) uniform Room {
    vec3 low;
    vec3 high;
    /// Where the environment was seen from.
    vec3 centre;
} room;

/// Where the environment has what is seen from a point in a direction.
vec3 towards_wall(Surface surface, vec3 direction) {
    return box_project(direction, surface.position, room.low, room.high, room.centre);
}
#endif

#if METALLIC_ROUGHNESS
#include "../../ambient/ibl.glsl"
#if OCCLUSION != OCCLUSION_NONE
#include "../../ambient/occlusion.glsl"
#endif

#if AMBIENT != AMBIENT_NONE && AMBIENT != AMBIENT_CONSTANT
/// The light of the surroundings on a side of the surface.
vec3 surrounding_light(Surface surface, vec3 normal) {
#if AMBIENT == AMBIENT_IBL
    vec3 light = texture(samplerCube(sky_diffuse, sky_sampler), normal).rgb * surroundings.diffuse_share;
#elif AMBIENT == AMBIENT_DDGI
    vec3 light = probe_irradiance(surface.position, normal);
#else
    vec3 light = ambient_light(normal);
#endif
    return surface.material.ambient * light;
}

/// The light of the surroundings from a direction, blurred by a roughness if they have that.
vec3 seen_light(Surface surface, vec3 direction, float roughness) {
#if AMBIENT == AMBIENT_IBL
    float level = prefilter_lod(roughness, layers.sky_levels);
#if BOX_PROJECTION
    direction = towards_wall(surface, direction);
#endif
    return textureLod(samplerCube(sky_specular, sky_sampler), direction, level).rgb * surroundings.specular_share;
#else
    return surrounding_light(surface, direction);
#endif
}

#if TRANSMISSION
/// The light of the surroundings that is seen through the surface.
vec3 light_through(Surface surface) {
    mat3 directions = through_directions(surface.layered);
    float roughness = through_roughness(surface.layered);
#if DISPERSION
    return vec3(
        seen_light(surface, directions[0], roughness).x,
        seen_light(surface, directions[1], roughness).y,
        seen_light(surface, directions[2], roughness).z
    );
#else
    return seen_light(surface, directions[1], roughness);
#endif
}
#endif
#endif

/// The light around a layered surface. `scattered` is what falls onto the viewer's side of it
/// without that of the environment maps.
Around light_around(Surface surface, vec3 scattered) {
    Around around;
#if AMBIENT == AMBIENT_IBL
    around.front = scattered + surrounding_light(surface, surface.normal);
#else
    around.front = scattered;
#endif
#if AMBIENT == AMBIENT_NONE || AMBIENT == AMBIENT_CONSTANT
#if AMBIENT == AMBIENT_NONE
    // What was computed beforehand has no direction.
    vec3 everywhere = vec3(0.0);
#else
    vec3 everywhere = scattered;
#endif
    around.mirrored = everywhere;
#if DIFFUSE_TRANSMISSION
    around.back = everywhere;
#endif
#if CLEARCOAT
    around.coated = everywhere;
#endif
#if TRANSMISSION
    around.through = everywhere;
#endif
#else
    around.mirrored = seen_light(surface, mirrored_direction(surface.layered), surface.layered.roughness);
#if DIFFUSE_TRANSMISSION
    around.back = surrounding_light(surface, -surface.normal);
#endif
#if CLEARCOAT
    vec3 mirrored = reflect(-surface.view, surface.layered.coat_normal);
    around.coated = seen_light(surface, mirrored, surface.layered.own.clearcoat_roughness);
#endif
#if TRANSMISSION
    around.through = light_through(surface);
#endif
#endif
    return around;
}

#if OCCLUSION != OCCLUSION_NONE
/// The light around a layered surface without what is hidden of the mirrored environment. What falls
/// onto its front has lost that already, by the share of ambient light of its material.
Around occluded(Around around, Layered at, float open) {
    Around seen = around;
    seen.mirrored *= specular_occlusion(dot(at.normal, at.view), open, at.roughness * at.roughness);
#if CLEARCOAT
    float rough = at.own.clearcoat_roughness;
    seen.coated *= specular_occlusion(dot(at.coat_normal, at.view), open, rough * rough);
#endif
    return seen;
}
#endif
#elif AMBIENT == AMBIENT_IBL
#if OCCLUSION != OCCLUSION_NONE
/// The squared roughness of the highlight, for how wide it mirrors the surroundings.
float highlight_alpha(Material material) {
#if SPECULAR == SPECULAR_GGX
    return material.roughness * material.roughness;
#else
    // The width of the lobe of Blinn and Phong.
    return sqrt(2.0 / (max(material.shininess, 0.0) + 2.0));
#endif
}
#endif

/// The sums with the light of the environment maps.
Accum add_environment(Accum sum, Surface surface) {
    vec3 diffuse = texture(samplerCube(sky_diffuse, sky_sampler), surface.normal).rgb;
#if BOX_PROJECTION
    vec3 mirrored = towards_wall(surface, reflect(-surface.view, surface.normal));
    vec3 specular = texture(samplerCube(sky_specular, sky_sampler), mirrored).rgb;
#else
    vec3 specular = texture(samplerCube(sky_specular, sky_sampler), reflect(-surface.view, surface.normal)).rgb;
#endif
    return Accum(
        sum.scattered + surface.material.ambient * diffuse * surroundings.diffuse_share,
        sum.reflected + surface.material.specular * specular * surroundings.specular_share
    );
}
#endif

#endif
