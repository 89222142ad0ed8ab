// lamplight

const version = 1.0;

// lamplight::brdf::specular

const gloss = 0.5;
fn blinn_phong(x: f32) -> f32 { return saturated(x); }

// lamplight::math

fn saturated(x: f32) -> f32 { return clamp(x, 0.0, 1.0); }

// package::main

fn main() -> f32 { return blinn_phong(1.0) * gloss + version; }
