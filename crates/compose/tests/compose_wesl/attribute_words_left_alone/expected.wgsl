// package::n

const package_n_position = 1.0;
const package_n_flat = 1.0;
const package_n_center = 1.0;
const package_n_storage = 1.0;
const package_n_read = 1.0;
const package_n_location = 1.0;
const package_n_group = 1.0;

// package::main

@group(0) @binding(0) var<storage, read> data: array<f32>;
@fragment fn main(@builtin(position) p: vec4f, @location(1) @interpolate(flat) q: u32) -> @location(0) vec4f {
    return p * package_n_position * package_n_flat * package_n_center * package_n_storage * package_n_read * package_n_location * package_n_group * data[0];
}
