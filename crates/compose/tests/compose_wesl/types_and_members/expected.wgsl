// package::t

struct package_t_light { colour: vec3f }
alias package_t_colour = vec3f;
struct package_t_Pair { light: vec3f, colour: package_t_colour }

// package::main

struct S { light: package_t_light, colour: array<package_t_colour, 2> }
@group(0) @binding(0) var tex: texture_2d<f32>;
fn main(s: S) -> package_t_colour {
    var t = package_t_Pair(s.light.colour, s.colour[0]);
    let light = t.light.x;
    return t . colour * light;
}
