@fragment @workgroup_size(1) fn fs_main() -> @location(0) vec4f { return vec4f(1); }
