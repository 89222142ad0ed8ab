@group(0) @binding(0) var<storage, read_write> a: vec2i;
@group(0) @binding(1) var<storage, read_write> b: i32;
@group(0) @binding(2) var<storage, read_write> c: array<vec2f, 3>;
@group(0) @binding(3) var<storage, read_write> d: mat4x3f;
@compute @workgroup_size(1) fn main() { a = vec2i(b); b = a.y; c[1].y = f32(b); c = array(vec2f(1), c[0], c[1]); d[1] = vec3f(1); d = d; }
