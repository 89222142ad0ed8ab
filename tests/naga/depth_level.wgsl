@group(0) @binding(0) var map: texture_depth_2d;
@group(0) @binding(1) var smp: sampler;
@fragment fn fs_main(@location(0) uv: vec2f, @location(1) @interpolate(flat) level: i32) -> @location(0) vec4f {
    return vec4f(textureSampleLevel(map, smp, uv, level) + textureSampleLevel(map, smp, uv, 1u));
}
