#include <lib/b.glsl>
float a() { return b(); }
