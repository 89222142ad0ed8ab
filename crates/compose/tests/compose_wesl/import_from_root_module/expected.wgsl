// package::helper

fn help(l: Light) -> vec3f { return l.colour; }

// package::main

struct Light { colour: vec3f }
fn main(l: Light) -> vec3f { return help(l); }
