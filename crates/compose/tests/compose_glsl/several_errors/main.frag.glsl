#version 450
#include "missing.glsl"
#if SHADO == 1
#endif
#bogus
#define F(x) x
int a = F(1, 2);
#error stop
void main() {}
