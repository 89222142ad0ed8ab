// lib::m

fn passed() -> f32 { return 1.0; }

// package::more

fn brought(x: f32) -> f32 { return x; }

// package::more::deep

fn g() -> f32 { return 1.0; }

// package::utils

fn double(x: f32) -> f32 { return x * 2.0; }

// package::main

const shadow = 1.0;
fn main() -> f32 {
    let half = 2.0;
    return clamp(double(half), 0.0, brought(shadow)) + g() + passed() + vec2f(1.0).x;
}
