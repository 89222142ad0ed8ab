#ifndef A
#define A
#include "b.glsl"
float a() { return b(); }
#endif
