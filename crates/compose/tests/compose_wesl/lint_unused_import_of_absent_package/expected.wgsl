// package::here

const one = 1.0;

// package::main

@fragment
fn main() -> @location(0) vec4f {
    return vec4f(one);
}
