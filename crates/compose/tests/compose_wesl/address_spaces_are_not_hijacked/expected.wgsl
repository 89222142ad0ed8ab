// package::n

fn package_n_storage(x: f32) -> f32 { return x * package_n_read; }
const package_n_read = 2.0;
const read_write = 3.0;

// package::main

@group(0) @binding(0) var<storage, read> data: array<f32>;
var<private> state: f32;
fn package_main_private(x: f32) -> f32 { return x; }
fn main() -> f32 { var<function> x = package_n_storage(data[0]) + read_write; return package_main_private(x) + state; }
