#version 120
varying vec2 uv;
uniform sampler2D picture;
uniform samplerCube sky;
void main() {
    vec4 texel = texture2D(picture, uv) + textureCube(sky, vec3(uv, 1));
    gl_FragColor = mod(texel, 1.0);
}
