var<private> n: u32;
fn next() -> u32 { n += 1; return n; }
@fragment fn main() -> @location(0) vec4f { var a = array(0u, 0u, 0u, 0u); a[next()] += next() * 10; a[next()] = next(); return vec4f(vec4u(a[0], a[1], a[2], a[3])); }
