@vertex var<private> a: f32;
@fragment fn fs_main() -> @location(0) vec4f { a = 1; return vec4f(a); }
