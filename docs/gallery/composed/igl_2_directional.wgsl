// constants

const max_lights = 1;

// package::brdf::diffuse

/// Lambert's cosine.
///
/// Parameters: `n`, `l` unit, one space, `l` away from the surface.
/// Returns: `max(n.l, 0)`, in [0, 1].
/// Source: Lambert, Photometria, 1760; Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.3.
/// Edges: 0 where the light is behind the surface, and for a zero vector.
/// Error model: absolute 1.5*2^-23*sum|n_i*l_i|.
fn lambert(n: vec3f, l: vec3f) -> f32 {
    return max(dot(n, l), 0.0);
}

// package::brdf::specular

/// Phong's lobe around the mirrored light.
///
/// Parameters: `n`, `l`, `v` unit, one space, `l` and `v` away from the surface; `s` shininess, at least 0.
/// Returns: `max(r.v, 0)^s` with `r = reflect(-l, n)`, in [0, 1]; 0 where `n.l <= 0`.
/// Source: Phong, "Illumination for Computer Generated Pictures", 1975.
/// Edges: 0 where the light is at or behind the horizon; 1 in front for s = 0.
/// Error model: relative `s*ln2*2^-21 + |t|*ln2*u + (3 + 2|t|)*u + s*rel(r.v)`, t = s*log2(r.v), u = 2^-23; r.v has absolute error 2^-20.
fn phong(n: vec3f, l: vec3f, v: vec3f, s: f32) -> f32 {
    if (!(dot(n, l) > 0.0)) {
        return 0.0;
    }
    return safe_pow(dot(reflect(-l, n), v), s);
}

// package::lighting::classic

/// The sums of a light loop. Start from zero.
struct Accum {
    /// Light to be multiplied by the surface's base colour: ambient and diffuse terms.
    scattered: vec3f,
    /// Light that keeps its own colour: highlights.
    reflected: vec3f,
}

/// A loop's sums with one light added.
///
/// Attenuation and cone come with `lit`, the shape of the reflection with `diffuse` and `specular`, and the shadow
/// with `visibility`: each is computed by a function of its own, and multiplied here for the first time.
/// Ambient light is not shadowed. Its factor is `lit.attenuation * lit.spot` in the book's light loop, 1 in its earlier examples.
///
/// Parameters: `accum` sums so far; `material` reflectances; `light` colours and strength; `lit` factors at the point; `ambient` factor on ambient light, [0, 1]; `diffuse` and `specular` terms of the reflection, at least 0, as from `lambert` and `blinn_phong`; `visibility` unshadowed share, [0, 1].
/// Returns: sums with the light's terms added, linear.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, examples 7.8 and 7.10.
/// Edges: a light that is off adds nothing when `lit` comes from `sample_light`, but for its ambient part where `ambient` says otherwise.
/// Error model: 4 ULP + absolute 8*2^-23 of the largest term.
fn accumulate(
    accum: Accum,
    material: Material,
    light: Light,
    lit: LightSample,
    ambient: f32,
    diffuse: f32,
    specular: f32,
    visibility: f32,
) -> Accum {
    let arriving = light.color * (lit.attenuation * lit.spot * visibility);
    return Accum(
        accum.scattered + light.ambient * material.ambient * ambient + arriving * material.diffuse * diffuse,
        accum.reflected + arriving * material.specular * (specular * light.strength),
    );
}

/// The colour that leaves the surface, from the sums of a light loop.
///
/// Parameters: `base` the surface's linear colour, [0, 1]; `material` its `emission` is read; `accum` the loop's sums.
/// Returns: `emission + base*scattered + reflected`, linear, not clamped.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, examples 7.8 and 7.10, without their clamp to 1.
/// Edges: none.
/// Error model: 2 ULP + absolute 2^-23, beside the sums' own errors.
fn resolve(base: vec3f, material: Material, accum: Accum) -> vec3f {
    return material.emission + base * accum.scattered + accum.reflected;
}

/// The visibility of a shadow that takes away only part of the light.
///
/// Parameters: `visibility` unshadowed share, [0, 1]; `strength` how much a full shadow takes away, [0, 1].
/// Returns: `1 - strength*(1 - visibility)`, in [0, 1].
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, shadow mapping: a strength of 0.5.
/// Edges: 1 for strength 0, `visibility` for strength 1.
/// Error model: absolute 2^-23.
fn shadow_mix(visibility: f32, strength: f32) -> f32 {
    return 1.0 - strength * (1.0 - visibility);
}

// package::lighting::light

/// A light of any kind, 96 bytes, the same in uniform (std140) and storage buffers.
///
/// Positions and directions are all in one space of the caller's choice: the one the surface is given in.
struct Light {
    /// Linear colour times intensity, at least 0.
    color: vec3f,
    /// `LIGHT_OFF`, `LIGHT_DIRECTIONAL`, `LIGHT_POINT` or `LIGHT_SPOT`.
    kind: u32,
    /// Linear colour of the light's ambient part, at least 0.
    ambient: vec3f,
    /// Reach in scene units, for the falloffs that have one; 0 means none.
    range: f32,
    /// Position in scene units; unused by a directional light.
    position: vec3f,
    /// Exponent of the cone, at least 0.
    exponent: f32,
    /// Unit direction in which the light shines: away from the light.
    axis: vec3f,
    /// Cosine of the half angle of a hard cone.
    cutoff: f32,
    /// Constant, linear and quadratic coefficients of the attenuation: 1, 1/unit, 1/unit^2.
    attenuation: vec3f,
    /// Cosine of the half angle within which a smooth cone is fully lit.
    inner: f32,
    /// Cosine of the half angle beyond which a smooth cone is dark.
    outer: f32,
    /// Factor on the highlights of this light, at least 0; 1 leaves them as the material has them.
    strength: f32,
    /// How much of the light a shadow takes away, [0, 1].
    shadow_strength: f32,
    /// Layer of the light's shadow map, for callers that keep several; -1 means none.
    shadow_layer: i32,
}

/// What arrives from a light at a point; the factors stay apart for the caller to replace or combine.
struct LightSample {
    /// Unit vector from the point to the light; zero where there is none.
    l: vec3f,
    /// Distance to the light in scene units; 0 for a directional light.
    distance: f32,
    /// Falloff with distance, 1 = none.
    attenuation: f32,
    /// Factor of the cone, [0, 1].
    spot: f32,
}

/// What arrives from a light of one direction.
///
/// Parameters: `light` the light: its `axis` is read.
/// Returns: `l` against the axis, distance 0, factors 1.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.3.
/// Edges: `l` is zero for a zero axis.
/// Error model: that of `safe_normalize` for `l`; exact for the rest.
fn sample_directional(light: Light) -> LightSample {
    return LightSample(safe_normalize(-light.axis, vec3f(0.0)), 0.0, 1.0, 1.0);
}

// package::lighting::material

/// A material, 64 bytes, the same in uniform (std140) and storage buffers.
struct Material {
    /// Linear colour the surface emits, at least 0.
    emission: vec3f,
    /// Exponent of the Phong and Blinn-Phong highlights, at least 0.
    shininess: f32,
    /// Linear reflectance of ambient light, [0, 1].
    ambient: vec3f,
    /// Perceptual roughness, [0, 1]: the `alpha` of GGX is its square.
    roughness: f32,
    /// Linear diffuse reflectance, [0, 1].
    diffuse: vec3f,
    /// Wrap of diffuse light around the terminator, [0, 1].
    wrap: f32,
    /// Linear specular reflectance, [0, 1]: the `f0` of Fresnel's terms.
    specular: vec3f,
    /// Oren-Nayar's standard deviation of the facets' slope, radians.
    sigma: f32,
}

// package::math::safe

/// The smallest positive normal `f32`, 2^-126: a floor for denominators.
/// A smaller number may be flushed to zero, and its reciprocal may overflow.
const SMALLEST_NORMAL: f32 = 1.1754944e-38;

/// The unit vector along `v`, or `fallback` where `v` has no direction.
///
/// The vector is scaled by its largest component first, so its squared length neither overflows nor vanishes.
///
/// Parameters: `v` any vector, any space and unit; `fallback` returned as it is, usually unit.
/// Returns: a vector of length 1 in the space of `v`, or `fallback`.
/// Source: scaling by the largest component: Blue, "A Portable Fortran Program to Find the Euclidean Norm of a Vector", 1978.
/// Edges: `fallback` where the largest component is below 2^-126 (zero included) or above 2^126 (infinity included).
/// Error model: 2.5 ULP (scaling) + 2 ULP (inverse square root) + 2 ULP (sum of squares) + 0.5 ULP per component.
fn safe_normalize(v: vec3f, fallback: vec3f) -> vec3f {
    let largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if (!(largest >= SMALLEST_NORMAL && largest <= 8.507059e37)) {
        return fallback;
    }
    return normalize(v / largest);
}

/// `max(x, 0)` raised to the power `e`, with `0^0 = 1`.
///
/// Parameters: `x` base, any number; `e` exponent, at least 0.
/// Returns: a number of at least 0; in [0, 1] for `x` up to 1.
/// Source: WGSL specification, "pow": the result is indeterminate for a negative base, which lighting meets behind a surface.
/// Edges: 1 for `e` = 0, whatever `x`; else 0 for `x` at or below 0, for a negative `e` too.
/// Error model: relative `e*ln2*2^-21 + |t|*ln2*u + (3 + 2|t|)*u + e*rel(x)` with `t = e*log2(x)`, `u = 2^-23`.
fn safe_pow(x: f32, e: f32) -> f32 {
    if (e == 0.0) {
        return 1.0;
    }
    if (!(x > 0.0)) {
        return 0.0;
    }
    return pow(x, e);
}

// package::shadow::bias

/// The depth moved towards the light by a constant.
///
/// Parameters: `d` depth, [0, 1] from near to far; `b` bias, in depth, at least 0; negative for reversed depth.
/// Returns: `d - b`.
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, variance shadow mapping: 0.001, added to the stored depth there.
/// Edges: not clamped.
/// Error model: 1 ULP of the larger of `d` and `b`.
fn constant_bias(d: f32, b: f32) -> f32 {
    return d - b;
}

/// The point moved out of the surface, more where light grazes it.
///
/// Parameters: `p` the lit point, scene units; `n`, `l` unit, the space of `p`, `l` away from the surface; `texel` size of the map's texel at the point, scene units; `scale` texels to move at grazing light, at least 0.
/// Returns: `p + n*scale*texel*sin(n, l)`, scene units, for `shadow_coord`.
/// Source: Holbert, "Saying Goodbye to Shadow Acne", Game Developers Conference, 2011.
/// Edges: `p` itself where the light is straight above.
/// Error model: absolute 2^-22*(|p| + scale*texel); the sine is the length of a cross product.
fn normal_offset(p: vec3f, n: vec3f, l: vec3f, texel: f32, scale: f32) -> vec3f {
    return p + n * (scale * texel * length(cross(n, l)));
}

// package::shadow::compare

/// One comparison with the map: 1 beyond its edge.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `uv` texture coordinates; `depth` reference, [0, 1].
/// Returns: the lit share of the 2x2 texels around, [0, 1].
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.21, which smears the edge instead.
/// Edges: 1 where uv is not in [0, 1].
/// Error model: the sampler's two weights, of at least 8 bits each: absolute 2^-7.
fn compare_tap(map: texture_depth_2d, smp: sampler_comparison, uv: vec2f, depth: f32) -> f32 {
    let visible = textureSampleCompareLevel(map, smp, uv, depth);
    return select(1.0, visible, is_on_map(uv));
}

/// One comparison: a hard shadow, softened by the sampler over one texel.
///
/// Parameters: `map`, `smp` depth map and comparison sampler; `at` place in the map.
/// Returns: visibility, [0, 1].
/// Source: Williams, "Casting Curved Shadows on Curved Surfaces", 1978; Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.21.
/// Edges: 1 where `at` is outside.
/// Error model: that of `compare_tap`.
fn hard(map: texture_depth_2d, smp: sampler_comparison, at: ShadowUv) -> f32 {
    if (!at.inside) {
        return 1.0;
    }
    return compare_tap(map, smp, at.uv, at.depth);
}

// package::shadow::coord

/// A point's place in a shadow map.
struct ShadowUv {
    /// Texture coordinates, origin at the map's first texel; [0, 1] inside.
    uv: vec2f,
    /// Depth to compare with the map, [0, 1] from near to far.
    depth: f32,
    /// Whether the point is inside the light's frustum. Outside is lit.
    inside: bool,
}

/// Whether texture coordinates are on the map.
///
/// Parameters: `uv` texture coordinates.
/// Returns: true where both are in [0, 1].
/// Source: stands in for a border colour, which not every target has.
/// Edges: the map's edges are on it; NaN is not.
/// Error model: exact.
fn is_on_map(uv: vec2f) -> bool {
    return uv.x >= 0.0 && uv.x <= 1.0 && uv.y >= 0.0 && uv.y <= 1.0;
}

/// A point in the light's clip space.
///
/// Parameters: `m` the light's projection times its view, for column vectors; `p_world` the point, world space, scene units.
/// Returns: clip coordinates, before the division by w.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.20; its bias matrix is `project` here.
/// Edges: none.
/// Error model: absolute 4*2^-23*sum|m_ij*p_j| per component.
fn shadow_coord(m: mat4x4f, p_world: vec3f) -> vec4f {
    return m * vec4f(p_world, 1.0);
}

/// The place in the shadow map of a point in clip space, for depths in [0, 1] and rows from the top.
///
/// This is the convention of WebGPU, Vulkan after its flipped viewport, Metal and Direct3D.
///
/// Parameters: `sc` clip coordinates from `shadow_coord`; `min_w` smallest light-space depth that can be shadowed, scene units for a perspective light, at least 0.
/// Returns: `uv = (0.5*x + 0.5, 0.5 - 0.5*y)` and `depth = z` after division by w; `inside` where uv and depth are in [0, 1] and `w > min_w`.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.19, for another clip space; the guard on w: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, shadow mapping (there 1, its near plane).
/// Edges: outside, with uv and depth 0, where w is at or below `min_w` (0 at least): behind the light.
/// Error model: absolute 4*2^-23*(|x/w| + 1), beside the error of `sc` divided by w.
fn project(sc: vec4f, min_w: f32) -> ShadowUv {
    if (!(sc.w > max(min_w, SMALLEST_NORMAL))) {
        return ShadowUv(vec2f(0.0), 0.0, false);
    }
    let ndc = sc.xyz / sc.w;
    let uv = vec2f(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y);
    return ShadowUv(uv, ndc.z, is_on_map(uv) && ndc.z >= 0.0 && ndc.z <= 1.0);
}

// package::surface::view

/// The direction to a viewer at the eye.
///
/// Parameters: `p_eye` the lit point, eye space, scene units.
/// Returns: unit vector from the point to the eye, eye space.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, chapter 7, "Lighting Coordinate Systems": the local viewer.
/// Edges: (0, 0, 1) for a point at the eye.
/// Error model: that of `safe_normalize`.
fn view_local(p_eye: vec3f) -> vec3f {
    return safe_normalize(-p_eye, vec3f(0.0, 0.0, 1.0));
}

// package::programs::forward

/// The viewer.
struct Camera {
    clip_from_world: mat4x4f,
    /// Its third column points behind the viewer, its fourth is the viewer's position.
    world_from_view: mat4x4f,
}

/// What is drawn.
struct Object {
    world_from_object: mat4x4f,
    /// The inverse transpose of the former, for normals.
    normal_from_object: mat4x4f,
    /// Multiplied with the vertex colours.
    color: vec4f,
}

/// The lights, of which the first `count` shine.
struct Lamps {
    count: u32,
    lights: array<Light, max_lights>,
}

/// Light from everywhere: each value of `ambient` reads what it needs.
struct Surroundings {
    /// `constant`: added to the ambient light of the lamps.
    color: vec3f,
    /// `sh9`: factor, 1/pi for coefficients of radiance.
    scale: f32,
    /// `hemisphere`: the light from the side of `up`.
    sky: vec3f,
    /// `ibl`: share of the diffuse environment, [0, 1].
    diffuse_share: f32,
    /// `hemisphere`: the light from the other side.
    ground: vec3f,
    /// `ibl`: share of the specular environment, [0, 1].
    specular_share: f32,
    /// `hemisphere`: unit, in the world.
    up: vec3f,
    /// `sh9`: L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
    sh: array<vec3f, 9>,
}

/// The light that casts the shadow, and how its map is read.
struct Caster {
    /// Spot and directional lights: projection times view of the shadow map.
    clip_from_world: mat4x4f,
    /// Point lights: distances of the near and far plane of the faces, in scene units.
    near: f32,
    far: f32,
    /// Which of the lamps, below `max_lights`.
    light: u32,
    /// Points this near to the light and nearer are lit; the w of its clip space.
    min_w: f32,
    /// Subtracted from the depth that is compared.
    bias: f32,
    /// How far the point is moved along its normal, in texels of the map.
    normal_offset: f32,
    /// Size of a texel in scene units: everywhere for directional lights, at distance 1 for others.
    texel: f32,
    /// `pcf_random16`, `pcf_vogel`: radius of the filter; `pcss`: width of the light; in texels.
    radius: f32,
    /// `evsm`: the positive and the negative exponent, as in `moments`.
    exponents: vec2f,
    /// `vsm`, `evsm`: see `shadow::moments`.
    min_variance: f32,
    bleed: f32,
    /// `vsm`: least visibility.
    least: f32,
}

/// Materials in one array: pairs of front and back with `two_sided`.
struct Materials {
    items: array<Material, 1>,
}

@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(1) var<uniform> lamps: Lamps;
@group(0) @binding(2) var<uniform> surroundings: Surroundings;
@group(0) @binding(4) var<uniform> caster: Caster;
@group(0) @binding(5) var shadow_map: texture_depth_2d;
@group(0) @binding(7) var shadow_sampler: sampler_comparison;
@group(1) @binding(0) var<uniform> materials: Materials;
@group(2) @binding(0) var<uniform> object: Object;

/// A corner of a triangle.
struct Corner {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
}

/// From the corners to the fragments; positions and directions in the world.
struct Varyings {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
}

@vertex
fn vs_main(in: Corner) -> Varyings {
    let position = object.world_from_object * vec4f(in.position, 1.0);
    let normal = (object.normal_from_object * vec4f(in.normal, 0.0)).xyz;
    var out: Varyings;
    out.clip = camera.clip_from_world * position;
    out.position = position.xyz;
    out.normal = normal;
    out.color = in.color * object.color;
    return out;
}

@fragment
fn fs_main(
    in: Varyings,
) -> @location(0) vec4f {
    let base = in.color;
    var color = shade(base.rgb, in);
    return vec4f(color, base.a);
}

/// The colour of the surface.
fn shade(
    base: vec3f,
    in: Varyings,
) -> vec3f {
    var surface: Surface;
    surface.position = in.position;
    surface.normal = safe_normalize(in.normal, vec3f(0.0));
    surface.view = towards_viewer(in.position);
    surface.material = materials.items[0];
    surface.visibility = visibility(surface, in.clip.xy);
    var sum = lit(surface);
    return resolve(base, surface.material, sum);
}

/// A point of a surface, as light meets it.
struct Surface {
    position: vec3f,
    normal: vec3f,
    /// Towards the viewer.
    view: vec3f,
    material: Material,
    /// How much of the shadow caster's light arrives.
    visibility: f32,
}

/// All light that leaves the point towards the viewer, but for the environment maps'.
fn lit(surface: Surface) -> Accum {
    var sum = Accum(surface.material.ambient * ambient_light(surface.normal), vec3f(0.0));
    for (var i = 0u; i < min(lamps.count, max_lights); i++) {
        sum = add_lamp(sum, surface, i);
    }
    return sum;
}

/// The sums with the light of one lamp.
fn add_lamp(sum: Accum, surface: Surface, i: u32) -> Accum {
    let light = lamps.lights[i];
    var arriving = sample_directional(light);

    let ambient = 1.0;

    let diffuse = lambert(surface.normal, arriving.l);

    let specular = phong(surface.normal, arriving.l, surface.view, surface.material.shininess);

    let visibility = select(1.0, shadow_mix(surface.visibility, light.shadow_strength), i == caster.light);

    return accumulate(sum, surface.material, light, arriving, ambient, diffuse, specular, visibility);
}

fn visibility(surface: Surface, pixel: vec2f) -> f32 {
    let at = place_in_map(surface);
    return hard(shadow_map, shadow_sampler, at);
}

/// Where the shadow map holds the point, the bias taken off its depth.
fn place_in_map(surface: Surface) -> ShadowUv {
    let point = receiver(surface, lamps.lights[caster.light]);
    var at = project(shadow_coord(caster.clip_from_world, point), caster.min_w);
    at.depth = constant_bias(at.depth, caster.bias);
    return at;
}

/// The point that is looked up: off the surface, so that it does not shadow itself.
fn receiver(surface: Surface, light: Light) -> vec3f {
    return normal_offset(surface.position, surface.normal, -light.axis, caster.texel, caster.normal_offset);
}

/// Light from everywhere, onto a surface of this unit normal.
fn ambient_light(normal: vec3f) -> vec3f {
    return surroundings.color;
}

/// Unit direction from a point to the viewer.
fn towards_viewer(position: vec3f) -> vec3f {
    return view_local(position - camera.world_from_view[3].xyz);
}
