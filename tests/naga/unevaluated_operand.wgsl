const a = false && 1;
@fragment fn fs_main() -> @location(0) vec4f { return vec4f(select(0.0, 1.0, a)); }
