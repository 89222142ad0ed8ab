// constants

const COUNT = 4u;

// lights

const sun = 1.0;

// package::bindings

struct Constants { exposure: f32 }
@group(0) @binding(0) var<uniform> constants: Constants;
@group(0) @binding(1) var<uniform> view: vec4f;

// package::moon::lights

const crescent = 0.25;

// package::main

@fragment
fn main() -> @location(0) vec4f {
    return vec4f(sun, f32(COUNT), constants.exposure + view.x, crescent);
}
