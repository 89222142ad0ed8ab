#version 450
//! The fragment stage of `moments`, which `moments.wesl` describes.
//!
//! Made from `moments.wesl` by `cargo xtask docs`: edit that, not this file.

#include "../shadow/bias.glsl"
#include "../shadow/moments.glsl"

layout(location = 0) out vec4 out_color;

/// How moments are made of a depth.
layout(std140, set = 0, binding = 1) uniform Moments {
    /// `evsm`: the positive and the negative exponent; `esm`: the sharpness and 0; as in the caster of `forward`.
    vec2 exponents;
    /// Added to the depth.
    float bias;
} terms;

void main() {
    float depth = constant_bias(gl_FragCoord.z, -terms.bias);
#if MOMENTS == MOMENTS_EVSM
    out_color = evsm_moments(depth, terms.exponents);
#elif MOMENTS == MOMENTS_ESM
    out_color = vec4(esm_moment(depth, terms.exponents.x), 0.0, 0.0, 0.0);
#elif MOMENTS == MOMENTS_MSM
    out_color = msm_moments(depth);
#elif SLOPE
    out_color = vec4(vsm_moments_slope(depth, dFdx(depth), dFdy(depth)), 0.0, 0.0);
#else
    out_color = vec4(vsm_moments(depth), 0.0, 0.0);
#endif
}
