// Names that end with a digit, and one of naga's own: no output has two underscores in a row, which
// browsers refuse in GLSL ES.
struct Lamp2 { color: vec4f }
struct ivec3 { scale: vec4f }
@group(0) @binding(0) var<uniform> lamp2: Lamp2;
@group(0) @binding(1) var<uniform> other: ivec3;

fn _group_0_binding_0_fs(level: f32) -> f32 {
    return level * other.scale.x;
}

@fragment fn fs_main() -> @location(0) vec4f {
    return lamp2.color * _group_0_binding_0_fs(2.0);
}
