@fragment fn fs_main(@location(0) @interpolate(flat) n: i32) -> @location(0) vec4f {
    var x = 0.0;
    switch n { case 1, 2: { x = 1.0; } case 3, default, 7: { x = 2.0; } }
    return vec4f(x);
}
