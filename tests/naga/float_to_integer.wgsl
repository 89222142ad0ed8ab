@fragment fn fs_main(@location(0) x: vec4f, @location(1) @interpolate(flat) i: vec4i) -> @location(0) vec4f {
    let whole = vec4i(x) + vec4i(i32(x.y)) + vec4i(vec4u(x)) + vec4i(i32(u32(x.z)));
    const far = i32(1e20f);
    return vec4f(whole + i) + vec4f(f32(far), f32(u32(1e20f)), f32(i32(-1e20f)), f32(u32(-1.5f)));
}
