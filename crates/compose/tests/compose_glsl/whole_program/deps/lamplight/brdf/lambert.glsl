#pragma once
#include "../math/safe.glsl"

// Cosine, clamped.
float lambert(vec3 n, vec3 l) {
    return saturate_(dot(n, l));
}
