@group(0) @binding(0) var t: texture_2d<f32>;
@group(0) @binding(1) var s: sampler;
@fragment
fn fs_main(@location(0) x: vec2<f32>) -> @location(0) vec4<f32> {
    if (x.x > 0.5) { workgroupBarrier(); }
    return textureSample(t, s, x);
}
