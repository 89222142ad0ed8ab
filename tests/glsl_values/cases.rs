//! Programs for one construct each, and calls of the language's functions.

/// Bodies of `main` with declarations before it: `put(x)` writes a word.
pub const CASES: &[(&str, &str)] = &[
    (
        "array of arrays",
        "void main() { float w[2][3]; for (int i = 0; i < 2; i++) for (int j = 0; j < 3; j++) w[i][j] = float(i * 10 + j); put(w[1][2]); put(w[0][1]); }",
    ),
    (
        "short circuit",
        "int g = 0; bool f() { g++; return true; } void main() { bool a = false && f(); bool b = true || f(); bool c = true && f(); put(g); put(int(a) + int(b) * 2 + int(c) * 4); }",
    ),
    (
        "compound index",
        "int n = 0; int next() { return n++; } void main() { int x[4] = int[4](0, 0, 0, 0); int i = 0; x[i++] += 10; x[next()] += 5; x[i++] = 7; put(x[0]); put(x[1]); put(i); put(n); }",
    ),
    (
        "inout of a component",
        "void f(inout float x) { x += 1.0; } void main() { vec3 k = vec3(1.0, 2.0, 3.0); f(k.y); f(k[2]); put(k.y); put(k.z); }",
    ),
    (
        "inout of a member",
        "struct S { vec3 a; float b[2]; }; void f(inout vec3 v) { v *= 2.0; } void g(out float x) { x = 9.0; } void main() { S s = S(vec3(1.0), float[2](1.0, 2.0)); f(s.a); g(s.b[1]); put(s.a.z); put(s.b[0]); put(s.b[1]); }",
    ),
    (
        "inout twice",
        "void f(inout int a, inout int b) { a += 1; b += 10; } void main() { int x = 1; int y = 2; f(x, y); put(x); put(y); }",
    ),
    (
        "global initializer",
        "vec3 n = block.color * 2.0; const float k = 3.0; float m = n.x + k; void main() { put(n.x); put(n.z); put(m); }",
    ),
    (
        "switch falls through",
        "int f(int x) { int r = 0; switch (x) { case 0: r += 1; case 1: r += 10; break; case 2: r += 100; default: r += 1000; case 5: r += 5; } return r; } void main() { for (int i = 0; i < 7; i++) put(f(i)); }",
    ),
    (
        "switch shares declarations",
        "int f(int x) { switch (x) { case 0: int a = 3; return a; case 1: a = 4; return a + 1; default: a = 7; a++; return a; } } void main() { for (int i = 0; i < 3; i++) put(f(i)); }",
    ),
    (
        "switch continues a loop",
        "void main() { int r = 0; for (int i = 0; i < 6; i++) { switch (i) { case 1: continue; case 2: case 3: r += 10; break; default: r += 1; } r += 100; } put(r); }",
    ),
    (
        "declaration as a statement",
        "int f(int a) { if (a > 100) int a = 42; return a; } void main() { put(f(7)); put(f(200)); }",
    ),
    (
        "name hides a function",
        "float shadow(float x) { return x * 2.0; } void main() { float shadow = shadow(2.0); put(shadow); }",
    ),
    (
        "parameter is written",
        "float f(float x) { x += 1.0; { float x = 5.0; x += 1.0; } return x; } void main() { put(f(1.0)); }",
    ),
    (
        "overloads",
        "float f(float x) { return 1.0; } float f(vec2 x) { return 2.0; } float f(int x) { return 3.0; } void main() { put(f(1.0)); put(f(vec2(0.0))); put(f(1)); }",
    ),
    (
        "names of WGSL",
        "float fn = 1.0; struct array { float var; }; float select(float let) { return let + 1.0; } void main() { array atomic = array(2.0); put(select(atomic.var)); put(fn); }",
    ),
    (
        "structures are equal",
        "struct S { vec2 a; int b[2]; }; void main() { S x = S(vec2(1.0), int[2](1, 2)); S y = x; put(int(x == y)); y.b[1] = 3; put(int(x == y)); put(int(x != y)); }",
    ),
    (
        "overflow of constants",
        "void main() { int a = 2147483647 + 1; put(a); uint b = 0u - 1u; put(b); int c = 0xFFFFFFFF; put(c); int d = 1 << 31; put(d); put(-2147483648); put(1.0 / 0.0); put(-1.0 / 0.0); }",
    ),
    (
        "functions of constants",
        "void main() { put(dot(vec3(1.0, 2.0, 3.0), vec3(4.0, 5.0, 6.0))); put(length(vec2(3.0, 4.0))); put(distance(vec2(1.0), vec2(4.0, 5.0))); put(normalize(vec2(0.0, 5.0)).y); put(cross(vec3(1.0, 2.0, 3.0), vec3(3.0, 1.0, 2.0)).y); put(determinant(mat3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0))); put(determinant(mat4(2.0))); put(determinant(mat2(1.0, 2.0, 3.0, 4.0))); put(reflect(vec2(1.0, -1.0), vec2(0.0, 1.0)).y); put(refract(vec2(0.0, -1.0), vec2(0.0, 1.0), 0.5).y); put(refract(vec2(0.8, -0.6), vec2(0.0, 1.0), 4.0).x); put(faceforward(vec2(1.0, 2.0), vec2(0.0, -1.0), vec2(0.0, 1.0)).y); put(ldexp(1.5, 3)); put(packHalf2x16(vec2(1.0, -2.0))); put(unpackHalf2x16(0x3c00c000u).x); put(clamp(5, 1, 3)); put(clamp(5u, 7u, 9u)); put(fma(2.0, 3.0, 4.0)); put(uintBitsToFloat(0x40400000u)); put(intBitsToFloat(0x7f800000)); }",
    ),
    (
        "comma",
        "void main() { int a = 1; int b = (a += 2, a * 2); put(a); put(b); for (int i = 0, j = 5; i < j; i++, j--) put(i * 10 + j); }",
    ),
    (
        "assignments are values",
        "void main() { int a, b, c; a = b = c = 4; put(a + b * 10 + c * 100); int i = 0; while ((a = i++) < 3) { put(a); } put(a); }",
    ),
    ("condition declares", "void main() { int i = 0; while (bool go = i < 3) { i++; put(i); } }"),
    (
        "do and continue",
        "void main() { int i = 0; do { i++; if (i == 2) continue; put(i); } while (i < 4); }",
    ),
    (
        "matrix by scalar",
        "void main() { mat2 m = mat2(1.0, 2.0, 3.0, 4.0); mat2 a = m / 2.0; mat2 b = m + 1.0; mat2 c = 1.0 - m; mat2 d = m / m; m++; put(a[1][1]); put(b[0][1]); put(c[1][0]); put(d[0][0]); put(m[1][1]); mat2 n = -m; put(n[0][0]); }",
    ),
    (
        "matrix constructors",
        "void main() { mat3 m = mat3(mat2(1.0, 2.0, 3.0, 4.0)); put(m[1][1]); put(m[2][2]); mat2 n = mat2(mat4(5.0)); put(n[1][1]); mat2x3 k = mat2x3(1.0, vec3(2.0, 3.0, 4.0), vec2(5.0, 6.0)); put(k[0][2]); put(k[1][2]); vec4 v = vec4(mat2(1.0, 2.0, 3.0, 4.0)); put(v.z); }",
    ),
    (
        "conversions",
        "void main() { put(int(3.9)); put(int(-3.9)); put(uint(7.5)); put(float(true)); put(int(bool(2))); vec3 v = vec3(ivec3(1, 2, 3)); put(v.z); ivec2 i = ivec2(vec3(1.5, 2.5, 3.5)); put(i.y); float f = 3; put(f); put(vec2(true, false).x); }",
    ),
    (
        "swizzles of swizzles",
        "void main() { vec4 v = vec4(1.0, 2.0, 3.0, 4.0); v.zw.yx = vec2(8.0, 9.0); put(v.z); put(v.w); v.xy += v.zw; put(v.x); v.wzyx = v; put(v.x); put(v.w); }",
    ),
    (
        "ternary with effects",
        "int g = 0; int f(int x) { g += x; return g; } void main() { int a = true ? f(1) : f(10); int b = g > 5 ? f(100) : f(1000); put(a); put(b); put(g); }",
    ),
    (
        "unsized arrays",
        "const float w[] = float[](1.0, 2.0, 3.0); void main() { put(w.length()); float s = 0.0; for (int i = 0; i < w.length(); i++) s += w[i]; put(s); int k[] = { 4, 5 }; put(k[1]); }",
    ),
    (
        "nested loops and returns",
        "int f(int n) { for (int i = 0; ; i++) { for (int j = 0; j < 5; j++) { if (i * j > n) return i * 10 + j; if (j > i) break; } } } void main() { put(f(3)); put(f(7)); }",
    ),
    (
        "order of effects",
        "int g = 1; int f(int x) { g = g * 2 + x; return g; } void main() { int r = f(0) * 100 + f(1) * 10 + g; put(r); int a[3] = int[3](f(1), f(2), f(3)); put(a[0]); put(a[2]); put(g); }",
    ),
    (
        "atomics",
        "shared uint s; void main() { s = 1u; uint a = atomicAdd(s, 4u); uint b = atomicCompSwap(s, 5u, 9u); put(a); put(b); put(s); put(atomicMax(s, 100u)); put(s); }",
    ),
    (
        "shifts",
        "void main() { int a = -8; put(a >> 1); put(a >> 1u); uint b = 0x80000000u; put(b >> 31); ivec2 v = ivec2(1, 2) << 3; put(v.y); put(1 << 5); }",
    ),
    (
        "block copies",
        "void main() { float a[3] = block.list; put(a[2]); mat2 m = block.small; put(m[1][0]); mat3 r = block.rows; put(r[2][1]); put(block.rows[2][1]); vec3 c = block.rows * vec3(1.0, 2.0, 3.0); put(c.y); put(block.wide[1].z); put(int(block.flag)); }",
    ),
    (
        "values of steps",
        "void main() { int x[3] = int[3](1, 2, 3); int i = 0; int y = ++x[i++]; put(y); put(i); put(x[0]); put(x[1]); int q = x[i++]++; put(q); put(i); put(x[1]); put(x[2]); float f[2] = float[2](0.5, 1.5); i = 0; float g = f[i++]--; put(g); put(i); put(f[0]); put(f[1]); }",
    ),
    (
        "values of assignments",
        "int n = 0; int next() { return n++; } void main() { int x[4] = int[4](0, 0, 0, 0); int i = 1; int z = (x[i++] = 5); put(z); put(i); put(x[1]); put(x[2]); int w = (x[next()] += 3); put(w); put(n); put(x[0]); vec3 v = vec3(1.0); v.zx = v.xz *= 2.0; put(v.x); put(v.z); float t = 1.0; t += (t = 3.0); put(t); int k = 0; k = k++ + k++; put(k); }",
    ),
    (
        "steps within steps",
        "void main() { int x[4] = int[4](0, 1, 2, 3); int y = x[x[x[x[x[1]++ & 3]++ & 3]++ & 3]++ & 3]++; put(y); for (int i = 0; i < 4; i++) put(x[i]); x[x[x[0]++ & 3]++ & 3]++; for (int i = 0; i < 4; i++) put(x[i]); }",
    ),
    (
        "effects without a use",
        "int n = 0; struct S { int x; }; int f() { n++; return n; } S s() { n += 10; return S(n); } bool touch() { n += 100; return n > 150; } void main() { f() == 1; s().x; (s().x, 3); for (int i = 0; i < 2; i++, f() + 1); put(n); touch() && touch(); put(n); vec2(f()).x; !touch(); -f(); touch() ? f() : f(); int a[2] = int[2](1, 2); a[f() & 1]; put(n); }",
    ),
    (
        "names of parameters that are written",
        "float pin(float x_in, float x) { x += 1.0; return x * 10.0 + x_in; } float pin_2(float x, float x_in) { x += 1.0; x_in += 2.0; return x * 10.0 + x_in; } void main() { put(pin(3.0, 4.0)); put(pin_2(3.0, 4.0)); }",
    ),
    (
        "order of arguments",
        "int g = 1; void fio(inout int a, int b) { a += b; } int two(int a, inout int b) { b += 1; return a; } void three(int a, out int b, inout int c) { b = a + c; c = b * 2; } void main() { int x[4] = int[4](10, 20, 30, 40); int i = 1; fio(x[i], i++); for (int k = 0; k < 4; k++) put(x[k]); put(i); int p = 2; int q = 5; three(p++, p, q); put(p); put(q); fio(q, q); put(q); three(q, q, p); put(q); put(p); i = 0; float whole[2] = float[2](0.0, 0.0); float part = modf(float(i) + 0.25, whole[i++]); put(part); put(i); put(whole[0]); }",
    ),
    (
        "comparisons as arguments",
        "bool f(bool a, bool b) { return a && !b; } void main() { float a = block.color.x; float b = 2.0; float c = block.after; float d = 4.0; int i = at; put(int(f(a < b, c > (d + 1.0) * 2.0))); bvec2 v = bvec2(a < b, c > (d + 1.0)); put(int(v.x)); put(int(v.y)); put(int(i < i + 5 >> 1)); put(int(a < b == c > d)); bool w[2] = bool[2](a < b, c >= (d)); put(int(w[0])); put(max(int(a < b), i >> (1))); }",
    ),
    (
        "own function beside one of the language",
        "float max(float a, int b) { return 42.0; } float clamp(float a) { return 1.5; } void main() { put(max(1, 2)); put(max(1.0, 2)); put(clamp(1)); put(max(1.0, 2.0)); put(max(1u, 2u)); }",
    ),
    (
        "members whose names meet",
        "struct S { float loop; float loop_; float fn_; float fn; }; void main() { S s = S(1.0, 2.0, 3.0, 4.0); s.loop_ += 10.0; put(s.loop); put(s.loop_); put(s.fn_); put(s.fn); }",
    ),
    (
        "buffer without a layout",
        "layout(binding = 2) readonly buffer Data { float a[5]; vec2 b[3]; mat2 c; int d; } data; void main() { for (int i = 0; i < 5; i++) put(data.a[i]); put(data.b[2].y); put(data.c[1].x); put(data.d); }",
    ),
    (
        "barriers",
        "shared int s[2]; void main() { s[0] = 3; memoryBarrierShared(); barrier(); s[1] = s[0] + 1; barrier(); memoryBarrier(); put(s[1]); }",
    ),
    (
        "depth textures through functions",
        "layout(binding = 3) uniform texture2D map; layout(binding = 4) uniform samplerShadow near; layout(binding = 5) uniform sampler plain; float hard(texture2D t, samplerShadow s, vec3 at) { return textureLod(sampler2DShadow(t, s), at, 0.0); } vec4 read(texture2D t, sampler s, vec2 at) { return textureLod(sampler2D(t, s), at, 0.0); } float both(texture2D t, samplerShadow s, sampler o, vec2 at) { vec4 d = read(t, o, at); put(d.x); put(d.y); put(d.z); put(d.w); return hard(t, s, vec3(at, 0.4)); } void main() { for (int i = 0; i < 16; i++) put(both(map, near, plain, (vec2(i % 4, i / 4) + 0.5) / 4.0)); }",
    ),
    (
        "depth textures gathered and fetched",
        "layout(binding = 3) uniform texture2D map; layout(binding = 4) uniform samplerShadow near; layout(binding = 5) uniform sampler plain; void main() { put(textureLod(sampler2DShadow(map, near), vec3(0.3), 0.0)); for (int i = 0; i < 4; i++) { vec2 at = vec2(i % 2 + 1, i / 2 + 1) / 4.0; vec4 a = textureGather(sampler2D(map, plain), at); vec4 b = textureGather(sampler2D(map, plain), at, 1); vec4 c = textureGather(sampler2D(map, plain), at, 3); vec4 d = textureGather(sampler2DShadow(map, near), at, 0.5); vec4 e = texelFetch(sampler2D(map, plain), ivec2(i), 0); for (int k = 0; k < 4; k++) { put(a[k]); put(b[k]); put(c[k]); put(d[k]); put(e[k]); } } }",
    ),
    (
        "comparisons by gradients of zero",
        "layout(binding = 3) uniform texture2D map; layout(binding = 4) uniform samplerShadow near; layout(binding = 5) uniform sampler plain; void main() { for (int i = 0; i < 16; i++) put(textureGrad(sampler2DShadow(map, near), vec3((vec2(i % 4, i / 4) + 0.5) / 4.0, 0.4), vec2(0.0), vec2(0.0))); }",
    ),
];

/// Cases with the words that the specification gives, where glslang differs: it copies arguments
/// that are variables after it evaluated all arguments, and GLSL 4.60, 6.1.1, copies each at its
/// place in the order.
pub const SPECIFIED: &[(&str, &str, &[u32])] = &[
    (
        "variables before effects",
        "int g = 1; int two(int a, inout int b) { b += 1; return a; } void main() { int x[4] = int[4](10, 20, 30, 40); put(two(g, x[g++])); put(g); put(x[1]); int v = 7; int r[2] = int[2](0, 0); put(two(v, r[v = 1])); put(v); put(r[1]); }",
        &[1, 2, 21, 7, 1, 1],
    ),
    (
        "a place before effects",
        "void fio(inout int a, int b) { a += b; } void main() { int q = 5; fio(q, q++); put(q); q = 5; fio(q, ++q); put(q); }",
        &[10, 11],
    ),
];

/// The whole text of a case.
pub fn whole_text(body: &str) -> String {
    format!(
        "#version 450\nlayout(local_size_x = 1) in;\n\
         layout(std430, binding = 0) buffer Out {{ uint words[]; }} result;\n\
         layout(std140, binding = 1) uniform Block {{ float list[3]; mat2 small; \
         layout(row_major) mat3 rows; vec3 color; float after; layout(row_major) mat2x3 wide; \
         bool flag; }} block;\n\
         int at = 0;\n\
         void put(uint x) {{ result.words[at++] = x; }}\n\
         void put(int x) {{ result.words[at++] = uint(x); }}\n\
         void put(float x) {{ result.words[at++] = floatBitsToUint(x); }}\n{body}\n"
    )
}

/// Calls over `f` (a float), `g` (another), `v`, `w` (vec3), `i` (int), `u` (uint), `m` (mat3).
pub const CALLS: &[&str] = &[
    "radians(f)",
    "degrees(f)",
    "sin(f)",
    "cos(f)",
    "tan(f * 0.3)",
    "asin(f * 0.2)",
    "acos(f * 0.2)",
    "atan(f)",
    "atan(f, g)",
    "sinh(f)",
    "cosh(f)",
    "tanh(f)",
    "asinh(f)",
    "acosh(abs(f) + 1.5)",
    "atanh(f * 0.1)",
    "pow(abs(f), g)",
    "exp(f)",
    "log(abs(f) + 0.5)",
    "exp2(f)",
    "log2(abs(f) + 0.5)",
    "sqrt(abs(f))",
    "inversesqrt(abs(f) + 0.5)",
    "abs(f)",
    "sign(f)",
    "floor(f)",
    "trunc(f)",
    "round(f + 0.1)",
    "roundEven(f)",
    "ceil(f)",
    "fract(f)",
    "mod(f, g)",
    "mod(-f, g)",
    "mod(v, w).x",
    "mod(v, g).y",
    "min(v, g).y",
    "max(v, w).z",
    "clamp(v, -1.0, 1.0).x",
    "clamp(f, 0.0, 1.0)",
    "mix(v, w, 0.25).y",
    "mix(v, w, w).x",
    "mix(v, w, lessThan(v, w)).z",
    "step(0.5, v).y",
    "step(v, w).z",
    "smoothstep(0.0, 2.0, v).x",
    "smoothstep(f - 1.0, f + 1.0, g)",
    "float(isnan(f))",
    "float(isinf(1.0 / (f - f)))",
    "float(isnan((f - f) / (f - f)))",
    "float(floatBitsToInt(f) & 0xffff)",
    "intBitsToFloat(0x40490fdb + i - i)",
    "uintBitsToFloat(floatBitsToUint(f))",
    "fma(f, g, 2.0)",
    "ldexp(f, 3)",
    "float(packUnorm4x8(vec4(v, 1.0) * 0.2) & 0xffffffu)",
    "unpackUnorm4x8(0x80ff4010u + u - u).y",
    "unpackSnorm4x8(0x80ff4010u + u - u).w",
    "unpackHalf2x16(packHalf2x16(v.xy)).y",
    "unpackSnorm2x16(packSnorm2x16(v.xy * 0.2)).x",
    "unpackUnorm2x16(packUnorm2x16(abs(v.xy) * 0.2)).x",
    "length(v)",
    "length(f)",
    "distance(v, w)",
    "distance(f, g)",
    "dot(v, w)",
    "dot(f, g)",
    "cross(v, w).y",
    "normalize(v).z",
    "normalize(f)",
    "faceforward(v, w, v).x",
    "faceforward(f, g, f)",
    "reflect(v, normalize(w)).x",
    "reflect(f, 1.0)",
    "refract(normalize(v), normalize(w), 0.7).y",
    "matrixCompMult(m, m)[1][2]",
    "outerProduct(v, w)[2][0]",
    "outerProduct(v.xy, w)[2][1]",
    "transpose(m)[0][2]",
    "determinant(m)",
    "inverse(m)[1][0]",
    "inverse(mat2(m))[0][1]",
    "inverse(mat4(vec4(v, 1.0), vec4(w, 0.5), vec4(m[1], 2.0), vec4(1.0, 0.0, 0.5, 3.0)))[2][1]",
    "float(lessThan(v, w).x)",
    "float(any(greaterThanEqual(v, w)))",
    "float(all(equal(v, v)))",
    "float(not(notEqual(v, w)).y)",
    "float(bitfieldExtract(u, 3, 5))",
    "float(bitfieldExtract(i, 1, 4))",
    "float(bitfieldInsert(u, 5u, 2, 3))",
    "float(bitfieldReverse(u) >> 16)",
    "float(bitCount(u))",
    "float(findLSB(u))",
    "float(findMSB(u))",
    "float(findMSB(-i))",
    "float(findLSB(0u * u))",
    "float(abs(-i))",
    "float(sign(i))",
    "float(min(i, 3))",
    "float(clamp(u, 1u, 5u))",
    "modf(f, g) + g",
    "frexp(f, i) + float(i)",
    "float(uaddCarry(u, 0xffffffffu, u)) + float(u)",
    "float(usubBorrow(1u, u, u) & 255u) + float(u)",
];

/// A program that writes what a call gives for a few values.
pub fn text_of_call(call: &str) -> String {
    let body = format!(
        "void main() {{ for (int k = 0; k < 6; k++) {{ float f = block.list[k % 3] + float(k) * 0.75; \
         float g = 1.5 + float(k); vec3 v = block.color + float(k); vec3 w = vec3(g, f, 0.5); \
         int i = k * 37 + 5; uint u = uint(k * 1001 + 77); \
         mat3 m = mat3(v, w, vec3(1.0, 0.0, 2.0)); put({call}); }} }}"
    );
    whole_text(&body)
}
