// Compute shaders, which nothing runs here: atomics, barriers, storage, work group variables.
struct Counts {
    total: atomic<u32>,
    largest: atomic<i32>,
    list: array<vec3f>,
}
struct Pair { first: vec2u, second: mat2x3f, kept: array<vec4f, 3> }

@group(0) @binding(0) var<storage, read_write> counts: Counts;
@group(0) @binding(1) var<storage, read> numbers: array<f32>;
@group(0) @binding(2) var<uniform> pair: Pair;
@group(0) @binding(3) var drawn: texture_storage_2d<rgba8unorm, write>;
@group(0) @binding(4) var layers: texture_storage_2d_array<rgba32uint, write>;
@group(0) @binding(5) var volume: texture_storage_3d<r32float, write>;
@group(0) @binding(6) var line: texture_storage_1d<r32sint, write>;
@group(0) @binding(7) var source: texture_storage_2d<r32float, read>;
@group(0) @binding(8) var both: texture_storage_2d<r32uint, read_write>;
@group(0) @binding(9) var several: texture_multisampled_2d<f32>;
@group(0) @binding(10) var depths: texture_depth_multisampled_2d;

var<workgroup> shared_sum: array<u32, 64>;
var<workgroup> shared_count: atomic<u32>;
var<private> turns: vec3<bool>;

@compute @workgroup_size(8, 8, 1)
fn first(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(local_invocation_index) index: u32,
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
) {
    shared_sum[index] = id.x + group.y * groups.z;
    atomicStore(&shared_count, 0u);
    workgroupBarrier();
    let before = atomicAdd(&shared_count, local.x) + atomicMax(&counts.total, 3u);
    let swapped = atomicCompareExchangeWeak(&counts.total, before, 7u);
    let within = atomicCompareExchangeWeak(&shared_count, 1u, 2u);
    if swapped.exchanged && within.exchanged {
        atomicSub(&counts.total, swapped.old_value);
        atomicAnd(&counts.total, 15u);
        atomicOr(&counts.total, 1u);
        atomicXor(&counts.total, 2u);
        atomicMin(&counts.largest, atomicExchange(&counts.largest, -4));
    }
    storageBarrier();
    let length = arrayLength(&counts.list) + arrayLength(&numbers);
    counts.list[min(id.x, length)] = vec3f(numbers[id.y % length], f32(atomicLoad(&shared_count)), 0.5);
    turns = vec3<bool>(id.x > 1u, id.y == 2u, turns.x);
    if all(turns) || any(turns.xy) {
        textureStore(drawn, id.xy, vec4f(f32(shared_sum[63u - index])));
    }
    textureStore(layers, id.xy, 1u, vec4u(pair.first, id.xy));
    textureStore(volume, id, vec4f(pair.second[1], pair.kept[2].w));
    textureStore(line, id.x, vec4i(-1));
    textureStore(both, id.xy, textureLoad(both, id.yx) + vec4u(1u));
    let read = textureLoad(source, id.xy) + textureLoad(several, id.xy, 1) + vec4f(textureLoad(depths, id.xy, 0));
    counts.list[0] = read.xyz + f32(textureNumSamples(several)) + vec3f(f32(textureDimensions(both).x));
}

@compute @workgroup_size(64)
fn second(@builtin(local_invocation_index) index: u32) {
    let kept = workgroupUniformLoad(&shared_sum[0]);
    for (var i = 0u; i < kept; i++) {
        shared_sum[index] += i;
    }
}
