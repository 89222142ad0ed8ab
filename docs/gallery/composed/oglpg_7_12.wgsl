// package::ambient::hemisphere

/// The share of the sky in the light a tilted surface receives.
///
/// The book calls this cosine form an approximation; it is the exact cosine-weighted share: 0.93301 at 30 degrees, 0.75 at 60, 0.25 at 120.
///
/// Parameters: `n`, `up` unit, one space: the surface's normal and the pole of the sky.
/// Returns: `0.5 + 0.5*n.up`, in [0, 1].
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.12; Nishita, Nakamae, "Continuous Tone Representation of Three-Dimensional Objects Illuminated by Sky Light", 1986.
/// Edges: 0.5 for a zero vector.
/// Error model: absolute 2^-24 + 0.75*2^-23*sum|n_i*up_i|.
fn hemisphere_weight(n: vec3f, up: vec3f) -> f32 {
    return 0.5 + 0.5 * dot(n, up);
}

/// Ambient light from sky and ground.
///
/// Parameters: `n`, `up` unit, one space: the surface's normal and the pole of the sky; `sky`, `ground` linear colours, at least 0.
/// Returns: `mix(ground, sky, hemisphere_weight)`, linear, between the two colours.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.12.
/// Edges: the mean of both for a zero vector.
/// Error model: absolute 2*2^-23*|sky - ground| + 2 ULP of the larger colour.
fn hemisphere(n: vec3f, up: vec3f, sky: vec3f, ground: vec3f) -> vec3f {
    return mix(ground, sky, hemisphere_weight(n, up));
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
    return hemisphere(normal, surroundings.up, surroundings.sky, surroundings.ground);
}
