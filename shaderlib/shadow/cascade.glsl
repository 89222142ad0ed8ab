//! Which of up to four cascaded shadow maps covers a point.

#ifndef LAMPLIGHT_SHADOW_CASCADE_GLSL
#define LAMPLIGHT_SHADOW_CASCADE_GLSL

/// The index of the cascade that covers a distance.
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
float cascade_blend(float view_depth, vec4 splits, float overlap) {
    int index = cascade_index(view_depth, splits);
    if (index > 3 || !(overlap > 0.0)) {
        return 0.0;
    }
    return clamp((view_depth - splits[index] + overlap) / overlap, 0.0, 1.0);
}

#endif
