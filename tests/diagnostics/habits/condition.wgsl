@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f {
    var y = 0.0;
    if x { y = 1.0; }
    return vec4f(y);
}
