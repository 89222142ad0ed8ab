alias A = array<array<array<f32, 100000>, 100000>, 100000>;
var<private> a: A;
@fragment fn main() -> @location(0) vec4f { return vec4f(a[1][2][3]); }
