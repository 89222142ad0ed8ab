@fragment fn fs_main(@location(0) @interpolate(flat) u: vec4u) -> @location(0) vec4f {
    let a = dot4I8Packed(u.x, u.y);
    return vec4f(f32(a), f32(dot4I8Packed(0u, bitcast<u32>(a))), f32(dot4U8Packed(u.z, u.w)), 1.0);
}
