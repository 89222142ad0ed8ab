@fragment fn fs_main(@location(0) @interpolate(flat) n: i32) -> @location(0) vec4f {
    var a = 0; var b = n;
    loop {
        let done = a >= 8;
        a = b;
        continuing { b += 1; break if done; }
    }
    return vec4f(f32(a));
}
