#version 450

float hard(texture2D m, samplerShadow m_sampler, vec3 uvd) {
    return texture(sampler2DShadow(m, m_sampler), uvd);
}

float twice(texture2D m, samplerShadow m_sampler, vec3 uvd) {
    return hard(m, m_sampler, uvd) * 2.0;
}

layout(set = 0, binding = 0) uniform texture2D shadow;

layout(set = 0, binding = 1) uniform samplerShadow shadow_sampler;

layout(location = 0) out vec4 color;

void main() {
    color = vec4(twice(shadow, shadow_sampler, vec3(0.5)));
}
// ---- Fragment; reads: 
