@group(0) @binding(0) var d: texture_depth_2d;
@fragment fn fs_main(@builtin(position) p: vec4f) -> @location(0) vec4f { return vec4f(textureLoad(d, vec2i(p.xy), 0)); }
