override taps: u32 = 9u;
@id(7) override bias: f32 = 0.5;
@fragment
fn fs_main(@location(0) x: f32) -> @location(0) vec4<f32> {
    var sum = bias;
    for (var i = 0u; i < taps; i++) { sum += x; }
    return vec4(sum);
}
