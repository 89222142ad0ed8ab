// package::util

const gain = 0.5;
const bias = 0.25;

// package::main

@fragment
fn main() -> @location(0) vec4f {
    return vec4f(gain, bias, 0.0, 1.0);
}
