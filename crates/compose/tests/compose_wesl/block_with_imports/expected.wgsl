// package::base

const one = 1.0;

// package::fog

const density = 0.5;
const far = 100.0;

// package::main

    const reach = far * one;

@fragment
fn main() -> @location(0) vec4f {
    return vec4f(density * reach);
    return vec4f(f32(one));
}
