@group(0) @binding(0) var layers: texture_2d_array<f32>;
@group(0) @binding(1) var smp: sampler;
@group(0) @binding(2) var depths: texture_depth_2d_array;
@group(0) @binding(3) var cmp: sampler_comparison;

@fragment fn fs(@location(0) a: vec4f, @location(1) b: vec4f) -> @location(0) vec4f {
    let layer = i32(floor(4.0 * b.x));
    var sum = textureSample(layers, smp, a.xy, 1);
    sum += 2.0 * textureSampleLevel(layers, smp, a.zw, layer, 1.5);
    sum += 3.0 * textureSampleBias(layers, smp, b.xy, 2u, 0.5);
    sum += 5.0 * textureSampleGrad(layers, smp, b.zw, 0, 0.3 * a.xy, 0.3 * a.zw);
    sum.x += textureSample(depths, smp, a.xy, 1);
    sum.y += textureSampleCompare(depths, cmp, a.zw, 1, b.x);
    sum.z += textureSampleCompareLevel(depths, cmp, b.zw, max(layer, 0), b.y);
    sum.w += f32(textureNumLayers(layers) + textureNumLevels(layers) * 8u);
    return sum;
}
