// package::lib::other

fn o() {}

// package::programs-v2

fn help() { let x = max(1.0, 2.0); }

// package::programs-v2::my shader

fn main() { help(); o(); }
fn kept() {}
fn package_programs__v2_my__shader_max(x: f32) {}
