// one
#include "b/b.glsl"
