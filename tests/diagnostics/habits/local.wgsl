struct L { color: vec3f }
@group(0) @binding(0) var<uniform> l: L;
@fragment fn fs_main(@location(0) normal: vec3f) -> @location(0) vec4f {
    let n = nromal;
    return vec4f(l.colour, 1.0);
}
