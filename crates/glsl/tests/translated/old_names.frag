#version 130
#extension GL_ARB_shader_texture_lod : enable
// Names of older versions and of extensions, beside an output of newer ones that nothing writes.
out vec4 colour;
uniform sampler2D image;
uniform sampler2DShadow depths;
uniform samplerCube sky;
in vec4 place;

void main() {
    vec4 sum = texture2DGradARB(image, place.xy, dFdx(place.xy), dFdy(place.xy));
    sum += texture2DProjGradARB(image, place, dFdx(place.xy), dFdy(place.xy));
    sum += textureCubeGradARB(sky, place.xyz, dFdx(place.xyz), dFdy(place.xyz));
    sum += shadow2DProj(depths, place) + texture2DProjLod(image, place.xyz, 0.0);
    gl_FragColor = sum;
}
