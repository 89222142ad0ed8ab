//! Shadows of small things by a march through the depth buffer.
//!
//! Made from `contact.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_SHADOW_CONTACT_GLSL
#define LAMPLIGHT_SHADOW_CONTACT_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// Whether a point of the march is behind what the depth buffer shows, and not far behind.
///
/// Parameters: `ray`, `scene` linear distances along the view axis of the point and of the surface seen there, scene units; `bias` least distance behind, scene units, at least 0; `thickness` assumed thickness of surfaces, scene units.
/// Returns: whether `bias < ray - scene < thickness`.
/// Source: Sousa, Kasyan, Schulz, "Secrets of CryENGINE 3 Graphics Technology", 2011: screen space local shadows.
/// Edges: false where `thickness` is not above `bias`; a negative `bias` takes in points before the surface; `ray` and `scene` count by their difference, whatever their signs.
/// Error model: exact but within 2^-23*(|ray| + |scene|) of either bound.
bool contact_hit(float ray, float scene, float bias, float thickness) {
    float behind = ray - scene;
    return behind > bias && behind < thickness;
}

/// A point of a march from a surface towards the light.
///
/// Parameters: `start` the lit point; `l` unit, the same space, towards the light; `reach` length of the march, scene units; `index` of the step, from 0; `count` number of steps, at least 1; `jitter` [0, 1): moves all points by a part of a step, by pixel.
/// Returns: `start + l*reach*(index + jitter)/count`, the space of `start`.
/// Source: even steps along the ray, as in Sousa, Kasyan, Schulz, "Secrets of CryENGINE 3 Graphics Technology", 2011.
/// Edges: `start` for a zero `l` and for a `reach` of 0; a negative `reach` goes away from the light; a `count` of 0 counts as 1; an `index` from `count` on is at the end of the march or beyond; `jitter` is not clamped.
/// Error model: absolute 2^-22*(|start| + reach).
vec3 march_point(vec3 start, vec3 l, float reach, uint index, uint count, float jitter) {
    return start + l * (reach * ((float(index) + jitter) / float(max(count, 1u))));
}

/// How much of an effect of the screen is left near the screen's edge.
///
/// Parameters: `uv` place on the screen, [0, 1]; `border` width of the fade, in parts of the screen, at least 0.
/// Returns: 1 within, falling linearly to 0 at the nearest edge, [0, 1].
/// Source: the usual guard of effects that see no further than the screen; a distance over a width.
/// Edges: 0 where `uv` is at or beside the screen's edge; a hard edge for a `border` of 0 or below.
/// Error model: absolute 2^-22 + 2^-23/border.
float edge_fade(vec2 uv, float border) {
    vec2 inside = min(uv, vec2(1.0) - uv);
    float nearest = min(inside.x, inside.y);
    if (!(nearest > 0.0)) {
        return 0.0;
    }
    if (!(nearest < border)) {
        return 1.0;
    }
    return nearest / border;
}

/// The shadows of what ambient occlusion knows of, for the light of a lamp.
///
/// The occlusion counts as a cone of open sky about the normal, and a lamp outside of it is hidden.
///
/// Parameters: `visibility` ambient occlusion, [0, 1], 1 is open; `nl` cosine n.l, [-1, 1].
/// Returns: `min(nl/sqrt(1 - visibility), 1)^2`, [0, 1]: a factor of the lamp's light.
/// Source: Chan, "Material Advances in Call of Duty: WWII", 2018, with `visibility` up to 0.9999.
/// Edges: 0 for an `nl` of 0 or below: the lamp is at or below the horizon; a `visibility` below 0 counts as 0, one above 0.9999 as that.
/// Error model: 6 ULP.
float micro_shadow(float visibility, float nl) {
    float c = max(nl, 0.0);
    return min(c * c / (1.0 - clamp(visibility, 0.0, 0.9999)), 1.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
