struct Storages { color: array<mat4x4f, 1>, other: array<mat3x3f, 2>, last: mat2x3f }
struct Nested { elements: array<Storages> }
@binding(0) @group(0) var<storage, read> storages: Nested;
@fragment fn main() -> @location(0) vec4f { let e = storages.elements[0]; let c = e.color; return e.color[0][0] + c[0][1] + vec4f(e.other[1][2], e.last[1].y); }
