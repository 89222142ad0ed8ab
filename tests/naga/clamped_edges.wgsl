@group(0) @binding(0) var t: texture_2d<f32>;
@group(0) @binding(1) var s: sampler;
@fragment fn fs_main(@location(0) v: vec2f) -> @location(0) vec4f { return textureSampleBaseClampToEdge(t, s, v); }
