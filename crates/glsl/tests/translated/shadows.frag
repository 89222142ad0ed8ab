#version 450
layout(set = 0, binding = 0) uniform texture2D map;
layout(set = 0, binding = 1) uniform samplerShadow comparing;
layout(set = 0, binding = 2) uniform sampler plain;
layout(set = 0, binding = 3) uniform textureCube cube;
layout(location = 0) in vec3 at;
layout(location = 0) out vec4 color;
float hard(texture2D map, samplerShadow smp, vec3 at) { return textureLod(sampler2DShadow(map, smp), at, 0.0); }
float blocker(texture2D map, sampler smp, vec2 at) { return textureLod(sampler2D(map, smp), at, 0.0).r + textureGather(sampler2D(map, smp), at).y; }
float cubed(textureCube cube, samplerShadow smp) { return textureGrad(samplerCubeShadow(cube, smp), vec4(at, 0.5), vec3(0.0), vec3(0.0)); }
float soft(texture2D map, samplerShadow smp, sampler other, vec3 at) { return hard(map, smp, at) * blocker(map, other, at.xy); }
void main() { color = vec4(soft(map, comparing, plain, at), blocker(map, plain, at.yx), cubed(cube, comparing), 1.0); }
