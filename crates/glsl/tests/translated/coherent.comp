#version 430
// Memory that other invocations share: what is only read or only written, and atomic functions.
layout(local_size_x = 8) in;
layout(binding = 0, rgba16f) coherent uniform image2D before;
layout(binding = 1, r32ui) coherent restrict uniform uimage2D after;
layout(std430, binding = 2) coherent buffer Counters {
    uint counted;
    uint largest[4];
};
layout(std430, binding = 3) coherent readonly buffer Limits {
    uint limit;
};
layout(std430, binding = 4) volatile writeonly buffer Marks {
    uint marks[];
};

void main() {
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    uint bright = uint(255.0 * imageLoad(before, place).r);
    if (bright > limit) {
        atomicAdd(counted, 1u);
    }
    atomicMax(largest[bright & 3u], bright);
    imageStore(after, place, uvec4(bright));
    marks[gl_LocalInvocationIndex] = bright;
}
