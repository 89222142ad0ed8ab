//! Lamps with an area, for `forward` with `area`.
//!
//! The area changes where light comes from, and not how much of it there is: far away, a lamp
//! lights as a point light of its colour and falloff, which are those of its middle. So every
//! result is in the unit of a point light that faces the surface.
//!
//! The light that falls onto the surface from spheres and rectangles is exact. That from tubes is of
//! their axis, whose points shine to all sides alike (Picott, "Extensions of the Linear and Area
//! Lighting Models", 1992). Highlights of rectangles are linearly transformed cosines (Heitz et al.,
//! 2016), those of spheres and tubes are of a representative point (Karis, 2013).
//!
//! Made from `areas.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_PROGRAMS_AREAS_GLSL
#define LAMPLIGHT_PROGRAMS_AREAS_GLSL

#if AREA == AREA_SPHERE || AREA == AREA_TUBE
#include "../brdf/specular.glsl"
#endif
#if AREA == AREA_RECTANGLE || AREA == AREA_SPHERE || AREA == AREA_TUBE
#include "../lighting/area.glsl"
#endif
#if AREA == AREA_SPHERE || AREA == AREA_TUBE
#include "../math/safe.glsl"
#endif

/// The extent of a lamp.
struct Area {
    /// `rectangle`: half of its width; `tube`: half of its axis; scene units, in the world.
    vec3 right;
    /// `sphere`, `tube`: scene units, at least 0.
    float radius;
    /// `rectangle`: half of its height, scene units. It shines towards `cross(right, up)`.
    vec3 up;
};

/// How a lamp of some size is seen in a highlight.
struct Seen {
    /// Unit direction of the light.
    vec3 l;
    /// Factor on the highlight, which is wider by as much.
    float gain;
};

#if AREA == AREA_RECTANGLE && SPECULAR == SPECULAR_GGX
layout(set = 1, binding = 10) uniform texture2D ltc_table;
layout(set = 1, binding = 11) uniform sampler table_sampler;
#endif

#if AREA == AREA_RECTANGLE
/// The light of the rectangle around `middle` that a lobe takes in, over pi. The rectangle is
/// brighter if it is smaller.
float reflected_rectangle(Area extent, vec3 normal, vec3 view, vec3 position, vec3 middle, mat3 lobe) {
    vec3 right = extent.right;
    vec3 up = extent.up;
    vec3 corners[4] = vec3[4](middle - right - up, middle + right - up, middle + right + up, middle - right + up);
    vec3 offset = middle - position;
    float brightness = dot(offset, offset) / max(4.0 * length(cross(right, up)), 1e-12);
    return brightness * ltc_rect(normal, view, position, lobe, corners);
}
#endif

#if AREA == AREA_SPHERE
/// The light that falls onto a surface from the lamp around `middle`.
float area_share(Area extent, vec3 normal, vec3 position, vec3 middle) {
    float radius = extent.radius;
    vec3 offset = middle - position;
    float d2 = max(dot(offset, offset), 1e-12);
    float mu = dot(normal, offset) * inversesqrt(d2);
    float sin2 = min(radius * radius / d2, 1.0);
    if (!(sin2 > 1e-12)) {
        return max(mu, 0.0);
    }
    return sphere_irradiance(mu, sin2) / (3.14159265 * sin2);
}
#elif AREA == AREA_TUBE
float area_share(Area extent, vec3 normal, vec3 position, vec3 middle) {
    vec3 half_axis = extent.right;
    vec3 offset = middle - position;
    vec3 start = offset - half_axis;
    vec3 end = offset + half_axis;
    float a = dot(normal, start);
    float b = dot(normal, end);
    if (a <= 0.0 && b <= 0.0) {
        return 0.0;
    }
    // What is below the horizon does not shine.
    float part = 1.0;
    if (a < 0.0) {
        part = b / (b - a);
        start = end + (start - end) * part;
    } else if (b < 0.0) {
        part = a / (a - b);
        end = start + (end - start) * part;
    }
    vec2 far = vec2(length(start), length(end));
    float sum = max(dot(normal, start), 0.0) / max(far.x, 1e-6) + max(dot(normal, end), 0.0) / max(far.y, 1e-6);
    // The same closest distance as that of point lights: a centimetre, where a scene unit is a metre.
    return dot(offset, offset) * part * sum / max(far.x * far.y + dot(start, end), 0.0001);
}
#elif AREA == AREA_RECTANGLE
float area_share(Area extent, vec3 normal, vec3 position, vec3 middle) {
    // A cosine looks alike from all sides, so any direction may be the viewer's.
    mat3 cosine = ltc_matrix(vec4(1.0, 0.0, 0.0, 1.0));
    return 3.14159265 * reflected_rectangle(extent, normal, any_tangent(normal), position, middle, cosine);
}
#endif

#if AREA == AREA_SPHERE || AREA == AREA_TUBE
/// The point of a lamp around `middle` that the surface mirrors, or the nearest one to that.
Seen seen_lamp(Area extent, vec3 normal, vec3 view, vec3 position, vec3 middle, float roughness) {
    vec3 offset = middle - position;
    vec3 mirrored = reflect(-view, normal);
    float alpha = max(roughness * roughness, LEAST_ALPHA);
    float d = length(offset);
    float round = area_energy(alpha, area_alpha(alpha, extent.radius, d));
#if AREA == AREA_SPHERE
    vec3 nearest = nearest_sphere(offset, mirrored, extent.radius);
    float gain = round;
#elif AREA == AREA_TUBE
    vec3 nearest = nearest_tube(offset - extent.right, offset + extent.right, mirrored, extent.radius);
#endif
#if AREA == AREA_TUBE
    // A line is wide in one direction.
    float gain = round * sqrt(area_energy(alpha, area_alpha(alpha, length(extent.right), d)));
#endif
    return Seen(safe_normalize(nearest, normal), gain);
}
#endif

#if AREA == AREA_RECTANGLE && SPECULAR == SPECULAR_GGX
/// The lobe of a surface of this cosine of the viewer, as a matrix for `reflected_rectangle`.
mat3 table_lobe(float nv, float roughness) {
    return ltc_matrix(textureLod(sampler2D(ltc_table, table_sampler), ltc_uv(nv, roughness), 0.0));
}
#endif

#endif
