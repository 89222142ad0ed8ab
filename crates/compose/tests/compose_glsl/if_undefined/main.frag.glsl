#version 450
#if SHADOW == SHADOW_HRAD
#error not reached
#elif SHADOW == SHADOW_HARD
#error not reached
#else
#error not reached
#endif
#if TWO_SIDE
#endif
#if defined(TWO_SIDE) && TWO_SIDE > 1
#endif
#if COMPLETELY_ELSE(3)
#endif
void main() {}
