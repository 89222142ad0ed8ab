#if SHADOW == SHADOW_HARD && TAPS == 9
vec4 shade() { return vec4(1.0) + mat3(1.0); }
#else
vec4 shade() { return vec4(1.0); }
#endif
