#define DEPTH
#ifdef DEPTH
const A: f32 = 1.0;
#endif
#if DEPTH >= 2
const B: f32 = 1.0;
#endif
