fn step(seed: ptr<function, u32>) -> u32 {
    *seed = *seed * 3u + 1u;
    return *seed;
}
struct Seeds { all: array<u32, 3>, last: u32 }
@fragment fn fs_main(@location(0) @interpolate(flat) at: u32) -> @location(0) vec4f {
    var seeds = Seeds(array<u32, 3>(1, 2, 3), 4);
    let a = step(&seeds.all[at]);
    let b = step(&seeds.last);
    return vec4f(f32(a), f32(b), f32(seeds.all[1]), 1.0);
}
