@group(0) @binding(0) var words: texture_2d<u32>;
@group(0) @binding(1) var signed: texture_2d<i32>;
@group(0) @binding(2) var smp: sampler;

@fragment fn fs(@location(0) a: vec4f, @location(1) b: vec4f) -> @location(0) vec4f {
    let at = vec2u(9.0 * abs(a.xy));
    var sum = vec4f(textureLoad(words, at, 0) & vec4u(65535u));
    sum += vec4f(textureLoad(signed, vec2i(9.0 * b.xy), 1));
    sum += vec4f(textureGather(1, words, smp, a.zw) >> vec4u(16u));
    sum += vec4f(textureGather(2, signed, smp, b.zw));
    return sum + vec4f(vec2f(textureDimensions(words, 1)), vec2f(textureDimensions(signed)));
}
