#import engine::types as types
#import engine::shade::shade;

#if LIGHTS >= 3
const COUNT: u32 = 3u;
#else if LIGHTS == 1
const COUNT: u32 = 1u;
#else
const COUNT: u32 = 0u;
#endif

@group(#{GROUP}) @binding(0) var<uniform> lights: array<vec4<f32>, #{TAPS}>;

#ifdef SPOT
#import engine::maths::basic square
@fragment
fn fs_main(@location(0) d: f32, @location(1) direction: vec3<f32>) -> @location(0) vec4<f32> {
#else
@fragment
fn fs_main(@location(0) d: f32) -> @location(0) vec4<f32> {
#endif
    var light: types::Light;
    light.colour = lights[0].xyz;
#ifdef SPOT
    light.outer = square(d);
    light.axis = direction;
    return vec4(shade(light, direction, d) * f32(COUNT));
#else
    return vec4(shade(light, d) * f32(COUNT));
#endif
}
#ifdef 0
fn never() {}
#endif
