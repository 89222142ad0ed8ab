// package::inner

fn half() {}
struct Mesh { x: f32 }

// package::main

fn main() { half(); half(); var m: Mesh; }
