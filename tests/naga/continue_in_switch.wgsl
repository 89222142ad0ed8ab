@fragment fn fs_main(@location(0) @interpolate(flat) n: i32) -> @location(0) vec4f {
    var sum = 0;
    for (var i = 0; i < n; i++) {
        switch i { case 1, 2: { continue; } case 3: { break; } default: { sum += 1; } }
        sum += 10;
    }
    return vec4f(f32(sum));
}
