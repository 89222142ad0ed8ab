#ifndef COMPARE_GLSL
#define COMPARE_GLSL

#define TEXEL (1.0 / 512.0)

// One tap.
float hard(texture2D map, samplerShadow smp, vec3 uvd) {
    return texture(sampler2DShadow(map, smp), uvd);
}

// Nine taps,
// one texel apart.
float pcf_3x3(texture2D map, samplerShadow smp, vec3 uvd, float texel) {
    float sum = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            sum += hard(map, smp, uvd + vec3(vec2(x, y) * texel, 0.0));
        }
    }
    return sum / 9.0;
}

float pcf_5x5(texture2D map, samplerShadow smp, vec3 uvd, float texel) {
    return hard(map, smp, uvd);
}

#endif
