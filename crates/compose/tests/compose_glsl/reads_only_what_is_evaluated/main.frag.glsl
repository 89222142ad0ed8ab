#version 450
#if A || B
const int N = SIZE;
#endif
#ifdef C
#endif
#define LATER DEAD
int unused() { return DEAD + LATER; }
layout(location = 0) out vec4 color;
void main() { color = vec4(float(N)); }
