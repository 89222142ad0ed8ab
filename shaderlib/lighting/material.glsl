//! What a surface does with light, and how a fragment chooses among an array of materials.
//!
//! Made from `material.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_LIGHTING_MATERIAL_GLSL
#define LAMPLIGHT_LIGHTING_MATERIAL_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// A material, 64 bytes, the same in uniform (std140) and storage buffers.
struct Material {
    /// Linear colour the surface emits, at least 0.
    vec3 emission;
    /// Exponent of the Phong and Blinn-Phong highlights, at least 0.
    float shininess;
    /// Linear reflectance of ambient light, [0, 1].
    vec3 ambient;
    /// Perceptual roughness, [0, 1]: the `alpha` of GGX is its square.
    float roughness;
    /// Linear diffuse reflectance, [0, 1].
    vec3 diffuse;
    /// Wrap of diffuse light around the terminator, [0, 1].
    float wrap;
    /// Linear specular reflectance, [0, 1]: the `f0` of Fresnel's terms.
    vec3 specular;
    /// Oren-Nayar's standard deviation of the facets' slope, radians.
    float sigma;
};

/// The index of the material on the visible side, in an array of front and back pairs.
///
/// Parameters: `i` number of the pair, at least 0; `front` whether the front side is visible.
/// Returns: `2*i` in front, `2*i + 1` behind.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.11, with the doubling done here.
/// Edges: a negative `i` gives a negative index: the caller keeps it inside the array.
/// Error model: exact.
int material_index(int i, bool front) {
    return 2 * i + (front ? 0 : 1);
}

/// The index of the material on the visible side, as the book prints it.
///
/// It differs from `material_index` in that the caller passes twice the number of the pair:
/// with the plain number, the back of one pair is the front of the next.
///
/// Parameters: `i` twice the number of the pair, at least 0; `front` whether the front side is visible.
/// Returns: `i` in front, `i + 1` behind.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.11.
/// Edges: a negative `i` gives an index of at most 0: the caller keeps it inside the array.
/// Error model: exact.
int material_index_oglpg(int i, bool front) {
    return front ? i : i + 1;
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
