@fragment fn fs_main(@location(0) v: vec3f) -> @location(0) vec4f {
    let m = mat3x3f(v, v);
    return vec4f(m[0], 1.0);
}
