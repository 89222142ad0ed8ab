// package::ambient::sh

/// Irradiance from nine coefficients of the radiance.
///
/// Parameters: `n` unit normal in the space of the coefficients; `sh` nine linear RGB coefficients.
/// Returns: irradiance, linear; may be below 0 for an environment of strong contrast.
/// Source: Ramamoorthi, Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001, equation 13; Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, equation 7.1 and example 7.14.
/// Edges: a zero normal gives `0.886227*L00 - 0.247708*L20`.
/// Error model: absolute 12*2^-23 of the sum of the terms' magnitudes.
fn sh9_irradiance(n: vec3f, sh: array<vec3f, 9>) -> vec3f {
    let second = 0.429043 * sh[8] * (n.x * n.x - n.y * n.y) + sh[6] * (0.743125 * n.z * n.z - 0.247708);
    let mixed = 0.858086 * (sh[4] * (n.x * n.y) + sh[7] * (n.x * n.z) + sh[5] * (n.y * n.z));
    let first = 1.023328 * (sh[3] * n.x + sh[1] * n.y + sh[2] * n.z);
    return 0.886227 * sh[0] + first + mixed + second;
}

/// Irradiance from nine coefficients, without the negative light that ringing leaves.
///
/// Parameters: `n` unit normal in the space of the coefficients; `sh` nine linear RGB coefficients.
/// Returns: `max(sh9_irradiance, 0)` per channel, linear, at least 0.
/// Source: as `sh9_irradiance`; the clamp because Grace Cathedral's blue reaches -0.0056.
/// Edges: 0 where the sum is negative.
/// Error model: that of `sh9_irradiance`.
fn sh9_irradiance_clamped(n: vec3f, sh: array<vec3f, 9>) -> vec3f {
    return max(sh9_irradiance(n, sh), vec3f(0.0));
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

@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(2) var<uniform> surroundings: Surroundings;
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

fn shade(base: vec3f, in: Varyings) -> vec3f {
    let light = ambient_light(safe_normalize(in.normal, vec3f(0.0)));
    return base * light;
}

/// Light from everywhere, onto a surface of this unit normal.
fn ambient_light(normal: vec3f) -> vec3f {
    return surroundings.scale * sh9_irradiance_clamped(normal, surroundings.sh);
}
