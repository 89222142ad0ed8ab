float wanted(float x) { return x; }
const float nothing_at_all = 1.0;
