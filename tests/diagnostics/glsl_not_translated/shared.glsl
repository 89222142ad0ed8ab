float grid(vec2 at) {
    float w[2][2];
    w[0][1] = at.x;
    return w[0][1];
}
