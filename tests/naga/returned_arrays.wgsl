struct S { a: array<f32, 3>, b: f32 }
fn change(s: S) -> S { var t = s; t.a[0] += 1; return t; }
fn pass_array(a: array<f32, 3>) -> array<f32, 3> { var b = a; b[1] = 9; return b; }
@fragment fn fs_main() -> @location(0) vec4f { var s = S(array(1, 2, 3), 4); let t = change(s); s.a = pass_array(t.a); var u = array<S, 2>(s, t); u[1].a = u[0].a; let w = u; u[0].b = 3; return vec4f(w[0].b, u[0].b, u[1].a[1], t.a[0]); }
