#version 450
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;
const float HALF = 0.5;
float constant = 3.0 * HALF;
vec3 n = normalize(v.xyz);
float m = mix(1.0, 3.0, 0.5);
void main() { c = vec4(n, m * constant); }
