@group(0) @binding(0) var t: texture_2d<f32>;
@group(0) @binding(1) var u: texture_2d<f32>;
@group(0) @binding(2) var s: sampler;
@group(0) @binding(3) var d: texture_depth_2d;
@group(0) @binding(4) var c: sampler_comparison;
fn read(a: texture_2d<f32>, b: sampler, uv: vec2f) -> vec4f { return textureSample(a, b, uv) + inner(a, b, uv); }
fn inner(a: texture_2d<f32>, b: sampler, uv: vec2f) -> vec4f { return textureSampleLevel(a, b, uv, 0) + vec4f(vec2f(textureDimensions(a)), 0, 0); }
fn shadow(a: texture_depth_2d, b: sampler_comparison, uv: vec2f) -> f32 { return textureSampleCompare(a, b, uv, 0.5); }
@fragment fn fs_main(@location(0) uv: vec2f) -> @location(0) vec4f { return read(t, s, uv) + read(u, s, uv) + vec4f(shadow(d, c, uv)); }
