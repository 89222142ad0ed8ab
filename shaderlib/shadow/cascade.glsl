//! Which of up to four cascaded shadow maps covers a point.

#ifndef LAMPLIGHT_SHADOW_CASCADE_GLSL
#define LAMPLIGHT_SHADOW_CASCADE_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The index of the cascade that covers a distance.
///
/// Parameters: `view_depth` distance along the view axis, scene units; `splits` far ends of the four cascades, rising, scene units; repeat the last for fewer.
/// Returns: 0 to 3, or 4 beyond the last: no cascade, lit.
/// Source: Zhang, Sun, Xu, Lun, "Parallel-Split Shadow Maps for Large-Scale Virtual Environments", 2006.
/// Edges: a distance at a cascade's end belongs to the next one.
/// Error model: exact.
int cascade_index(float view_depth, vec4 splits) {
    if (view_depth < splits.x) {
        return 0;
    }
    if (view_depth < splits.y) {
        return 1;
    }
    if (view_depth < splits.z) {
        return 2;
    }
    return view_depth < splits.w ? 3 : 4;
}

/// The share of the next cascade near the end of the one that covers a distance.
///
/// After the last cascade the next one is none: mix with 1.
///
/// Parameters: `view_depth` and `splits` as for `cascade_index`; `overlap` distance before a cascade's end over which the next one fades in, scene units.
/// Returns: 0 to 1, rising over the overlap.
/// Source: Microsoft, "Cascaded Shadow Maps", DirectX technical article: blending between cascades.
/// Edges: 0 for an overlap of 0 or less, and beyond the last cascade.
/// Error model: absolute 2^-22 + 2^-23*(view_depth + split)/overlap.
float cascade_blend(float view_depth, vec4 splits, float overlap) {
    int index = cascade_index(view_depth, splits);
    if (index > 3 || !(overlap > 0.0)) {
        return 0.0;
    }
    return clamp((view_depth - splits[index] + overlap) / overlap, 0.0, 1.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
