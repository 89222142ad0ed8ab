@group(0) @binding(0) var image: texture_storage_2d<rgba8unorm, read>;
fn load(t: texture_storage_2d<rgba8unorm, read>, other: vec4f) -> vec4f {
    let size = textureDimensions(t);
    return select(other, textureLoad(t, vec2u(size.x - 1, 0)), size.y > 1);
}
@fragment fn fs_main() -> @location(0) vec4f { return load(image, vec4f(1)); }
