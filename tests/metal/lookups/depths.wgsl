@group(0) @binding(0) var depth: texture_depth_2d;
@group(0) @binding(1) var smp: sampler;
@group(0) @binding(2) var cmp: sampler_comparison;

@fragment fn fs(@location(0) a: vec4f, @location(1) b: vec4f) -> @location(0) vec4f {
    var sum = vec4f(0.0);
    sum.x += textureSample(depth, smp, a.xy);
    sum.x += 2.0 * textureSampleLevel(depth, smp, a.zw, 1);
    sum.y += textureSampleCompare(depth, cmp, a.xy, b.x);
    sum.y += 2.0 * textureSampleCompareLevel(depth, cmp, b.zw, a.x);
    sum.z += textureSampleCompare(depth, cmp, a.zw, b.y, vec2i(1, 2));
    sum.z += 2.0 * textureLoad(depth, vec2i(6.0 * abs(a.xy)), 0);
    sum.w += textureSample(depth, smp, b.xy, vec2i(-1, 0));
    return sum;
}
