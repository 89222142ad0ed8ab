@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f {
    let y = x > 0.5 ? 1.0 : 0.0;
    return vec4f(y);
}
