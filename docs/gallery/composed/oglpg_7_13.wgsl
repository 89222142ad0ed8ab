// package::ambient::ibl

/// A surface's colour with the diffuse and specular maps mixed in.
///
/// Parameters: `base` surface's linear colour, [0, 1]; `diffuse`, `specular` linear colours read from the maps, at least 0; `dp`, `sp` their shares, [0, 1].
/// Returns: `c = mix(base, diffuse*base, dp)`, then `mix(c, specular + c, sp)`, linear, not clamped.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.13.
/// Edges: `base` for both shares 0.
/// Error model: absolute 2*2^-23*(|base|*(1 + |diffuse|) + |specular|).
fn ibl_mix(base: vec3f, diffuse: vec3f, specular: vec3f, dp: f32, sp: f32) -> vec3f {
    let c = mix(base, diffuse * base, dp);
    return mix(c, specular + c, sp);
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
@group(0) @binding(12) var sky_diffuse: texture_cube<f32>;
@group(0) @binding(13) var sky_specular: texture_cube<f32>;
@group(0) @binding(14) var sky_sampler: sampler;
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

/// The colour of the surface where no lamp shines.
fn shade(base: vec3f, in: Varyings) -> vec3f {
    let normal = safe_normalize(in.normal, vec3f(0.0));
    let mirrored = reflect(-towards_viewer(in.position), normal);
    let diffuse = textureSample(sky_diffuse, sky_sampler, normal).rgb;
    let specular = textureSample(sky_specular, sky_sampler, mirrored).rgb;
    return ibl_mix(base, diffuse, specular, surroundings.diffuse_share, surroundings.specular_share);
}

/// Unit direction from a point to the viewer.
fn towards_viewer(position: vec3f) -> vec3f {
    return view_local(position - camera.world_from_view[3].xyz);
}
