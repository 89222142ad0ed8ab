@group(0) @binding(0) var d: texture_depth_2d;
@group(0) @binding(1) var s: sampler;
@fragment fn fs_main(@builtin(position) p: vec4f) -> @location(0) vec4f { return vec4f(textureSample(d, s, p.xy)); }
