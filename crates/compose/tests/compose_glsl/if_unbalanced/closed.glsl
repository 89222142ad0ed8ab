#if 1
#endif
#endif
#else
