//! Soft shadows from a distance field: how near a ray to the light passes to anything.
//!
//! Made from `sdf.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_SHADOW_SDF_GLSL
#define LAMPLIGHT_SHADOW_SDF_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// One step of a ray march to the light: the smallest unoccluded share of the light's cone so far.
///
/// Begin with `res` = 1 and `ph` = 0. After each step, advance the ray by `h`, and pass x and y of the result as the next `res` and `ph`.
///
/// Parameters: `res` the least share so far, [0, 1]; `h` signed distance from this point of the ray to the scene, scene units; `ph` that distance at the previous step, which is also the length of that step, scene units; `t` distance of this point along the ray, scene units; `k` sharpness: the distance of the light over its radius, at least 0.
/// Returns: x the least share, [0, 1]; y the distance here, at least 0, for the next step.
/// Source: Quilez, "Soft Shadows in Raymarched SDFs", 2010, with the nearest point between two steps: Aaltonen, "GPU-Based Clay Simulation and Ray-Tracing Tech in Claybook", 2018.
/// Edges: 0 for an `h` of 0 or below, inside an object, and for a `k` of 0 or below; without a previous step, a `ph` of 0 or below, only the distance at this point counts; `res`, clamped to [0, 1], where the nearest point is behind the start, so for a `t` of 0 or below.
/// Error model: 6 ULP, and 2^-22*k*h^2/((t - y)*d).
vec2 sdf_soft_step(float res, float h, float ph, float t, float k) {
    float here = max(h, 0.0);
    float sharp = max(k, 0.0);
    // The spheres of both steps meet at this distance before the point.
    float back = 0.0;
    if (here < 2.0 * ph) {
        back = 0.5 * here * (here / ph);
    }
    float apart = sqrt((here - back) * (here + back));
    float along = t - back;
    float least = clamp(res, 0.0, 1.0);
    if (!(sharp * apart < least * along)) {
        return vec2(least, here);
    }
    return vec2(sharp * apart / along, here);
}

/// The visibility of a round light from the unoccluded share of its cone: a smooth step.
///
/// Parameters: `share` unoccluded share, [-1, 1]: 0 where the ray touches an object, -1 where the cone is fully blocked.
/// Returns: `(1 + share)^2*(2 - share)/4`, [0, 1].
/// Source: Quilez, "Soft Shadows in Raymarched SDFs", 2010: the part of the penumbra behind the edge.
/// Edges: clamped to [-1, 1].
/// Error model: 4 ULP of 1 + share.
float sdf_soft_smooth(float share) {
    float x = clamp(share, -1.0, 1.0);
    return 0.25 * (1.0 + x) * (1.0 + x) * (2.0 - x);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
