// package::k

const x = 2.0;

// package::main

fn f() -> f32 { return x; }
@fragment fn main() -> @location(0) vec4f {
    return vec4f(f());
}
