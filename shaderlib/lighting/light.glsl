//! One light of any kind, and what arrives from it at a point.
//!
//! Made from `light.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_LIGHTING_LIGHT_GLSL
#define LAMPLIGHT_LIGHTING_LIGHT_GLSL

#include "../math/safe.glsl"
#include "attenuation.glsl"
#include "spot.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

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
    /// Linear colour times intensity, at least 0. In the programs 1 gives a white matt surface the colour 1: illuminance over pi, so of a lamp of `c` candelas it is `c/pi` with a falloff by the squared distance, and of a sun of `x` lux `x/pi`.
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
///
/// Parameters: `light` the light: its `axis` is read.
/// Returns: `l` against the axis, distance 0, factors 1.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.3.
/// Edges: `l` is zero for a zero axis.
/// Error model: that of `normalize_or_zero` for `l`; exact for the rest.
LightSample sample_directional(Light light) {
    return LightSample(normalize_or_zero(-light.axis), 0.0, 1.0, 1.0);
}

/// What arrives from a light at a position, with polynomial attenuation.
///
/// For another falloff, replace `attenuation` with the result of a function of `lighting::attenuation` for `distance`.
///
/// Parameters: `light` the light: `position` and `attenuation` are read; `p` the lit point, scene units, in the light's space.
/// Returns: direction, distance, attenuation as `polynomial` gives it, cone factor 1.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.4.
/// Edges: `l` is zero at the light itself, where the example divides 0 by 0.
/// Error model: 6 ULP + absolute 2^-23 for `l`, 4 ULP for `distance`, 12 ULP for `attenuation`.
LightSample sample_point(Light light, vec3 p) {
    vec3 offset = light.position - p;
    float d2 = dot(offset, offset);
    float inverse_ = inversesqrt(max(d2, SMALLEST_NORMAL));
    float d = d2 * inverse_;
    return LightSample(offset * inverse_, d, polynomial(d, light.attenuation), 1.0);
}

/// What arrives from a spot light, with polynomial attenuation and a power of the cosine.
///
/// For another cone, replace `spot` with the result of a function of `lighting::spot` for `dot(-l, axis)`.
///
/// Parameters: `light` the light: `position`, `attenuation`, `axis`, `cutoff` and `exponent` are read; `p` the lit point, scene units, in the light's space.
/// Returns: as `sample_point`, with the cone factor of `cone_exponent`.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.5.
/// Edges: at the light itself, and for a zero `axis`, the cosine is 0.
/// Error model: that of `sample_point`; for the cone that of `cone_exponent` at a cosine with the error of `l`.
LightSample sample_spot(Light light, vec3 p) {
    LightSample lit = sample_point(light, p);
    float cone = cone_exponent(dot(-lit.l, light.axis), light.cutoff, light.exponent);
    return LightSample(lit.l, lit.distance, lit.attenuation, cone);
}

/// What arrives from a light, whatever its kind.
///
/// Parameters: `light` the light; `p` the lit point, scene units, in the light's space.
/// Returns: as `sample_directional`, `sample_point` or `sample_spot`.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, examples 7.7 and 7.8.
/// Edges: every member is 0 for a light that is off or of unknown kind.
/// Error model: that of the function chosen.
LightSample sample_light(Light light, vec3 p) {
    if (light.kind != LIGHT_DIRECTIONAL && light.kind != LIGHT_POINT && light.kind != LIGHT_SPOT) {
        return LightSample(vec3(0.0), 0.0, 0.0, 0.0);
    }
    // All kinds share the direction, which is most of the work.
    bool is_far = light.kind == LIGHT_DIRECTIONAL;
    vec3 offset = is_far ? -light.axis : light.position - p;
    float d2 = dot(offset, offset);
    float inverse_ = inversesqrt(max(d2, SMALLEST_NORMAL));
    vec3 l = offset * inverse_;
    float d = is_far ? 0.0 : d2 * inverse_;
    float attenuation = is_far ? 1.0 : polynomial(d, light.attenuation);
    float cone = cone_exponent(dot(-l, light.axis), light.cutoff, light.exponent);
    return LightSample(l, d, attenuation, light.kind == LIGHT_SPOT ? cone : 1.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
