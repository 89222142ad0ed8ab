#ifndef SHARED_GLSL
#define SHARED_GLSL
float fade(float x) {
#if TWO_SIDED
    x = abs(x);
#endif
    return x;
}
#endif
