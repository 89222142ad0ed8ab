//! Lists of lamps for the cells of the view frustum, for `forward` with `clustered`. The lists are
//! in a uniform block, so every target has them.
//!
//! Made from `clusters.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_PROGRAMS_CLUSTERS_GLSL
#define LAMPLIGHT_PROGRAMS_CLUSTERS_GLSL

#if CLUSTERED
#include "../lighting/cluster.glsl"
#endif

#if CLUSTERED
/// The lists of all cells, and their indices: at most 2048 cells, 7680 indices and 255 lamps.
layout(std140, set = 1, binding = 15) uniform Clusters {
    /// Number of cells across, down and in depth, each at least 1.
    uvec3 counts;
    /// Range of the slices, scene units, `0 < near < far`.
    float near;
    float far;
    /// For each cell the place of its first index, and from bit 16 on how many there are. Four cells
    /// are one vector.
    uvec4 cells[512];
    /// Indices of lamps, in bytes; the lowest bits of a number come first.
    uvec4 indices[480];
} clusters;

/// The list of the lamps that reach a point: the place of the first index, and how many there are.
uvec2 lamp_list(vec3 position, mat4 clip_from_world, mat4 world_from_view) {
    vec4 clip = clip_from_world * vec4(position, 1.0);
    vec2 uv = 0.5 * clip.xy / max(clip.w, 1e-6) + 0.5;
    float z = dot(world_from_view[3].xyz - position, world_from_view[2].xyz);
    uint cell = min(cluster_index(uv, z, clusters.near, clusters.far, clusters.counts), 2047u);
    uint list = clusters.cells[cell >> 2u][cell & 3u];
    return uvec2(list & 65535u, list >> 16u);
}

/// The index of a lamp at a place of the lists.
uint listed_lamp(uint place) {
    uint at = min(place, 7679u);
    return (clusters.indices[at >> 4u][(at >> 2u) & 3u] >> (8u * (at & 3u))) & 255u;
}
#endif

#endif
