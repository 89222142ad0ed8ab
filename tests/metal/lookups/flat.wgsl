@group(0) @binding(0) var map: texture_2d<f32>;
@group(0) @binding(1) var smp: sampler;
@group(1) @binding(0) var<uniform> scale: vec4f;

@fragment fn fs(@location(0) a: vec4f, @location(1) b: vec4f) -> @location(0) vec4f {
    var sum = textureSample(map, smp, a.xy);
    sum += 2.0 * textureSampleBias(map, smp, a.zw, b.x);
    sum += 3.0 * textureSampleLevel(map, smp, b.xy, 2.0 * abs(a.x));
    sum += 5.0 * textureSampleGrad(map, smp, a.xz, 0.2 * b.xy, 0.1 * b.zw);
    sum += 7.0 * textureSampleLevel(map, smp, b.zw, 0.0, vec2i(-2, 3));
    sum += textureSample(map, smp, a.yw * scale.xy, vec2i(1, -1));
    return sum * scale;
}
