//! Programs with much that naga's writers treat in a special way.

/// Names and functions that writers number, rename or add, in all combinations of the axes.
pub const TRAPS: &str = "
struct Material { color: vec3f, kind: i32, spread: array<vec4f, 3> }
struct Block { items: array<Material, 4>, turn: mat3x3f, counts: vec4i }
struct Carried { @builtin(position) clip: vec4f, @location(0) normal: vec3f, @location(1) @interpolate(flat) index: u32 }
@group(0) @binding(0) var<uniform> block: Block;
@group(0) @binding(1) var<uniform> other: vec4f;
@group(1) @binding(0) var map: texture_2d<f32>;
@group(1) @binding(1) var shadow: texture_depth_2d;
@group(1) @binding(2) var smooth_sampler: sampler;
@group(1) @binding(3) var compare: sampler_comparison;
@group(1) @binding(4) var whole: texture_2d<i32>;
const OFFSETS = array<vec2f, 4>(vec2f(0.1), vec2f(0.2), vec2f(0.3), vec2f(0.4));
const LIMIT: i32 = 7;
var<private> seen: i32;

// Keywords of other languages, and names that shadow declarations.
fn lit(float4: f32, main: f32) -> f32 { let fixed = float4 * main; let tap_3 = fixed + 1.0; return tap_3; }
fn helper(material: Material, lit: f32) -> vec3f { var at = material.color; { let at = lit; return at * material.color; } return at; }
// Functions that the writers add: of two kinds where both are used.
@if(sign == int) fn turned(v: i32, u: vec2i) -> i32 { return -v / (u.x | 1); }
@if(sign == vec) fn turned(v: i32, u: vec2i) -> i32 { let t = -u % vec2i(v | 1); return t.x + abs(t.y); }
@if(sign == both) fn turned(v: i32, u: vec2i) -> i32 { let t = -u / vec2i(3); return -v + t.x + i32(f32(v) * 0.5); }
fn table_4(i: i32) -> vec2f { return OFFSETS[i & 3]; }
fn loops(count: i32) -> f32 {
    var sum = 0.0;
    for (var i = 0; i < count; i++) { for (var j = 0; j < LIMIT; j++) { sum += table_4(i + j).x; } }
    for (var i = 0; i < 2; i++) { sum += f32(i); }
    switch count { case LIMIT: { sum += 1.0; } case 2, 3: { sum -= 1.0; } default: {} }
    return sum;
}
fn fresh(kind: i32) -> Material { return Material(vec3f(1.0), kind, array<vec4f, 3>(vec4f(1.0), vec4f(2.0), vec4f(3.0))); }
fn counted() -> i32 { seen += 1; return seen; }
@if(lookup == one) fn look(at: vec2f) -> f32 { return textureSampleLevel(map, smooth_sampler, at, 0.0).x; }
@if(lookup == two) fn look(at: vec2f) -> f32 { return textureSampleCompareLevel(shadow, compare, at, 0.5) + f32(textureDimensions(map).x); }
@if(lookup == three) fn look(at: vec2f) -> f32 { let size = textureDimensions(whole); return f32(textureLoad(whole, vec2i(at * vec2f(size)), 0).x); }
fn looked(at: vec2f, scale: f32) -> f32 { return scale * look(at); }
fn split(x: f32) -> f32 { let parts = modf(x); return parts.fract + parts.whole; }

@vertex fn vs_main(@location(0) place: vec3f, @builtin(vertex_index) number: u32) -> Carried {
    var out: Carried;
    out.clip = vec4f(place + block.items[number % 4u].color, 1.0);
    @if(sign != both) { out.normal = vec3f(f32(turned(i32(number), vec2i(1)))) + other.xyz; }
    @else { out.normal = fresh(3).color * loops(2); }
    out.index = number;
    return out;
}

@fragment fn fs_main(in: Carried, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let normal = normalize(in.normal);
    var material = block.items[in.index & 3u];
    @if(lookup == one) { material = fresh(turned(material.kind, block.counts.xy)); }
    @if(wide) { material.color *= split(normal.x) * f32(counted()); }
    let lit = lit(normal.x, looked(normal.xy, loops(material.kind)));
    if !front { discard; }
    return vec4f(helper(material, lit) + vec3f((block.turn * normal).xy, other.w), f32(turned(1, vec2i(2))));
}
";

pub const TRAPS_MANIFEST: &str = r#"
[program.traps]
wesl = "traps.wesl"
[program.traps.axis]
sign = { values = ["int", "vec", "both"] }
lookup = { values = ["one", "two", "three"] }
wide = { values = [false, true] }
"#;

/// Code that GLSL cannot express: matrices of two rows in blocks, and functions of newer versions.
pub const ROWS: &str = "
struct Block { turn: mat3x2f, counts: vec4i }
@group(0) @binding(0) var<uniform> block: Block;
fn turned(v: vec3f, i: i32) -> vec2f { return block.turn * v + block.turn[i & 1]; }
fn split(x: f32) -> f32 { let parts = frexp(x); return ldexp(parts.fract, parts.exp + 1); }
@vertex fn vs_main(@location(0) place: vec3f) -> @builtin(position) vec4f {
    return vec4f(turned(place, block.counts.x), split(place.z), 1.0);
}
@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    @if(wide) { return vec4f(turned(at.xyz, 1), split(at.x), f32(countOneBits(block.counts.y))); }
    @else { return vec4f(turned(at.zyx, 0), at.xy); }
}
";

pub const ROWS_MANIFEST: &str = r#"
[program.rows]
wesl = "rows.wesl"
targets = ["spirv", "hlsl", "msl", "wgsl"]
[program.rows.axis]
wide = { values = [false, true] }
"#;

/// Names that have another meaning for a writer, and variables whose order depends on an axis.
pub const NAMES: &str = "
const MAX: f32 = 4.0;
const scale: f32 = 2.0;
@if(first) const TABLE = vec3u(1u, 2u, 3u);
struct Vertex { @location(0) at: vec2f, @location(1) light: f32 }
struct Float { value: f32, turn: vec2i }
@if(first) @group(0) @binding(0) var<uniform> x: vec4f;
@group(0) @binding(1) var<uniform> y: vec4f;
@if(!first) @group(0) @binding(0) var<uniform> x: vec4f;
@group(0) @binding(2) var<uniform> many: array<vec4f, 3>;
fn bounded(value: f32) -> f32 { return max(value, MAX); }
fn made(value: f32) -> Float { return Float(value, vec2i(1, 2)); }
fn threefold(scale: f32) -> f32 { return scale * 3.0; }
@if(first) fn mixed() -> vec4f { return x - y + f32(TABLE[2]); }
@else fn mixed() -> vec4f { return x + 2.0 * y; }
@if(kind == one || kind == both) fn third(v: f32) -> f32 { return f32(i32(v) / 3); }
@if(kind == two || kind == both) fn thirds(v: f32) -> f32 { return f32((vec2u(u32(v)) / vec2u(3u)).x); }
@if(scaled) fn held(value: f32) -> f32 { return value * scale; }
@else fn held(value: f32) -> f32 { return value; }
@vertex fn vs_main(in: Vertex) -> @builtin(position) vec4f { return mixed() + vec4f(in.at, bounded(in.light), many[1].x); }
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    let float = made(at.x);
    var sum = threefold(held(float.value)) + many[float.turn.x].y;
    @if(kind == one || kind == both) { sum += third(sum); }
    @if(kind == two || kind == both) { sum += thirds(sum); }
    return mixed() * sum;
}
";

pub const NAMES_MANIFEST: &str = r#"
[program.names]
wesl = "names.wesl"
[program.names.axis]
first = { values = [false, true] }
scaled = { values = [false, true] }
kind = { values = ["none", "one", "two", "both"] }
"#;
