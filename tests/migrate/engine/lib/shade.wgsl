#define_import_path engine::shade

#import engine::{
    types::Light,
    // the basics
    maths::basic::square,
}
#ifdef SPOT
#import engine::maths::basic::root
#endif
#import engine::maths as maths

fn shade(
    light: Light,
#ifdef SPOT
    direction: vec3<f32>,
#endif
    distance: f32,
) -> f32 {
    var sum = light.intensity / square(distance);
#ifdef SPOT
    let cone = dot(light.axis, direction);
    sum *= root(max(cone, 0.001)); // keep
#else   // SPOT
    let cone = light.radius;
#endif  // SPOT
    let factor = maths::basic::square(cone)
#ifdef TINTED
        * light.tint.x
#endif
        ;
#ifdef SOFT
    if factor > 0.5 {
#endif
        sum += factor * engine::types::PI;
#ifdef SOFT
    } else {
        sum -= 0.25;
    }
#endif
    if sum > 9.0 {
        sum = 9.0;
    }
#ifndef FAST
    else if sum > 7.0 {
        sum = 7.0;
    }
#endif
    for (var i = 0u; i < #{TAPS}u; i++) {
        sum += f32(i) * #GAIN;
    }
    switch i32(sum) {
#ifdef ROUGH
        case 1: { sum = 2.0; }
#endif
        case 2, 3: { sum = 4.0; }
        default: {}
    }
    return sum;
}
