fn bp(n: vec3f, l: vec3f, v: vec3f, s: f32) -> f32 { return n.x + l.x + v.x + s; }
@fragment fn fs_main(@location(0) v: vec3f) -> @location(0) vec4f {
    return vec4f(bp(v, v, 8.0));
}
