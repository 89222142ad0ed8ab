// lamp_light::x

const lamp__light_x_y = 1.0;

// package::a_b::c

struct package_a__b_c_Entry__struct { x_y: f32 }
fn package_a__b_c_do__it(e: f32) { var s: package_a__b_c_Entry__struct; s.x_y = e; }

// package::main

fn main() { package_a__b_c_do__it(lamp__light_x_y); }
