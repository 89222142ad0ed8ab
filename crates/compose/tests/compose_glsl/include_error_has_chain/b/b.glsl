#if NOPE
#endif
#error from below
