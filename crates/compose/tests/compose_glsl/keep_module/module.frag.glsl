#include "a.glsl"
float f() { return a(); }
float g() { return 1.0; }
