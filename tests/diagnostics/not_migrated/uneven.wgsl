#if DEPTH !! 2
const B: f32 = 1.0;
#endif
