    const lights = array(vec3f(0.0));

@fragment
fn main() -> @location(0) vec4f {
    return vec4f(lights[0], 1.0);
}
