#version 100
#extension GL_EXT_frag_depth : enable
#extension GL_EXT_shader_texture_lod : enable
precision highp float;
uniform sampler2D image;
varying vec3 place;

void main() {
    gl_FragDepthEXT = place.z;
    gl_FragColor = texture2DProjGradEXT(image, place, place.xy, place.yx);
}
