fn f(x: i32) -> vec2<f32> {
    return vec3<f32>(1.0);
}
@fragment
fn fs_main() -> @location(0) vec4<f32> { return vec4(f(1), 0.0, 1.0); }
