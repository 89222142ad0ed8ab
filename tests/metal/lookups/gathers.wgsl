@group(0) @binding(0) var map: texture_2d<f32>;
@group(0) @binding(1) var smp: sampler;
@group(0) @binding(2) var depth: texture_depth_2d;
@group(0) @binding(3) var cmp: sampler_comparison;
@group(0) @binding(4) var layers: texture_2d_array<f32>;
@group(0) @binding(5) var cube: texture_cube<f32>;

@fragment fn fs(@location(0) a: vec4f, @location(1) b: vec4f) -> @location(0) vec4f {
    var sum = textureGather(0, map, smp, a.xy);
    sum += 2.0 * textureGather(2, map, smp, a.zw);
    sum += 3.0 * textureGather(1, map, smp, b.xy, vec2i(2, -1));
    sum += 5.0 * textureGather(3, layers, smp, b.zw, 1);
    sum += 7.0 * textureGather(1, cube, smp, a.xyz - 0.5);
    sum += 11.0 * textureGather(depth, smp, a.xy);
    sum += 13.0 * textureGatherCompare(depth, cmp, a.zw, b.x);
    sum += 17.0 * textureGatherCompare(depth, cmp, b.zw, a.x, vec2i(1, 1));
    return sum;
}
