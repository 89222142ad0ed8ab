#version 450
#define
#define 3
#define A(x, x) 1
#define B(x y) 1
#define C(x
#define GL_MINE 1
#define __LINE__ 3
#define defined 1
#undef
#undef __VERSION__
#undef A B
#define D 1
#define D 2
#define E(x) x
#define E(y) y
#define F 1 + 2
#define F 1  +  2
#define MAX_LIGHTS 8
#define G 1
#undef G
#define G 2
#undef NEVER
void main() {}
