struct P { a: vec3f, b: f32, c: array<i32, 2> }
const ps = array<P, 2>(P(vec3f(1), 2, array(1, 2)), P(vec3f(3), 4, array(3, 4)));
const z = P();
@fragment fn fs_main(@location(0) @interpolate(flat) i: u32) -> @location(0) vec4f { return vec4f(ps[i].a * z.b, f32(ps[i].c[1 - i])); }
