//! The environment maps of `forward`, added to the light of its lamps.

#ifndef LAMPLIGHT_PROGRAMS_FORWARD_ENVIRONMENT_GLSL
#define LAMPLIGHT_PROGRAMS_FORWARD_ENVIRONMENT_GLSL

#include "lamps.glsl"

#if AMBIENT == AMBIENT_IBL
/// The sums with the light of the environment maps.
Accum add_environment(Accum sum, Surface surface) {
    vec3 diffuse = texture(samplerCube(sky_diffuse, sky_sampler), surface.normal).rgb;
    vec3 specular = texture(samplerCube(sky_specular, sky_sampler), reflect(-surface.view, surface.normal)).rgb;
    return Accum(
        sum.scattered + surface.material.ambient * diffuse * surroundings.diffuse_share,
        sum.reflected + surface.material.specular * specular * surroundings.specular_share
    );
}
#endif

#endif
