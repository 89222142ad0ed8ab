struct Light { c: vec4f }
@group(0) @binding(0) var<uniform> lights: array<Light>;
@fragment fn fs_main() -> @location(0) vec4f { return lights[0].c; }
