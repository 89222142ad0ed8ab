// package::util

const bias = 0.25;

// package::main

@fragment
fn main() -> @location(0) vec4f {
        let gain = 2.0;
    return vec4f(gain, bias, 0.0, 1.0);
}
