// package::o

@id(7) override scale: f32 = 1.0;

// package::p

fn package_p_scale() -> f32 { return 2.0; }

// package::main

fn main() -> f32 { return scale * package_p_scale(); }
