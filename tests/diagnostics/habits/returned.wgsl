@fragment fn fs_main(@location(0) c: vec3f) -> @location(0) vec4f {
    let d = c * 2.0;
    return d;
}
