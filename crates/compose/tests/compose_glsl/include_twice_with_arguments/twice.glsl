// Twice.
TYPE NAME(TYPE x) {
    return x + x;
}
