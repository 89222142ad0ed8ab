fn unpack(packed: u32) -> vec2<u32> { return vec2<u32>(packed >> 8u, packed & 15u); }
@fragment fn fs_main(@location(0) @interpolate(flat) x: u32) -> @location(0) vec4f { return vec4f(vec2f(unpack(x)), 0, 1); }
