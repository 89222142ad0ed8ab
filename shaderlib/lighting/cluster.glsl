//! Clustered shading: the cell of the view frustum that contains a point. Each cell has its own list of lights.
//!
//! Made from `cluster.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_LIGHTING_CLUSTER_GLSL
#define LAMPLIGHT_LIGHTING_CLUSTER_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The slice of the depth that a distance lies in.
///
/// Slices grow with the distance by a constant factor, so that cells stay about as deep as they are wide.
///
/// Parameters: `z` distance along the view axis, scene units; `near`, `far` range of the slices, scene units, `0 < near < far`; `count` number of slices, [1, 4096].
/// Returns: 0 to `count - 1`: `floor(count*log(z/near)/log(far/near))`.
/// Source: Olsson, Billeter, Assarsson, "Clustered Deferred and Forward Shading", 2012, section 3.2; Sousa, Geffroy, "The Devil Is in the Details: idTech 666", 2016.
/// Edges: the first slice for a `z` up to `near`, negative ones too, the last beyond `far`; 0 for a `far` that is not beyond `near`, and for a `count` of 0; `near` counts as at least 1e-6; indeterminate where `far` or `far/near` is above 1e38, so for a plane at the largest number.
/// Error model: exact but within 2^-20*count/log2(far/near) of a border, where it is either slice.
uint cluster_slice(float z, float near, float far, uint count) {
    float first = max(near, 1e-6);
    if (!(far > first && z > first)) {
        return 0u;
    }
    float at = float(count) * (log2(z / first) / log2(far / first));
    return min(uint(max(min(at, 65535.0), 0.0)), count - 1u);
}

/// The distance at which a slice begins.
///
/// Parameters: `index` of the slice; `near`, `far` range of the slices, scene units, `0 < near < far`; `count` number of slices, at least 1.
/// Returns: `near*(far/near)^(index/count)`, scene units: `near` for 0, `far` for `count`.
/// Source: Olsson, Billeter, Assarsson, "Clustered Deferred and Forward Shading", 2012, section 3.2.
/// Edges: `near` for a `far` that is not beyond it, and for a `count` of 0; an `index` beyond `count` counts as that; `near` counts as at least 1e-6; indeterminate where `far` or `far/near` is above 1e38, so for a plane at the largest number.
/// Error model: relative 2^-21 + 2^-22*log2(far/near).
float slice_depth(uint index, float near, float far, uint count) {
    float first = max(near, 1e-6);
    float share = float(min(index, count)) / float(max(count, 1u));
    return first * exp2(share * log2(max(far / first, 1.0)));
}

/// The number of the cell that a point lies in.
///
/// Parameters: `uv` place on the screen, [0, 1]; `z` distance along the view axis, scene units; `near`, `far` range of the slices, scene units; `counts` number of cells across, down and in depth, each at least 1.
/// Returns: `x + counts.x*(y + counts.y*z)`, below the product of the counts.
/// Source: Olsson, Billeter, Assarsson, "Clustered Deferred and Forward Shading", 2012, section 3.2.
/// Edges: a `uv` beside the screen counts as its edge; a count of 0 in `counts` leaves its coordinate and those after it 0; `z`, `near` and `far` as for `cluster_slice`.
/// Error model: exact but at the borders of cells; see `cluster_slice`.
uint cluster_index(vec2 uv, float z, float near, float far, uvec3 counts) {
    vec2 size = vec2(float(counts.x), float(counts.y));
    vec2 at = max(min(uv * size, size - 1.0), vec2(0.0));
    uint x = uint(min(at.x, 4294967040.0));
    uint y = uint(min(at.y, 4294967040.0));
    return x + counts.x * (y + counts.y * cluster_slice(z, near, far, counts.z));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
