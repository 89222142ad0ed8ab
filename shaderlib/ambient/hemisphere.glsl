//! Ambient light from a sky above and a ground below.

#ifndef LAMPLIGHT_AMBIENT_HEMISPHERE_GLSL
#define LAMPLIGHT_AMBIENT_HEMISPHERE_GLSL

/// The share of the sky in the light a tilted surface receives.
float hemisphere_weight(vec3 n, vec3 up) {
    return 0.5 + 0.5 * dot(n, up);
}

/// The share of the sky in the form the book calls analytic.
float hemisphere_weight_sine(vec3 n, vec3 up) {
    float half_sine = 0.5 * length(cross(n, up));
    return dot(n, up) >= 0.0 ? 1.0 - half_sine : half_sine;
}

/// Ambient light from sky and ground.
vec3 hemisphere(vec3 n, vec3 up, vec3 sky, vec3 ground) {
    return mix(ground, sky, hemisphere_weight(n, up));
}

/// Ambient light from sky and ground, with the direction to a light as the pole.
vec3 hemisphere_oglpg(vec3 n, vec3 p, vec3 light, vec3 sky, vec3 ground) {
    return mix(ground, sky, 0.5 + 0.5 * dot(n, normalize(light - p)));
}

#endif
