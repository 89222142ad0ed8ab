// What stages may take and give, and the functions that naga writes helpers for.
struct Moved {
    @builtin(position) place: vec4f,
    @location(0) @interpolate(flat) number: u32,
    @location(1) @interpolate(linear) across: vec2f,
    @location(2) @interpolate(perspective, centroid) inside: vec3f,
    @location(3) @interpolate(perspective, sample) each: f32,
    @location(4) @interpolate(flat) whole: vec3i,
}
struct Drawn {
    @location(0) first: vec4f,
    @location(1) second: vec4u,
    @location(3) third: vec2f,
    @builtin(frag_depth) depth: f32,
    @builtin(sample_mask) mask: u32,
}
// Metal packs these vectors, so that the number behind each has room.
struct Packed { a: vec3u, b: u32, c: vec3i, d: i32 }
struct Inner { a: vec3f, b: f32, c: array<mat3x3f, 2>, d: mat4x2f }
override scale: f32 = 1.5;
override count: i32 = -3;
override strict: bool = true;
const LIST = array<vec3f, 3>(vec3f(1.0), vec3f(0.5, 1.0, -2.0), vec3f());
@group(0) @binding(0) var<uniform> inner: Inner;
@group(0) @binding(1) var map: texture_2d<f32>;
@group(0) @binding(2) var smp: sampler;
@group(0) @binding(3) var<uniform> numbers: Packed;

@vertex fn moved(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) instance: u32,
    @location(0) place: vec3f,
    @location(7) number: vec2u,
) -> Moved {
    var moved: Moved;
    moved.place = vec4f(place * scale, f32(index + instance));
    moved.number = number.y;
    moved.across = (inner.d * vec4f(1.0, 2.0, 3.0, 4.0)).yx;
    moved.inside = inner.c[1] * LIST[index % 3u];
    moved.whole = vec3i(place) / vec3i(count) % 7;
    return moved;
}

fn changed(at: ptr<function, vec3f>, by: f32) -> f32 {
    (*at).y += by;
    *at = -*at;
    return (*at).z;
}

@fragment fn drawn(
    moved: Moved,
    @builtin(front_facing) front: bool,
    @builtin(sample_index) sample: u32,
    @builtin(sample_mask) mask: u32,
) -> Drawn {
    var at = moved.inside;
    let back = changed(&at, inner.a.x);
    let parts = modf(at);
    let other = frexp(at.xy);
    let split = modf(back);
    if !front && strict {
        discard;
    }
    let whole = abs(moved.whole) - (-moved.whole) * sign(moved.whole);
    var sum = vec4f(parts.fract + parts.whole * split.fract, other.fract.x + f32(other.exp.y));
    sum += textureSampleBaseClampToEdge(map, smp, at.xy);
    switch dot(whole, vec3i(1, 2, 3)) {
        case 1, 2: { sum.x = 3.0; }
        case -2147483648: { sum.y = 1.0; }
        default: { sum = select(sum, sum.wzyx, sum < vec4f(0.25)); }
    }
    let packed = pack4xI8(vec4i(1, -2, 3, whole.x)) ^ pack4xU8Clamp(vec4u(300u)) ^ pack4xU8(vec4u(4u)) ^ pack4xI8Clamp(vec4i(-300));
    let words = vec4u(unpack4xI8(packed) + vec4i(unpack4xU8(packed)));
    let bits = firstLeadingBit(words) + firstTrailingBit(words) + vec4u(firstLeadingBit(vec4i(words)));
    let masked = (words.xyz ^ numbers.a) | (~numbers.a >> vec3u(numbers.b)) & numbers.a;
    let shifted = ((numbers.c << numbers.a) >> masked) % vec3i(numbers.d) + (whole << numbers.a);
    let chosen = countLeadingZeros(words.xyz) + reverseBits(words.xyz) + countOneBits(words.yzw) + vec3u(shifted);
    return Drawn(sum * dpdxFine(sum) + fwidthCoarse(sum), bits + vec4u(chosen, u32((moved.across < sum.xy).y)), at.xy, at.z, mask | sample);
}
