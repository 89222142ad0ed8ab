struct P { @location(0) a: vec2f, @location(1) b: vec3f, @builtin(position) p: vec4f }
@group(0) @binding(0) var<storage> all: array<P>;
@vertex fn main(@builtin(vertex_index) i: u32) -> P { return all[i]; }
