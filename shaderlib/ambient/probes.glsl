//! Published light probes: radiance around ten places as nine spherical harmonics, for
//! `ambient::sh`.
//!
//! Made from `probes.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_AMBIENT_PROBES_GLSL
#define LAMPLIGHT_AMBIENT_PROBES_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The light around a point: a breezeway.
///
/// Parameters: none.
/// Returns: nine linear RGB coefficients of the radiance, ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, table 7.1.
/// Edges: none.
/// Error model: exact: the published digits.
vec3[9] probe_breezeway() {
    return vec3[9](
        vec3(0.32, 0.36, 0.38),
        vec3(0.37, 0.41, 0.45),
        vec3(-0.01, -0.01, -0.01),
        vec3(-0.1, -0.12, -0.12),
        vec3(-0.13, -0.15, -0.17),
        vec3(-0.01, -0.02, 0.02),
        vec3(-0.07, -0.08, -0.09),
        vec3(0.02, 0.03, 0.03),
        vec3(-0.29, -0.32, -0.36)
    );
}

/// The light around a point: a campus at sunset.
///
/// Parameters: none.
/// Returns: nine linear RGB coefficients of the radiance, ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, table 7.1.
/// Edges: none.
/// Error model: exact: the published digits.
vec3[9] probe_campus_sunset() {
    return vec3[9](
        vec3(0.79, 0.94, 0.98),
        vec3(0.44, 0.56, 0.7),
        vec3(-0.1, -0.18, -0.27),
        vec3(0.45, 0.38, 0.2),
        vec3(0.18, 0.14, 0.05),
        vec3(-0.14, -0.22, -0.31),
        vec3(-0.39, -0.4, -0.36),
        vec3(0.09, 0.07, 0.04),
        vec3(0.67, 0.67, 0.52)
    );
}

/// The light around a point: a eucalyptus grove.
///
/// Parameters: none.
/// Returns: nine linear RGB coefficients of the radiance, ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, table 7.1.
/// Edges: none.
/// Error model: exact: the published digits.
vec3[9] probe_eucalyptus_grove() {
    return vec3[9](
        vec3(0.38, 0.43, 0.45),
        vec3(0.29, 0.36, 0.41),
        vec3(0.04, 0.03, 0.01),
        vec3(-0.1, -0.1, -0.09),
        vec3(-0.06, -0.06, -0.04),
        vec3(0.01, -0.01, -0.05),
        vec3(-0.09, -0.13, -0.15),
        vec3(-0.06, -0.05, -0.04),
        vec3(0.02, 0.0, -0.05)
    );
}

/// The light around a point: Funston Beach at sunset.
///
/// Parameters: none.
/// Returns: nine linear RGB coefficients of the radiance, ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, table 7.1.
/// Edges: none.
/// Error model: exact: the published digits.
vec3[9] probe_funston_beach_sunset() {
    return vec3[9](
        vec3(0.68, 0.69, 0.7),
        vec3(0.32, 0.37, 0.44),
        vec3(-0.17, -0.17, -0.17),
        vec3(-0.45, -0.42, -0.34),
        vec3(-0.17, -0.17, -0.15),
        vec3(-0.08, -0.09, -0.1),
        vec3(-0.03, -0.02, -0.01),
        vec3(0.16, 0.14, 0.1),
        vec3(0.37, 0.31, 0.2)
    );
}

/// The light around a point: Galileo's tomb.
///
/// Parameters: none.
/// Returns: nine linear RGB coefficients of the radiance, ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, table 7.1.
/// Edges: none.
/// Error model: exact: the published digits.
vec3[9] probe_galileos_tomb() {
    return vec3[9](
        vec3(1.04, 0.76, 0.71),
        vec3(0.44, 0.34, 0.34),
        vec3(-0.22, -0.18, -0.17),
        vec3(0.71, 0.54, 0.56),
        vec3(0.64, 0.5, 0.52),
        vec3(-0.12, -0.09, -0.08),
        vec3(-0.37, -0.28, -0.29),
        vec3(-0.17, -0.13, -0.13),
        vec3(0.55, 0.42, 0.42)
    );
}

/// The light around a point: Grace Cathedral.
///
/// Parameters: none.
/// Returns: nine linear RGB coefficients of the radiance, ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, table 7.1.
/// Edges: none.
/// Error model: exact: the published digits.
vec3[9] probe_grace_cathedral() {
    return vec3[9](
        vec3(0.79, 0.44, 0.54),
        vec3(0.39, 0.35, 0.6),
        vec3(-0.34, -0.18, -0.27),
        vec3(-0.29, -0.06, 0.01),
        vec3(-0.11, -0.05, -0.12),
        vec3(-0.26, -0.22, -0.47),
        vec3(-0.16, -0.09, -0.15),
        vec3(0.56, 0.21, 0.14),
        vec3(0.21, -0.05, -0.3)
    );
}

/// The light around a point: the old town square.
///
/// Parameters: none.
/// Returns: nine linear RGB coefficients of the radiance, ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, table 7.1.
/// Edges: none.
/// Error model: exact: the published digits.
vec3[9] probe_old_town_square() {
    return vec3[9](
        vec3(0.87, 0.88, 0.86),
        vec3(0.18, 0.25, 0.31),
        vec3(0.03, 0.04, 0.04),
        vec3(0.0, -0.03, -0.05),
        vec3(-0.12, -0.12, -0.12),
        vec3(0.0, 0.0, 0.01),
        vec3(-0.03, -0.02, -0.02),
        vec3(-0.08, -0.09, -0.09),
        vec3(-0.16, -0.19, -0.22)
    );
}

/// The light around a point: the old town square, in six digits.
///
/// Parameters: none.
/// Returns: nine linear RGB coefficients of the radiance, ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.14.
/// Edges: none.
/// Error model: exact: the published digits.
vec3[9] probe_old_town_square_6_digits() {
    return vec3[9](
        vec3(0.871297, 0.875222, 0.86447),
        vec3(0.175058, 0.245335, 0.312891),
        vec3(0.034675, 0.036107, 0.037362),
        vec3(-0.004629, -0.029448, -0.048028),
        vec3(-0.120535, -0.12116, -0.117507),
        vec3(0.003242, 0.003624, 0.007511),
        vec3(-0.028667, -0.024926, -0.020998),
        vec3(-0.077539, -0.086325, -0.091591),
        vec3(-0.161784, -0.191783, -0.219152)
    );
}

/// The light around a point: St. Peter's Basilica.
///
/// Parameters: none.
/// Returns: nine linear RGB coefficients of the radiance, ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, table 7.1.
/// Edges: none.
/// Error model: exact: the published digits.
vec3[9] probe_st_peters_basilica() {
    return vec3[9](
        vec3(0.36, 0.26, 0.23),
        vec3(0.18, 0.14, 0.13),
        vec3(-0.02, -0.01, 0.0),
        vec3(0.03, 0.02, 0.0),
        vec3(0.02, 0.01, 0.0),
        vec3(-0.05, -0.03, -0.01),
        vec3(-0.09, -0.08, -0.07),
        vec3(0.01, 0.0, 0.0),
        vec3(-0.08, -0.03, 0.0)
    );
}

/// The light around a point: the Uffizi Gallery.
///
/// Parameters: none.
/// Returns: nine linear RGB coefficients of the radiance, ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, table 7.1.
/// Edges: none.
/// Error model: exact: the published digits.
vec3[9] probe_uffizi_gallery() {
    return vec3[9](
        vec3(0.32, 0.31, 0.35),
        vec3(0.37, 0.37, 0.43),
        vec3(0.0, 0.0, 0.0),
        vec3(-0.01, -0.01, -0.01),
        vec3(-0.02, -0.02, -0.03),
        vec3(-0.01, -0.01, -0.01),
        vec3(-0.28, -0.28, -0.32),
        vec3(0.0, 0.0, 0.0),
        vec3(-0.24, -0.24, -0.28)
    );
}

/// The light around a point: a kitchen in Vine Street.
///
/// Parameters: none.
/// Returns: nine linear RGB coefficients of the radiance, ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, table 7.1.
/// Edges: none.
/// Error model: exact: the published digits.
vec3[9] probe_vine_street_kitchen() {
    return vec3[9](
        vec3(0.64, 0.67, 0.73),
        vec3(0.28, 0.32, 0.33),
        vec3(0.42, 0.6, 0.77),
        vec3(-0.05, -0.04, -0.02),
        vec3(-0.1, -0.08, -0.05),
        vec3(0.25, 0.39, 0.53),
        vec3(0.38, 0.54, 0.71),
        vec3(0.06, 0.01, -0.02),
        vec3(-0.03, -0.02, -0.03)
    );
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
