@group(0) @binding(0) var a: texture_storage_2d<rgba16float, write>;
@group(0) @binding(1) var b: texture_storage_2d<r32float, read_write>;
@group(0) @binding(2) var e: texture_storage_2d_array<r32float, read>;
fn put(t: texture_storage_2d<rgba16float, write>, at: vec2u) { textureStore(t, at, vec4f(1)); }
fn both(t: texture_storage_2d<r32float, read_write>, at: vec2u) { textureStore(t, at, textureLoad(t, at + 1)); }
fn fetch(t: texture_storage_2d_array<r32float, read>, at: vec2u) -> f32 { return textureLoad(t, at, 1).x; }
@compute @workgroup_size(1) fn cs_main(@builtin(global_invocation_id) i: vec3u) { put(a, i.xy); both(b, i.xy); if fetch(e, i.xy) > 1 { put(a, i.yx); } }
