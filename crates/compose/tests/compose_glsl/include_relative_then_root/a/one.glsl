#include "two.glsl"
#include "common/top.glsl"
float one() { return 1.0; }
