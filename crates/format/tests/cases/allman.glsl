#version 450
layout(location = 0) in vec3 normal;
#extension GL_GOOGLE_include_directive : require
#include "light.glsl"
layout(set = 0, binding = 1) uniform Camera
{
    mat4 view;
    vec4 eye[2];
} camera;
const float weights[3] = {
    0.25, 0.5,
    0.25
};

void main()
{
    for (int i = 0; i < 3; ++i)
    {
        switch (i)
        {
            case 0: sum += weights[i]; break;
            case 1:
                // The middle.
                sum -= -weights[i];
                break;
            default:
                discard;
        }
    }
    if (sum > 1.0) sum = 1.0; else if (sum < 0.0)
        sum = 0.0;
    else
    {
        sum = sum > 0.5 ? 1.0 : 0.0;
    }
    do { sum--; } while (sum > 2.0);
}
