@fragment fn fs_main() -> @location(0) vec4f { return vec4f(1.0 / 0.0); }
