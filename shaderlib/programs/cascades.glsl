//! The shadow map of a directional light in four parts, for `forward` with `cascades`. Each part has
//! what is at some distances from the viewer, so that shadows nearby have small texels.
//!
//! The parts are the quarters of one map. A matrix leads to its quarter: the parts from the first to
//! the last are at the upper left, the upper right, the lower left and the lower right. A host that
//! makes the matrices leaves as many texels around what a part covers as the filter reads.
//!
//! Made from `cascades.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_PROGRAMS_CASCADES_GLSL
#define LAMPLIGHT_PROGRAMS_CASCADES_GLSL

#if CASCADES
#include "../shadow/cascade.glsl"
#endif

#if CASCADES
/// The parts of the map, from the nearest to the farthest.
layout(std140, set = 2, binding = 10) uniform Cascades {
    /// From the world to the clip space of the whole map.
    mat4 clip_from_world[4];
    /// Far ends, as distances along the view axis, rising, scene units; the last one is repeated if
    /// there are fewer.
    vec4 splits;
    /// Sizes of a texel, scene units.
    vec4 texels;
    /// Distance before a part's end over which the next one fades in, scene units.
    float overlap;
} cascades;

/// The parts that a point is looked up in.
struct CascadePair {
    /// The part that covers the point; 4 beyond all parts.
    int here;
    /// The part after it; 4 where there is none.
    int next;
    /// The share of that, [0, 1].
    float share;
};

/// The parts for a point at a distance along the view axis.
CascadePair cascade_pair(float view_depth) {
    int here = cascade_index(view_depth, cascades.splits);
    float share = cascade_blend(view_depth, cascades.splits, cascades.overlap);
    int after = min(here + 1, 3);
    bool is_last = !(cascades.splits[after] > cascades.splits[min(here, 3)]);
    return CascadePair(here, is_last ? 4 : after, share);
}
#endif

#endif
