float disc(vec2 at) {
    double exact = dot(at, at);
    return float(exact);
}
