#version 450
layout(set = 0, binding = 0) uniform texture2D picture;
layout(set = 0, binding = 1) uniform sampler filtered;
layout(set = 0, binding = 2) uniform sampler2DShadow depth;
layout(set = 0, binding = 3) uniform sampler2D layers[2];
layout(input_attachment_index = 1, set = 0, binding = 5) uniform subpassInput before;
layout(location = 0) in vec3 at;
layout(location = 0) out vec4 color;
vec4 read(sampler2D from, vec2 uv) { return textureLod(from, uv, 2.0) + textureGather(from, uv, 1); }
float mix(float a, float b) { return a + b; }
void main() {
    color = texture(sampler2D(picture, filtered), at.xy) + read(layers[1], at.yz);
    color += subpassLoad(before) * texture(depth, at);
    color.xy += vec2(textureSize(layers[0], 0)) + mix(1.0, 2.0) * mix(at.xy, at.yz, 0.5);
    float whole;
    color.z = modf(at.z, whole) + whole + inverse(mat2(at.x, 1.0, 0.0, at.y))[0][1];
}
