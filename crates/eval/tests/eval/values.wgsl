struct Light { position: vec3f, range: f32, flags: vec2u, on: bool }

// expect: pack_light(1, 2, 3, 4) = 1 2 3 4 5 6 true
fn pack_light(position: vec3f, range: f32) -> Light {
    return Light(position, range, vec2u(5, 6), true);
}

// expect: use_light(1, 2, 3, 4, 5, 6, true) = 11
// expect: use_light(1, 2, 3, 4, 5, 6, false) = 0
fn use_light(l: Light) -> f32 {
    if !l.on { return 0.0; }
    return l.position.y * l.range + f32(l.flags.x) - l.position.z + l.position.x;
}

// expect: swizzles(1, 2, 3, 4) = 3 2 1 4
fn swizzles(v: vec4f) -> vec4f {
    return vec4f(v.zyx, v.w);
}

// expect: write_components(1, 2, 3) = 9 2 4
fn write_components(v: vec3f) -> vec3f {
    var r = v;
    r.x = 9.0;
    r[2] = r[2] + 1.0;
    return r;
}

// expect: scaled(2, 1, 2, 3) = 2 4 6
fn scaled(s: f32, v: vec3f) -> vec3f { return s * v; }
// expect: divided(6, 1, 2, 3) = 6 3 2
fn divided(s: f32, v: vec3f) -> vec3f { return s / v; }

// expect: transform(1, 2) = 6 8 10
fn transform(v: vec2f) -> vec3f {
    let m = mat2x3f(vec3f(0, 2, 4), vec3f(3, 3, 3));
    return m * v;
}
// expect: transform_left(1, 2, 3) = 16 18
fn transform_left(v: vec3f) -> vec2f {
    let m = mat2x3f(vec3f(0, 2, 4), vec3f(3, 3, 3));
    return v * m;
}
// expect: compose_matrices(2) = 2 4 6 8
fn compose_matrices(s: f32) -> mat2x2f {
    return mat2x2f(1, 2, 3, 4) * mat2x2f(s, 0, 0, s);
}
// expect: matrix_sum() = 6 8 10 12
fn matrix_sum() -> mat2x2f { return mat2x2f(1, 2, 3, 4) + mat2x2f(5, 6, 7, 8); }
// expect: column(0) = 1 2
// expect: column(1) = 3 4
// expect: column(9) = 3 4
fn column(i: i32) -> vec2f {
    var m = mat2x2f(1, 2, 3, 4);
    return m[i];
}
// expect: transposed() = 1 2 3 4 5 6
fn transposed() -> mat3x2f { return transpose(mat2x3f(1, 3, 5, 2, 4, 6)); }

const TABLE = array<f32, 4>(10, 20, 30, 40);
// expect: table(2) = 30
// expect: table(-1) = 40
// expect: table(100) = 40
// finding: table(2) = none
// finding: table(4) = OutOfBounds
fn table(i: i32) -> f32 { return TABLE[i]; }

// expect: of_structs(1) = 4
fn of_structs(i: u32) -> f32 {
    var lights: array<Light, 3>;
    lights[i].position[1] = 3.0;
    lights[i].range = 1.0;
    let l = lights[i];
    return l.position.y + l.range;
}

// A pointer parameter takes what it points to, and gives back what is left there.
fn bump(p: ptr<function, f32>) { *p += 1.0; }
fn bump_all(v: ptr<function, array<f32, 3>>) {
    for (var i = 0; i < 3; i++) { bump(&(*v)[i]); }
}
// expect: pointers(1) = 2 3 4
fn pointers(x: f32) -> vec3f {
    var a = array<f32, 3>(x, x + 1, x + 2);
    bump_all(&a);
    return vec3f(a[0], a[1], a[2]);
}

// expect: bump(1) = 2

// expect: selects(true, 1, 2) = 2
// expect: selects(false, 1, 2) = 1
fn selects(c: bool, a: f32, b: f32) -> f32 { return select(a, b, c); }
// expect: select_each(1, 5) = 1 7
fn select_each(a: f32, b: f32) -> vec2f { return select(vec2f(a, b), vec2f(6, 7), vec2f(a, b) > vec2f(2.0)); }
// expect: any_all(1, 0) = true false
fn any_all(a: u32, b: u32) -> vec2<bool> {
    let v = vec2u(a, b) == vec2u(1);
    return vec2(any(v), all(v));
}

// expect: nan_by_bits(1) = false
fn nan_by_bits(x: f32) -> bool { return (bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u; }
// expect: nan_made(0) = true
// finding: nan_made(0) = Domain
fn nan_made(x: f32) -> bool { return nan_by_bits(sqrt(x - 1.0)); }

// expect: bits(1) = 0x3f800000
fn bits(x: f32) -> u32 { return bitcast<u32>(x); }
// expect: from_bits(0x40490fdb) = 3.14159274101257324
fn from_bits(x: u32) -> f32 { return bitcast<f32>(x); }

// expect: conversions(2.7, -3, 4) = -2 4294967293 4 2
fn conversions(f: f32, i: i32, u: u32) -> vec4f {
    return vec4f(f32(i32(-f)), f32(u32(i)), f32(u), f32(u32(f)));
}
// finding: conversions(2.7, -3, 4) = none
// finding: to_unsigned(-5) = Conversion
fn to_unsigned(f: f32) -> u32 { return u32(f); }

// expect: integers(7, -2) = 5 -14 -3 1
fn integers(a: i32, b: i32) -> vec4i { return vec4i(a + b, a * b, a / b, a % b); }
// finding: integers(7, 0) = DivisionByZero DivisionByZero
// expect: integers(7, 0) = 7 0 7 0
// expect: shifts(-8, 1) = -16 -4
fn shifts(a: i32, b: u32) -> vec2i { return vec2i(a << b, a >> b); }
// expect: wraps(4294967295) = 0 4294967294
fn wraps(a: u32) -> vec2u { return vec2u(a + 1u, a * 2u); }

// finding: divides(1) = none
// finding: divides(0) = DivisionByZero
fn divides(x: f32) -> f32 { return 1.0 / x; }
// finding: ambiguous(1) = Ambiguous
// finding: ambiguous(2) = none
fn ambiguous(x: f32) -> f32 { if sqrt(x) > 1.0 { return 1.0; } return 0.0; }
// finding: zero_normal(0) = Domain
fn zero_normal(x: f32) -> vec3f { return normalize(vec3f(x)); }
// finding: overflows(100) = Infinity
// finding: overflows(1) = none
fn overflows(x: f32) -> f32 { return exp(x * 10.0); }

override scale: f32 = 2.0;
override twice: f32 = scale * 2.0;
// expect: overridden(3) = 12
fn overridden(x: f32) -> f32 { return twice * x; }

// error: waits() = eval-barrier
fn waits() -> u32 {
    workgroupBarrier();
    return 1u;
}
