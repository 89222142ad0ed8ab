fn det(a: vec3f, b: vec3f) -> f32 { return dot(a, b); }
@fragment fn fs_main() -> @location(0) vec4f {
    let det = det(vec3f(1), vec3f(2));
    let d0 = det(vec3f(1), vec3f(1));
    return vec4f(det + d0);
}
