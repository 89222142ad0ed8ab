#version 330 core
// Over the whole picture, as such sites have it.
uniform float iTime;
uniform vec3 iResolution;
out vec4 color;

void main() {
    vec2 at = (gl_FragCoord.xy - 0.5 * iResolution.xy) / iResolution.y;
    float wave = sin(9.0 * at.x + iTime) + sin(11.0 * length(at) - 2.0 * iTime) + sin(7.0 * at.y + 3.0 * at.x);
    color = vec4(0.5 + 0.5 * cos(wave + vec3(0.0, 2.1, 4.2)), 1.0);
}
