float safe(float x) {
#if STRICT
    return x + missing;
#endif
    return x;
}
