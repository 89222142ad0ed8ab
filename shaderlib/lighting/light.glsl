//! One light of any kind, and what arrives from it at a point.

#ifndef LAMPLIGHT_LIGHTING_LIGHT_GLSL
#define LAMPLIGHT_LIGHTING_LIGHT_GLSL

#include "attenuation.glsl"
#include "spot.glsl"
#include "../math/safe.glsl"

/// `Light.kind` of a light that is off.
const uint LIGHT_OFF = 0u;
/// `Light.kind` of a light with one direction everywhere.
const uint LIGHT_DIRECTIONAL = 1u;
/// `Light.kind` of a light that shines from a point.
const uint LIGHT_POINT = 2u;
/// `Light.kind` of a light that shines from a point into a cone.
const uint LIGHT_SPOT = 3u;

/// A light of any kind, 96 bytes, the same in uniform (std140) and storage buffers.
///
/// Positions and directions are all in one space of the caller's choice: the one the surface is given in.
struct Light {
    /// Linear colour times intensity, at least 0.
    vec3 color;
    /// `LIGHT_OFF`, `LIGHT_DIRECTIONAL`, `LIGHT_POINT` or `LIGHT_SPOT`.
    uint kind;
    /// Linear colour of the light's ambient part, at least 0.
    vec3 ambient;
    /// Reach in scene units, for the falloffs that have one; 0 means none.
    float range;
    /// Position in scene units; unused by a directional light.
    vec3 position;
    /// Exponent of the cone, at least 0.
    float exponent;
    /// Unit direction in which the light shines: away from the light.
    vec3 axis;
    /// Cosine of the half angle of a hard cone.
    float cutoff;
    /// Constant, linear and quadratic coefficients of the attenuation: 1, 1/unit, 1/unit^2.
    vec3 attenuation;
    /// Cosine of the half angle within which a smooth cone is fully lit.
    float inner;
    /// Cosine of the half angle beyond which a smooth cone is dark.
    float outer;
    /// Factor on the highlights of this light, at least 0; 1 leaves them as the material has them.
    float strength;
    /// How much of the light a shadow takes away, [0, 1].
    float shadow_strength;
    /// Layer of the light's shadow map, for callers that keep several; -1 means none.
    int shadow_layer;
};

/// What arrives from a light at a point; the factors stay apart for the caller to replace or combine.
struct LightSample {
    /// Unit vector from the point to the light; zero where there is none.
    vec3 l;
    /// Distance to the light in scene units; 0 for a directional light.
    float distance;
    /// Falloff with distance, 1 = none.
    float attenuation;
    /// Factor of the cone, [0, 1].
    float spot;
};

/// What arrives from a light of one direction.
LightSample sample_directional(Light light) {
    return LightSample(safe_normalize(-light.axis, vec3(0.0)), 0.0, 1.0, 1.0);
}

/// What arrives from a light at a position, with polynomial attenuation.
LightSample sample_point(Light light, vec3 p) {
    vec3 offset = light.position - p;
    float d = length(offset);
    return LightSample(safe_normalize(offset, vec3(0.0)), d, polynomial(d, light.attenuation), 1.0);
}

/// What arrives from a spot light, with polynomial attenuation and a power of the cosine.
LightSample sample_spot(Light light, vec3 p) {
    LightSample lit = sample_point(light, p);
    float cone = cone_exponent(dot(-lit.l, light.axis), light.cutoff, light.exponent);
    return LightSample(lit.l, lit.distance, lit.attenuation, cone);
}

/// What arrives from a light, whatever its kind.
LightSample sample_light(Light light, vec3 p) {
    if (light.kind == LIGHT_DIRECTIONAL) {
        return sample_directional(light);
    }
    if (light.kind == LIGHT_POINT) {
        return sample_point(light, p);
    }
    if (light.kind == LIGHT_SPOT) {
        return sample_spot(light, p);
    }
    return LightSample(vec3(0.0), 0.0, 0.0, 0.0);
}

#endif
