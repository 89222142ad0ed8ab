enable wgpu_binding_array;
@group(0) @binding(0) var images: binding_array<texture_2d<f32>>;
@fragment fn fs_main() -> @location(0) vec4f {
    return textureLoad(images[2], vec2i(0), 0);
}
