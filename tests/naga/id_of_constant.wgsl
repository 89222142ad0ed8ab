@id(1) const a = 4;
@fragment fn fs_main() -> @location(0) vec4f { return vec4f(a); }
