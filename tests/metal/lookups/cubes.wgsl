@group(0) @binding(0) var cube: texture_cube<f32>;
@group(0) @binding(1) var smp: sampler;
@group(0) @binding(2) var depth: texture_depth_cube;
@group(0) @binding(3) var cmp: sampler_comparison;
@group(0) @binding(4) var cubes: texture_cube_array<f32>;
@group(0) @binding(5) var depths: texture_depth_cube_array;

@fragment fn fs(@location(0) a: vec4f, @location(1) b: vec4f) -> @location(0) vec4f {
    let first = a.xyz - 0.5;
    let second = b.xyz - 0.5;
    var sum = textureSample(cube, smp, first);
    sum += 2.0 * textureSampleLevel(cube, smp, second, 1.25);
    sum += 3.0 * textureSampleBias(cube, smp, first + second, 1.0);
    sum += 5.0 * textureSampleLevel(cubes, smp, first, 1, 0.0);
    sum += 7.0 * textureSample(cubes, smp, second, 0);
    sum.x += textureSampleCompare(depth, cmp, first, b.w);
    sum.y += textureSampleCompareLevel(depth, cmp, second, a.w);
    sum.z += textureSample(depth, smp, first);
    sum.w += textureSampleCompare(depths, cmp, second, 1, a.w);
    return sum + vec4f(vec2f(textureDimensions(cube, 1)), vec2f(textureDimensions(cubes)));
}
