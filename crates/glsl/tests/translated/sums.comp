#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Totals { uint count; float sums[]; } totals;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D picture;
shared float part[64];
void add(inout float sum, float value) { sum += value; }
void main() {
    uint at = gl_LocalInvocationIndex;
    part[at] = float(totals.sums.length());
    barrier();
    float sum = 0.0;
    for (int i = 0, j = 63; i < j; i++, j--) {
        if (i == 3) continue;
        add(sum, part[i] + part[j]);
    }
    uint old = atomicAdd(totals.count, 1u);
    add(totals.sums[old], sum);
    imageStore(picture, ivec2(gl_GlobalInvocationID.xy), vec4(sum));
}
