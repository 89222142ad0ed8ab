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

/// Blinn's lobe with the half vector given.
///
/// Parameters: `n`, `h` unit, one space; `n_dot_l` cosine n.l, [-1, 1]; `s` shininess, at least 0.
/// Returns: `max(n.h, 0)^s`, in [0, 1]; 0 where `n_dot_l <= 0`.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.3: the half vector is a uniform, the highlight is 0 where the diffuse term is.
/// Edges: 0 where the light is at or behind the horizon.
/// Error model: that of `safe_pow(n.h, s)`; n.h has absolute error 3*2^-23.
fn blinn_phong_half(n: vec3f, h: vec3f, n_dot_l: f32, s: f32) -> f32 {
    if (!(n_dot_l > 0.0)) {
        return 0.0;
    }
    return safe_pow(dot(n, h), s);
}

/// Blinn's lobe around the half vector.
///
/// Parameters: `n`, `l`, `v` unit, one space, `l` and `v` away from the surface; `s` shininess, at least 0.
/// Returns: `max(n.h, 0)^s` with `h = normalize(l + v)`, in [0, 1]; 0 where `n.l <= 0`.
/// Source: Blinn, "Models of Light Reflection for Computer Synthesized Pictures", 1977.
/// Edges: 0 where the light is at or behind the horizon; the half vector of `l = -v` is zero, so the result is 0 but for s = 0.
/// Error model: relative `s*ln2*2^-21 + |t|*ln2*u + (3 + 2|t|)*u + s*rel(n.h)`, t = s*log2(n.h), u = 2^-23; n.h has absolute error 12*2^-23/|l + v|.
fn blinn_phong(n: vec3f, l: vec3f, v: vec3f, s: f32) -> f32 {
    return blinn_phong_half(n, safe_normalize(l + v, vec3f(0.0)), dot(n, l), s);
}

// package::lighting::attenuation

/// The reciprocal of a polynomial in the distance: constant, linear and quadratic attenuation.
///
/// Parameters: `d` distance to the light, scene units, at least 0; `k` constant, linear and quadratic coefficients (1, 1/unit, 1/unit^2), at least 0.
/// Returns: `1 / (k.x + k.y*d + k.z*d*d)`: in (0, 1] where `k.x` is at least 1, above 1 where the polynomial is below 1.
/// Source: Shreiner, Sellers, Kessenich, Licea-Kane, OpenGL Programming Guide, 8th edition, 2013, example 7.4.
/// Edges: 1 where the polynomial is 0 or negative: no coefficients mean no attenuation.
/// Error model: 2.5 ULP (division) + 3 ULP (sum and products of terms of at least 0).
fn polynomial(d: f32, k: vec3f) -> f32 {
    let q = k.x + d * (k.y + d * k.z);
    if (!(q >= SMALLEST_NORMAL)) {
        return 1.0;
    }
    return 1.0 / q;
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

/// What arrives from a light at a position, with polynomial attenuation.
///
/// Another falloff replaces `attenuation` from `distance`, by a function of `lighting::attenuation`.
///
/// Parameters: `light` the light: `position` and `attenuation` are read; `p` the lit point, scene units, in the light's space.
/// Returns: direction, distance, attenuation as `polynomial` gives it, cone factor 1.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.4.
/// Edges: `l` is zero at the light itself, where the example divides 0 by 0.
/// Error model: 6 ULP + absolute 2^-23 for `l`, 4 ULP for `distance`, 12 ULP for `attenuation`.
fn sample_point(light: Light, p: vec3f) -> LightSample {
    let offset = light.position - p;
    let d = length(offset);
    return LightSample(safe_normalize(offset, vec3f(0.0)), d, polynomial(d, light.attenuation), 1.0);
}

/// What arrives from a spot light, with polynomial attenuation and a power of the cosine.
///
/// Another cone replaces `spot` from `dot(-l, axis)`, by a function of `lighting::spot`.
///
/// Parameters: `light` the light: `position`, `attenuation`, `axis`, `cutoff` and `exponent` are read; `p` the lit point, scene units, in the light's space.
/// Returns: as `sample_point`, with the cone factor of `cone_exponent`.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.5.
/// Edges: at the light itself the cosine is 0.
/// Error model: that of `sample_point`; for the cone that of `cone_exponent` at a cosine with the error of `l`.
fn sample_spot(light: Light, p: vec3f) -> LightSample {
    let lit = sample_point(light, p);
    let cone = cone_exponent(dot(-lit.l, light.axis), light.cutoff, light.exponent);
    return LightSample(lit.l, lit.distance, lit.attenuation, cone);
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

// package::lighting::spot

/// A power of the cosine inside the cone, 0 outside.
///
/// Parameters: `c` cosine of the angle to the axis, [-1, 1]; `cutoff` cosine of the cone's half angle, [-1, 1]; `e` exponent, at least 0.
/// Returns: `max(c, 0)^e` where `c >= cutoff`, else 0; in [0, 1].
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.5.
/// Edges: a cone wider than a half space (`cutoff < 0`) is dark behind the light, where the example takes a power of a negative number; 1 inside the cone for `e` = 0.
/// Error model: that of `safe_pow(c, e)`; either value where `c` and `cutoff` are closer than their errors.
fn cone_exponent(c: f32, cutoff: f32, e: f32) -> f32 {
    if (!(c >= cutoff)) {
        return 0.0;
    }
    return safe_pow(c, e);
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

/// A colour with every channel clamped to [0, 1].
///
/// Parameters: `c` linear colour, any range.
/// Returns: linear colour in [0, 1].
/// Source: OpenGL Programming Guide, 8th edition, 2013, example 7.2: `min(colour, 1)` at the end of the shader.
/// Edges: negative channels become 0; NaN gives either bound.
/// Error model: exact.
fn saturate_color(c: vec3f) -> vec3f {
    return clamp(c, vec3f(0.0), vec3f(1.0));
}

// package::surface::view

/// The direction to a viewer infinitely far away.
///
/// Parameters: none.
/// Returns: (0, 0, 1), eye space: towards the viewer, where the book's prose says -z.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, chapter 7, "Lighting Coordinate Systems", example 7.4.
/// Edges: none.
/// Error model: exact.
fn view_infinite() -> vec3f {
    return vec3f(0.0, 0.0, 1.0);
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

/// Materials in one array: pairs of front and back with `two_sided`.
struct Materials {
    items: array<Material, 1>,
}

@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(1) var<uniform> lamps: Lamps;
@group(0) @binding(2) var<uniform> surroundings: Surroundings;
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
    color = saturate_color(color);
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
    var arriving = sample_spot(light, surface.position);

    let ambient = 1.0;

    let diffuse = lambert(surface.normal, arriving.l);

    let specular = blinn_phong(surface.normal, arriving.l, surface.view, surface.material.shininess);

    let visibility = 1.0;

    return accumulate(sum, surface.material, light, arriving, ambient, diffuse, specular, visibility);
}

/// Light from everywhere, onto a surface of this unit normal.
fn ambient_light(normal: vec3f) -> vec3f {
    return surroundings.color;
}

/// Unit direction from a point to the viewer.
fn towards_viewer(position: vec3f) -> vec3f {
    return (camera.world_from_view * vec4f(view_infinite(), 0.0)).xyz;
}
