//! From a point to its place in a shadow map. Conventions of clip space and texture space are handled here and nowhere else.

#ifndef LAMPLIGHT_SHADOW_COORD_GLSL
#define LAMPLIGHT_SHADOW_COORD_GLSL

#include "../math/safe.glsl"

/// A point's place in a shadow map.
struct ShadowUv {
    /// Texture coordinates, origin at the map's first texel; [0, 1] inside.
    vec2 uv;
    /// Depth to compare with the map, [0, 1] from near to far.
    float depth;
    /// Whether the point is inside the light's frustum. Outside is lit.
    bool inside;
};

/// Whether texture coordinates are on the map.
bool is_on_map(vec2 uv) {
    return uv.x >= 0.0 && uv.x <= 1.0 && uv.y >= 0.0 && uv.y <= 1.0;
}

/// A point in the light's clip space.
vec4 shadow_coord(mat4 m, vec3 p_world) {
    return m * vec4(p_world, 1.0);
}

/// The place in the shadow map of a point in clip space, for depths in [0, 1] and rows from the top.
ShadowUv project(vec4 sc, float min_w) {
    if (!(sc.w > max(min_w, SMALLEST_NORMAL))) {
        return ShadowUv(vec2(0.0), 0.0, false);
    }
    vec3 ndc = sc.xyz / sc.w;
    vec2 uv = vec2(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y);
    return ShadowUv(uv, ndc.z, is_on_map(uv) && ndc.z >= 0.0 && ndc.z <= 1.0);
}

/// The place in the shadow map of a point in OpenGL's clip space, depths from -1 to 1 and rows from the bottom.
ShadowUv project_gl(vec4 sc, float min_w) {
    return project(vec4(sc.x, -sc.y, 0.5 * (sc.z + sc.w), sc.w), min_w);
}

/// The distance along the view axis that a perspective depth stands for.
float linearize_depth(float d, float near, float far) {
    // The weighted sum does not cancel near d = 1, as far - d*(far - near) does.
    return near * far / max(far * (1.0 - d) + near * d, SMALLEST_NORMAL);
}

/// The brightness Igalia's tutorial shows for a depth.
float depth_view_igl(float d) {
    return 1.0 - (1.0 - d) * 100.0;
}

/// The depth a perspective face of a cube map holds for an offset from the light.
float cube_depth(vec3 offset, float near, float far) {
    float z = max(max(max(abs(offset.x), abs(offset.y)), abs(offset.z)), max(near, SMALLEST_NORMAL));
    return far / max(far - near, SMALLEST_NORMAL) * ((z - near) / z);
}

#endif
