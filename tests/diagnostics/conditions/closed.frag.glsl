#endif
#else
#if
#endif
void main() {}
