// Every kind of resource the library's programs use, textures passed to functions included.
struct Camera {
    view_projection: mat4x4<f32>,
    eye: vec3<f32>,
    near: f32,
}

struct Light {
    position: vec4<f32>,
    color: vec3<f32>,
    cutoff: f32,
}

struct Lights {
    items: array<Light, 4>,
    normal_matrix: mat3x3<f32>,
    count: u32,
}

@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(1) var<uniform> lights: Lights;
@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;
@group(1) @binding(2) var shadow_cube: texture_depth_cube;
@group(1) @binding(3) var shadow_layers: texture_depth_2d_array;
@group(2) @binding(0) var albedo: texture_2d<f32>;
@group(2) @binding(1) var smooth_sampler: sampler;
@group(2) @binding(2) var layers: texture_2d_array<f32>;
@group(2) @binding(3) var sky: texture_cube<f32>;
@group(2) @binding(4) var never_used: texture_3d<f32>;

struct Varyings {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) @interpolate(flat, either) material: u32,
}

@vertex
fn vs_main(@location(0) position: vec3<f32>, @location(1) normal: vec3<f32>, @builtin(instance_index) instance: u32) -> Varyings {
    var out: Varyings;
    out.clip = camera.view_projection * vec4(position, 1.0);
    out.world = position;
    out.normal = lights.normal_matrix * normal;
    out.material = instance;
    return out;
}

fn visibility(map: texture_depth_2d, samp: sampler_comparison, uv: vec2<f32>, depth: f32) -> f32 {
    var sum = 0.0;
    for (var i = 0; i < 9; i++) {
        let offset = vec2(f32(i % 3) - 1.0, f32(i / 3) - 1.0) / vec2<f32>(textureDimensions(map));
        sum += textureSampleCompareLevel(map, samp, uv + offset, depth);
    }
    return sum / 9.0;
}

fn cube_visibility(map: texture_depth_cube, samp: sampler_comparison, direction: vec3<f32>, depth: f32) -> f32 {
    return textureSampleCompareLevel(map, samp, direction, depth);
}

fn texel(map: texture_2d<f32>, samp: sampler, uv: vec2<f32>) -> vec4<f32> {
    return textureSample(map, samp, uv);
}

struct Out {
    @location(0) color: vec4<f32>,
    @location(1) moments: vec2<f32>,
}

@fragment
fn fs_main(in: Varyings) -> Out {
    let n = normalize(in.normal);
    var color = texel(albedo, smooth_sampler, in.world.xy).rgb;
    color += textureSample(layers, smooth_sampler, in.world.xy, i32(in.material)).rgb;
    color += textureSampleLevel(sky, smooth_sampler, n, 2.0).rgb;
    var sum = vec3(0.0);
    for (var i = 0u; i < min(lights.count, 4u); i++) {
        let light = lights.items[i];
        let l = normalize(light.position.xyz - in.world);
        sum += light.color * max(dot(n, l), 0.0);
    }
    sum *= visibility(shadow_map, shadow_sampler, in.world.xy, in.clip.z);
    sum *= cube_visibility(shadow_cube, shadow_sampler, n, 0.5);
    sum *= textureSampleCompareLevel(shadow_layers, shadow_sampler, in.world.xy, 1, 0.5);
    return Out(vec4(color * sum, 1.0), vec2(in.clip.z, in.clip.z * in.clip.z));
}
