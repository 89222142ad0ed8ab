struct S { base: vec3i, scale: f32 }
@group(0) @binding(0) var<uniform> s: S;
@vertex fn vs_main(@location(0) chunk: vec3i, @location(1) index: u32) -> @builtin(position) vec4f {
    let p = vec3f(chunk - s.base) + vec3f(-s.base) * s.scale;
    return vec4f(p / f32(index), 1);
}
