// Lights that the engine binds.
    /// One light.
    struct Light {
        position: vec3f,
    }

    @group(0) @binding(0) var<uniform> lights: array<Light, 4>; // bound once

        fn cone(light: Light) -> f32 {
            return 1.0;
        }

@fragment
fn main() -> @location(0) vec4f {
    return vec4f(lights[0].position, cone(lights[0]));
}
