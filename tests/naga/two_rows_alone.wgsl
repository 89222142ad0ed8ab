@group(0) @binding(0) var<uniform> m: mat3x2<f32>;
@fragment fn fs_main() -> @location(0) vec4f { return vec4f(m * vec3f(1), 0, 1); }
