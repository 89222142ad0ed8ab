#pragma once
float saturate_(float x) {
    return clamp(x, 0.0, 1.0);
}
float unused_(float x) {
    return x;
}
