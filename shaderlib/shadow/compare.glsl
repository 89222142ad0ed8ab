//! Visibility from a depth map: hard, filtered and soft lookups. 1 is lit; a point outside the map is lit.
//!
//! The sampler compares `reference <= stored` (or its opposite for reversed depth) and filters linearly, clamped to
//! the edge. Kernels are in texels. Subtract a bias from `at.depth` first: see `shadow::bias`.
//!
//! Made from `compare.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_SHADOW_COMPARE_GLSL
#define LAMPLIGHT_SHADOW_COMPARE_GLSL

#include "../filter/sampling.glsl"
#include "../math/noise.glsl"
#include "coord.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// One comparison with the map: 1 beyond its edge.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `uv` texture coordinates; `depth` reference, [0, 1].
/// Returns: the lit share of the 2x2 texels around, [0, 1].
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, examples 7.15 and 7.21: its map repeats the texels of the edge instead.
/// Edges: 1 where `uv` is not in [0, 1]; a `depth` outside [0, 1] is clamped by a map of normalised integers, and not by one of floats.
/// Error model: the sampler's two weights, of at least 8 bits each: absolute 2^-7.
float compare_tap(LAMPLIGHT_DEPTH_MAP(map, smp), vec2 uv, float depth) {
    float visible = textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(uv, depth), 0.0);
    return is_on_map(uv) ? visible : 1.0;
}

/// One comparison: a hard shadow, softened by the sampler over one texel.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `at` place in the map.
/// Returns: visibility, [0, 1].
/// Source: Williams, "Casting Curved Shadows on Curved Surfaces", 1978; Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.21.
/// Edges: 1 where `at` is outside.
/// Error model: that of `compare_tap`.
float hard(LAMPLIGHT_DEPTH_MAP(map, smp), ShadowUv at) {
    return at.inside ? textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(at.uv, at.depth), 0.0) : 1.0;
}

/// The mean of a square grid of comparisons, two texels apart.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `at` place in the map; `reach` comparisons on each side of the middle, at least 0.
/// Returns: visibility, [0, 1].
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, percentage closer filtering.
/// Edges: 1 where `at` is outside; each comparison beyond the map's edge counts as lit; 0 for a negative `reach`, which compares nothing.
/// Error model: that of `compare_tap` + absolute 2^-20 (sum and division).
float pcf_grid(LAMPLIGHT_DEPTH_MAP(map, smp), ShadowUv at, int reach) {
    if (!at.inside) {
        return 1.0;
    }
    vec2 stride = 2.0 / vec2(textureSize(LAMPLIGHT_DEPTH_SAMPLER(map, smp), 0));
    float side = float(2 * reach + 1);
    float sum = 0.0;
    // The middle is on the map: what is left of it can only be left of the map, and so on.
    for (int y = -reach; y <= reach; y++) {
        float v = at.uv.y + float(y) * stride.y;
        float row = 0.0;
        for (int x = -reach; x <= reach; x++) {
            float u = at.uv.x + float(x) * stride.x;
            float visible = textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(vec2(u, v), at.depth), 0.0);
            row += x == 0 || (x < 0 ? u >= 0.0 : u <= 1.0) ? visible : 1.0;
        }
        sum += y == 0 || (y < 0 ? v >= 0.0 : v <= 1.0) ? row : side;
    }
    return sum / (side * side);
}

/// Nine comparisons at -2, 0 and 2 texels in each direction, averaged.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `at` place in the map.
/// Returns: visibility, [0, 1].
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, percentage closer filtering: the step is two texels.
/// Edges: as `pcf_grid`.
/// Error model: that of `pcf_grid`.
float pcf_3x3(LAMPLIGHT_DEPTH_MAP(map, smp), ShadowUv at) {
    return pcf_grid(LAMPLIGHT_DEPTH_ARG(map, smp), at, 1);
}

/// Twenty-five comparisons at -4, -2, 0, 2 and 4 texels in each direction, averaged.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `at` place in the map.
/// Returns: visibility, [0, 1].
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, percentage closer filtering: named by the recipe, without its code.
/// Edges: as `pcf_grid`.
/// Error model: that of `pcf_grid`.
float pcf_5x5(LAMPLIGHT_DEPTH_MAP(map, smp), ShadowUv at) {
    return pcf_grid(LAMPLIGHT_DEPTH_ARG(map, smp), at, 2);
}

/// A tent of 3x3 texels (weights 1, 2, 1) in four bilinear comparisons.
///
/// Parameters: `map`, `smp` depth map and comparison sampler, which must filter linearly; `at` place in the map.
/// Returns: visibility, [0, 1].
/// Source: Castaño, "Shadow Mapping Summary, Part 1", The Witness, 2013.
/// Edges: 1 where `at` is outside; each comparison beyond the map's edge counts as lit.
/// Error model: that of `compare_tap` + absolute 2^-20; the offsets put up to 2^-8 more on each weight.
float pcf_castano_3(LAMPLIGHT_DEPTH_MAP(map, smp), ShadowUv at) {
    if (!at.inside) {
        return 1.0;
    }
    vec2 size = vec2(textureSize(LAMPLIGHT_DEPTH_SAMPLER(map, smp), 0));
    vec2 shifted = at.uv * size + 0.5;
    vec2 centre = floor(shifted) - 0.5;
    vec2 f = fract(shifted);
    // Each weight is that of two neighbouring texels; each place lies between them in the ratio of theirs.
    vec2 w0 = 3.0 - 2.0 * f;
    vec2 w1 = 1.0 + 2.0 * f;
    vec2 p0 = (centre + (2.0 - f) / w0 - 1.0) / size;
    vec2 p1 = (centre + f / w1 + 1.0) / size;
    // The point is on the map, so the first of two places can only be before the map, and the other only behind.
    bvec2 first = greaterThanEqual(p0, vec2(0.0));
    bvec2 last = lessThanEqual(p1, vec2(1.0));
    float a = first.x && first.y ? textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(p0, at.depth), 0.0) : 1.0;
    float b = last.x && first.y ? textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(vec2(p1.x, p0.y), at.depth), 0.0) : 1.0;
    float c = first.x && last.y ? textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(vec2(p0.x, p1.y), at.depth), 0.0) : 1.0;
    float d = last.x && last.y ? textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(p1, at.depth), 0.0) : 1.0;
    return (w0.y * (w0.x * a + w1.x * b) + w1.y * (w0.x * c + w1.x * d)) / 16.0;
}

/// One row of `pcf_castano_5`: three bilinear comparisons.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `columns` the three u coordinates; `v` the row's; `weights` of the columns; `depth` reference, [0, 1].
/// Returns: the weighted sum, [0, sum of the weights].
/// Source: as `pcf_castano_5`.
/// Edges: a comparison left of the map counts as lit in the first of the `columns`, and one right of it in the last; `v` beyond the map is at its edge; `weights` are not clamped; `depth` as for `compare_tap`.
/// Error model: that of `compare_tap`, times the weights.
float castano_row(LAMPLIGHT_DEPTH_MAP(map, smp), vec3 columns, float v, vec3 weights, float depth) {
    float left = textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(vec2(columns.x, v), depth), 0.0);
    float middle = textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(vec2(columns.y, v), depth), 0.0);
    float right = textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(vec2(columns.z, v), depth), 0.0);
    return weights.x * (columns.x >= 0.0 ? left : 1.0) + weights.y * middle + weights.z * (columns.z <= 1.0 ? right : 1.0);
}

/// A bell of 5x5 texels (weights 1, 3, 4, 3, 1) in nine bilinear comparisons.
///
/// Parameters: `map`, `smp` depth map and comparison sampler, which must filter linearly; `at` place in the map.
/// Returns: visibility, [0, 1].
/// Source: Castaño, "Shadow Mapping Summary, Part 1", The Witness, 2013.
/// Edges: 1 where `at` is outside; each comparison beyond the map's edge counts as lit.
/// Error model: that of `compare_tap` + absolute 2^-20; the offsets put up to 2^-8 more on each weight.
float pcf_castano_5(LAMPLIGHT_DEPTH_MAP(map, smp), ShadowUv at) {
    if (!at.inside) {
        return 1.0;
    }
    vec2 size = vec2(textureSize(LAMPLIGHT_DEPTH_SAMPLER(map, smp), 0));
    vec2 shifted = at.uv * size + 0.5;
    vec2 centre = floor(shifted) - 0.5;
    vec2 f = fract(shifted);
    vec3 wx = vec3(4.0 - 3.0 * f.x, 7.0, 1.0 + 3.0 * f.x);
    vec3 wy = vec3(4.0 - 3.0 * f.y, 7.0, 1.0 + 3.0 * f.y);
    vec3 px = (centre.x + vec3(3.0 - 2.0 * f.x, 3.0 + f.x, f.x) / wx + vec3(-2.0, 0.0, 2.0)) / size.x;
    vec3 py = (centre.y + vec3(3.0 - 2.0 * f.y, 3.0 + f.y, f.y) / wy + vec3(-2.0, 0.0, 2.0)) / size.y;
    float top = castano_row(LAMPLIGHT_DEPTH_ARG(map, smp), px, py.x, wx, at.depth);
    float middle = castano_row(LAMPLIGHT_DEPTH_ARG(map, smp), px, py.y, wx, at.depth);
    float bottom = castano_row(LAMPLIGHT_DEPTH_ARG(map, smp), px, py.z, wx, at.depth);
    // A row that is off the map counts as lit.
    float lit = wx.x + wx.y + wx.z;
    float top_lit = py.x >= 0.0 ? top : lit;
    float bottom_lit = py.z <= 1.0 ? bottom : lit;
    return (wy.x * top_lit + wy.y * middle + wy.z * bottom_lit) / 144.0;
}

/// Sixteen comparisons at random places of a square around the point, averaged.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `at` place in the map; `radius` half the square's side, texels; `pixel` framebuffer position, which chooses the places.
/// Returns: visibility, [0, 1].
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, percentage closer filtering, with the square centred, measured after the division, and an integer hash.
/// Edges: 1 where `at` is outside; near the edge of the map, the square shrinks until all of it is on the map; a `radius` of 0 compares at the point alone, and a negative one mirrors the square; negative positions of `pixel` count as 0.
/// Error model: that of `compare_tap` + absolute 2^-20; the places are exact to 2^-23 of the radius.
float pcf_random16(LAMPLIGHT_DEPTH_MAP(map, smp), ShadowUv at, float radius, vec2 pixel) {
    if (!at.inside) {
        return 1.0;
    }
    vec2 room = min(at.uv, 1.0 - at.uv);
    vec2 reach = min(max(radius / vec2(textureSize(LAMPLIGHT_DEPTH_SAMPLER(map, smp), 0)), -room), room);
    uint state = pixel_seed(pixel);
    float sum = 0.0;
    for (int i = 0; i < 16; i++) {
        uint across = hash_pcg(state);
        uint down = hash_pcg(across);
        state = down;
        vec2 r = 2.0 * vec2(unit_float(across), unit_float(down)) - 1.0;
        sum += textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(at.uv + r * reach, at.depth), 0.0);
    }
    return sum / 16.0;
}

/// Sixteen comparisons at random places to one side of the point, as the recipe computes them.
///
/// It differs from `pcf_random16` in that the offsets are from 0 to 0.25, added before the division by w: shadows move
/// by 0.125/w along both axes of the map, and the blur shrinks with distance. The offsets come from `random_hpg`, seeded with
/// the pixel, its coordinates in the orders x, y, x and y, x, y, and the number of the comparison.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `sc` clip coordinates from `shadow_coord`; `min_w` as for `project`; `pixel` any framebuffer position.
/// Returns: visibility, [0, 1].
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, percentage closer filtering.
/// Edges: 1 where `project` finds the point outside, for `sc` and `min_w` as for `project`; each comparison beyond the map's edge counts as lit.
/// Error model: none for the places: `random_hpg` depends on the driver. The mean is in [0, 1].
float pcf_random16_hpg(LAMPLIGHT_DEPTH_MAP(map, smp), vec4 sc, float min_w, vec2 pixel) {
    ShadowUv at = project(sc, min_w);
    if (!at.inside) {
        return 1.0;
    }
    float sum = 0.0;
    for (int i = 0; i < 16; i++) {
        float across = 0.25 * random_hpg(vec4(pixel.x, pixel.y, pixel.x, float(i)));
        float down = 0.25 * random_hpg(vec4(pixel.y, pixel.x, pixel.y, float(i)));
        sum += compare_tap(LAMPLIGHT_DEPTH_ARG(map, smp), at.uv + vec2(across, down) / sc.w, at.depth);
    }
    return sum / 16.0;
}

/// Comparisons on a spiral disk around the point, averaged.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `at` place in the map; `count` how many, at least 1; `radius` of the disk, texels; `phi` turn of the disk, any angle, radians: noise times 2*pi hides the pattern.
/// Returns: visibility, [0, 1].
/// Source: Vogel, "A Better Way to Construct the Sunflower Head", 1979, as the places of percentage closer filtering.
/// Edges: 1 where `at` is outside; near the edge of the map, the disk shrinks until all of it is on the map; a `count` below 1 counts as 1; a `radius` of 0 compares at the point alone, and a negative one turns the disk by half.
/// Error model: that of `compare_tap` + absolute count*2^-24; the places have that of `vogel_disk` times the radius.
float pcf_vogel(LAMPLIGHT_DEPTH_MAP(map, smp), ShadowUv at, int count, float radius, float phi) {
    if (!at.inside) {
        return 1.0;
    }
    int taps = max(count, 1);
    vec2 room = min(at.uv, 1.0 - at.uv);
    vec2 reach = min(max(radius / vec2(textureSize(LAMPLIGHT_DEPTH_SAMPLER(map, smp), 0)), -room), room);
    // The disk does not depend on the point, so compilers compute it. Only its turn is left.
    float turn = fract(phi * 0.15915494 + 0.5) * 6.2831853 - 3.1415927;
    vec2 across = vec2(cos(turn), sin(turn)) * reach;
    vec2 down = vec2(-sin(turn), cos(turn)) * reach;
    float sum = 0.0;
    for (int i = 0; i < taps; i++) {
        vec2 place = vogel_disk(i, taps, 0.0);
        sum += textureLod(LAMPLIGHT_DEPTH_SAMPLER(map, smp), vec3(at.uv + place.x * across + place.y * down, at.depth), 0.0);
    }
    return sum / float(taps);
}

/// The mean depth of what is nearer to the light, on a disk around a place in the map.
///
/// Parameters: `depths`, `depths_smp` the depth map as a plain texture and a sampler that does not filter; `at` place in the map; `radius` of the disk, texels; `phi` turn of the disk, any angle, radians.
/// Returns: the mean depth of the nearer ones among 16 samples, [0, 1]; `at.depth` where none is.
/// Source: Fernando, "Percentage-Closer Soft Shadows", 2005: the blocker search.
/// Edges: samples beyond the map's edge are those at it, where the sampler clamps; a `radius` of 0 reads one place, and a negative one turns the disk by half.
/// Error model: absolute 2^-20; a sample counts or not where it is closer to `at.depth` than their errors.
float mean_blocker(LAMPLIGHT_COLOR_MAP(depths, depths_smp), ShadowUv at, float radius, float phi) {
    vec2 reach = radius / vec2(textureSize(LAMPLIGHT_COLOR_SAMPLER(depths, depths_smp), 0));
    // The disk does not depend on the point, so compilers compute it. Only its turn is left.
    float turn = fract(phi * 0.15915494 + 0.5) * 6.2831853 - 3.1415927;
    vec2 across = vec2(cos(turn), sin(turn)) * reach;
    vec2 down = vec2(-sin(turn), cos(turn)) * reach;
    float sum = 0.0;
    float found = 0.0;
    for (int i = 0; i < 16; i++) {
        vec2 place = vogel_disk(i, 16, 0.0);
        float d = textureLod(LAMPLIGHT_COLOR_SAMPLER(depths, depths_smp), at.uv + place.x * across + place.y * down, 0.0).x;
        float nearer = d < at.depth ? 1.0 : 0.0;
        sum += nearer * d;
        found += nearer;
    }
    return found > 0.0 ? sum / max(found, 1.0) : at.depth;
}

/// A shadow that is sharp near its caster and soft far from it.
///
/// The map is read in two ways, so it is bound twice: some targets cannot compare and read through one binding.
/// The penumbra's width is computed as if the map's depths were distances from the light. This is exact for linear depths, and an approximation for perspective ones. For those, make distances of the depths of the point and of `mean_blocker`, and filter over half of `shadow::penumbra::pcss_width`, as the program `forward` does.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `depths`, `depths_smp` the same map as a plain texture, with a sampler that does not filter; `at` place in the map; `light_size` width of the light, texels of the map; `phi` turn of the disks, any angle, radians.
/// Returns: visibility, [0, 1].
/// Source: Fernando, "Percentage-Closer Soft Shadows", 2005: penumbra = (receiver - blocker)*light/blocker.
/// Edges: 1 where `at` is outside and where nothing is nearer to the light; the penumbra is kept between 1 texel and `light_size`, which is at least 1.
/// Error model: that of `pcf_vogel` for the penumbra's radius, which has that of `mean_blocker` times light_size/blocker^2.
float pcss(
    LAMPLIGHT_DEPTH_MAP(map, smp),
    LAMPLIGHT_COLOR_MAP(depths, depths_smp),
    ShadowUv at,
    float light_size,
    float phi
) {
    if (!at.inside) {
        return 1.0;
    }
    float widest = max(light_size, 1.0);
    float blocker = mean_blocker(LAMPLIGHT_COLOR_ARG(depths, depths_smp), at, widest, phi);
    if (!(blocker < at.depth)) {
        return 1.0;
    }
    float penumbra = (at.depth - blocker) / max(blocker, 0.001) * widest;
    return pcf_vogel(LAMPLIGHT_DEPTH_ARG(map, smp), at, 16, clamp(penumbra, 1.0, widest), phi);
}

/// One comparison with a cube map: the shadow of a point light.
///
/// Parameters: `cube`, `smp` depth cube map and comparison sampler; `offset` from the light to the point, in the cube's space, any length; `depth` reference, [0, 1], computed as for the faces: by `cube_depth` for perspective faces.
/// Returns: visibility, [0, 1].
/// Source: Gerasimov, "Omnidirectional Shadow Mapping", GPU Gems, 2004, chapter 12; Igalia, "Working with lights and shadows", part II, whose faces must be 90 degrees wide, not 45.
/// Edges: 1 for a `depth` outside [0, 1]; a zero `offset`, a point at the light, is looked up along z.
/// Error model: that of `compare_tap`.
float cube_compare(LAMPLIGHT_DEPTH_CUBE(cube, smp), vec3 offset, float depth) {
    // A direction of length 0 has no face.
    vec3 direction = offset == vec3(0.0) ? vec3(0.0, 0.0, 1.0) : offset;
    float visible = textureGrad(LAMPLIGHT_CUBE_SAMPLER(cube, smp), vec4(direction, depth), vec3(0.0), vec3(0.0));
    return depth >= 0.0 && depth <= 1.0 ? visible : 1.0;
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
