@group(0) @binding(0) var image: texture_2d<f32>;
@fragment fn fs_main() -> @location(0) vec4f { return textureLoad(image, vec2<i32>(i32(3.0), i32(0.0)), u32(1.5)); }
