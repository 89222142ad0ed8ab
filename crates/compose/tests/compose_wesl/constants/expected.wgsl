// constants

const max_lights = 4;
const offset = -3;
const taps = 9;
const two_sided = true;

// package::m

const taps_squared = taps * taps + max_lights;

// package::main

fn main() -> i32 { var n = max_lights + offset; if two_sided { n += taps_squared; } return n; }
