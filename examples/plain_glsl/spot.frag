#version 450
#extension GL_GOOGLE_include_directive : require

#include "lamplight/brdf/diffuse.glsl"
#include "lamplight/lighting/attenuation.glsl"
#include "lamplight/lighting/spot.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 color;

layout(set = 0, binding = 0) uniform Spot {
    vec3 place;
    float cutoff;
    vec3 axis;
    float exponent;
} spot;

void main() {
    vec3 to_light = spot.place - position;
    float d = length(to_light);
    vec3 l = to_light / d;
    float cone = cone_exponent(dot(-l, spot.axis), spot.cutoff, spot.exponent);
    float falloff = polynomial(d, vec3(1.0, 0.0, 0.1));
    color = vec4(vec3(lambert(normalize(normal), l) * cone * falloff), 1.0);
}
