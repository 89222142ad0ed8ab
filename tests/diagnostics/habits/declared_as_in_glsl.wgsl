@fragment fn fs_main(@location(0) v: vec3f) -> @location(0) vec4f {
    vec3 n = normalize(v);
    for (int i = 0; i < 3; i++) { }
    return vec4f(n, 1.0);
}
