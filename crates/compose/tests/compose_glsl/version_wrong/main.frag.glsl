// A comment may stand before.
#version 450
#version 450
#include "a.glsl"
#version
#version 450 fancy
void main() {}
