struct S { m: mat3x3f, a: array<mat3x4f, 2> }
@group(0) @binding(0) var<uniform> s: S;
@fragment fn fs_main(@location(0) @interpolate(flat) i: u32, @location(1) v: vec3f) -> @location(0) vec4f {
    var m = s.m; m[i] = v; m[1][i] = 4.0; m[i][i] += 2.0; m *= s.m; m += s.m; m *= 2.0; let n = m - s.m;
    return vec4f(s.m[i] * transpose(n) * v, determinant(m)) + s.a[i] * v + (vec4f(v, 1) * s.a[1]).xyzx + vec4f((s.a[i][i]));
}
