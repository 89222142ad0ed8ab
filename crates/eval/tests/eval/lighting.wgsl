// expect: blinn_phong(0, 0, 1, 0, 0, 1, 0, 0, 1, 32) = 1
// expect: blinn_phong(0, 0, 1, 0, 0.6, 0.8, 0, -0.6, 0.8, 32) = 1
// expect: blinn_phong(0, 0, 1, 0, 0.6, 0.8, 0, 0, 1, 4) = 0.81
// expect: blinn_phong(0, 0, 1, 0, 0.6, -0.8, 0, 0, 1, 4) = 0
fn blinn_phong(n: vec3f, l: vec3f, v: vec3f, s: f32) -> f32 {
    let n_dot_l = dot(n, l);
    if n_dot_l <= 0.0 {
        return 0.0;
    }
    let h = normalize(l + v);
    return pow(max(dot(n, h), 0.0), s);
}

// expect: reflected(1, -1, 0, 0, 1, 0) = 1 1 0
fn reflected(i: vec3f, n: vec3f) -> vec3f { return reflect(i, n); }
// expect: refracted(0.6, -0.8, 0, 1, 0.5) = 0.3 -0.9539392014169457
// expect: refracted(0.6, -0.8, 0, 1, 2) = 0 0
fn refracted(i: vec2f, n: vec2f, r: f32) -> vec2f { return refract(i, n, r); }
// expect: facing(0, 0, 1, 0, 0, -1) = 0 0 1
// expect: facing(0, 0, 1, 0, 0, 1) = 0 0 -1
fn facing(n: vec3f, i: vec3f) -> vec3f { return faceForward(n, i, vec3f(0, 0, 1)); }
// expect: crossed(1, 0, 0, 0, 1, 0) = 0 0 1
fn crossed(a: vec3f, b: vec3f) -> vec3f { return cross(a, b); }
// expect: apart(1, 2, 4, 6) = 5
fn apart(a: vec2f, b: vec2f) -> f32 { return distance(a, b); }
// expect: det3() = -3
fn det3() -> f32 { return determinant(mat3x3f(1, 4, 7, 2, 5, 8, 3, 6, 10)); }
// expect: det4(2) = 16
fn det4(x: f32) -> f32 { return determinant(mat4x4f(x, 0, 0, 1, 0, x, 0, 1, 0, 0, x, 1, 0, 0, 0, x)); }

// quad: slope(0 0 | 1 0 | 0 1 | 1 1) = 3 5 8 | 3 5 8 | 3 5 8 | 3 5 8
fn slope(p: vec2f) -> vec3f {
    let f = 3.0 * p.x + 5.0 * p.y;
    return vec3f(dpdx(f), dpdy(f), fwidth(f));
}
// quad: fine(0 | 1 | 10 | 30) = 1 10 1 10 | 1 29 1 10 | 20 10 1 10 | 20 29 1 10
fn fine(f: f32) -> vec4f { return vec4f(dpdxFine(f), dpdyFine(f), dpdxCoarse(f), dpdyCoarse(f)); }
// error: slope(1, 2) = eval-needs-quad

// quad: in_branch(1 | 2 | -1 | 3) = 2 | 2 | 4 | 4
fn in_branch(x: f32) -> f32 {
    var y = x;
    if x < 0.0 { y = -x; }
    if y > 5.0 { return 0.0; }
    return 2.0 * dpdx(y) * select(1.0, 1.0, x > 0.0);
}
