//! Normals: of triangles, from textures, and of the visible side.
//!
//! Made from `normal.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_SURFACE_NORMAL_GLSL
#define LAMPLIGHT_SURFACE_NORMAL_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The normal of a triangle, twice its area long.
///
/// The sum over the faces around a vertex, normalised, is the vertex's normal, each face weighted by its area.
///
/// Parameters: `a`, `b`, `c` corners, one space, scene units.
/// Returns: `(b - a) x (c - a)`, scene units^2, in that space.
/// Source: Newcastle University, Graphics for Games, tutorial 11 "Real-Time Lighting A".
/// Edges: zero for a triangle without area, so where two of `a`, `b` and `c` are equal.
/// Error model: absolute 2*2^-23*|b - a|*|c - a|.
vec3 face_normal_area(vec3 a, vec3 b, vec3 c) {
    return cross(b - a, c - a);
}

/// The unit normal of a triangle, towards the side that sees its corners counter-clockwise.
///
/// Parameters: `a`, `b`, `c` corners, one space, scene units.
/// Returns: unit vector along `(b - a) x (c - a)`, in that space.
/// Source: Newcastle University, Graphics for Games, tutorial 11 "Real-Time Lighting A".
/// Edges: (0, 0, 1) for a triangle without area, so where two of `a`, `b` and `c` are equal.
/// Error model: that of `safe_normalize` + 4*2^-23*|b - a|*|c - a|/area; the differences cancel for corners far from the origin.
vec3 face_normal(vec3 a, vec3 b, vec3 c) {
    return safe_normalize(face_normal_area(a, b, c), vec3(0.0, 0.0, 1.0));
}

/// The normal bent by a normal map.
///
/// On the back of a surface, whose normal is turned round, `-tangent` bends it: the bent normal is the opposite of that of the front.
///
/// Parameters: `n` unit normal; `tangent` unit tangent in `xyz`, the same space, with the bitangent's sign, 1 or -1, in `w`; `texel` value of the normal map, [0, 1] in each channel, where 0.5 stands for 0.
/// Returns: unit normal, in that space.
/// Source: Blinn, "Simulation of Wrinkled Surfaces", 1978; the tangent's sign as in Khronos Group, glTF 2.0, "Meshes".
/// Edges: `n` where `tangent` is zero or along `n`, with a blue of at least 0.5, and for a `texel` of 0.5, 0.5, 0.5, which is not clamped; for a zero `n` only the tangent's part is left.
/// Error model: absolute 6*2^-23/(sin(a)*min(|2*texel - 1|, 1)), with a the angle between `n` and the tangent.
vec3 perturb_normal(vec3 n, vec4 tangent, vec3 texel) {
    vec3 t = normalize_or_zero(tangent.xyz - n * dot(n, tangent.xyz));
    vec3 b = cross(n, t) * tangent.w;
    vec3 bent = 2.0 * texel - 1.0;
    return safe_normalize(t * bent.x + b * bent.y + n * bent.z, n);
}

/// The normal of the visible side.
///
/// Parameters: `n` unit normal of the front; `front` whether the front side is visible.
/// Returns: `n` in front, `-n` behind.
/// Source: an addition to Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.11. The example does not flip the normal, so its back faces have no diffuse light.
/// Edges: zero for a zero `n`.
/// Error model: exact.
vec3 flip_if_back(vec3 n, bool front) {
    return front ? n : -n;
}

/// A detail normal laid onto a base normal, by the rotation that takes z to the base.
///
/// Parameters: `base`, `detail` unit normals in tangent space, z out of the surface, `base.z` above -1.
/// Returns: unit normal in tangent space.
/// Source: Hill, "Blending in Detail", 2012: reoriented normal mapping.
/// Edges: `detail` for a base of z, `base` for a detail of z; `base` where it looks straight down, and for a zero `detail`; `detail` without its z for a zero `base`.
/// Error model: absolute 8*2^-23/(1 + base.z).
vec3 blend_rnm(vec3 base, vec3 detail) {
    vec3 t = vec3(base.xy, base.z + 1.0);
    if (!(t.z > 1e-6)) {
        return base;
    }
    vec3 u = vec3(-detail.xy, detail.z);
    return safe_normalize(t * (dot(t, u) / t.z) - u, base);
}

/// A detail normal laid onto a base normal by the sum of their slopes' directions, cheaply.
///
/// Parameters: `base`, `detail` unit normals in tangent space, z out of the surface.
/// Returns: unit normal along `(base.xy + detail.xy, base.z)`, tangent space.
/// Source: Hill, "Blending in Detail", 2012, after Epic Games' Unreal Developer Network: UDN blending.
/// Edges: `base` where the sum is zero; `base`, normalised, for a zero `detail`.
/// Error model: absolute 8*2^-23 over the length of the sum.
vec3 blend_udn(vec3 base, vec3 detail) {
    return safe_normalize(vec3(base.xy + detail.xy, base.z), base);
}

/// A detail normal laid onto a base normal with both of their slopes.
///
/// Parameters: `base`, `detail` unit normals in tangent space, z out of the surface.
/// Returns: unit normal along `(base.xy + detail.xy, base.z*detail.z)`, tangent space.
/// Source: Oat, Tatarchuk, Isidoro, "Layered Car Paint Shader", ShaderX 2, 2003; Hill, "Blending in Detail", 2012: whiteout blending.
/// Edges: `base` where the sum is zero; without a z where `base` or `detail` is zero.
/// Error model: absolute 8*2^-23 over the length of the sum.
vec3 blend_whiteout(vec3 base, vec3 detail) {
    return safe_normalize(vec3(base.xy + detail.xy, base.z * detail.z), base);
}

/// A normal in two numbers, for G-buffers: the mirror ball's equal-area map.
///
/// Parameters: `n` unit normal in view space, z towards the viewer.
/// Returns: `n.xy/sqrt(8*n.z + 8) + 1/2`, a disk in [0, 1].
/// Source: Mittring, "A bit more deferred - CryEngine 3", 2009: the sphere map transform, which is Lambert's azimuthal projection of equal area.
/// Edges: (0.5, 0.5), the centre of the disk, for a zero `n`; a `1 + n.z` below 1e-7 counts as that: straight away from the viewer is the centre, like straight towards.
/// Error model: absolute 2^-23 + 2^-24/(1 + n.z).
vec2 spheremap_encode(vec3 n) {
    return n.xy / sqrt(8.0 * max(1.0 + n.z, 1e-7)) + 0.5;
}

/// The normal that `spheremap_encode` holds in two numbers.
///
/// Parameters: `e` place on the disk, [0, 1].
/// Returns: unit normal in view space.
/// Source: Mittring, "A bit more deferred - CryEngine 3", 2009: the inverse of the sphere map transform.
/// Edges: places beyond the disk count as its rim, and give the opposite of z but for rounding.
/// Error model: absolute 2^-20.
vec3 spheremap_decode(vec2 e) {
    vec2 f = 4.0 * e - 2.0;
    float s = min(dot(f, f), 4.0);
    return vec3(f * sqrt(1.0 - 0.25 * s), 1.0 - 0.5 * s);
}

/// A tangent in the world, with the sign of the bitangent there.
///
/// An object that is mirrored has its bitangent on the other side of the normal and the tangent.
///
/// Parameters: `tangent` in `xyz`, in the object's space, with the bitangent's sign, 1 or -1, in `w`; `world_from_object` an affine transform, for column vectors.
/// Returns: the tangent in `xyz`, not unit, and the sign in `w`, which changes if the determinant is below 0.
/// Source: Khronos Group, glTF 2.0, "Meshes": the bitangent is the cross product of normal and tangent times `w`; a cross product changes its sign with what mirrors.
/// Edges: the sign stays for a `world_from_object` whose determinant is 0; a zero `tangent` stays zero; `w` of any size is kept.
/// Error model: absolute 6*2^-23*s*|t|, with s the largest member and t the tangent; a determinant that is 0 but for rounding may have either sign.
vec4 world_tangent(vec4 tangent, mat4 world_from_object) {
    mat4 m = world_from_object;
    bool is_mirrored = determinant(mat3(m[0].xyz, m[1].xyz, m[2].xyz)) < 0.0;
    return vec4((m * vec4(tangent.xyz, 0.0)).xyz, is_mirrored ? -tangent.w : tangent.w);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
