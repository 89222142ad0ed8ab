//! Lights with an area: spheres, disks, tubes, and rectangles by linearly transformed cosines.
//!
//! Made from `area.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_LIGHTING_AREA_GLSL
#define LAMPLIGHT_LIGHTING_AREA_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The part of one edge in the vector irradiance of a polygon.
///
/// Parameters: `a`, `b` unit directions to the ends of the edge, in a frame whose z is the normal.
/// Returns: the unit normal of the plane of both, times the angle between them over 2*pi; components in [-0.5, 0.5].
/// Source: Lambert, Photometria, 1760; the rational fit of the angle: Heitz, Dupuy, Hill, Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines", 2016, code of the supplement.
/// Edges: zero where `a` and `b` are equal, where they are opposite, whose plane is not known, and where one is zero.
/// Error model: relative 2e-6 + 2^-22/s, with s the sine of the angle.
vec3 ltc_edge(vec3 a, vec3 b) {
    vec3 c = cross(a, b);
    float x = dot(a, b);
    float y = abs(x);
    float fit = (0.8543985 + (0.4965155 + 0.0145206 * y) * y) / (3.417594 + (4.1616724 + y) * y);
    // The fit is for acute angles. An obtuse angle is a half turn minus its supplement, which is acute.
    float obtuse = 0.5 / sqrt(max(dot(c, c), 1e-14)) - fit;
    return c * (x > 0.0 ? fit : obtuse);
}

/// A vector at right angles to another.
///
/// Parameters: `n` unit.
/// Returns: a unit vector, the same for the same `n`.
/// Source: the cross product with an axis that is not along `n`.
/// Edges: zero for a zero vector.
/// Error model: absolute 4*2^-23.
vec3 any_tangent(vec3 n) {
    vec3 axis = abs(n.x) > 0.6 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    return normalize_or_zero(cross(n, axis));
}

/// The integral of a linearly transformed cosine over a rectangle.
///
/// With the identity for `minv` it is the rectangle's form factor: irradiance over pi of a light of radiance 1.
///
/// Parameters: `n`, `v` unit, one space, `v` away from the surface; `p` the lit point, anywhere in that space, scene units; `minv` inverse of the lobe's matrix in the frame of `n` and `v`, as from `ltc_matrix`, with a positive determinant; `quad` corners of a plane convex quadrilateral, the space of `p`: it shines to the side that sees them counter-clockwise.
/// Returns: the integral, in [0, 1] up to rounding. Multiply it by the light's radiance and the lobe's albedo to get the reflected radiance.
/// Source: Heitz, Dupuy, Hill, Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines", 2016; the polygon is cut exactly, at the horizon of the surface and at that of the lobe, which an oblique lobe has below the former.
/// Edges: 0 from behind the light and in its plane, below either horizon, for a `quad` without area, and where `n` or `minv` is zero; the frame's azimuth is any where `v` is along `n` or zero.
/// Error model: absolute 2^-17 for a light that is as large as it is far away; differences of corners and `p` cancel for a point far from the origin.
float ltc_rect(vec3 n, vec3 v, vec3 p, mat3 minv, vec3 quad[4]) {
    vec3 face = cross(quad[2] - quad[0], quad[3] - quad[1]);
    if (!(dot(face, p - quad[0]) > 0.0)) {
        return 0.0;
    }
    vec3 t1 = safe_normalize(v - n * dot(v, n), any_tangent(n));
    vec3 t2 = cross(n, t1);
    vec3 corners[4] = quad;
    vec4 heights = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        vec3 q = corners[i] - p;
        heights[i] = dot(n, q);
        corners[i] = minv * vec3(dot(t1, q), dot(t2, q), heights[i]);
    }
    float sum = 0.0;
    // Where the outline goes below the horizon of the surface, and where it comes back: at most once
    // each. The same for that of the lobe.
    vec3 sets = vec3(0.0);
    vec3 rises = vec3(0.0);
    vec3 leaves = vec3(0.0);
    vec3 enters = vec3(0.0);
    for (int i = 0; i < 5; i++) {
        // The last edge joins what the surface cut.
        vec3 start = sets;
        vec3 end = rises;
        if (i < 4) {
            float here = heights[i];
            float next = heights[(i + 1) % 4];
            start = here > 0.0 ? corners[i] : vec3(0.0);
            end = next > 0.0 ? corners[(i + 1) % 4] : vec3(0.0);
            if ((here > 0.0) != (next > 0.0)) {
                vec3 cut = corners[i] + (corners[(i + 1) % 4] - corners[i]) * (here / (here - next));
                if (here > 0.0) {
                    end = cut;
                    sets = cut;
                } else {
                    start = cut;
                    rises = cut;
                }
            }
        }
        bool is_above = start.z > 0.0 || end.z > 0.0;
        if ((start.z > 0.0) != (end.z > 0.0)) {
            vec3 cut = start + (end - start) * (start.z / (start.z - end.z));
            if (start.z > 0.0) {
                end = vec3(cut.xy, 0.0);
                leaves = end;
            } else {
                start = vec3(cut.xy, 0.0);
                enters = start;
            }
        }
        if (is_above) {
            sum += ltc_edge(safe_normalize(start, vec3(0.0)), safe_normalize(end, vec3(0.0))).z;
        }
    }
    sum += ltc_edge(safe_normalize(leaves, vec3(0.0)), safe_normalize(enters, vec3(0.0))).z;
    return max(-sum, 0.0);
}

/// Where a table of 64 by 64 lobes is read.
///
/// Parameters: `nv` cosine n.v, [0, 1]; `roughness` perceptual, [0, 1].
/// Returns: texture coordinates from the centre of the first texel to that of the last.
/// Source: Heitz, Dupuy, Hill, Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines", 2016, code of the supplement.
/// Edges: parameters outside [0, 1] are clamped to it.
/// Error model: absolute 3*2^-24 + 2^-24/sqrt(1 - nv).
vec2 ltc_uv(float nv, float roughness) {
    vec2 at = vec2(clamp(roughness, 0.0, 1.0), sqrt(1.0 - clamp(nv, 0.0, 1.0)));
    return at * 0.984375 + 0.0078125;
}

/// The inverse matrix of a lobe from the four numbers that a table holds of it.
///
/// Parameters: `t` entries of the inverse, column by column: x of the first column, z of the first, x of the third, z of the third.
/// Returns: the matrix for `ltc_rect`. Of the entries that `t` does not hold, the middle one is 1 and the others are 0.
/// Source: Heitz, Dupuy, Hill, Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines", 2016, code of the supplement.
/// Edges: (1, 0, 0, 1) is the identity: a cosine lobe; zeros flatten all to a line, over which `ltc_rect` is 0; nothing is clamped.
/// Error model: exact.
mat3 ltc_matrix(vec4 t) {
    return mat3(vec3(t.x, 0.0, t.y), vec3(0.0, 1.0, 0.0), vec3(t.z, 0.0, t.w));
}

/// Irradiance from a sphere of radiance 1, the part below the horizon cut off.
///
/// Parameters: `mu` cosine of the angle between the normal and the direction to the centre, [-1, 1]; `sin2` squared sine of half the angle that the sphere subtends, [0, 1]: `R^2/d^2` for its radius `R` and the distance `d` of its centre, 1 on the sphere and within it.
/// Returns: irradiance, [0, pi].
/// Source: Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 4.7.2.1 "Sphere area lights".
/// Edges: 0 for `sin2` of 0 or less; parameters beyond their ranges are clamped; (1 + mu)*pi/2 on the sphere.
/// Error model: absolute 6e-6, relative 2^-22 where the whole sphere is above the horizon.
float sphere_irradiance(float mu, float sin2) {
    float c = min(mu, 1.0);
    float s2 = clamp(sin2, 0.0, 1.0);
    if (c * c >= s2) {
        return 3.1415927 * s2 * max(c, 0.0);
    }
    // Of the angles in which the horizon cuts the sphere the tangents are known: no arc cosine loses digits.
    float x = sqrt((1.0 - s2) / s2);
    float q = sqrt((s2 - c * c) / s2);
    float angle = atan(q, -x * c);
    return max((c * angle - x * q) * s2 + atan(q, x), 0.0);
}

/// Irradiance from a disk of radiance 1, the part below the horizon cut off.
///
/// Parameters: `mu` cosine of the angle between the normal and the direction to the centre, [-1, 1]; `facing` cosine of the angle between the disk's normal and the direction from its centre to the point, [-1, 1]; `sin2` squared sine of half the angle that the disk subtends for a point on its axis, [0, 1]: `R^2/(R^2 + d^2)` for its radius `R` and the distance `d` of its centre.
/// Returns: irradiance, [0, pi].
/// Source: Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 4.7.2.2 "Disk area lights".
/// Edges: as for `sphere_irradiance`; 0 from behind, for a `facing` of 0 or below; exact for a disk that faces the point.
/// Error model: that of `sphere_irradiance`, and 1 ULP.
float disk_irradiance(float mu, float facing, float sin2) {
    return sphere_irradiance(mu, sin2) * clamp(facing, 0.0, 1.0);
}

/// The representative point of a spherical light for a reflection.
///
/// Parameters: `l` vector from the lit point to the centre, scene units, any length; `r` unit mirror direction, the space of `l`: the direction to the viewer, mirrored at the normal; `radius` of the sphere, scene units, at least 0.
/// Returns: vector from the lit point to that point, scene units. If the mirror ray meets the sphere, it is the ray's point nearest to the centre, else the sphere's point nearest to the ray.
/// Source: Karis, "Real Shading in Unreal Engine 4", 2013, "Representative Point Method"; for a mirrored direction away from the light the ray ends at the lit point.
/// Edges: `l` for a `radius` of 0 or less, and where the ray goes through the centre; for a zero `r` the point of the sphere, or of what is in it, that is nearest to the lit point.
/// Error model: absolute 2^-20*|l|.
vec3 nearest_sphere(vec3 l, vec3 r, float radius) {
    vec3 c = r * max(dot(l, r), 0.0) - l;
    return l + c * clamp(radius * inversesqrt(dot(c, c) + SMALLEST_NORMAL), 0.0, 1.0);
}

/// The representative point of a tubular light for a reflection.
///
/// Parameters: `l0`, `l1` vectors from the lit point to the ends of the tube's axis, scene units; `r` unit mirror direction, the same space; `radius` of the tube, scene units, at least 0.
/// Returns: vector from the lit point to that point, as from `nearest_sphere` at the axis' point nearest to the line of `r`.
/// Source: Karis, "Real Shading in Unreal Engine 4", 2013, "Tube lights": the smallest distance of the axis to the line.
/// Edges: the sphere at `l0` for an axis along `r` or without length, where `l0` and `l1` are equal; the axis' point for a `radius` of 0 or less; as for `nearest_sphere` for a zero `r`, at the axis' point that is nearest to the lit point.
/// Error model: absolute 2^-20*(|l0| + |l1|)/sin(a)^2, with a the angle between the axis and `r`.
vec3 nearest_tube(vec3 l0, vec3 l1, vec3 r, float radius) {
    vec3 axis = l1 - l0;
    vec3 across = axis - r * dot(axis, r);
    float d2 = dot(across, across);
    float share = clamp(-dot(l0, across) / d2, 0.0, 1.0);
    return nearest_sphere(l0 + axis * (d2 > 1e-10 * dot(axis, axis) ? share : 0.0), r, radius);
}

/// The roughness of a lobe widened by the size of a light.
///
/// Parameters: `alpha` squared perceptual roughness, [0, 1]; `radius` of the light, scene units, at least 0; `d` distance to it, scene units, above 0.
/// Returns: `alpha + radius/(2*d)`, clamped to [0, 1].
/// Source: Karis, "Real Shading in Unreal Engine 4", 2013, "Specular D Modification": half of `radius/d`, of which other versions take a third.
/// Edges: 1 for a `d` of 0 or less from a light with a size; `alpha`, clamped, for a `radius` of 0 or less.
/// Error model: 3 ULP.
float area_alpha(float alpha, float radius, float d) {
    float size = max(radius, 0.0);
    // Nearer than a quarter of the size the sum is above 1.
    return clamp(alpha + 0.5 * size / max(d, 0.25 * size + SMALLEST_NORMAL), 0.0, 1.0);
}

/// The normalisation factor of a lobe that was widened by the size of a light.
///
/// Parameters: `alpha` squared perceptual roughness, at least 0; `wide` the same after `area_alpha`.
/// Returns: `(alpha/wide)^2`, [0, 1]. Multiply the distribution by it for a sphere, and by its square root for a tube.
/// Source: Karis, "Real Shading in Unreal Engine 4", 2013, "Specular D Modification".
/// Edges: 1 where `wide` is not larger than `alpha`; 0 for an `alpha` of 0 or less that was widened.
/// Error model: 6 ULP.
float area_energy(float alpha, float wide) {
    if (!(wide > alpha)) {
        return 1.0;
    }
    if (!(alpha > 0.0)) {
        return 0.0;
    }
    float ratio = alpha / wide;
    return ratio * ratio;
}

/// The integral of a linearly transformed cosine over a disk or an ellipse.
///
/// With the identity for `minv` it is the form factor: irradiance over pi of a light of radiance 1.
///
/// Parameters: `n`, `v` unit, one space, `v` away from the surface; `p` the lit point, anywhere in that space, scene units; `minv` as for `ltc_rect`; `center`, `ex`, `ey` centre and half axes of the ellipse, the space of `p`: it shines to the side to which the cross product of its axes points.
/// Returns: the integral, in [0, 1] up to rounding. Multiply it by the light's radiance and the lobe's albedo to get the reflected radiance.
/// Source: Heitz, Hill, "Real-Time Line- and Disk-Light Shading with Linearly Transformed Cosines", SIGGRAPH, 2017: `L1*L2/sqrt((1 + L1^2)*(1 + L2^2))` with the half axes of the cone of directions, whose largest eigenvalue is found here by Newton's method.
/// Edges: 0 from behind the light and below either horizon, for an ellipse without area, so where `ex` or `ey` is zero, where `center` is at `p`, and where `n` or `minv` is zero; the frame's azimuth is any where `v` is along `n` or zero; where the horizon of the surface cuts the light, an ellipse of the same area and height as what is above stands for that, and where that of the lobe does, a sphere of the same form factor.
/// Error model: absolute 2^-18 for a light that is as large as it is far away, beside what both are off at the horizons, up to 0.03.
float ltc_disk(vec3 n, vec3 v, vec3 p, mat3 minv, vec3 center, vec3 ex, vec3 ey) {
    vec3 t1 = safe_normalize(v - n * dot(v, n), any_tangent(n));
    vec3 t2 = cross(n, t1);
    vec3 q = center - p;
    vec3 rising = ex;
    vec3 level = ey;
    // Of the half axes, one rises most above the horizon of the surface, and one not at all.
    vec2 slope = vec2(dot(n, ex), dot(n, ey));
    float reach = length(slope);
    float height = dot(n, q);
    if (!(height > -reach)) {
        return 0.0;
    }
    if (height < reach) {
        // The part above the horizon is a segment, whose place an ellipse of its height and its area takes.
        float edge = -height / reach;
        float half_height = max(0.5 - 0.5 * edge, 1e-6);
        float half_chord = sqrt(max(1.0 - edge * edge, 0.0));
        float area = atan(half_chord, edge) - edge * half_chord;
        vec2 up = slope / reach;
        rising = ex * up.x + ey * up.y;
        level = (ey * up.x - ex * up.y) * (area * 0.31830989 / half_height);
        q += rising * (1.0 - half_height);
        rising *= half_height;
    }
    vec3 far = minv * vec3(dot(t1, q), dot(t2, q), dot(n, q));
    float scale = 1.0 / max(length(far), 1e-18);
    vec3 c = far * scale;
    vec3 a = minv * vec3(dot(t1, rising), dot(t2, rising), dot(n, rising)) * scale;
    vec3 b = minv * vec3(dot(t1, level), dot(t2, level), dot(n, level)) * scale;
    vec3 ab = cross(a, b);
    float volume = dot(c, ab);
    if (!(volume < 0.0)) {
        return 0.0;
    }
    // The directions of the light are those with a positive value of a quadric, whose inverse is c*c - a*a - b*b as
    // outer products: it has one positive eigenvalue, which is at most 1, and its eigenvector is the light's axis.
    vec3 ca = cross(c, a);
    vec3 cb = cross(c, b);
    float trace = 1.0 - dot(a, a) - dot(b, b);
    float minors = dot(ab, ab) - dot(ca, ca) - dot(cb, cb);
    float root = 1.0;
    for (int i = 0; i < 10; i++) {
        float value = ((root - trace) * root + minors) * root - volume * volume;
        root -= value / ((3.0 * root - 2.0 * trace) * root + minors);
    }
    float product = volume * volume / root;
    vec3 once = c - a * dot(a, c) - b * dot(b, c);
    vec3 twice = c * dot(c, once) - a * dot(a, once) - b * dot(b, once);
    vec3 axis = safe_normalize(twice + (root - trace) * once + product * c, vec3(0.0));
    float share = -volume * inversesqrt(max(root * ((3.0 * root - 2.0 * trace) * root + minors), 1e-30));
    return sphere_irradiance(axis.z, share) * 0.31830989;
}

/// The integral of a linearly transformed cosine over a thin tube.
///
/// Parameters: `n`, `v`, `p`, `minv` as for `ltc_rect`; `a`, `b` ends of the tube's axis, the space of `p`, scene units; `radius` of the tube, scene units, small compared to its distance.
/// Returns: the integral, [0, 1], without the caps. Multiply it by the light's radiance and the lobe's albedo to get the reflected radiance.
/// Source: Heitz, Hill, "Real-Time Line- and Disk-Light Shading with Linearly Transformed Cosines", SIGGRAPH, 2017: `l/(d*(d^2 + l^2)) + atan(l/d)/d^2` from end to end, times the radius over pi, without the differences that cancel.
/// Edges: the part below the horizon is cut off; 0 where `a` and `b` are equal, where the line goes through `p`, and where `n` or `minv` is zero; the frame's azimuth is any where `v` is along `n` or zero; a tube that is too thick for its distance counts as one that covers the hemisphere; a negative `radius` counts as 0, which gives 0.
/// Error model: absolute 2^-18 for a tube of a tenth of its distance.
float ltc_line(vec3 n, vec3 v, vec3 p, mat3 minv, vec3 a, vec3 b, float radius) {
    vec3 t1 = safe_normalize(v - n * dot(v, n), any_tangent(n));
    vec3 t2 = cross(n, t1);
    vec3 qa = vec3(dot(t1, a - p), dot(t2, a - p), dot(n, a - p));
    vec3 qb = vec3(dot(t1, b - p), dot(t2, b - p), dot(n, b - p));
    if (!(qa.z > 0.0 || qb.z > 0.0)) {
        return 0.0;
    }
    vec3 across = safe_normalize(cross(qa, qb), vec3(0.0));
    if (qa.z < 0.0) {
        qa = qa + (qb - qa) * (qa.z / (qa.z - qb.z));
    }
    if (qb.z < 0.0) {
        qb = qb + (qa - qb) * (qb.z / (qb.z - qa.z));
    }
    vec3 head = minv * qa;
    vec3 tail = minv * qb;
    if (!(head.z > 0.0 || tail.z > 0.0) || dot(across, across) == 0.0) {
        return 0.0;
    }
    if (head.z < 0.0) {
        head = head + (tail - head) * (head.z / (head.z - tail.z));
    }
    if (tail.z < 0.0) {
        tail = tail + (head - tail) * (tail.z / (tail.z - head.z));
    }
    vec3 along = safe_normalize(tail - head, vec3(0.0));
    float l1 = dot(head, along);
    float l2 = dot(tail, along);
    vec3 nearest = head - along * l1;
    float d = max(length(nearest), 1e-12);
    float span = (l2 - l1) * d / max(dot(head, head) * dot(tail, tail), 1e-30);
    float rise = span * (d * d - l1 * l2) + atan(d * (l2 - l1), d * d + l1 * l2);
    float sum = nearest.z / d * rise / d + along.z * span * (l1 + l2);
    // How much narrower than the transformed light its own is: the determinant over the cofactors of the inverse matrix.
    vec3 c0 = cross(minv[1], minv[2]);
    vec3 wide = across.x * c0 + across.y * cross(minv[2], minv[0]) + across.z * cross(minv[0], minv[1]);
    float width = max(radius, 0.0) * dot(minv[0], c0) * inversesqrt(max(dot(wide, wide), 1e-30));
    return clamp(width * sum * 0.31830989, 0.0, 1.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
