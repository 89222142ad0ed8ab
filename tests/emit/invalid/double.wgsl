@fragment
fn fs_main(@location(0) x: f32) -> @location(0) vec4<f32> {
    let wide = f64(x);
    return vec4(f32(wide));
}
