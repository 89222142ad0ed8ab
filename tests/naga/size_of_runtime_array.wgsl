struct S { @size(64) all: array<f32> }
@group(0) @binding(0) var<storage> s: S;
@fragment fn fs_main() -> @location(0) vec4f { return vec4f(s.all[0]); }
