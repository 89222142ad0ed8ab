#include "deep/math.glsl"
vec4 shade() { return vec4(safe(1.0)); }
