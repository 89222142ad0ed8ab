#extension GL_EXT_samplerless_texture_functions : require // for depth
void a() {}
