//! The materials of `forward`, for the stages that read them. A program without the axis `material`
//! has an array.

#ifndef LAMPLIGHT_PROGRAMS_FORWARD_MATERIALS_GLSL
#define LAMPLIGHT_PROGRAMS_FORWARD_MATERIALS_GLSL

#include "../../lighting/material.glsl"

#if defined(MATERIAL) && MATERIAL == MATERIAL_SINGLE
#define MATERIALS 1
#elif TWO_SIDED
#define MATERIALS 28
#else
#define MATERIALS 14
#endif

/// Materials in one array: pairs of front and back with `two_sided`.
layout(std140, set = 1, binding = 0) uniform Materials {
    Material items[MATERIALS];
} materials;

#endif
