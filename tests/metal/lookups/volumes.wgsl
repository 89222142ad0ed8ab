@group(0) @binding(0) var volume: texture_3d<f32>;
@group(0) @binding(1) var smp: sampler;
@group(0) @binding(2) var line: texture_1d<f32>;

@fragment fn fs(@location(0) a: vec4f, @location(1) b: vec4f) -> @location(0) vec4f {
    var sum = textureSample(volume, smp, a.xyz);
    sum += 2.0 * textureSampleLevel(volume, smp, b.xyz, 0.75);
    sum += 3.0 * textureSampleLevel(volume, smp, a.yzw, 0.0, vec3i(1, -2, 1));
    sum += 5.0 * textureLoad(volume, vec3i(4.0 * abs(b.xyz)), 0);
    sum += 7.0 * textureSample(line, smp, a.x);
    sum += 11.0 * textureLoad(line, u32(3.0 * abs(b.x)), 0);
    return sum + vec4f(vec3f(textureDimensions(volume)), f32(textureDimensions(line)));
}
