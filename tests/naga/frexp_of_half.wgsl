enable f16;
@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f {
    let parts = frexp(f16(x));
    return vec4f(f32(parts.fract), f32(parts.exp), 0, 1);
}
