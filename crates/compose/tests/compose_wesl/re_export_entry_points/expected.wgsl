// lib::passes

@group(0) @binding(1) var<uniform> the_light: vec4f;
fn lib_passes_the__light() -> f32 { return 1.0; }
@vertex fn draw() -> @builtin(position) vec4f { return vec4f(0.0); }
@fragment fn my_shade() -> @location(0) vec4f { return the_light * lib_passes_the__light(); }
