#ifndef B
#define B
#include "a.glsl"
float b() { return 1.0; }
#endif
