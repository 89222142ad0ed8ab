#include "main.frag.glsl"
