// constants

const DEBUG = false;
const GAIN = 0.5f;
const SAMPLES = 4u;
const SLOT = 3;

// package::main

@group(0) @binding(SLOT) var<uniform> view: vec4f;

@fragment
fn main() -> @location(0) vec4f {
    var sum = view * GAIN;
    for (var i = 0u; i < SAMPLES; i++) { sum += view; }
    if (DEBUG) { sum = vec4f(0.0); }
    return sum;
}
