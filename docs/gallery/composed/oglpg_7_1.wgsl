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

@group(0) @binding(0) var<uniform> camera: Camera;
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
    var color = base.rgb;
    return vec4f(color, base.a);
}
