#include <n/k.glsl>
float f() { return k(); }
